#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <utility>

#include "bake/bake_triangles.h"
#include "bake/finalize_steps.h"
#include "bake/sphere.h"
#include "core/index.h"
#include "core/machine_limits.h"
#include "core/text.h"
#include "core/worker_pool.h"

namespace whit {

namespace {

constexpr std::uint64_t kIndexLimit = std::numeric_limits<std::uint32_t>::max();

// A mesh on its way into a geometry.
struct Source {
  Mesh* mesh = nullptr;
  Affine toGeometry;
  std::uint32_t firstVertex = 0;
  SceneOrder::PlacedMesh place;
  std::uint32_t item = 0, firstOfItem = 0;  // the item's first triangle, in the file's order
  TriangleClassification classified;
};

struct PlacedSphere {
  Affine map;
  std::uint32_t material = 0;
  std::uint64_t rank = 0;  // place in the order of the scene
  std::uint32_t instance = 0, item = 0, number = 0;
};

// The bits of a corner's numbers: its position and, where an alpha map cuts the material, both
// pairs of texture coordinates. Bits of numbers that are not finite are equal to themselves.
using PlacedCorner = std::array<std::uint32_t, 7>;

// A triangle by its baked corners in ascending order, and what must be equal too for one of two in
// the same place to be redundant. Which of them a ray meets would be left to the order in which
// they are tested, and with it the last bits of the picture.
struct PlacedTriangle {
  PlacedTriangle(const std::array<PlacedCorner, 3>& all, std::uint32_t number, bool bothSides,
                 bool isCut)
      : corners(all), material(number), used(isCut ? 7 : 3) {
    // The winding turns around if sorting swaps an odd number of pairs.
    const auto& [a, b, c] = all;
    const bool odd = (b < a) != (c < a);
    turned = !bothSides && odd != (c < b);
    std::ranges::sort(corners);
  }
  bool operator==(const PlacedTriangle&) const = default;
  std::uint64_t hash() const {
    std::uint64_t all = material;
    for (const PlacedCorner& corner : corners) {
      for (const auto i : indices(used)) all = mixed64(all + corner[i]);
    }
    return all;
  }

  std::array<PlacedCorner, 3> corners;
  std::uint32_t material;
  std::uint32_t used;   // so many of a corner's numbers count, and the others are 0
  bool turned = false;  // its corners run in the opposite direction, and one side alone is seen
};

// The hash of a triangle, and the triangle's index in a list of places.
using HashedPlace = std::pair<std::uint64_t, std::size_t>;

// Drops places whose hash no other place has. Two tables, of at least eight bits a place, find
// nearly all of them.
void dropSingles(std::vector<HashedPlace>& places) {
  const std::size_t mask = std::bit_ceil(8 * places.size() + 1) - 1;
  std::vector<bool> once(mask + 1), twice(mask + 1);
  for (const auto& [hash, place] : places) {
    if (once[hash & mask]) twice[hash & mask] = true;
    once[hash & mask] = true;
  }
  std::erase_if(places, [&](const HashedPlace& p) { return !twice[p.first & mask]; });
}

bool bends(const Object& object) {
  return std::ranges::any_of(object.meshes,
                             [](const Mesh& mesh) { return mesh.deformation != nullptr; });
}

PlacedCorner placedCorner(const Source& source, const std::vector<Vec3f>& positions,
                          std::uint32_t vertex, bool isCut) {
  const Vec3f& p = positions[source.firstVertex + vertex];
  const auto uvOf = [&](const std::vector<Vec2f>& uvs) {
    return isCut && !uvs.empty() ? uvs[vertex] : Vec2f{};
  };
  const Vec2f uv = uvOf(source.mesh->uvs), second = uvOf(source.mesh->secondUvs);

  // Adding 0 turns -0 into +0, because both are the same number.
  PlacedCorner corner;
  const std::array numbers{p.x, p.y, p.z, uv.x, uv.y, second.x, second.y};
  for (const auto i : indices(numbers)) corner[i] = std::bit_cast<std::uint32_t>(numbers[i] + 0.0f);
  return corner;
}

class Baker {
 public:
  Baker(SceneDescription& description, Scene& scene, Warnings& warnings, Progress* progress)
      : description_(description), scene_(scene), warnings_(warnings), progress_(progress) {
    for (const Material& m : scene.materials) uses_.push_back(useOf(m, scene.textures));
  }

