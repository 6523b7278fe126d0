// Embree's packets of rays as kernels see them: columns of words, one after the other, each as long
// as the packet is wide.
#pragma once

#include <cstddef>

namespace whit {

struct PacketWords {
  float* first;        // of the first packet
  std::size_t stride;  // words from one packet to the next
  std::size_t width;   // 4, 8 or 16: words of a column
};

// The columns that kernels use of RTCRay4, 8 and 16, and of RTCRayHit4, 8 and 16, which begin with
// the same and go on with the hit.
namespace packet_column {
inline constexpr std::size_t orgX = 0, orgY = 1, orgZ = 2, tNear = 3, dirX = 4, dirY = 5, dirZ = 6,
                             tFar = 8, id = 10;
inline constexpr std::size_t u = 15, v = 16, primitive = 17, geometry = 18, instance = 19;
}  // namespace packet_column

}  // namespace whit
