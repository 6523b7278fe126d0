#include "accuracy/scene_variants.h"

#include <utility>

namespace whit::accuracy {

const Scene& SceneVariants::with(int sphereSegments) {
  if (sphereSegments == segmentsGiven_) return given_;
  const auto found = others_.find(sphereSegments);
  if (found != others_.end()) return found->second;
  return others_.emplace(sphereSegments, load_(sphereSegments)).first->second;
}

std::string SceneVariants::leavesOut(int sphereSegments) {
  constexpr std::uint64_t kMostTriangles = 20'000'000;
  if (sphereSegments == 0 || sphereSegments == segmentsGiven_) return {};
  const Scene& exact = with(0);
  const std::uint64_t spheres = exact.triangles.size() - exact.firstSphere;
  const auto segments = static_cast<std::uint64_t>(sphereSegments);
  if (spheres * segments * segments <= kMostTriangles) return {};
  return std::to_string(spheres) + " spheres would be more than " +
         std::to_string(kMostTriangles / 1'000'000) + " million triangles";
}

}  // namespace whit::accuracy
