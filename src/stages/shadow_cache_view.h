// The shadow cache of one light, as kernels read it. A triangle of the world is divided into parts,
// 2^n a side by its barycentric weights, and a part that needs it into cells. The cache is filled
// between frames (shadow_cache/shadow_tables.h).
#pragma once

#include <cstdint>

namespace whit {

// Lit and dark are proved. A state that cannot be proved is mixed, and one that was not computed
// yet is unknown; rays of both are traced.
enum class ShadowState : std::uint32_t {
  unknown,
  lit,   // no shadow ray that starts there meets anything
  dark,  // one opaque triangle is met by all of them
  mixed
};

inline constexpr int kCellsASide = 32;
// How they are stored, two bits each.
inline constexpr int kCellsAWord = 16, kWordsARow = kCellsASide / kCellsAWord,
                     kWordsAPlace = kCellsASide * kWordsARow;
// Triangles that have no parts: spheres, what is instanced.
inline constexpr std::uint32_t kNoParts = 0xffffffffu;
// The last so many bits of a triangle's word say how many parts it has a side, as a power of two.
inline constexpr int kPartBits = 4;
// Along its edges a triangle has a rim that is never decided, because rays from there almost hit
// the neighbors. This is its width as a share of a part.
inline constexpr float kShadowRim = 0x1p-8f;
// A ray is decided only if it starts this near to the point of its weights, per axis, as a share of
// the sum of the sizes that the point's coordinates are interpolated from. The rounding bound by
// which rays are lifted is less, except on slivers.
inline constexpr float kCachedShadowReach = 0x1p-20f;

struct ShadowCacheView {
  // A word a triangle: the number of its first part, shifted by kPartBits; kNoParts.
  const std::uint32_t* first = nullptr;
  // A word a part, row by row of the second weight: a ShadowState, or from 4 on the place of its
  // cells, shifted by two, plus 4.
  const std::uint32_t* parts = nullptr;
  // kWordsAPlace words a place, one row of cells after the other, two bits a ShadowState.
  const std::uint32_t* cells = nullptr;
  // A byte a part: the number of rays that have requested it, at most 255, and less where workers
  // count at once. Written while frames are traced, by any worker.
  std::uint8_t* wanted = nullptr;
  bool serves() const { return first != nullptr; }
};

// Rounding errors that the proofs about shadow rays and triangles (simd/meet_casters.h) allow for.

// Half a unit in the last place of a float, and how many of them each kind of sum may be off. No
// more than eight roundings follow one another from a vertex to a sum: its difference from the
// origin and from another vertex, the product and difference of a cross product, the product and
// two sums of a dot product, and the length to the light; 12 leaves room, for what the proofs
// themselves round in double as well.
inline constexpr double kHalfUlp = 0x1p-24;
inline constexpr double kRoundings = 12;
// Products below the range of a float are flushed to zero: six of a cross product, each times a
// length, and three of a dot product, by less than 2^-126 each.
inline constexpr double kFlushed = 0x1p-122;
// Embree takes edge functions for zero that are so small a part of their sum.
inline constexpr double kEdgeTolerance = 0x1p-21;

}  // namespace whit
