// What a frame will run: the effects that the scene calls for, less those disabled, and what
// follows from them: stages, ray kinds, kernel variants, columns. Made once, before the frame;
// nothing in a frame asks again.
#pragma once

#include <string>
#include <vector>

#include "core/options.h"
#include "scene/scene.h"
#include "stages/columns.h"
#include "stages/stage.h"

namespace whit {

struct Plan {
  EffectSet effects;  // what the kernels are compiled for
  std::vector<Stage> stages;
  Groups groups;  // columns that are allocated
  bool traceShadows = false, traceReflections = false, traceRefractions = false;
  bool packets = true;    // rays go to Embree by fours at least
  int glossySamples = 0;  // of a lobe that the eye sees
  int depth = 0;          // deepest impulse that can occur
};

Plan makePlan(const Scene& scene, const RenderOptions& options);

// One row of `whit info`'s kernels: those of simd/kernel_variants.h that the plan runs, and
// Embree's part of a stage.
struct KernelUse {
  Stage stage;
  std::string kernel;
  std::string variant;  // effect names joined by '+', "plain" if none
  std::string target;   // SIMD target, or "embree"
};
std::vector<KernelUse> kernelsOf(const Plan& plan);

}  // namespace whit
