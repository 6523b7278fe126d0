// The floor: what Embree alone needs for the rays of a frame.
#include <algorithm>
#include <limits>
#include <vector>

#include "accel/accel_parts.h"
#include "accel/packets.h"
#include "accel/single_rays.h"

namespace whit {

namespace {

// Kernels only read them.
float* column(const RayLog::Stream& stream, std::size_t c) {
  return const_cast<float*>(stream.columns[c].data());
}

template <int kWidth>
double replayShadows(const Accel::Parts& parts, const RayLog::Stream& stream) {
  const EmbreeScene& scene = parts.embree;
  const std::size_t count = packetsFor<kWidth>(stream.count);
  std::vector<typename PacketTypes<kWidth>::Ray> packets(count);
  std::vector<Lanes<kWidth>> lanes(count);
  for (auto& packet : packets) setConstants<kWidth>(packet, kShadowMask);
  setLanes<kWidth>(lanes.data(), stream.count);
  const ShadowColumns shadows{
      column(stream, 0), column(stream, 1), column(stream, 2), column(stream, 3),
      column(stream, 4), column(stream, 5), column(stream, 6), nullptr};
  parts.kernels.packShadowRays(shadows, stream.count, scene.reach(),
                               wordsOf<kWidth>(packets.data()));
  QueryContext context(stream.coherent);
  const bool together = parts.together(kWidth, stream.coherent);
  const auto start = TraceClock::now();
  occludedAll(lanes.data(), scene.top(), context, together, packets.data(), count);
  return millisecondsSince(start);
}

template <int kWidth>
double replayHits(const Accel::Parts& parts, const RayLog::Stream& stream) {
  const EmbreeScene& scene = parts.embree;
  const std::size_t count = packetsFor<kWidth>(stream.count);
  std::vector<typename PacketTypes<kWidth>::RayHit> packets(count);
  std::vector<Lanes<kWidth>> lanes(count);
  for (auto& packet : packets) setConstants<kWidth>(packet.ray, kSeenMask);
  setLanes<kWidth>(lanes.data(), stream.count);
  RayColumns rays;
  rays.orgX = column(stream, 0), rays.orgY = column(stream, 1), rays.orgZ = column(stream, 2);
  rays.dirX = column(stream, 3), rays.dirY = column(stream, 4), rays.dirZ = column(stream, 5);
  parts.kernels.packRays(rays, stream.count, scene.reach(), wordsOf<kWidth>(packets.data()));
  forgetHits<kWidth>(packets.data(), count);
  QueryContext context(stream.coherent);
  const bool together = parts.together(kWidth, stream.coherent);
  const auto start = TraceClock::now();
  intersectAll(lanes.data(), scene.top(), context, together, packets.data(), count);
  return millisecondsSince(start);
}

// Full packets but for the last one of a stream.
template <int kWidth>
double replayStream(const Accel::Parts& parts, const RayLog::Stream& stream) {
  return stream.anyHit ? replayShadows<kWidth>(parts, stream) : replayHits<kWidth>(parts, stream);
}

double replaySingly(const EmbreeScene& scene, const RayLog::Stream& stream) {
  std::vector<RTCRayHit> rays;
  rays.reserve(stream.count);
  for (std::size_t i = 0; i < stream.count; ++i) {
    const auto& c = stream.columns;
    const Vec3f origin{c[0][i], c[1][i], c[2][i]}, direction{c[3][i], c[4][i], c[5][i]};
    if (!isTraceable(scene.reach(), origin, direction)) continue;
    const unsigned mask = stream.anyHit ? kShadowMask : kSeenMask;
    rays.push_back(withoutHit(singleRay(origin, direction, c[6][i], mask)));
  }
  QueryContext context(stream.coherent);
  const auto start = TraceClock::now();
  for (RTCRayHit& ray : rays) {
    if (stream.anyHit) {
      occluded(nullptr, scene.top(), context, ray.ray);
    } else {
      intersect(nullptr, scene.top(), context, ray);
    }
  }
  return millisecondsSince(start);
}

}  // namespace

RayLog::Stream& RayLog::streamOf(bool anyHit, bool coherent) {
  for (Stream& s : streams_) {
    if (s.anyHit == anyHit && s.coherent == coherent) return s;
  }
  return streams_.emplace_back(Stream{anyHit, coherent, 0, {}});
}

void RayLog::append(const RayColumns& rays, std::size_t n, bool coherent) {
  append(streamOf(false, coherent),
         {rays.orgX, rays.orgY, rays.orgZ, rays.dirX, rays.dirY, rays.dirZ, nullptr}, n);
}

void RayLog::append(const ShadowColumns& s, std::size_t n, bool coherent) {
  append(streamOf(true, coherent), {s.orgX, s.orgY, s.orgZ, s.dirX, s.dirY, s.dirZ, s.tFar}, n);
}

void RayLog::append(Stream& stream, const std::array<const float*, 7>& from, std::size_t n) {
  for (std::size_t c = 0; c < from.size(); ++c) {
    std::vector<float>& column = stream.columns[c];
    column.resize(stream.count);
    if (from[c]) {
      column.insert(column.end(), from[c], from[c] + n);
    } else {
      column.resize(stream.count + n, std::numeric_limits<float>::infinity());
    }
    column.resize(roundUpToBlock(stream.count + n));
  }
  stream.count += n;
}

double Accel::replay(const RayLog& log) const {
  double sum = 0;
  for (const RayLog::Stream& stream : log.streams()) {
    switch (stream.anyHit ? parts_->shadowPacket(stream.coherent) : parts_->packet) {
      case 16:
        sum += replayStream<16>(*parts_, stream);
        break;
      case 8:
        sum += replayStream<8>(*parts_, stream);
        break;
      case 4:
        sum += replayStream<4>(*parts_, stream);
        break;
      default:
        sum += replaySingly(parts_->embree, stream);
    }
  }
  return sum;
}

}  // namespace whit
