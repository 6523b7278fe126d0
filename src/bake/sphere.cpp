#include "bake/sphere.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "bake/finalize_steps.h"

namespace whit {

namespace {

// Mirrors a point of the octahedral map at the diagonal of its quadrant. The upper hemisphere fills
// the square between the diagonals, the lower one the four corners.
Vec3d fold(double x, double y) {
  const auto sign = [](double a) { return a < 0 ? -1.0 : 1.0; };
  return {(1 - std::abs(y)) * sign(x), (1 - std::abs(x)) * sign(y), 0};
}

// `way` is the position of a sphere's center along a line. The direction of the line lies in no
// plane that centers are likely to share.
struct Along {
  double way = 0;
  PlacedTriangleId id;
};
const Vec3d kLine{0.3217, 0.8431, 0.4309};

// Upper bounds on the differences by rounding between coincident spheres, measured in the space of
// the unit sphere that `map` carries. They are larger for flat spheres and for those far from the
// origin.
struct Rounding {
  double shape = 0, center = 0;
};

Rounding roundingOf(const Affine& map) {
  constexpr double kMostOfShape = 0x1p-8, kMostOfCenter = 0x1p-12;
  const auto sizeOf = [](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return std::sqrt(dot(a, a) + dot(b, b) + dot(c, c));
  };
  const std::array<Vec3d, 3> rows = inverseRows(map);
  const double least = 0x1p-22 * sizeOf(rows[0], rows[1], rows[2]);
  const double shape = std::min(4 * least * sizeOf(map.x, map.y, map.z), kMostOfShape);
  return {shape, shape + std::min(least * maxComponent(abs(map.p)), kMostOfCenter)};
}

// True if the maps make the same ellipsoid of the unit sphere: they differ by a rotation or a
// reflection that comes first.
bool coincide(const Affine& a, const Affine& b) {
  const Rounding most = roundingOf(a);

  // In the space of the unit sphere of `a`, the axes of `b` have to be orthonormal.
  const std::array<Vec3d, 3> rows = inverseRows(a);
  const Vec3d x = multiply(rows, b.x), y = multiply(rows, b.y), z = multiply(rows, b.z);
  const Vec3d lengths{dot(x, x), dot(y, y), dot(z, z)}, angles{dot(x, y), dot(y, z), dot(z, x)};
  const double off = maxComponent(max(abs(angles), abs(lengths - Vec3d(1))));
  return off <= most.shape && length(multiply(rows, b.p - a.p)) <= most.center;
}

}  // namespace

std::array<Vec3d, 3> inverseRows(const Affine& map) {
  const double volume = map.determinant();
  return {cross(map.y, map.z) / volume, cross(map.z, map.x) / volume, cross(map.x, map.y) / volume};
}

Vec3d multiply(const std::array<Vec3d, 3>& rows, const Vec3d& v) {
  return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
}

TriangleRecord makeSphereRecord(const Affine& toGeometry, std::uint32_t material) {
  SphereRecord record{};
  const Vec3d columns[] = {toGeometry.x, toGeometry.y, toGeometry.z};
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 3; ++i) record.axes[3 * axis + i] = static_cast<float>(columns[axis][i]);
    record.center[axis] = static_cast<float>(toGeometry.p[axis]);
  }
  record.outward = toGeometry.determinant() < 0 ? -1.0f : 1.0f;
  record.material = material;
  return std::bit_cast<TriangleRecord>(record);
}

Affine sphereMap(const TriangleRecord& record) {
  const auto r = std::bit_cast<SphereRecord>(record);
  const auto column = [&](int i) {
    return Vec3d(double{r.axes[i]}, double{r.axes[i + 1]}, double{r.axes[i + 2]});
  };
  return {column(0), column(3), column(6),
          Vec3d(double{r.center[0]}, double{r.center[1]}, double{r.center[2]})};
}

Affine sphereInWorld(const Scene& scene, PlacedTriangleId sphere) {
  const Affine own = sphereMap(scene.triangles[sphere.triangle]);
  return sphere.instance == kNoInstance ? own : scene.instances[sphere.instance].toWorld * own;
}

Box sphereBounds(const Affine& map) {
  Vec3f lower, upper;
  // An ellipsoid reaches as far along an axis as that row of its linear part is long.
  for (int i = 0; i < 3; ++i) {
    const double reach = std::sqrt(map.x[i] * map.x[i] + map.y[i] * map.y[i] + map.z[i] * map.z[i]);
    // The margin covers the rounding of the map to floats.
    const double room = 0x1p-21 * (reach + std::abs(map.p[i]));
    lower[i] = static_cast<float>(map.p[i] - reach - room);
    upper[i] = static_cast<float>(map.p[i] + reach + room);
  }

  Box box;
  box.add(lower);
  box.add(upper);
  return box;
}

std::array<double, 2> sphereWeights(const Vec3d& unit) {
  // The sphere is projected onto the octahedron |x| + |y| + |z| = 1, which is unfolded to a square.
  const Vec3d on = unit / (std::abs(unit.x) + std::abs(unit.y) + std::abs(unit.z));
  const Vec3d flat = on.z < 0 ? fold(on.x, on.y) : on;
  return {kSphereWeightBegin + kSphereWeightScale * (flat.x + 1),
          kSphereWeightBegin + kSphereWeightScale * (flat.y + 1)};
}

Vec3d spherePoint(double u, double v) {
  const double x = (u - kSphereWeightBegin) / kSphereWeightScale - 1;
  const double y = (v - kSphereWeightBegin) / kSphereWeightScale - 1;
  const double z = 1 - std::abs(x) - std::abs(y);
  const Vec3d flat = z < 0 ? fold(x, y) : Vec3d{x, y, 0};
  return normalized(Vec3d{flat.x, flat.y, z});
}

