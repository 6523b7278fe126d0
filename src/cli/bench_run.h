// Runs that are measured against each other: their frames take turns, so that other load of the
// machine affects all of them alike.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/event_counters.h"
#include "core/index.h"
#include "core/machine_limits.h"
#include "engine/engine.h"
#include "inspect/floor.h"
#include "output/digest.h"
#include "output/frame_summary.h"
#include "render/renderer.h"

namespace whit::cli {

// A scene with one choice of options.
class BenchRun {
 public:
  BenchRun(std::shared_ptr<OpenScene> open, const RenderOptions& options, Progress* progress,
           const std::string& name = "")
      : engine_(std::move(open)),
        film_(makeFilm(engine_.scene(), options, engine_.opened()->load.maxMemoryBytes)) {
    engine_.setOptions(options);
    const Renderer& renderer = engine_.prepare(progress);
    summary_ =
        summarize(engine_.scene(), engine_.options(), renderer, film_, engine_.opened()->loadMs);
    summary_.name = name;
  }

  void warmUp() { engine_.render({}, film_); }

  // Measures one frame; with `floor` also Embree alone for its rays.
  void measure(bool floor) {
    // Our own threads wait for the frame, so all other tasks are of other programs.
    summary_.otherTasks.push_back(otherRunnableTasks());
    const std::vector<double> before = readCounters(processorCounters());
    summary_.frames.push_back(engine_.render({}, film_).stats);

    const std::vector<double> after = readCounters(processorCounters());
    summary_.events.resize(std::min(before.size(), after.size()));
    for (const auto i : indices(summary_.events)) summary_.events[i] += after[i] - before[i];
    if (summary_.events.empty()) summary_.noEvents = reasonOfNoCounts(processorCounters());

    summary_.imageHash = digestOf(film_.image);
    if (floor)
      summary_.floorMs.push_back(measureFloor(engine_.renderer(), engine_.camera(), film_));
  }

  const RunSummary& summary() const { return summary_; }
  // Memory of the scene and the renderer in 10^6 bytes; complete after a frame.
  double memoryMb() const { return static_cast<double>(engine_.memoryBytes()) / 1e6; }
  const Film& film() const { return film_; }  // the last frame

 private:
  Engine engine_;
  Film film_;
  RunSummary summary_;
};

using BenchRuns = std::vector<std::unique_ptr<BenchRun>>;

struct TurnCounts {
  int warmUp = 3, counted = 20;
  bool floor = false;
};
// Measures one frame of each run in turn, and the floor of a frame right after it.
inline void measureInTurn(const BenchRuns& runs, const TurnCounts& turns, Progress* progress) {
  for (int i = 0; i < turns.warmUp; ++i) {
    for (const auto& run : runs) run->warmUp();
  }

  for (int i = 0; i < turns.counted; ++i) {
    reportProgress(progress, "measuring", static_cast<double>(i) / turns.counted);
    for (const auto& run : runs) run->measure(turns.floor);
  }
}

}  // namespace whit::cli
