#include "inspect/floor.h"

#include <algorithm>
#include <atomic>
#include <deque>
#include <mutex>
#include <vector>

namespace whit {

namespace {

// Notes the rays that go to Embree, in the order in which they do.
class RayLogger : public StageObserver {
 public:
  void after(Stage stage, const Chunk& c) override {
    if (stage == Stage::findIntersections) {
      for (std::size_t s = 0; s < c.segmentCount; ++s) {
        const Segment& segment = c.segments[s];
        log_.append(advanced(c.rays, segment.begin), segment.end - segment.begin, c.coherent);
      }
    } else if (stage == Stage::checkShadows) {
      log_.append(c.shadows, c.shadowCount, c.shadowsAreCoherent());
    }
  }
  const RayLog& log() const { return log_; }

 private:
  RayLog log_;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Wall-clock time of the replay of all logs, each by the next worker that is free.
double replay(Renderer& renderer, const std::deque<RayLogger>& lists) {
  std::atomic<std::size_t> next{0};
  const int threads = renderer.machine().threads;
  std::vector<double> ms(static_cast<std::size_t>(threads));
  renderer.scheduler().pool().run([&](int worker) {
    double mine = 0;
    for (std::size_t i = next++; i < lists.size(); i = next++) {
      mine += renderer.accel().replay(lists[i].log());
    }
    ms[static_cast<std::size_t>(worker)] = mine;
  });
  double sum = 0;
  for (const double m : ms) sum += m;
  return sum / threads;
}

}  // namespace

FloorResult measureFloor(Renderer& renderer, const Camera& camera, Film& film, int frames) {
  std::deque<RayLogger> lists;
  std::mutex mutex;
  // A list of pixels is watched once, by whom it is replayed.
  renderer.render(camera, film, [&](std::size_t) {
    const std::lock_guard lock(mutex);
    return &lists.emplace_back();
  });
  FloorResult result;
  for (const RayLogger& list : lists) {
    for (const RayLog::Stream& stream : list.log().streams()) result.rays += stream.count;
  }
  std::vector<double> floors, whole;
  for (int frame = 0; frame < std::max(frames, 1); ++frame) {
    whole.push_back(renderer.render(camera, film).frameMs);
    floors.push_back(replay(renderer, lists));
  }
  result.floorMs = median(std::move(floors));
  result.frameMs = median(std::move(whole));
  return result;
}

}  // namespace whit
