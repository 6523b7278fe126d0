// Runs that are measured against each other: their frames take turns, so that other load of the
// machine affects all of them alike.
#pragma once

#include <memory>
#include <vector>

#include "cli/app/frame_summary.h"
#include "cli/app/open_scene.h"

namespace whit::cli {

// A scene with one choice of options.
class BenchRun {
 public:
  // `common` gives the film's size and limits, `options` everything else.
  BenchRun(std::shared_ptr<const OpenScene> open, const CommonOptions& common,
           const RenderOptions& options, Progress* progress);

  // Switches the shadow cache on. It is empty in all warm-up frames but the first, which goes
  // without it, and filled before the measured ones. Not in reference mode.
  void useShadowCache() { cachesShadows_ = true; }

  void warmUp();
  void measure(bool floor);  // one frame; with `floor` also Embree alone for its rays
  const RunSummary& summary() const { return summary_; }
  // Memory of the scene and the renderer in 10^6 bytes; complete after a frame.
  double memoryMb() const;
  // The last frame, and the options that made it.
  const Film& film() const { return film_; }
  const RenderOptions& options() const { return options_; }

 private:
  void fillShadowCache();

  std::shared_ptr<const OpenScene> open_;
  RenderOptions options_;
  Renderer renderer_;
  Camera camera_;
  Film film_;
  std::uint64_t maxMemoryBytes_;
  bool cachesShadows_ = false, begun_ = false;
  std::vector<double> coldMs_;
  RunSummary summary_;
};

using BenchRuns = std::vector<std::unique_ptr<BenchRun>>;

struct Turns {
  int warmUp = 3, counted = 20;
  bool floor = false;
};
// One frame of each run in turn; a floor right after its frame.
void takeTurns(const BenchRuns& runs, const Turns& turns, Progress* progress);

}  // namespace whit::cli
