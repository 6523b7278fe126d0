// What Embree alone takes of a frame: no pipeline around it can be faster.
#include <algorithm>
#include <atomic>

#include "render/renderer_parts.h"

namespace whit {

FloorResult Renderer::measureFloor(const Camera& camera, Film& film, int frames) {
  Parts& p = *parts_;
  FrameJob job = p.makeJob(camera, film, p.tracedWindow(film));
  std::vector<RayLog> logs;
  p.renderFrame(job, &logs);
  FloorResult result;
  for (const RayLog& log : logs) {
    for (const RayLog::Stream& stream : log.streams()) result.rays += stream.count;
  }
  std::vector<double> floors, whole;
  for (int frame = 0; frame < std::max(frames, 1); ++frame) {
    whole.push_back(p.renderFrame(job, nullptr).frameMs);
    std::atomic<std::size_t> next{0};
    std::vector<double> ms(p.tracers.size());
    p.pool->run([&](int worker) {
      double mine = 0;
      for (std::size_t i = next++; i < logs.size(); i = next++) mine += p.accel->replay(logs[i]);
      ms[static_cast<std::size_t>(worker)] = mine;
    });
    double sum = 0;
    for (const double m : ms) sum += m;
    floors.push_back(sum / p.machine.threads);
  }
  const auto median = [](std::vector<double>& values) {
    std::nth_element(values.begin(),
                     values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
  };
  result.floorMs = median(floors);
  result.frameMs = median(whole);
  return result;
}

}  // namespace whit
