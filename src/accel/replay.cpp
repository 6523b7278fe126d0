// The floor: what Embree alone needs for the rays of a frame.
#include <vector>

#include "accel/bad_rays.h"
#include "accel/embree_scene.h"
#include "accel/parts.h"
#include "accel/trace_packets.h"

namespace whit {

namespace {

constexpr std::size_t kFloatsPerRay = 7;

template <int kWidth, typename Ray>
void loadLane(Ray& ray, int lane, const float* r, unsigned mask) {
  ray.org_x[lane] = r[0];
  ray.org_y[lane] = r[1];
  ray.org_z[lane] = r[2];
  ray.dir_x[lane] = r[3];
  ray.dir_y[lane] = r[4];
  ray.dir_z[lane] = r[5];
  ray.tfar[lane] = r[6];
  ray.tnear[lane] = ray.time[lane] = 0;
  ray.mask[lane] = mask;
  ray.id[lane] = ray.flags[lane] = 0;
}

// Full packets; the last one of a stream repeats its final ray in the lanes left over, masked off.
template <int kWidth>
double replayStream(const EmbreeScene& scene, const RayLog::Stream& stream) {
  using RayHit = typename PacketTypes<kWidth>::RayHit;
  using Ray = typename PacketTypes<kWidth>::Ray;
  const std::size_t n = stream.rays.size() / kFloatsPerRay;
  const std::size_t count = (n + kWidth - 1) / kWidth;
  std::vector<RayHit> hits(stream.occlusion ? 0 : count);
  std::vector<Ray> shadows(stream.occlusion ? count : 0);
  std::vector<Lanes<kWidth>> lanes(count);
  for (std::size_t i = 0; i < count * kWidth; ++i) {
    const std::size_t packet = i / kWidth;
    const int lane = static_cast<int>(i % kWidth);
    const float* ray = &stream.rays[std::min(i, n - 1) * kFloatsPerRay];
    lanes[packet].live[lane] = i < n ? -1 : 0;
    if (stream.occlusion) {
      loadLane<kWidth>(shadows[packet], lane, ray, kShadowMask);
      continue;
    }
    loadLane<kWidth>(hits[packet].ray, lane, ray, kSeenMask);
    hits[packet].hit.geomID[lane] = hits[packet].hit.primID[lane] = RTC_INVALID_GEOMETRY_ID;
    hits[packet].hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
  }
  for (Ray& packet : shadows) leaveOutBadRays<kWidth>(packet, scene.reach());
  for (RayHit& packet : hits) leaveOutBadRays<kWidth>(packet.ray, scene.reach());
  QueryContext context(stream.coherent);
  const bool together = stream.coherent && scene.streamWidth() == kWidth;
  const auto start = TraceClock::now();
  if (stream.occlusion) {
    occludedAll(lanes.data(), scene.top(), context, together, shadows.data(), count);
  } else {
    intersectAll(lanes.data(), scene.top(), context, together, hits.data(), count);
  }
  return millisecondsSince(start);
}

double replaySingly(const EmbreeScene& scene, const RayLog::Stream& stream) {
  const std::size_t n = stream.rays.size() / kFloatsPerRay;
  std::vector<RTCRayHit> rays;
  rays.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const float* r = &stream.rays[i * kFloatsPerRay];
    if (!isTraceable(scene.reach(), r[0], r[1], r[2], r[3], r[4], r[5])) continue;
    RTCRayHit& ray = rays.emplace_back();
    ray.ray.org_x = r[0];
    ray.ray.org_y = r[1];
    ray.ray.org_z = r[2];
    ray.ray.dir_x = r[3];
    ray.ray.dir_y = r[4];
    ray.ray.dir_z = r[5];
    ray.ray.tfar = r[6];
    ray.ray.mask = stream.occlusion ? kShadowMask : kSeenMask;
    ray.hit.geomID = ray.hit.primID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  }
  QueryContext context(stream.coherent);
  const auto start = TraceClock::now();
  for (RTCRayHit& ray : rays) {
    if (stream.occlusion) {
      occluded(nullptr, scene.top(), context, ray.ray);
    } else {
      intersect(nullptr, scene.top(), context, ray);
    }
  }
  return millisecondsSince(start);
}

}  // namespace

void RayLog::append(bool occlusion, bool coherent, const float* const columns[7], std::size_t n) {
  Stream* stream = nullptr;
  for (Stream& s : streams_) {
    if (s.occlusion == occlusion && s.coherent == coherent) stream = &s;
  }
  if (!stream) {
    streams_.push_back({occlusion, coherent, {}});
    stream = &streams_.back();
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t c = 0; c < kFloatsPerRay; ++c) stream->rays.push_back(columns[c][i]);
  }
}

double Accel::replay(const RayLog& log) const {
  double sum = 0;
  for (const RayLog::Stream& stream : log.streams()) {
    switch (stream.occlusion ? parts_->shadowPacket(stream.coherent) : parts_->packet) {
      case 16:
        sum += replayStream<16>(parts_->embree, stream);
        break;
      case 8:
        sum += replayStream<8>(parts_->embree, stream);
        break;
      case 4:
        sum += replayStream<4>(parts_->embree, stream);
        break;
      default:
        sum += replaySingly(parts_->embree, stream);
    }
  }
  return sum;
}

}  // namespace whit
