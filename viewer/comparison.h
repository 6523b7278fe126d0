// The comparison of a frame with the scalar reference's picture of the same view.
#pragma once

#include <optional>

#include "inspect/metrics.h"
#include "render/renderer.h"

namespace whit::view {

// How the frame is compared with the reference.
enum class CompareMode { off, split, heatMap };

// Grows row by row from the top while the reference is traced.
struct Comparison {
  Film reference;  // rows [0, rows) are done
  int rows = 0;
  double referenceMs = 0;
  // These two are set when all rows are done:
  std::optional<ImageDifference> difference;
  DisplayImage heatMap;  // as large as the frame

  bool complete() const { return difference.has_value(); }
  double progress() const {
    return reference.image.height > 0 ? static_cast<double>(rows) / reference.image.height : 0;
  }
};

// Measures how far `frame` is from the finished reference. Throws as compareImages().
void finishComparison(const Film& frame, float exposure, ToneCurve curve, Comparison& comparison);

// Returns the frame left of column `split` and the rows of the reference that are done right of it.
DisplayImage splitPicture(const DisplayImage& frame, const Comparison& comparison, int split);

}  // namespace whit::view