  SceneOrder run() {
    plan();

    // All triangles are classified before the tables are allocated in their final sizes.
    for (const auto g : indices(sources_)) {
      place(g);
      dropCoincident(g);
      countClasses(g);
    }

    dropEmptyGeometries();
    reserveTables();
    for (const auto g : indices(sources_)) emit(g);

    // Spheres take the numbers behind those of all triangles.
    scene_.firstSphere = static_cast<std::uint32_t>(scene_.triangles.size());
    for (const auto g : indices(sources_)) emitSpheres(g);

    findWhatMoves();
    if (!scene_.motion.ofGeometry) {
      boundInstances(scene_, boxes_, warnings_);
    } else {
      // moveScene() bounds the instances for each time.
      scene_.motion.instances = scene_.instances;
      countInstanced(scene_);
      scene_.motion.boxes = std::move(boxes_);
    }
    return std::move(order_);
  }

 private:
  // Assigns meshes to geometries. Objects that are used once and stand still belong to geometry 0,
  // which is the world; every other object gets a geometry of its own.
  void plan() {
    std::vector<Object>& objects = description_.objects;
    nameItems();

    std::vector<std::uint64_t> uses(objects.size());
    std::vector<bool> moves(objects.size());
    for (const auto i : indices(objects)) moves[i] = bends(objects[i]);
    for (const Instance& instance : description_.instances) {
      ++uses[instance.object];
      if (instance.mover != kNoNode) moves[instance.object] = true;
    }

    // Geometries are numbered in the order of the objects. Objects without instances are freed.
    std::vector<std::uint32_t> geometryOf(objects.size());
    std::uint32_t geometries = 1;
    for (const auto i : indices(objects)) {
      if (uses[i] > 1 || (uses[i] == 1 && moves[i])) geometryOf[i] = geometries++;
      if (uses[i] == 0) objects[i] = {};
    }

    sources_.resize(geometries);
    order_.meshes.resize(geometries);
    spheres_.resize(geometries);
    scene_.geometries.resize(geometries);

    for (std::uint32_t i = 0; i < description_.instances.size(); ++i) {
      const Instance& instance = description_.instances[i];
      const std::uint32_t g = geometryOf[instance.object];
      const bool inWorld = g == 0;
      order_.instances.push_back(instance.rank);
      if (!inWorld) {
        scene_.instances.push_back(
            {g, i, instance.toWorld, instance.mover, instance.toWorld, firstItemOf(i)});
      }

      // The first instance of an object fills the geometry that all of its instances share.
      if (!inWorld && !sources_[g].empty()) continue;

      for (Mesh& mesh : objects[instance.object].meshes) {
        Source source;
        source.mesh = &mesh;
        source.place.rank = mesh.rank;
        source.item = mesh.item;
        if (inWorld) {
          source.toGeometry = instance.toWorld;
          source.place.instance = i;
          source.place.rank += instance.rank;
          source.item += firstItemOf(i);
        }
        sources_[g].push_back(std::move(source));
        withNormals_ = withNormals_ || !mesh.normals.empty();
        withColors_ = withColors_ || !mesh.colors.empty();
        withSecondUvs_ = withSecondUvs_ || !mesh.secondUvs.empty();
      }
    }
  }

  void nameItems() {
    ItemNumbers& items = scene_.items;
    items.count = description_.items;
    items.names = std::move(description_.itemNames);
    if (items.count > 0) return;

    // A description without numbered items has one item for each instance.
    items.count = description_.instances.size();
    for (const Instance& instance : description_.instances) {
      if (items.names.size() == kNamedItems) break;
      items.names.push_back(description_.objects[instance.object].name);
    }
  }

  std::uint32_t firstItemOf(std::size_t instance) const {
    const std::uint64_t item =
        description_.items > 0 ? description_.instances[instance].firstItem : instance;
    return static_cast<std::uint32_t>(std::min(item, kIndexLimit - 1));
  }

  void numberTriangles(std::size_t g) {
    std::vector<Source>& sources = sources_[g];
    std::uint32_t end = 0;
    for (const auto s : indices(sources)) {
      sources[s].place.firstTriangle = end;
      // Meshes of one item follow each other and share its numbering.
      const bool goesOn = s > 0 && sources[s].item == sources[s - 1].item;
      sources[s].firstOfItem = goesOn ? sources[s - 1].firstOfItem : sources[s].place.firstTriangle;
      end += static_cast<std::uint32_t>(sources[s].mesh->triangles.size());
      order_.meshes[g].push_back(sources[s].place);
    }
  }

