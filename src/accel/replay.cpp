// The floor: what Embree alone needs for the rays of a frame.
#include <vector>

#include "accel/bad_rays.h"
#include "accel/embree_scene.h"
#include "accel/packing.h"
#include "accel/parts.h"
#include "accel/trace_packets.h"

namespace whit {

namespace {

// Kernels only read them.
float* column(const RayLog::Stream& stream, std::size_t c) {
  return const_cast<float*>(stream.columns[c].data());
}

template <int kWidth>
double replayShadows(const EmbreeScene& scene, const RayLog::Stream& stream) {
  const std::size_t count = packetsFor<kWidth>(stream.count);
  std::vector<typename PacketTypes<kWidth>::Ray> packets(count);
  std::vector<Lanes<kWidth>> lanes(count);
  for (auto& packet : packets) setConstants<kWidth>(packet, kShadowMask);
  setLanes<kWidth>(lanes.data(), stream.count);
  const ShadowColumns shadows{
      column(stream, 0), column(stream, 1), column(stream, 2), column(stream, 3),
      column(stream, 4), column(stream, 5), column(stream, 6), nullptr};
  simd::packShadowRays(shadows, stream.count, scene.reach(), wordsOf<kWidth>(packets.data()));
  QueryContext context(stream.coherent);
  const bool together = stream.coherent && scene.streamWidth() == kWidth;
  const auto start = TraceClock::now();
  occludedAll(lanes.data(), scene.top(), context, together, packets.data(), count);
  return millisecondsSince(start);
}

template <int kWidth>
double replayHits(const EmbreeScene& scene, const RayLog::Stream& stream) {
  const std::size_t count = packetsFor<kWidth>(stream.count);
  std::vector<typename PacketTypes<kWidth>::RayHit> packets(count);
  std::vector<Lanes<kWidth>> lanes(count);
  for (auto& packet : packets) setConstants<kWidth>(packet.ray, kSeenMask);
  setLanes<kWidth>(lanes.data(), stream.count);
  RayColumns rays;
  rays.orgX = column(stream, 0), rays.orgY = column(stream, 1), rays.orgZ = column(stream, 2);
  rays.dirX = column(stream, 3), rays.dirY = column(stream, 4), rays.dirZ = column(stream, 5);
  simd::packRays(rays, stream.count, scene.reach(), wordsOf<kWidth>(packets.data()));
  forgetHits<kWidth>(packets.data(), count);
  QueryContext context(stream.coherent);
  const bool together = stream.coherent && scene.streamWidth() == kWidth;
  const auto start = TraceClock::now();
  intersectAll(lanes.data(), scene.top(), context, together, packets.data(), count);
  return millisecondsSince(start);
}

// Full packets but for the last one of a stream.
template <int kWidth>
double replayStream(const EmbreeScene& scene, const RayLog::Stream& stream) {
  return stream.occlusion ? replayShadows<kWidth>(scene, stream)
                          : replayHits<kWidth>(scene, stream);
}

double replaySingly(const EmbreeScene& scene, const RayLog::Stream& stream) {
  std::vector<RTCRayHit> rays;
  rays.reserve(stream.count);
  for (std::size_t i = 0; i < stream.count; ++i) {
    std::array<float, 7> r;
    for (std::size_t c = 0; c < r.size(); ++c) r[c] = stream.columns[c][i];
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
    streams_.push_back({occlusion, coherent, 0, {}});
    stream = &streams_.back();
  }
  for (std::size_t c = 0; c < stream->columns.size(); ++c) {
    std::vector<float>& column = stream->columns[c];
    column.resize(stream->count);
    column.insert(column.end(), columns[c], columns[c] + n);
    column.resize(roundUpToBlock(stream->count + n));
  }
  stream->count += n;
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
