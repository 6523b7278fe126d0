// Who looks on while a frame is traced: comparisons with the reference, debug views, logs of rays.
// Observers hang on the walk of the tracer (render/tile_tracer.h) and see each chunk of rays after
// each stage that it went through.
#pragma once

#include "stages/chunk.h"

namespace whit {

class StageObserver {
 public:
  virtual ~StageObserver() = default;
  virtual void after(Stage stage, const Chunk& chunk) = 0;
};

}  // namespace whit
