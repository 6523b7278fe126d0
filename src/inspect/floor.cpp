#include "inspect/floor.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "core/quantile.h"

namespace whit {

namespace {

// Notes the rays that go to Embree, in the order in which they do.
class RayLogger : public StageObserver {
 public:
  void after(Stage stage, const Chunk& c) override {
    if (stage == Stage::findIntersections) {
      for (std::size_t s = 0; s < c.segmentCount; ++s) {
        const Segment& segment = c.segments[s];
        const RayColumns r = advanced(c.rays, segment.begin);
        log_.append(false, c.coherent, {r.orgX, r.orgY, r.orgZ, r.dirX, r.dirY, r.dirZ, nullptr},
                    segment.end - segment.begin);
      }
    } else if (stage == Stage::checkShadows) {
      const ShadowColumns& r = c.shadows;
      log_.append(true, c.shadowsAreCoherent(),
                  {r.orgX, r.orgY, r.orgZ, r.dirX, r.dirY, r.dirZ, r.tFar}, c.shadowCount);
    }
  }
  const RayLog& log() const { return log_; }

 private:
  RayLog log_;
};

// Returns the wall-clock time of the replay of all logs, one for each worker.
double replay(Renderer& renderer, const std::vector<RayLogger>& loggers) {
  std::vector<double> ms(loggers.size());
  renderer.scheduler().pool().run([&](int worker) {
    const auto w = static_cast<std::size_t>(worker);
    ms[w] = renderer.accel().replay(loggers[w].log());
  });
  return std::accumulate(ms.begin(), ms.end(), 0.0) / static_cast<double>(ms.size());
}

}  // namespace

FloorResult measureFloor(Renderer& renderer, const Camera& camera, Film& film, int frames) {
  std::vector<RayLogger> loggers(static_cast<std::size_t>(renderer.machine().threads));
  std::vector<StageObserver*> observers;
  observers.reserve(loggers.size());
  for (RayLogger& logger : loggers) observers.push_back(&logger);
  renderer.render(camera, film, nullptr, observers);
  FloorResult result;
  for (const RayLogger& logger : loggers) {
    for (const RayLog::Stream& stream : logger.log().streams()) result.rays += stream.count;
  }
  std::vector<double> floors, whole;
  for (int frame = 0; frame < std::max(frames, 1); ++frame) {
    whole.push_back(renderer.render(camera, film).frameMs);
    floors.push_back(replay(renderer, loggers));
  }
  result.floorMs = quantile(std::move(floors), 0.5);
  result.frameMs = quantile(std::move(whole), 0.5);
  return result;
}

}  // namespace whit