std::array<double, 2> sphereUv(const Vec3d& unit) {
  const double turn = std::atan2(-unit.z, unit.x) / (2 * std::numbers::pi);
  const double rho = std::hypot(unit.x, unit.z);
  return {turn < 0 ? turn + 1 : turn, std::atan2(rho, -unit.y) / std::numbers::pi};
}

Vec2f uvAt(const Scene& scene, std::uint32_t number, double u, double v) {
  if (scene.isSphere(number)) {
    const std::array<double, 2> uv = sphereUv(spherePoint(u, v));
    return {static_cast<float>(uv[0]), static_cast<float>(uv[1])};
  }

  const float* const uvs = scene.uvsOf(number, false);
  const auto at = [&](std::size_t i) {
    return static_cast<float>((1 - u - v) * double{uvs[i]} + u * double{uvs[i + 2]} +
                              v * double{uvs[i + 4]});
  };
  return {at(0), at(1)};
}

TriangleRecord touchingTriangle(const TriangleRecord& sphere, double u, double v) {
  const Affine map = sphereMap(sphere);
  const Vec3d q = spherePoint(u, v);
  const auto [s, t] = sphereUv(q);

  const double rho = std::hypot(q.x, q.z);
  const double cosine = rho > 0 ? q.x / rho : 1;
  const double sine = rho > 0 ? q.z / rho : 0;

  // Derivatives of the surface point by u and by v, times the edges' length in texture coordinates.
  const double step = double{kTouchingEdge} * std::numbers::pi;
  const double round = 2 * step * std::max(rho, double{kPoleRadius});
  const Vec3d along = map.vector(Vec3d{sine, 0, -cosine} * round);
  const Vec3d across = map.vector(Vec3d{-q.y * cosine, rho, -q.y * sine} * step);

  TriangleRecord record{};
  // Where the map mirrors, the edges change places, so that the triangle still faces outwards.
  Vec3d corners[] = {{}, along, across};
  double own = kTouchingEdge, other = 0;
  if (map.determinant() < 0) {
    std::swap(corners[1], corners[2]);
    std::swap(own, other);
  }

  const double uvs[] = {s, t, s + own, t + other, s + other, t + own};

  for (int i = 0; i < 9; ++i) record.position[i] = static_cast<float>(corners[i / 3][i % 3]);
  for (int i = 0; i < 6; ++i) record.uv[i] = static_cast<float>(uvs[i]);
  record.material = sphere.material;
  return record;
}

std::optional<SphereRoots> meetSphere(const Affine& fromUnit, const Vec3d& origin,
                                      const Vec3d& direction) {
  // The line is transformed to the space of the unit sphere.
  const std::array<Vec3d, 3> rows = inverseRows(fromUnit);
  const Vec3d f = multiply(rows, origin - fromUnit.p), d = multiply(rows, direction);
  const double a = dot(d, d), b = -dot(f, d);

  // The discriminant comes from the point of the line that is nearest to the center.
  const Vec3d nearest = f + d * (b / a);
  const double inside = 1 - dot(nearest, nearest);
  if (!(inside >= 0)) return std::nullopt;

  // `q` is free of cancellation: one root is q / a, the other follows from the product of both.
  const double q = b + std::copysign(std::sqrt(a * inside), b);
  const double first = (dot(f, f) - 1) / q, second = q / a;
  if (!(std::isfinite(first) && std::isfinite(second))) return std::nullopt;
  return SphereRoots{std::min(first, second), std::max(first, second)};
}

Vec3d onUnitSphere(const Affine& fromUnit, const Vec3d& point) {
  return multiply(inverseRows(fromUnit), point - fromUnit.p);
}

CoincidentSpheres findCoincidentSpheres(const Scene& scene, const SceneOrder& order) {
  CoincidentSpheres found;
  if (scene.instancedSpheres > kMostSearched) return found;

  // Spheres are sorted by their centers along a line, so that only neighbors are compared.
  std::vector<Along> all;
  const auto add = [&](const Geometry& geometry, std::uint32_t instance) {
    for (std::uint32_t i = 0; i < geometry.spheres; ++i) {
      const PlacedTriangleId id{geometry.firstSphere + i, instance};
      all.push_back({dot(sphereInWorld(scene, id).p, kLine), id});
    }
  };
  add(scene.geometries[0], kNoInstance);
  for (std::uint32_t k = 0; k < scene.instances.size(); ++k) {
    add(scene.geometries[scene.instances[k].geometry], k);
  }
  std::ranges::sort(all, {}, [](const Along& a) { return std::pair(a.way, orderOf(a.id)); });

  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const Affine map = sphereInWorld(scene, all[i].id);
    const double reach = maxComponent(abs(map.x) + abs(map.y) + abs(map.z));

    // Centers of coincident spheres are no farther along the line than this.
    const double most = all[i].way + 3 * reach * roundingOf(map).center;
    if (!(all[i + 1].way <= most) || found.contains(orderOf(all[i].id))) continue;

    std::vector<PlacedTriangleId> place{all[i].id};
    for (std::size_t k = i + 1; k < all.size() && all[k].way <= most; ++k) {
      const bool isPlaced = found.contains(orderOf(all[k].id));
      if (!isPlaced && coincide(map, sphereInWorld(scene, all[k].id))) place.push_back(all[k].id);
    }
    if (place.size() == 1) continue;

    std::ranges::sort(place, {}, [&](PlacedTriangleId id) { return order.placeOf(scene, id); });
    const auto shared = std::make_shared<const std::vector<PlacedTriangleId>>(std::move(place));
    for (const PlacedTriangleId& id : *shared) found.emplace(orderOf(id), shared);
  }
  return found;
}

}  // namespace whit
