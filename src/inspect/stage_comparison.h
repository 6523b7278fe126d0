// Each step of the vector pipeline held against the scalar reference, on the very same input
// (whit compare --stages).
#pragma once

#include <string>
#include <vector>

#include "render/renderer.h"

namespace whit {

// The worst difference between what a stage wrote into a column and what the scalar reference says,
// in ulps of the column's magnitude.
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
