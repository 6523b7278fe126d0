#include "make/shapes/mesh_builder.h"

#include <limits>
#include <numbers>

#include "core/index.h"
#include "scene/generation_limit.h"

namespace whit::procedural {
namespace {

constexpr std::uint64_t kVertexBytes = 2 * sizeof(Vec3f) + sizeof(Vec2f);
constexpr std::uint64_t kTriangleBytes = 3 * sizeof(std::uint32_t);

std::uint64_t nodesOf(int nu, int nv) {
  return (static_cast<std::uint64_t>(nu) + 1) * (static_cast<std::uint64_t>(nv) + 1);
}

}  // namespace

std::uint32_t MeshBuilder::vertex(const SurfacePoint& point) {
  // Adding zero turns -0 into +0, so that equal positions have equal bits.
  const Vec3d p = point.position + Vec3d(0.0);

  GenerationLimit::charge(1, kVertexBytes);
  // Triangles refer to vertices by numbers of 32 bits.
  if (mesh_.positions.size() == std::numeric_limits<std::uint32_t>::max()) {
    throwLimit("a shape has more than 2^32 - 1 vertices");
  }

  mesh_.positions.emplace_back(p);
  if (shading_ == Shading::smooth) {
    mesh_.normals.emplace_back(normalized(point.normal, Vec3d{0, 1, 0}));
  }
  mesh_.uvs.push_back({static_cast<float>(point.uv.u), static_cast<float>(point.uv.v)});
  return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
}

void MeshBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const auto& p = mesh_.positions;
  if (p[a] == p[b] || p[b] == p[c] || p[c] == p[a]) return;

  GenerationLimit::charge(1, kTriangleBytes);
  mesh_.triangles.push_back({a, b, c});
}

void MeshBuilder::quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  triangle(a, b, c);
  triangle(a, c, d);
}

void MeshBuilder::plate(const std::array<Vec3d, 4>& corners, double repeat) {
  const Vec3d normal = cross(corners[2] - corners[0], corners[3] - corners[1]);
  const Vec3d size = abs(normal);

  // The texture is projected along the largest axis; seen from outside, u runs to the right.
  std::array<std::uint32_t, 4> index{};
  for (const auto k : indices(4)) {
    const Vec3d& p = corners[k];
    Uv uv{normal.x > 0 ? -p.z : p.z, p.y};
    if (size.y >= size.x && size.y >= size.z) {
      uv = {p.x, normal.y > 0 ? -p.z : p.z};
    } else if (size.z >= size.x) {
      uv = {normal.z > 0 ? p.x : -p.x, p.y};
    }
    index[k] = vertex({p, normal, {uv.u / repeat, uv.v / repeat}});
  }
  quad(index[0], index[1], index[2], index[3]);
}

void MeshBuilder::sheet(int nu, int nv, const std::function<SurfacePoint(int, int)>& at) {
  GenerationLimit::require(nodesOf(nu, nv), kVertexBytes);
  const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
  const auto row = static_cast<std::uint32_t>(nu) + 1;

  for (int j = 0; j <= nv; ++j) {
    for (int i = 0; i <= nu; ++i) vertex(at(i, j));
  }

  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(nv); ++j) {
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(nu); ++i) {
      const std::uint32_t a = first + j * row + i;
      quad(a, a + 1, a + row + 1, a + row);
    }
  }
}

void MeshBuilder::smoothSheet(int nu, int nv, bool wrapU,
                              const std::function<Vec3d(int, int)>& position,
                              const std::function<Uv(int, int)>& uv) {
  GenerationLimit::charge(nodesOf(nu, nv), sizeof(Vec3d));

  const auto row = static_cast<std::size_t>(nu) + 1;
  std::vector<Vec3d> points(row * (static_cast<std::size_t>(nv) + 1));

  // Beyond the sheet's edges lie the edges themselves, or its other end where u wraps around.
  const auto point = [&](int i, int j) -> Vec3d& {
    const int column = wrapU ? (i + nu) % nu : std::clamp(i, 0, nu);
    return points[static_cast<std::size_t>(std::clamp(j, 0, nv)) * row +
                  static_cast<std::size_t>(column)];
  };

  for (int j = 0; j <= nv; ++j) {
    for (int i = 0; i < nu + (wrapU ? 0 : 1); ++i) point(i, j) = position(i, j);
  }

  // Normals follow from central differences, which become one-sided at the edges.
  sheet(nu, nv, [&](int i, int j) {
    const Vec3d along = point(i + 1, j) - point(i - 1, j);
    const Vec3d across = point(i, j + 1) - point(i, j - 1);
    return SurfacePoint{point(i, j), cross(along, across), uv(i, j)};
  });
}