  // Transforms the vertices of a geometry and classifies its triangles.
  void place(std::size_t g) {
    Geometry& geometry = scene_.geometries[g];
    std::uint64_t vertices = 0, triangles = 0;
    for (const Source& source : sources_[g]) {
      vertices += source.mesh->positions.size();
      triangles += source.mesh->triangles.size();
    }
    if (vertices > kIndexLimit) throwLimit("more than 2^32 - 1 vertices");
    if (triangles > kIndexLimit) throwLimit("more than 2^32 - 1 triangles");

    numberTriangles(g);
    // Embree reads 16 bytes at the last vertex too, which the extra element provides.
    geometry.position.reserve(vertices + 1);

    for (Source& source : sources_[g]) {
      transform(*source.mesh, source.toGeometry);
      placeSpheres(source, g);

      // The mesh loses its positions here, so that they are in memory twice for one mesh only.
      source.firstVertex = static_cast<std::uint32_t>(geometry.position.size());
      const std::vector<Vec3f> positions = std::exchange(source.mesh->positions, {});
      geometry.position.insert(geometry.position.end(), positions.begin(), positions.end());
      source.classified =
          classifyTriangles(*source.mesh, geometry.position.data() + source.firstVertex,
                            positions.size(), uses_, warnings_);
    }
  }

  // Numbers of a geometry's sources, the last in the order of the scene first.
  std::vector<std::uint32_t> fromTheLast(std::size_t g) const {
    std::vector<std::uint32_t> numbers(sources_[g].size());
    std::iota(numbers.rbegin(), numbers.rend(), 0u);
    std::ranges::stable_sort(numbers, [&](std::uint32_t a, std::uint32_t b) {
      return sources_[g][a].place.rank > sources_[g][b].place.rank;
    });
    return numbers;
  }

  // Drops spheres that Embree would not take, or that have no inside.
  void placeSpheres(const Source& source, std::size_t g) {
    const Mesh& mesh = *source.mesh;
    std::uint64_t dropped = 0;
    std::uint32_t number = 0;

    for (const Affine& map : mesh.spheres) {
      const Box box = sphereBounds(map);
      const bool fits = isFinite(box.lower) && isFinite(box.upper) &&
                        maxComponent(max(abs(box.lower), abs(box.upper))) <= kLargestCoordinate;

      // A map whose determinant is 0 or subnormal cannot be inverted.
      const double volume = sphereMap(makeSphereRecord(map, 0)).determinant();
      if (fits && std::isnormal(volume)) {
        spheres_[g].push_back({map, mesh.materials[0], source.place.rank, source.place.instance,
                               source.item, number});
      } else {
        ++dropped;
      }
      ++number;
    }

    warnings_.add("sphere too small, too flat or too far away dropped", "mesh '" + mesh.name + "'",
                  dropped);
  }

  // Among coincident triangles we keep the last one, because Embree would report that one. Glass
  // keeps all: two faces are two boundaries. So do meshes that bend: the triangles may part. An
  // alpha map that cuts two triangles in different places shows the one through holes of the other.
  void dropCoincident(std::size_t g) {
    const std::vector<Vec3f>& position = scene_.geometries[g].position;
    struct Place {
      std::uint32_t source, triangle;
    };

    // Candidates are the triangles of rigid meshes without transmission.
    std::vector<Place> places;  // the last one comes first
    for (const std::uint32_t s : fromTheLast(g)) {
      const Source& source = sources_[g][s];
      if (source.mesh->deformation) continue;
      for (auto i = static_cast<std::uint32_t>(source.mesh->triangles.size()); i-- > 0;) {
        if (source.classified.classes[i] == kDroppedClass) continue;
        if (scene_.materials[source.mesh->material(i)].hasTransmission()) continue;
        places.push_back({s, i});
      }
    }

    const auto triangle = [&](std::uint64_t k) {
      const auto& [s, i] = places[k];
      const Source& source = sources_[g][s];
      const std::uint32_t number = source.mesh->material(i);
      const Material& material = scene_.materials[number];
      const bool isCut = material.alphaMap != kNoTexture;

      const auto& [a, b, c] = source.mesh->triangles[i];
      return PlacedTriangle(
          {placedCorner(source, position, a, isCut), placedCorner(source, position, b, isCut),
           placedCorner(source, position, c, isCut)},
          number, material.doubleSided, isCut);
    };

    // Sorting by hash makes equal triangles neighbors; the one to keep comes first.
    std::vector<HashedPlace> order(places.size());
    constexpr std::size_t kChunk = 16384;
    parallelFor(usableThreads(), (order.size() + kChunk - 1) / kChunk, [&](std::size_t chunk, int) {
      const std::size_t end = std::min((chunk + 1) * kChunk, order.size());
      for (std::size_t k = chunk * kChunk; k < end; ++k) order[k] = {triangle(k).hash(), k};
    });
    dropSingles(order);
    std::ranges::sort(order);

    // Triangles of equal hashes are compared in full, because different ones may share a hash.
    std::vector<std::size_t> again;
    std::vector<PlacedTriangle> kept;  // the kept triangles of one hash
    for (std::size_t n = 1; n < order.size(); ++n) {
      const auto [hash, k] = order[n];
      if (hash != order[n - 1].first) {
        kept.clear();
        continue;
      }
      if (kept.empty()) kept.push_back(triangle(order[n - 1].second));
      const PlacedTriangle own = triangle(k);
      if (contains(kept, own)) {
        again.push_back(k);
      } else {
        kept.push_back(own);
      }
    }

    std::ranges::sort(again);
    for (const std::size_t k : again) {
      const auto& [s, i] = places[k];
      Source& source = sources_[g][s];
      source.classified.drop(i);
      warnings_.add("triangle in the place of another of its material dropped",
                    concat("mesh '", source.mesh->name, "', triangle ", i));
    }
  }

