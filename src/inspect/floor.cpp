#include "inspect/floor.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace whit {

namespace {

// Rays of one kind of call, in the order in which they were traced.
struct RayStream {
  bool anyHit = false, coherent = false;
  std::size_t count = 0;
  // Origin, direction, and tFar of any-hit rays; filled up to whole blocks.
  std::array<std::vector<float>, 7> columns{};
};

// Notes the rays that go to Embree.
class RayLogger : public StageObserver {
 public:
  void after(Stage stage, const Chunk& c) override {
    if (stage == Stage::findIntersections) {
      const RayColumns& r = c.rays;
      append({false, c.coherent}, r.org, r.dir, nullptr, c.n);
    } else if (stage == Stage::checkShadows) {
      const ShadowColumns& r = c.shadows;
      append({true, c.shadowsAreCoherent()}, r.org, r.dir, r.tFar, c.shadowCount);
    }
  }
  const std::vector<RayStream>& streams() const { return streams_; }

 private:
  void append(const RayStream& kind, const Columns3& org, const Columns3& dir, const float* tFar,
              std::size_t n) {
    const std::array<const float*, 7> rays{org.x, org.y, org.z, dir.x, dir.y, dir.z, tFar};
    auto stream = std::ranges::find_if(streams_, [&](const RayStream& s) {
      return s.anyHit == kind.anyHit && s.coherent == kind.coherent;
    });
    if (stream == streams_.end()) stream = streams_.insert(stream, kind);

    // Columns are padded to whole blocks, so new rays replace the padding.
    for (std::size_t c = 0; c < rays.size() && rays[c]; ++c) {
      std::vector<float>& column = stream->columns[c];
      column.resize(stream->count);
      column.insert(column.end(), rays[c], rays[c] + n);
      column.resize(roundUpToBlock(stream->count + n));
    }

    stream->count += n;
  }

  std::vector<RayStream> streams_;
};

// Returns the milliseconds that Embree needs for the rays, in full packets.
double replay(const Accel& accel, const RayStream& stream) {
  const FrameConstants constants{};
  TraceMeter meter;
  Chunk c;
  c.frame = &constants;
  c.meter = &meter;
  c.coherent = stream.coherent;
  c.depth = 1;  // rays of depth 0 would be traced again where their eye lies in a surface

  // Rays are only read.
  const auto column = [&](std::size_t i) { return const_cast<float*>(stream.columns[i].data()); };
  const Columns3 org{column(0), column(1), column(2)}, dir{column(3), column(4), column(5)};

  if (stream.anyHit) {
    // Each any-hit ray has a result slot of its own.
    std::vector<std::uint32_t> slots(roundUpToBlock(stream.count));
    std::iota(slots.begin(), slots.end(), 0u);
    const ColumnStore<UnshadowedColumns> results(stream.count, {});
    c.unshadowed = *results;
    c.shadows = {org, dir, column(6), slots.data()};
    c.shadowCount = stream.count;

    accel.checkShadows(c);
    return meter.embreeMs;
  }

  // Closest-hit rays form a single segment.
  const ColumnStore<HitColumns> results(stream.count, {});
  c.hits = *results;
  c.rays = {org, dir};
  c.n = stream.count;
  c.segments[0] = {RayKind::primary, 0, c.n};
  c.segmentCount = 1;

  accel.findHits(c);
  return meter.embreeMs;
}

// Replays the log of each worker, all at once. Returns the mean over the workers of the
// milliseconds inside Embree.
double replay(Renderer& renderer, const std::vector<RayLogger>& loggers) {
  std::vector<double> ms(loggers.size());
  renderer.scheduler().pool().run([&](int worker) {
    const std::size_t w = worker;
    for (const RayStream& stream : loggers[w].streams()) ms[w] += replay(renderer.accel(), stream);
  });

  return std::accumulate(ms.begin(), ms.end(), 0.0) / static_cast<double>(ms.size());
}

}  // namespace

double measureFloor(Renderer& renderer, const Camera& camera, Film& film) {
  std::vector<RayLogger> loggers(renderer.machine().threads);
  std::vector<StageObserver*> observers;
  observers.reserve(loggers.size());
  for (RayLogger& logger : loggers) observers.push_back(&logger);

  renderer.render({.camera = camera, .film = film, .observers = observers});

  // A frame without observers comes before the replay, so that caches hold what a frame leaves.
  renderer.render(camera, film);
  return replay(renderer, loggers);
}

}  // namespace whit