void MeshBuilder::revolve(const std::vector<ProfilePoint>& profile, int segments, double uRepeat) {
  sheet(segments, static_cast<int>(profile.size()) - 1, [&](int i, int j) {
    const ProfilePoint& q = entryOf(profile, j);
    const TurnPoint t = turn(i, segments);
    return SurfacePoint{{q.r * t.cosine, q.y, -q.r * t.sine},
                        {q.nr * t.cosine, q.ny, -q.nr * t.sine},
                        {uRepeat * i / segments, q.v}};
  });
}

void MeshBuilder::box(const Vec3d& l, const Vec3d& h, double repeat) {
  using Corners = std::array<Vec3d, 4>;
  const Vec3d v000{l.x, l.y, l.z}, v100{h.x, l.y, l.z}, v010{l.x, h.y, l.z}, v110{h.x, h.y, l.z};
  const Vec3d v001{l.x, l.y, h.z}, v101{h.x, l.y, h.z}, v011{l.x, h.y, h.z}, v111{h.x, h.y, h.z};

  plate(Corners{v001, v101, v111, v011}, repeat);
  plate(Corners{v100, v000, v010, v110}, repeat);
  plate(Corners{v101, v100, v110, v111}, repeat);
  plate(Corners{v000, v001, v011, v010}, repeat);
  plate(Corners{v011, v111, v110, v010}, repeat);
  plate(Corners{v000, v100, v101, v001}, repeat);
}

void MeshBuilder::append(const Mesh& mesh, const Affine& map) {
  const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
  const bool mirrored = map.determinant() < 0;

  for (const auto k : indices(mesh.positions)) {
    const Uv uv = mesh.uvs.empty() ? Uv{} : Uv{mesh.uvs[k].x, mesh.uvs[k].y};
    const Vec3d normal = mesh.normals.empty() ? Vec3d{} : map.normal(Vec3d(mesh.normals[k]));
    vertex({map.point(Vec3d(mesh.positions[k])), normal, uv});
  }

  // A map that mirrors would turn the triangles inside out.
  for (auto [a, b, c] : mesh.triangles) {
    if (mirrored) std::swap(b, c);
    triangle(first + a, first + b, first + c);
  }
}

Mesh MeshBuilder::take(const std::string& name) {
  mesh_.name = name;
  return std::exchange(mesh_, Mesh{});
}

TurnPoint turn(int i, int n) {
  const int k = ((i % n) + n) % n;
  const long long quarters = 4LL * k;

  // cos() and sin() are not exact at the quarters, but shapes need them to be.
  if (quarters % n == 0) {
    constexpr std::array<TurnPoint, 4> kQuarter{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    return entryOf(kQuarter, quarters / n);
  }

  const double angle = 2 * std::numbers::pi * k / n;
  return {std::cos(angle), std::sin(angle)};
}

std::vector<ProfilePoint> creasedProfile(const std::vector<std::array<double, 2>>& points,
                                         double creaseDegrees, double repeat) {
  struct Normal {
    double r, y;
  };

  std::vector<Normal> across;  // unit normals of the segments, to the right of their course
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const double dr = points[k + 1][0] - points[k][0], dy = points[k + 1][1] - points[k][1];
    const double size = std::max(std::hypot(dr, dy), 1e-300);
    across.push_back({dy / size, -dr / size});
  }

  const double smoothest = std::cos(creaseDegrees * std::numbers::pi / 180);
  std::vector<ProfilePoint> profile;
  double v = 0;
  for (const auto k : indices(points)) {
    const double r = points[k][0], y = points[k][1];
    if (k > 0) v += std::hypot(r - points[k - 1][0], y - points[k - 1][1]) / repeat;

    const Normal before = across[k > 0 ? k - 1 : 0];
    const Normal after = across[std::min(k, across.size() - 1)];
    // A crease has two points in one place, each with the normal of its own segment.
    if (before.r * after.r + before.y * after.y >= smoothest) {
      profile.push_back({r, y, before.r + after.r, before.y + after.y, v});
    } else {
      profile.push_back({r, y, before.r, before.y, v});
      profile.push_back({r, y, after.r, after.y, v});
    }
  }
  return profile;
}

}  // namespace whit::procedural