  void countClasses(std::size_t g) {
    Geometry& geometry = scene_.geometries[g];
    for (const Source& source : sources_[g]) {
      for (const auto c : indices(kTriangleClasses)) {
        geometry.classBegin[c + 1] += source.classified.count[c];
      }
    }

    // Prefix sums turn the counts of the classes into their bounds.
    for (const auto c : indices(kTriangleClasses)) {
      geometry.classBegin[c + 1] += geometry.classBegin[c];
    }
  }

  // Removes geometries without triangles and spheres, together with their instances.
  void dropEmptyGeometries() {
    std::vector<std::uint32_t> newNumber(sources_.size());
    std::uint32_t kept = 1;

    // Geometries that stay close the gaps. The new number of a removed one remains 0.
    for (std::size_t g = 1; g < sources_.size(); ++g) {
      if (scene_.geometries[g].classBegin.back() == 0 && spheres_[g].empty()) continue;
      if (kept != g) {
        scene_.geometries[kept] = std::move(scene_.geometries[g]);
        sources_[kept] = std::move(sources_[g]);
        order_.meshes[kept] = std::move(order_.meshes[g]);
        spheres_[kept] = std::move(spheres_[g]);
      }
      newNumber[g] = kept++;
    }

    scene_.geometries.resize(kept);
    sources_.resize(kept);
    spheres_.resize(kept);
    std::erase_if(scene_.instances,
                  [&](const InstanceRecord& i) { return newNumber[i.geometry] == 0; });
    for (InstanceRecord& i : scene_.instances) i.geometry = newNumber[i.geometry];
  }

  void reserveTables() {
    std::uint64_t triangles = 0;
    for (const Geometry& geometry : scene_.geometries) triangles += geometry.classBegin.back();

    std::uint64_t total = triangles;
    for (const auto& spheres : spheres_) total += spheres.size();
    if (total > kIndexLimit) throwLimit("more than 2^32 - 1 triangles and spheres");

    scene_.triangles.reserve(total);
    if (withNormals_) scene_.normals.reserve(total);
    if (withColors_) scene_.colors.reserve(total);
    if (withSecondUvs_) scene_.secondUvs.reserve(total);

    isSearched_ = triangles <= kMostSearched;
    if (isSearched_) order_.triangles.reserve(triangles);
    boxes_.resize(scene_.geometries.size());
  }

  // Writes the triangles class by class and in order. The tables grow at their ends while the
  // meshes are freed, so that both are never completely in memory at the same time.
  void emit(std::size_t g) {
    Geometry& geometry = scene_.geometries[g];
    geometry.firstTriangle = static_cast<std::uint32_t>(scene_.triangles.size());
    geometry.index.reserve(geometry.classBegin.back());

    // Deformed meshes are remembered, because moveScene() writes their vertices again.
    for (const Source& source : sources_[g]) {
      if (!source.mesh->deformation) continue;
      scene_.motion.bent.push_back(
          {static_cast<std::uint32_t>(g), source.firstVertex, source.mesh->deformation});
    }

    for (const auto c : indices(kTriangleClasses)) {
      for (Source& source : sources_[g]) {
        auto& count = source.classified.count;
        if (count[c] == 0) continue;

        emitClass(source, c, geometry, boxes_[g]);
        count[c] = 0;

        // A mesh is freed as soon as the last of its classes is written.
        const bool done = std::all_of(count.begin(), count.begin() + kTriangleClasses,
                                      [](std::uint32_t n) { return n == 0; });
        if (done) *source.mesh = {};

        reportProgress(progress_, "baking geometry",
                       static_cast<double>(scene_.triangles.size()) /
                           static_cast<double>(scene_.triangles.capacity()));
      }
    }
  }

