// whit compare --stages: how far each vector stage is from its scalar twin.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace whit {

// The worst difference between a stage's output and its twin's on the same input, in ulps of the
// magnitude of one quantity of its columns.
struct StageDifference {
  Stage stage;
  std::string column;
  std::uint64_t slots = 0;
  double worstUlp = 0, limitUlp = 0;
  int pixelX = 0, pixelY = 0, depth = 0;
};
std::vector<StageDifference> compareStages(Renderer& renderer, const Camera& camera,
                                           const Film& film);

}  // namespace whit
