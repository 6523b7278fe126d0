#include "cli/bench_run.h"

#include "accuracy/digest.h"
#include "cli/info_rows.h"

namespace whit::cli {

BenchRun::BenchRun(std::shared_ptr<const OpenScene> open, const CommonOptions& common,
                   const RenderOptions& options, Progress* progress)
    : open_(std::move(open)),
      options_(options),
      renderer_(open_->scene, options, progress),
      camera_(chooseCamera(open_->scene, options)),
      film_(openFilm(open_->scene, common)),
      summary_(summarise(open_->scene, options, renderer_, film_, open_->loadMs)) {}

void BenchRun::warmUp() { renderFrame(renderer_, options_.mode, camera_, film_); }

void BenchRun::measure(bool floor) {
  summary_.frames.push_back(renderFrame(renderer_, options_.mode, camera_, film_));
  summary_.imageHash = accuracy::digestOf(film_.image);
  if (floor) summary_.floorMs.push_back(renderer_.measureFloor(camera_, film_, 1).floorMs);
}

double BenchRun::memoryMb() const { return cli::memoryMb(open_->scene, renderer_); }

void takeTurns(const BenchRuns& runs, const Turns& turns, Progress* progress) {
  for (int i = 0; i < turns.warmUp; ++i) {
    for (const auto& run : runs) run->warmUp();
  }
  for (int i = 0; i < turns.counted; ++i) {
    reportProgress(progress, "measuring", static_cast<double>(i) / turns.counted);
    for (const auto& run : runs) run->measure(turns.floor);
  }
}

}  // namespace whit::cli
