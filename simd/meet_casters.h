// Proofs about triangles and all shadow rays from a receiver to a light, eight triangles at a time,
// and tests against the shaft of these rays. The proofs hold for the numbers that Embree's robust
// traversal computes in single precision, not only for exact rays.
// Embree's robust test ("modified Pluecker", kernels/geometry/triangle_intersector_pluecker.h) has,
// with corners a, b, c relative to the ray's origin O and its direction D, three edge functions
// D.(a x b), D.(b x c), D.(c x a), all of one sign where the line hits the triangle, and the
// distance (a.N) / (D.N), N the normal. With D = L - O each of these numbers is linear in O: over a
// convex receiver its extremes lie at the corners. Rounding may add at most 2^-24 times the lengths
// that went into each number; the bounds below leave room beside that.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/vec3.h"

namespace whit {

struct Light;

// A light without extent. Rays end just before a point light (kShadowReach).
struct LightPoint {
  Vec3d position;  // of a directional light the unit vector towards it
  bool directional = false;

  static LightPoint of(const Light& light);
  bool operator==(const LightPoint&) const = default;
  // Not normalized, as shadow rays have it.
  Vec3d towards(const Vec3d& from) const { return directional ? position : position - from; }
};

// A convex piece of a receiving triangle. All shadow rays with weights in it, within the kernel's
// reach (kCachedShadowReach), start no further than `reach` from it.
struct Receiver {
  // A square of weights, cut by the three edges.
  static constexpr std::size_t kMostCorners = 7;
  std::array<Vec3d, kMostCorners> corners;
  std::size_t count = 0;  // none: the piece lies in the rim
  double reach = 0;
  Vec3d center;
  double radius = 0;  // around it, of the corners

  void add(const Vec3d& corner) { corners[count++] = corner; }
};

namespace simd {

// Eight boxes, tested together in single precision: centers and half widths.
struct alignas(64) BoxBlock {
  static constexpr std::size_t kBoxes = 8;
  float center[3][kBoxes] = {}, half[3][kBoxes] = {};
};

// The sides of a shaft, in single precision, further out by what rounding may add.
struct RoundedShaft {
  static constexpr std::size_t kMostPlanes = Receiver::kMostCorners + 1;
  float middle[3], width[3];  // of its box
  float outward[kMostPlanes][3], size[kMostPlanes][3], offset[kMostPlanes];
  std::size_t count = 0;
};

// Planes, with their unit normals away from the shaft, and its box.
struct ShaftSides {
  struct Plane {
    Vec3d outward;
    double offset = 0;
  };
  std::array<Plane, RoundedShaft::kMostPlanes> planes;
  std::size_t count = 0;
  Vec3d lower, upper;
};

// Eight triangles. All but the corners and the growth are of one light, the bounds of a receiver:
// they hold for its pieces as well.
struct alignas(64) CasterBlock {
  static constexpr std::size_t kCasters = 8;
  using Row = double[kCasters];
  Row corner[3][3], normal[3], gradient[3][3], lightHeight;
  Row edgeBound[3], slopeBound, heightBound;
  Row growth;
};

// A bit a triangle of the block.
using CasterBits = std::uint8_t;

// A question about `blocks` blocks of casters: `met` receives those of `asked` that rays of the
// receiver may hit. An `opaque` one may hide the receiver.
struct CasterQuestion {
  const CasterBlock* blocks = nullptr;
  std::size_t count = 0;
  const CasterBits *asked = nullptr, *opaque = nullptr;
  CasterBits* met = nullptr;
};

inline constexpr std::size_t kNoCaster = ~std::size_t{0};

struct CasterKernels {
  // Which of the boxes the shaft does not surely pass by, a bit each.
  unsigned (*meetBoxes)(const RoundedShaft& shaft, const BoxBlock& boxes);
  // From the corners, all else but the growth.
  void (*setCasters)(CasterBlock& block, const LightPoint& light, const Receiver& receiver);
  // Returns the place of a caster that hides the receiver, if one is found to: `met` is unfinished
  // then.
  std::size_t (*meetCasters)(const CasterQuestion& question, const LightPoint& light,
                             const Receiver& receiver);
  // Takes those out of `met` that the shaft passes by by more than their growth. Whether any are
  // left.
  bool (*passCasters)(const CasterQuestion& question, const ShaftSides& shaft);
};
// Returns the kernels for the chosen target.
CasterKernels findCasterKernels();

}  // namespace simd
}  // namespace whit
