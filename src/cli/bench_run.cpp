#include "cli/bench_run.h"

#include "accuracy/digest.h"
#include "inspect/floor.h"
#include "render/auto_exposure.h"
#include "render/shadow_cache_schedule.h"

namespace whit::cli {

BenchRun::BenchRun(std::shared_ptr<const OpenScene> open, const CommonOptions& common,
                   const RenderOptions& options, Progress* progress)
    : open_(std::move(open)),
      options_(options),
      renderer_(open_->scene, options, progress),
      camera_(chooseCamera(open_->scene, options)),
      film_(openFilm(open_->scene, common)),
      maxMemoryBytes_(common.load.maxMemoryBytes) {
  settleExposure(renderer_, camera_, options_);
  summary_ = summarize(open_->scene, options_, renderer_, film_, open_->loadMs);
}

void BenchRun::warmUp() {
  const bool proves = cachesShadows_ && begun_ && options_.mode != Mode::reference;
  if (proves && coldMs_.empty()) {
    renderer_.expectFrames(
        memoryLeft(open_->scene, renderer_, maxMemoryBytes_),
        options_.shadowCache == ShadowCacheMode::audit ? 1 : ShadowCacheSchedule::kTurns);
  }
  const FrameStats stats = renderFrame(renderer_, options_.mode, camera_, film_);
  if (proves && renderer_.decidesShadows()) coldMs_.push_back(stats.frameMs);
  begun_ = true;
}

void BenchRun::fillShadowCache() {
  ShadowCacheUse& use = summary_.shadowCache.emplace();
  use.coldMs = quantile(coldMs_, 0.5);
  use.fillMs = renderer_.fillShadowCache().ms;
  use.bytes = renderer_.shadowCacheBytes();
}

void BenchRun::measure(bool floor) {
  if (!coldMs_.empty() && !summary_.shadowCache) fillShadowCache();
  summary_.frames.push_back(renderFrame(renderer_, options_.mode, camera_, film_));
  summary_.imageHash = accuracy::digestOf(film_.image);
  if (floor) summary_.floorMs.push_back(measureFloor(renderer_, camera_, film_, 1).floorMs);
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
