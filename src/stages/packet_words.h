// Embree's packets of rays as kernels see them: consecutive columns of words, each as long as the
// packet is wide.
#pragma once

#include <cstddef>

#include "bake/scene.h"

namespace whit {

struct PacketWords {
  float* first;        // word of the first packet
  std::size_t stride;  // words from one packet to the next
  std::size_t width;   // 4, 8 or 16: words of a column
};

// Columns of RTCRay4, 8 and 16 that kernels use. RTCRayHit4, 8 and 16 begin with the same columns,
// and those of the hit follow.
namespace packet_column {
inline constexpr std::size_t orgX = 0, orgY = 1, orgZ = 2, tNear = 3;
inline constexpr std::size_t dirX = 4, dirY = 5, dirZ = 6, tFar = 8, id = 10;
inline constexpr std::size_t u = 15, v = 16, primitive = 17, geometry = 18, instance = 19;
}  // namespace packet_column

// Spheres follow the four classes of world triangles in a scene; instances follow the spheres in
// the top-level scene. Less than kFirstInstanceId, or negative, is the id of the world.
inline constexpr unsigned kSpheresId = kTriangleClasses, kFirstInstanceId = kSpheresId + 1;

}  // namespace whit
