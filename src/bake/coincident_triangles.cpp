#include "bake/bake_triangles.h"

#include <algorithm>
#include <bit>
#include <unordered_map>

namespace whit {

namespace {

// The hash table has this many bits per triangle, so that few triangles that are alone in their
// place share a bit.
constexpr std::uint64_t kBitsPerTriangle = 32;

// Both zeros are the same place.
std::uint64_t bitsOf(float x) { return std::bit_cast<std::uint32_t>(x + 0.0f); }

// The key is the same for any order of the corners.
std::uint64_t keyOf(const PlacedTriangle& t) {
  std::uint64_t sum = t.material;
  for (const Vec3f& p : t.corners) {
    sum += mixed(mixed(bitsOf(p.x) | bitsOf(p.y) << 32) + bitsOf(p.z));
  }
  return mixed(sum);
}

bool isBefore(const Vec3f& a, const Vec3f& b) {
  return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
}

// True if the corners run in the opposite direction.
bool isTurned(const PlacedTriangle& t) {
  const auto& [a, b, c] = t.corners;
  const bool odd = isBefore(b, a) != isBefore(c, a);
  return odd != isBefore(c, b);
}

bool coincide(PlacedTriangle a, PlacedTriangle b) {
  if (a.material != b.material) return false;
  if (!a.bothSides && isTurned(a) != isTurned(b)) return false;
  std::ranges::sort(a.corners, isBefore);
  std::ranges::sort(b.corners, isBefore);
  return a.corners == b.corners;
}

}  // namespace

std::vector<std::uint64_t> findCoincident(
    std::uint64_t count, const std::function<PlacedTriangle(std::uint64_t)>& triangle) {
  const std::uint64_t bits = std::bit_ceil(std::max<std::uint64_t>(count, 1) * kBitsPerTriangle);
  std::vector<bool> once(bits), again(bits);
  bool any = false;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t bit = keyOf(triangle(i)) & (bits - 1);
    if (once[bit]) any = again[bit] = true;
    once[bit] = true;
  }
  std::vector<std::uint64_t> found;
  if (!any) return found;
  once = {};
  std::unordered_multimap<std::uint64_t, std::uint64_t> kept;
  for (std::uint64_t i = 0; i < count; ++i) {
    const PlacedTriangle own = triangle(i);
    const std::uint64_t key = keyOf(own);
    if (!again[key & (bits - 1)]) continue;
    const auto [first, last] = kept.equal_range(key);
    if (std::any_of(first, last,
                    [&](const auto& k) { return coincide(own, triangle(k.second)); })) {
      found.push_back(i);
    } else {
      kept.emplace(key, i);
    }
  }
  return found;
}

}  // namespace whit
