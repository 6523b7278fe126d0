// Decides where back faces have to be passed. The filter that passes them costs time and is left
// out for surfaces whose back faces cannot be seen.
#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

#include "bake/finalize_steps.h"
#include "core/index.h"
#include "core/machine_limits.h"
#include "core/worker_pool.h"

namespace whit {

namespace {

// A mesh whose coincident vertices are merged into one.
class WeldedMesh {
 public:
  explicit WeldedMesh(const Mesh& mesh) : positions_(mesh.positions) {
    const std::vector<std::uint32_t> welded = weld();
    triangles_.reserve(mesh.triangles.size());
    for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
      if (std::max({t[0], t[1], t[2]}) >= positions_.size()) continue;
      const std::array<std::uint32_t, 3> corners{welded[t[0]], welded[t[1]], welded[t[2]]};
      const bool flat =
          corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
      if (!flat) triangles_.push_back(corners);
    }
  }

  // True if each edge belongs to as many triangles in one direction as in the other.
  bool isClosed() const {
    // An edge is the sorted pair of its vertices and the direction in which a triangle runs along
    // it.
    std::vector<std::pair<std::array<std::uint32_t, 2>, int>> edges;
    edges.reserve(3 * triangles_.size());

    for (const std::array<std::uint32_t, 3>& t : triangles_) {
      for (const auto i : indices(3)) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        edges.emplace_back(std::array{std::min(a, b), std::max(a, b)}, a < b ? 1 : -1);
      }
    }

    // Sorting makes the uses of an edge neighbors. Their directions have to cancel.
    std::ranges::sort(edges);
    int balance = 0;
    for (const auto i : indices(edges)) {
      balance += edges[i].second;
      const bool last = i + 1 == edges.size() || edges[i + 1].first != edges[i].first;
      if (last && balance != 0) return false;
    }
    return true;
  }

  // True if every connected part encloses a positive volume.
  bool facesOutwards() const {
    // Union-find with path halving gives each connected part one of its vertices as its name.
    std::vector<std::uint32_t> part(positions_.size());
    std::iota(part.begin(), part.end(), 0u);
    const auto partOf = [&](std::uint32_t vertex) {
      while (part[vertex] != vertex) {
        part[vertex] = part[part[vertex]];
        vertex = part[vertex];
      }
      return vertex;
    };

    for (const std::array<std::uint32_t, 3>& t : triangles_) {
      part[partOf(t[1])] = partOf(t[0]);
      part[partOf(t[2])] = partOf(t[0]);
    }

    // Six times the signed volume of a part is the sum over the tetrahedra with that vertex.
    std::vector<double> volume(positions_.size(), 0.0);
    for (const std::array<std::uint32_t, 3>& t : triangles_) {
      const std::uint32_t own = partOf(t[0]);
      const auto at = [&](std::size_t i) { return Vec3d(positions_[t[i]] - positions_[own]); };
      volume[own] += dot(at(0), cross(at(1), at(2)));
    }
    return std::ranges::all_of(triangles_, [&](const auto& t) { return volume[partOf(t[0])] > 0; });
  }

 private:
  // Returns for each vertex the number of the first one that coincides with it.
  std::vector<std::uint32_t> weld() const {
    std::vector<std::uint32_t> order(positions_.size()), first(positions_.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) {
      return std::array{positions_[i].x, positions_[i].y, positions_[i].z};
    };
    std::ranges::sort(order, {}, [&](std::uint32_t i) { return std::pair(key(i), i); });

    for (const auto i : indices(order)) {
      const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
      first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
  }

  const std::vector<Vec3f>& positions_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

bool isShell(const Mesh& mesh) {
  const bool finite =
      std::ranges::all_of(mesh.positions, [](const Vec3f& p) { return isFinite(Vec3d(p)); });
  if (!finite) return false;

  const WeldedMesh welded(mesh);
  return welded.isClosed() && welded.facesOutwards();
}

}  // namespace

void decideDoubleSided(SceneDescription& description) {
  // A material culls if rays have to pass its back faces.
  std::vector<bool> culls(description.materials.size(), false);
  const auto isSingle = [&](const Mesh& mesh) {
    return std::ranges::any_of(mesh.materials, [&](std::uint32_t m) {
      return m < culls.size() && !description.materials[m].doubleSided &&
             !description.materials[m].boundsMedium();
    });
  };
  // Alpha maps and transmission show the inside of a mesh.
  const auto hasHoles = [&](const Mesh& mesh) {
    return std::ranges::any_of(mesh.materials, [&](std::uint32_t m) {
      if (m >= culls.size()) return false;
      const Material& material = description.materials[m];
      return material.alphaMap != kNoTexture || material.passesLight();
    });
  };

  std::vector<const Mesh*> meshes;
  for (const Object& object : description.objects) {
    for (const Mesh& mesh : object.meshes) {
      if (isSingle(mesh)) meshes.push_back(&mesh);
    }
  }

  // A closed mesh without holes hides all of its back faces from outside.
  std::vector<std::uint8_t> isClosed(meshes.size(), 0);
  parallelFor(usableThreads(), meshes.size(), [&](std::size_t i, int) {
    isClosed[i] = !hasHoles(*meshes[i]) && isShell(*meshes[i]);
  });

  for (const auto i : indices(meshes)) {
    for (const std::uint32_t m : meshes[i]->materials) {
      if (m < culls.size() && isClosed[i] == 0) culls[m] = true;
    }
  }

  for (const auto i : indices(culls)) {
    Material& m = description.materials[i];
    m.doubleSided = m.doubleSided || m.boundsMedium() || !culls[i];
  }
}

void noteHiddenSides(const SceneDescription& description, Warnings& warnings) {
  for (const Instance& instance : description.instances) {
    const Object& object = description.objects[instance.object];
    const bool mirrored = instance.toWorld.determinant() < 0;

    for (const Mesh& mesh : object.meshes) {
      const bool isSingle = std::ranges::all_of(mesh.materials, [&](std::uint32_t m) {
        return m < description.materials.size() && !description.materials[m].doubleSided;
      });

      const auto isSeen = [&](const std::array<std::uint32_t, 3>& t) {
        if (std::ranges::max(t) >= mesh.positions.size()) return false;
        const auto corner = [&](std::size_t i) {
          return instance.toWorld.point(Vec3d(mesh.positions[t[i]]));
        };
        const Vec3d p = corner(0), normal = cross(corner(1) - p, corner(2) - p);
        // A mirrored instance reverses the winding, and with it the direction of the normal.
        return std::ranges::any_of(description.cameras, [&](const Camera& camera) {
          const Vec3d target = camera.orthographicHeight > 0 ? Vec3d(camera.at) : p;
          const double side = dot(Vec3d(camera.eye) - target, normal);
          return mirrored ? side < 0 : side > 0;
        });
      };
      // A sphere has fronts towards every camera outside of it.
      if (!isSingle || !mesh.spheres.empty()) continue;
      if (std::ranges::any_of(mesh.triangles, isSeen)) continue;

      warnings.note(
          "single-sided mesh that every camera is behind is not seen (to show its back: "
          "--set /materials/*/doubleSided=true)",
          description.name + (object.name.empty() ? "" : ": " + object.name));
    }
  }
}

}  // namespace whit
