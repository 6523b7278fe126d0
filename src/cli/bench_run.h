// Runs that are measured against each other: their frames take turns, so that other load of the
// machine affects all of them alike.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "accuracy/digest.h"
#include "cli/app/frame_summary.h"
#include "cli/app/open_scene.h"
#include "inspect/floor.h"
#include "render/renderer.h"

namespace whit::cli {

// A scene with one choice of options.
class BenchRun {
 public:
  BenchRun(std::shared_ptr<const OpenScene> open, const CommonOptions& common,
           const RenderOptions& options, Progress* progress)
      : open_(std::move(open)),
        options_(options),
        renderer_(open_->scene, options, progress),
        camera_(chooseCamera(open_->scene, options)),
        film_(makeFilm(open_->scene, options, common.load.maxMemoryBytes)) {
    settleExposure(renderer_, camera_, options_);
    summary_ = summarize(open_->scene, options_, renderer_, film_, open_->loadMs);
  }

  void warmUp() { renderFrame(renderer_, options_.mode, camera_, film_); }

  // Measures one frame; with `floor` also Embree alone for its rays.
  void measure(bool floor) {
    summary_.frames.push_back(renderFrame(renderer_, options_.mode, camera_, film_));
    summary_.imageHash = accuracy::digestOf(film_.image);
    if (floor) summary_.floorMs.push_back(measureFloor(renderer_, camera_, film_));
  }

  const RunSummary& summary() const { return summary_; }
  // Memory of the scene and the renderer in 10^6 bytes; complete after a frame.
  double memoryMb() const { return cli::memoryMb(open_->scene, renderer_); }
  const Film& film() const { return film_; }  // the last frame

 private:
  std::shared_ptr<const OpenScene> open_;
  RenderOptions options_;
  Renderer renderer_;
  Camera camera_;
  Film film_;
  RunSummary summary_;
};

using BenchRuns = std::vector<std::unique_ptr<BenchRun>>;

struct Turns {
  int warmUp = 3, counted = 20;
  bool floor = false;
};
// Measures one frame of each run in turn; a floor right after its frame.
inline void takeTurns(const BenchRuns& runs, const Turns& turns, Progress* progress) {
  for (int i = 0; i < turns.warmUp; ++i) {
    for (const auto& run : runs) run->warmUp();
  }
  for (int i = 0; i < turns.counted; ++i) {
    reportProgress(progress, "measuring", static_cast<double>(i) / turns.counted);
    for (const auto& run : runs) run->measure(turns.floor);
  }
}

}  // namespace whit::cli
