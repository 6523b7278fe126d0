// Rounding errors that the proofs about shadow rays and triangles (simd/meet_casters.h) allow for.
#pragma once

namespace whit {

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
