// How far a vector stage may be from its scalar twin.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace whit {

// Limits, in ulps of the largest component, with the reasons for their sizes.
inline constexpr double kDirectionLimit = 4;  // a normalized sum of three products
inline constexpr double kPositionLimit = 4;   // three products, against the largest corner
inline constexpr double kLiftLimit = 8;       // three products of two positions' difference
inline constexpr double kNormalLimit = 4;  // cross product by differences of products, normalized
// An ulp of a texture coordinate u is 2^-23 u of a repeat; times the texture's size in texels and
// the contrast between two of them it is a visible number of ulps of the color (hard case H68).
inline constexpr double kTexturedLimit = 4096;
inline constexpr double kSkyLimit = 512;  // likewise, for azimuth and elevation
// A footprint that is wrong by so many ulps moves the lookup between mip levels, whose contrast may
// be that of the color; of a compact triangle that is seen head on.
inline constexpr double kFootprintLimit = 16;
inline constexpr double kConeLimit = 2;       // one product and one sum
inline constexpr double kRadianceLimit = 32;  // a dozen factors, some of them squared
inline constexpr double kWeightLimit = 4096;  // Fresnel's root at the critical angle: 4e-4 (H37)
inline constexpr double kChildLimit = 512;    // the refracted direction there: 3e-5 (H37)
inline constexpr double kSumLimit = 1;        // one addition
inline constexpr double kExact = 0;

inline double ulpOf(double magnitude) {
  const float m = static_cast<float>(std::fabs(magnitude));
  // Far below anything visible, and far enough above the least normal float for its ulp to be one
  // too: workers flush what is smaller to zero.
  constexpr float least = 1e-25f;
  const float at = std::max(m, least);
  return static_cast<double>(std::nextafter(at, std::numeric_limits<float>::infinity()) - at);
}

}  // namespace whit
