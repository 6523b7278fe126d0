// The plan of a frame: the list of steps that run. Made once from what the scene calls for and what
// the options ask for; nothing in a frame asks again. The tracer (render/tile_tracer.h), the
// observers, `whit info` and the benchmarks all walk these lists.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "bake/scene.h"
#include "core/options.h"
#include "stages/chunk.h"
#include "stages/stage.h"

namespace whit {

// One row of `whit info`'s kernels.
struct KernelUse {
  Stage stage;
  std::string kernel;
  std::string target;  // SIMD target, or "embree"
  bool operator==(const KernelUse&) const = default;
};

struct Step {
  std::string name;
  std::size_t number = 0;  // index in simd::kKernels of the kernel that it is or begins with
  Stage stage;
  StepFunction run;
  Parts reads, writes;
  std::uint32_t wants = 0;  // kMaterial flags: chunks of which no surfel has any of them skip it
  // For steps that write children: the kind of the children, and an upper bound on their number per
  // surfel of a primary hit. Deeper ones have one at most.
  RayKind childKind = RayKind::reflection;
  std::size_t childrenAtEye = 0;
  std::vector<KernelUse> kernels;  // what it consists of
  bool endsStage = false;          // no other step of its stage follows

  bool runsFor(std::uint32_t materialFlags) const {
    return wants == 0 || (materialFlags & wants) != 0;
  }
  std::size_t childrenAt(int depth) const {
    return depth == 0 ? childrenAtEye : std::min<std::size_t>(childrenAtEye, 1);
  }
};

// All that one light, or one sample of it, goes through.
struct LightSteps {
  std::size_t light = 0;                  // index into the tables' lights, or kAmbientLight
  std::uint32_t sample = 0, samples = 1;  // which part of it, of how many
  std::vector<Step> steps;
};

struct Plan {
  EffectSet effects;        // effects that scene and options have
  FeatureSet features;      // what whole calls ask for
  bool sampled = false;     // rays are sampled: more samples of a pixel take noise away
  int depth = 0;            // deepest impulse that can occur
  bool limitsRays = false;  // a sample may have more impulses than --max-rays
  int coherentDepth = 0;    // deepest queue whose rays travel close together
  ChannelSet channels;      // channels that are kept

  std::vector<Step> perSample, perQueue, impulses, onReturn, atEye, perTile;
  std::vector<LightSteps> perLight;

  // visit(step) for every step, in the order in which they first run.
  template <typename Visitor>
  void forEachStep(Visitor&& visit) const {
    for (const Step& step : perSample) visit(step);
    for (const Step& step : perQueue) visit(step);
    for (const LightSteps& light : perLight) {
      for (const Step& step : light.steps) visit(step);
    }
    for (const std::vector<Step>* list : {&impulses, &onReturn, &atEye, &perTile}) {
      for (const Step& step : *list) visit(step);
    }
  }
  // Returns the first step for which `holds` is true, or null.
  template <typename Predicate>
  const Step* first(const Predicate& holds) const {
    const Step* found = nullptr;
    forEachStep([&](const Step& step) { found = !found && holds(step) ? &step : found; });
    return found;
  }
  const Step* find(std::string_view name) const {
    return first([&](const Step& step) { return step.name == name; });
  }
  bool writes(Part part) const {
    return first([&](const Step& step) { return step.writes.has(part); }) != nullptr;
  }
  bool has(Stage stage) const {
    return first([&](const Step& step) { return step.stage == stage; }) != nullptr;
  }
  std::vector<Stage> stages() const;
};

// Makes a plan for kernels of the chosen target (simd::chooseTarget).
Plan makePlan(const Scene& scene, const RenderOptions& options);

std::vector<KernelUse> kernelsOf(const Plan& plan);

}  // namespace whit
