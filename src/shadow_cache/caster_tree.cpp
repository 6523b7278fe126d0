#include "shadow_cache/caster_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "bake/facet.h"
#include "bake/sphere.h"
#include "stages/shadow_cache_view.h"

namespace whit {

namespace {

// The bits of a number with two zeros behind each.
std::uint64_t spread(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

// The place of a point on a curve that keeps neighbors together (Morton 1966).
std::uint64_t placeOnCurve(const Vec3f& p, const Box& bounds) {
  std::uint64_t place = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double width = double{bounds.upper[axis]} - bounds.lower[axis];
    const double at = width > 0 ? (double{p[axis]} - bounds.lower[axis]) / width : 0;
    place |= spread(static_cast<std::uint64_t>(std::clamp(at, 0.0, 1.0) * 0x1fffff)) << axis;
  }
  return place;
}

Box boxOfTriangle(const TriangleRecord& record) {
  Box box;
  for (const Vec3d& corner : cornersOf(record, nullptr)) box.add(Vec3f(corner));
  return box;
}

// The bounding box of all triangles and spheres of a geometry, in its own space.
Box boxOfGeometry(const Scene& scene, const Geometry& geometry) {
  Box box;
  for (const Vec3f& p : geometry.position) box.add(p);
  for (std::uint32_t i = 0; i < geometry.spheres; ++i) {
    const Box one = sphereBounds(sphereMap(scene.triangles[geometry.firstSphere + i]));
    box.add(one.lower);
    box.add(one.upper);
  }
  return box;
}

// The largest distances from the origin, per axis.
Vec3d extentOf(const Box& box) { return max(abs(Vec3d(box.lower)), abs(Vec3d(box.upper))); }

Box grown(const Box& box, const Vec3d& by) {
  const Vec3d size = extentOf(box);
  if (!(maxComponent(by + size) < double{kLargestCoordinate})) {
    return {Vec3f(-std::numeric_limits<float>::max()), Vec3f(std::numeric_limits<float>::max())};
  }
  // Rounding to float is less than what is added beside.
  const Vec3d more = by + size * 0x1p-22;
  return {Vec3f(Vec3d(box.lower) - more), Vec3f(Vec3d(box.upper) + more)};
}

// A triangle is tested by rays that meet the box of its leaf in Embree's BVH, which holds
// neighbors: it is taken to reach no further from the triangle than half of its size and this part
// of the scene's, or than the box of so many neighbors on the curve to each side. It is the one
// thing about Embree that proofs take for granted without a bound.
constexpr double kLeafReach = 1.0 / 1024;
constexpr std::size_t kLeafNeighbors = 4;

// Returns how near a ray must come for Embree to find a hit where there is none, if no ray starts
// further from the triangle than `distance`: the triangle's shape and its angle to the light
// decide. Infinite where the light lies in its plane. With the triangle as rounding may have moved
// it (by `turned` from its plane, where the light is), rays that cross its plane outside of it do
// so at a distance x or more, where the least of the edge functions is below zero by cosine *
// lowest / 2 * x or more.
double influenceOf(const TriangleRecord& record, const LightPoint& light, double distance) {
  constexpr double kNowhere = std::numeric_limits<double>::infinity();
  const auto [a, b, c] = cornersOf(record, nullptr);
  const Vec3d normal = cross(b - a, c - a);
  const double area2 = length(normal);
  if (!(area2 > 0)) return kNowhere;
  const double longest = std::max({length(b - a), length(c - b), length(a - c)});
  const Vec3d way = light.directional ? -light.position : a - light.position;
  const double shortest = length(way);
  const double lowest = area2 / longest;  // height over the longest edge
  const double unit = kRoundings * kHalfUlp * distance;
  const double toLight = shortest + (light.directional ? 0 : longest);
  const double away = std::fabs(dot(way, normal)) / area2;
  const double turned = unit * ((light.directional ? 0 : 1) + toLight / lowest);
  if (!(away > 2 * turned)) return kNowhere;
  // The point may be as far from the triangle as the light is.
  const double cosine = away / 2 / (light.directional ? 1 : 2 * shortest);
  const double gained = cosine * lowest / 2 - 2 * unit;
  if (!(gained > 0)) return kNowhere;
  const double influence = 2 * (3 * unit * longest / gained);
  return light.directional || influence < shortest ? influence : kNowhere;
}

float growthOf(const Scene& scene, const CasterList& list, std::size_t at,
               const LightPoint& light) {
  const CasterRef& caster = list.casters[at];
  double reach = list.boxOf(scene, caster).diagonal() / 2 + list.size * kLeafReach;
  const double influence = influenceOf(scene.triangles[caster.number], light, list.size);
  if (influence > reach) {
    Box neighbors;
    const std::size_t end = std::min(at + kLeafNeighbors + 1, list.casters.size());
    for (std::size_t i = at - std::min(at, kLeafNeighbors); i < end; ++i) {
      const Box box = list.boxOf(scene, list.casters[i]);
      neighbors.add(box.lower);
      neighbors.add(box.upper);
    }
    reach = std::max(reach, neighbors.diagonal());
  }
  return static_cast<float>(std::min(influence, reach)) * (1 + 0x1p-20f);
}

// Embree's own tests of boxes are off by some ulps.
constexpr double kSolidMargin = 0x1p-16;

// How far rounding moves a ray that is carried into an instance's space, as seen in the world: 16
// ulps of each product that Embree adds up there, in single precision. `start` is the extent of the
// scene, where rays start, and `own` that of the instance's geometry in its own space.
Vec3d roundingInInstance(const Affine& m, const Vec3d& own, const Vec3d& start) {
  const Vec3d x = abs(m.x), y = abs(m.y), z = abs(m.z);
  const auto intoWorld = [&](const Vec3d& v) { return x * v.x + y * v.y + z * v.z; };
  const auto cofactor = [](const Vec3d& a, const Vec3d& b, const Vec3d& v) {
    return v.x * (a.y * b.z + a.z * b.y) + v.y * (a.z * b.x + a.x * b.z) +
           v.z * (a.x * b.y + a.y * b.x);
  };
  const Vec3d world = intoWorld(own) + abs(m.p) + start;
  const Vec3d inverse{cofactor(y, z, world), cofactor(z, x, world), cofactor(x, y, world)};
  return intoWorld(own + inverse / std::fabs(m.determinant())) * 0x1p-20;
}

}  // namespace

CasterList::CasterList(const Scene& scene) {
  const Geometry& world = scene.geometries[0];
  for (std::uint32_t c = 0; c < kTriangleClasses; ++c) {
    if ((c & kNoShadowBit) != 0) continue;
    for (std::uint32_t i = world.classBegin[c]; i < world.classBegin[c + 1]; ++i) {
      casters.push_back({world.firstTriangle + i, (c & kMaskedBit) == 0});
    }
  }
  const auto addSolid = [this](const Box& box) {
    casters.push_back({CasterRef::kBox + static_cast<std::uint32_t>(solid.size()), false});
    solid.push_back(box);
  };
  for (std::uint32_t i = 0; i < world.spheres; ++i) {
    addSolid(sphereBounds(sphereMap(scene.triangles[world.firstSphere + i])));
  }
  std::vector<Box> boxes;
  const Vec3d start = extentOf({scene.lower, scene.upper});
  for (const Geometry& geometry : scene.geometries) boxes.push_back(boxOfGeometry(scene, geometry));
  for (const InstanceRecord& instance : scene.instances) {
    const Box& own = boxes[instance.geometry];
    if (own.empty()) continue;
    Box placed;
    for (int i = 0; i < 8; ++i) placed.add(Vec3f(instance.toWorld.point(Vec3d(own.corner(i)))));
    addSolid(grown(placed, roundingInInstance(instance.toWorld, extentOf(own), start)));
  }
  for (const CasterRef& caster : casters) {
    const Box box = boxOf(scene, caster);
    bounds.add(box.lower);
    bounds.add(box.upper);
  }
  if (casters.empty()) return;
  const Vec3f lower = min(bounds.lower, scene.lower), upper = max(bounds.upper, scene.upper);
  size = length(Vec3d(upper) - Vec3d(lower));
  for (Box& box : solid) box = grown(box, Vec3d(size * kSolidMargin));
  std::vector<std::pair<std::uint64_t, CasterRef>> sorted;
  sorted.reserve(casters.size());
  for (const CasterRef& caster : casters) {
    const Box box = boxOf(scene, caster);
    sorted.emplace_back(placeOnCurve((box.lower + box.upper) * 0.5f, bounds), caster);
  }
  std::ranges::stable_sort(sorted, [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < sorted.size(); ++i) casters[i] = sorted[i].second;
}

Box CasterList::boxOf(const Scene& scene, const CasterRef& caster) const {
  return caster.isBox() ? solid[caster.number - CasterRef::kBox]
                        : boxOfTriangle(scene.triangles[caster.number]);
}

std::uint64_t CasterList::bytes() const {
  return casters.size() * sizeof(CasterRef) + solid.size() * sizeof(Box);
}

CasterTree::CasterTree(const Scene& scene, const CasterList& list, const LightPoint& light)
    : list_(list) {
  growth_.reserve(list.casters.size());
  std::vector<Box> boxes;
  boxes.reserve(list.casters.size());
  for (std::size_t i = 0; i < list.casters.size(); ++i) {
    const CasterRef& caster = list.casters[i];
    const Box box = list.boxOf(scene, caster);
    growth_.push_back(caster.isBox() ? 0 : growthOf(scene, list, i, light));
    boxes.push_back(caster.isBox() ? box : grown(box, Vec3d(double{growth_.back()})));
  }
  while (!boxes.empty()) {
    std::vector<Box> above((boxes.size() + kChildren - 1) / kChildren);
    HugeVector<simd::BoxBlock>& blocks = levels_.emplace_back(above.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      setBox(blocks[i / kChildren], i % kChildren, boxes[i]);
      above[i / kChildren].add(boxes[i].lower);
      above[i / kChildren].add(boxes[i].upper);
    }
    if (blocks.size() == 1) break;
    boxes = std::move(above);
  }
}

void CasterTree::gather(const simd::CasterKernels& kernels, const simd::RoundedShaft& shaft,
                        std::vector<Candidate>& found) const {
  if (levels_.empty()) return;
  struct Node {
    std::size_t level, block;
  };
  std::array<Node, 256> stack;
  std::size_t depth = 0;
  stack[depth++] = {levels_.size() - 1, 0};
  while (depth > 0) {
    const auto [level, block] = stack[--depth];
    const std::size_t count = level == 0 ? list_.casters.size() : levels_[level - 1].size();
    for (unsigned met = kernels.meetBoxes(shaft, levels_[level][block]); met != 0; met &= met - 1) {
      const std::size_t i = block * kChildren + static_cast<std::size_t>(std::countr_zero(met));
      if (i >= count) break;
      if (level > 0) {
        stack[depth++] = {level - 1, i};
        continue;
      }
      found.push_back({list_.casters[i], growth_[i]});
    }
  }
}

std::uint64_t CasterTree::bytes() const {
  std::uint64_t blocks = 0;
  for (const auto& level : levels_) blocks += level.size();
  return blocks * sizeof(simd::BoxBlock) + growth_.size() * sizeof(float);
}

}  // namespace whit
