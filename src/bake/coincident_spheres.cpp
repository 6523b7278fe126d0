#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bake/finalize_steps.h"
#include "bake/sphere.h"

namespace whit {

namespace {

// A sphere among the others along a line. The direction of the line is in no plane that centers are
// likely to share.
struct Along {
  double way = 0;
  PlacedTriangleId id;
};
const Vec3d kLine{0.3217, 0.8431, 0.4309};

// How far a coincident sphere may be off by rounding, where `map` makes one of them of the unit
// sphere: more where they are flat or far from the origin.
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
  const std::array<Vec3d, 3> rows = inverseRows(a);
  const Vec3d x = multiply(rows, b.x), y = multiply(rows, b.y), z = multiply(rows, b.z);
  const Vec3d lengths{dot(x, x), dot(y, y), dot(z, z)}, angles{dot(x, y), dot(y, z), dot(z, x)};
  const double off = maxComponent(max(abs(angles), abs(lengths - Vec3d(1))));
  return off <= most.shape && length(multiply(rows, b.p - a.p)) <= most.center;
}

}  // namespace

CoincidentSpheres findCoincidentSpheres(const Scene& scene, const SceneOrder& order) {
  CoincidentSpheres found;
  if (scene.instancedSpheres > kMostSearched) return found;
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
