#include "bake/facet_space.h"

#include <algorithm>
#include <cmath>

namespace whit {

namespace {

// Of a facet's error, by which its box is grown. One would do but for the rounding of the box to
// float and for corners of two triangles that no edge separates, though they are farther apart.
constexpr double kGrowth = 2;

// Everything is nearer than that, and floats reach much farther.
constexpr double kFarthest = 8.0 * kLargestCoordinate;

Vec3d largestCorner(const Box& box) { return max(abs(Vec3d(box.lower)), abs(Vec3d(box.upper))); }

// Bounds of the lengths to which a map takes unit vectors.
struct Stretch {
  double least, most;
};

Stretch stretchOf(const Affine& map) {
  const double squares = dot(map.x, map.x) + dot(map.y, map.y) + dot(map.z, map.z);
  // Of the three singular values the product of two is at most half the sum of all squares.
  return {2 * std::abs(map.determinant()) / squares, std::sqrt(squares)};
}

void setBox(const Vec3d& lower, const Vec3d& upper, double error, BoxedBlock& block) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    block.lower[i] = static_cast<float>(lower[axis] - kGrowth * error);
    block.upper[i] = static_cast<float>(upper[axis] + kGrowth * error);
  }
}

}  // namespace

FacetSpace FacetSpace::ofObject(const Scene& scene, const BlocksOfGeometries& blocks,
                                std::uint32_t geometry) {
  FacetSpace space(scene, blocks);
  space.geometry_ = geometry;
  const Vec3d far = largestCorner(blocks[geometry]->box(blocks[geometry]->top(), 0));
  for (const InstanceRecord& instance : scene.instances) {
    if (instance.geometry != geometry) continue;
    const Stretch stretch = stretchOf(instance.toWorld);
    const double error = kErrorOfMagnitude * magnitudeOf(far, &instance.toWorld);
    space.error_ = std::min(std::max(space.error_, error / stretch.least), kFarthest);
    // A corner's magnitude in the world is no less than the length of what its map's linear part
    // makes of it; its magnitude here is at most sqrt(3) times its length. Widths
    // grow by `most` at most.
    const double share = stretch.least / stretch.most / std::sqrt(3.0);
    space.leastShare_ = std::min(space.leastShare_, share);
  }
  return space;
}

Facet FacetSpace::facet(PlacedTriangleId id) const {
  Facet facet;
  setCorners(scene_.triangles[id.triangle], toWorld(id.instance), facet);
  facet.least *= leastShare_;
  if (error_ > 0) facet.error = error_;
  return facet;
}

BoxedBlock FacetSpace::triangle(PlacedTriangleId id) const {
  BoxedBlock boxed;
  boxed.number = id.triangle;
  boxed.instance = id.instance;
  const Affine* const map = toWorld(id.instance);
  const float* const p = scene_.triangles[id.triangle].position;
  Vec3d corners[3];
  double magnitude = 0;
  for (int i = 0; i < 3; ++i) {
    corners[i] = Vec3d(p[3 * i], p[3 * i + 1], p[3 * i + 2]);
    magnitude = std::max(magnitude, magnitudeOf(corners[i], map));
    if (map) corners[i] = map->point(corners[i]);
  }
  setBox(min(min(corners[0], corners[1]), corners[2]), max(max(corners[0], corners[1]), corners[2]),
         error_ > 0 ? error_ : kErrorOfMagnitude * magnitude, boxed);
  return boxed;
}

std::vector<BoxedBlock> FacetSpace::everything() const {
  std::vector<BoxedBlock> all;
  const TriangleBlocks& own = *blocks_[geometry_];
  if (own.top() > 0) all.push_back(block(own.top(), 0, kNoInstance));
  if (geometry_ != 0) return all;
  for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
    const TriangleBlocks& placed = *blocks_[scene_.instances[i].geometry];
    if (placed.top() > 0) all.push_back(block(placed.top(), 0, i));
  }
  return all;
}

std::uint32_t FacetSpace::firstPart(const BoxedBlock& block) const {
  const std::uint32_t first = block.number * TriangleBlocks::kChildren;
  if (block.level > 1) return first;
  return first + scene_.geometries[geometryOf(block.instance)].firstTriangle;
}

std::uint32_t FacetSpace::endOfParts(const BoxedBlock& block) const {
  const std::uint32_t geometry = geometryOf(block.instance);
  const std::uint32_t first = block.number * TriangleBlocks::kChildren;
  const std::uint32_t left = blocks_[geometry]->count(block.level - 1) - first;
  return firstPart(block) + std::min(left, TriangleBlocks::kChildren);
}

BoxedBlock FacetSpace::part(const BoxedBlock& whole, std::uint32_t number) const {
  return whole.level == 1 ? triangle({number, whole.instance})
                          : block(whole.level - 1, number, whole.instance);
}

BoxedBlock FacetSpace::block(std::uint32_t level, std::uint32_t number,
                             std::uint32_t instance) const {
  BoxedBlock boxed;
  boxed.level = level;
  boxed.number = number;
  boxed.instance = instance;
  const Box& box = blocks_[geometryOf(instance)]->box(level, number);
  const Affine* const map = toWorld(instance);
  Vec3d lower(box.lower), upper(box.upper);
  const double error = kErrorOfMagnitude * magnitudeOf(max(abs(lower), abs(upper)), map);
  if (map) {
    const Vec3d center = map->point((lower + upper) * 0.5), half = (upper - lower) * 0.5;
    const Vec3d reach = abs(map->x) * half.x + abs(map->y) * half.y + abs(map->z) * half.z;
    lower = center - reach;
    upper = center + reach;
  }
  setBox(lower, upper, error_ > 0 ? error_ : error, boxed);
  return boxed;
}

}  // namespace whit