  // Entries at the number of a sphere in the tables of normals, colors and second texture
  // coordinates are never used, but may be read.
  void emitSpheres(std::size_t g) {
    Geometry& geometry = scene_.geometries[g];
    geometry.firstSphere = static_cast<std::uint32_t>(scene_.triangles.size());
    geometry.spheres = static_cast<std::uint32_t>(spheres_[g].size());

    std::ranges::stable_sort(
        spheres_[g], [](const PlacedSphere& a, const PlacedSphere& b) { return a.rank < b.rank; });

    for (const PlacedSphere& sphere : spheres_[g]) {
      const auto number = static_cast<std::uint32_t>(scene_.triangles.size());
      order_.spheres.push_back({sphere.rank, sphere.instance, number});
      scene_.items.add(number, sphere.item, sphere.number);

      scene_.triangles.push_back(makeSphereRecord(sphere.map, sphere.material));
      if (withSecondUvs_) scene_.secondUvs.push_back({});
      if (withNormals_) scene_.normals.push_back({});
      if (withColors_) scene_.colors.push_back({{1, 1, 1, 1, 1, 1, 1, 1, 1}});

      const Box own = sphereBounds(sphere.map);
      boxes_[g].add(own.lower);
      boxes_[g].add(own.upper);
    }
    spheres_[g] = {};
  }

  void emitClass(const Source& source, std::size_t wanted, Geometry& geometry, Box& box) {
    const Mesh& mesh = *source.mesh;
    Tally badUv, badNormal, badColor;

    for (const auto i : indices(mesh.triangles)) {
      if (source.classified.classes[i] != wanted) continue;

      auto corners = mesh.triangles[i];
      for (std::uint32_t& corner : corners) {
        corner += source.firstVertex;
        box.add(geometry.position[corner]);
      }
      geometry.index.push_back(corners);

      const auto number = static_cast<std::uint32_t>(source.place.firstTriangle + i);
      if (isSearched_) order_.triangles.push_back(number);
      scene_.items.add(static_cast<std::uint32_t>(scene_.triangles.size()), source.item,
                       number - source.firstOfItem);

      // Each table of the scene gets one entry, so that all have the same length.
      std::uint64_t uvs = 0, normals = 0, colors = 0;
      const MaterialUse& use = uses_[mesh.material(i)];
      scene_.triangles.push_back(makeTriangleRecord(mesh, i, geometry.position, corners, use, uvs));
      if (withSecondUvs_) scene_.secondUvs.push_back(makeSecondUvRecord(mesh, i, use, uvs));
      if (withNormals_) {
        scene_.normals.push_back(makeNormalRecord(mesh, i, scene_.triangles.back(), normals));
      }
      if (withColors_) scene_.colors.push_back(makeColorRecord(mesh, i, colors));

      badUv.add(i, uvs);
      badNormal.add(i, normals);
      badColor.add(i, colors);
    }

    badUv.report(warnings_, "non-finite texture coordinate set to 0", mesh);
    badColor.report(warnings_, "vertex color out of range clamped", mesh);
    badNormal.report(warnings_, "zero or non-finite normal replaced by the face's", mesh);
  }

  void findWhatMoves() {
    BakedMotion& motion = scene_.motion;
    const auto isBent = [&](const InstanceRecord& i) {
      return std::ranges::any_of(motion.bent,
                                 [&](const BentVertices& b) { return b.geometry == i.geometry; });
    };

    for (const InstanceRecord& i : scene_.instances) {
      motion.ofGeometry |= i.mover != kNoNode || isBent(i);
    }

    // A camera that moves changes the farthest start of a ray, and so which instances can be
    // traced.
    const auto& cameras = motion.given.cameras;
    const bool carried =
        std::ranges::any_of(cameras, [](const MovingCamera& m) { return m.node != kNoNode; });
    motion.ofGeometry |= carried && !scene_.instances.empty();
  }

  SceneDescription& description_;
  Scene& scene_;
  Warnings& warnings_;
  Progress* progress_;
  SceneOrder order_;
  std::vector<MaterialUse> uses_;                   // a use for each material
  std::vector<std::vector<Source>> sources_;        // a list for each geometry
  std::vector<std::vector<PlacedSphere>> spheres_;  // likewise
  std::vector<Box> boxes_;                          // a box for each geometry, in its own space
  bool withNormals_ = false, withColors_ = false, withSecondUvs_ = false;
  bool isSearched_ = false;  // true if coplanar triangles are searched
};

}  // namespace

SceneOrder bakeGeometry(SceneDescription& description, Scene& scene, Warnings& warnings,
                        Progress* progress) {
  return Baker(description, scene, warnings, progress).run();
}

}  // namespace whit
