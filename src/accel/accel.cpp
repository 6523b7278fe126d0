#include "accel/accel.h"

#include <array>
#include <chrono>
#include <cstring>
#include <limits>

#include "accel/bad_rays.h"
#include "accel/embree_scene.h"
#include "accel/parts.h"
#include "core/error.h"

namespace whit {

namespace {

using Clock = std::chrono::steady_clock;

// Packets are filled, traced and emptied in groups of this many rays, so that the clock around
// Embree's calls is read rarely and sees nothing but them.
constexpr std::size_t kGroup = 128;

double milliseconds(Clock::duration d) {
  return std::chrono::duration<double, std::milli>(d).count();
}

template <int kWidth>
struct Group {
  static constexpr std::size_t kPackets = kGroup / kWidth;
  alignas(64) std::array<typename PacketTypes<kWidth>::RayHit, kPackets> packets;
  alignas(64) int valid[kPackets][kWidth];
  std::size_t count = 0;  // packets in use
};
template <int kWidth>
struct ShadowGroup {
  static constexpr std::size_t kPackets = kGroup / kWidth;
  alignas(64) std::array<typename PacketTypes<kWidth>::Ray, kPackets> packets;
  alignas(64) int valid[kPackets][kWidth];
  std::size_t count = 0;
};

// Full packets have these lanes; the last one of a queue may have fewer.
template <int kWidth, typename Group>
void setAllLanes(Group& group) {
  for (auto& valid : group.valid) std::fill(valid, valid + kWidth, -1);
}

// Embree's robust traversal accepts hits at tnear, so the origin must not lie on the surface: it
// has been moved off by its error bound.
template <int kWidth, typename Ray>
void setConstants(Ray& ray, unsigned mask) {
  for (int lane = 0; lane < kWidth; ++lane) {
    ray.tnear[lane] = 0;
    ray.time[lane] = 0;
    ray.mask[lane] = mask;
    ray.id[lane] = 0;
    ray.flags[lane] = 0;
  }
}

template <int kWidth, typename Ray, typename Columns>
void loadRay(Ray& ray, const Columns& rays, std::size_t i) {
  std::memcpy(ray.org_x, rays.orgX + i, sizeof(ray.org_x));
  std::memcpy(ray.org_y, rays.orgY + i, sizeof(ray.org_y));
  std::memcpy(ray.org_z, rays.orgZ + i, sizeof(ray.org_z));
  std::memcpy(ray.dir_x, rays.dirX + i, sizeof(ray.dir_x));
  std::memcpy(ray.dir_y, rays.dirY + i, sizeof(ray.dir_y));
  std::memcpy(ray.dir_z, rays.dirZ + i, sizeof(ray.dir_z));
}

// Masked lanes get a harmless empty ray: where Embree splits a packet that is wider than the CPU,
// it looks at their coordinates all the same.
template <int kWidth, typename Ray>
void emptyLanes(Ray& ray, int* valid, std::size_t live) {
  for (std::size_t lane = live; lane < kWidth; ++lane) {
    valid[lane] = 0;
    ray.org_x[lane] = ray.org_y[lane] = ray.org_z[lane] = 0;
    ray.dir_x[lane] = ray.dir_y[lane] = 0;
    ray.dir_z[lane] = 1;
    ray.tfar[lane] = -1;
  }
}

template <int kWidth>
void fillGroup(Group<kWidth>& group, const RayColumns& rays, std::size_t begin, std::size_t end,
               float reach) {
  group.count = 0;
  for (std::size_t i = begin; i < end; i += kWidth, ++group.count) {
    auto& packet = group.packets[group.count];
    loadRay<kWidth>(packet.ray, rays, i);
    for (int lane = 0; lane < kWidth; ++lane) {
      packet.ray.tfar[lane] = std::numeric_limits<float>::infinity();
      packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.primID[lane] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    emptyLanes<kWidth>(packet.ray, group.valid[group.count], end - i);
    leaveOutBadRays<kWidth>(packet.ray, reach);
  }
}

template <int kWidth>
void storeHits(const EmbreeScene& scene, const typename PacketTypes<kWidth>::RayHit& packet,
               const HitColumns& hits, std::size_t i) {
  std::memcpy(hits.t + i, packet.ray.tfar, sizeof(packet.ray.tfar));
  std::memcpy(hits.u + i, packet.hit.u, sizeof(packet.hit.u));
  std::memcpy(hits.v + i, packet.hit.v, sizeof(packet.hit.v));
  if (scene.plain()) {
    std::memcpy(hits.triangle + i, packet.hit.primID, sizeof(packet.hit.primID));
    if (!hits.instance) return;
  }
  for (int lane = 0; lane < kWidth; ++lane) {
    const std::size_t slot = i + static_cast<std::size_t>(lane);
    const unsigned instance = packet.hit.instID[0][lane];
    const bool placed = instance != RTC_INVALID_GEOMETRY_ID;
    const std::uint32_t* base = scene.triangleBase(placed ? 1 + (instance - kFirstInstanceId) : 0);
    const unsigned geometry = packet.hit.geomID[lane];
    hits.triangle[slot] = geometry == RTC_INVALID_GEOMETRY_ID
                              ? kMiss
                              : base[geometry % kTriangleClasses] + packet.hit.primID[lane];
    if (hits.instance) hits.instance[slot] = placed ? instance - kFirstInstanceId : kMiss;
  }
}

template <int kWidth>
void traceHits(const EmbreeScene& scene, const RayColumns& rays, std::size_t n, bool coherent,
               const HitColumns& hits, TraceMeter& meter) {
  QueryContext context(coherent);
  Group<kWidth> group;
  setAllLanes<kWidth>(group);
  for (auto& packet : group.packets) setConstants<kWidth>(packet.ray, kSeenMask);
  for (std::size_t begin = 0; begin < n; begin += kGroup) {
    const std::size_t end = std::min(n, begin + kGroup);
    fillGroup<kWidth>(group, rays, begin, end, scene.reach());
    const Clock::time_point start = Clock::now();
    for (std::size_t p = 0; p < group.count; ++p) {
      intersect(group.valid[p], scene.top(), context, group.packets[p]);
    }
    meter.embreeMs += milliseconds(Clock::now() - start);
    for (std::size_t p = 0; p < group.count; ++p) {
      storeHits<kWidth>(scene, group.packets[p], hits, begin + p * kWidth);
    }
    meter.tally->lanes += group.count * kWidth;
  }
}

template <int kWidth>
void traceShadows(const EmbreeScene& scene, const ShadowColumns& shadows, std::size_t n,
                  bool coherent, float* visible, TraceMeter& meter) {
  QueryContext context(coherent);
  ShadowGroup<kWidth> group;
  setAllLanes<kWidth>(group);
  for (auto& packet : group.packets) setConstants<kWidth>(packet, kShadowMask);
  for (std::size_t begin = 0; begin < n; begin += kGroup) {
    const std::size_t end = std::min(n, begin + kGroup);
    group.count = 0;
    for (std::size_t i = begin; i < end; i += kWidth, ++group.count) {
      auto& packet = group.packets[group.count];
      loadRay<kWidth>(packet, shadows, i);
      std::memcpy(packet.tfar, shadows.tFar + i, sizeof(packet.tfar));
      emptyLanes<kWidth>(packet, group.valid[group.count], end - i);
      leaveOutBadRays<kWidth>(packet, scene.reach());
    }
    const Clock::time_point start = Clock::now();
    for (std::size_t p = 0; p < group.count; ++p) {
      occluded(group.valid[p], scene.top(), context, group.packets[p]);
    }
    meter.embreeMs += milliseconds(Clock::now() - start);
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t lane = i - begin;
      // Embree marks an occluded ray with a tfar of minus infinity. No branch: which way it goes
      // cannot be foretold.
      const bool clear = group.packets[lane / kWidth].tfar[lane % kWidth] >= 0;
      visible[shadows.slot[i]] = static_cast<float>(static_cast<int>(clear));
    }
    meter.tally->lanes += group.count * kWidth;
  }
}

RTCRay singleRay(const EmbreeScene& scene, const Vec3f& origin, const Vec3f& direction, float tFar,
                 unsigned mask) {
  RTCRay ray{};
  ray.org_x = origin.x;
  ray.org_y = origin.y;
  ray.org_z = origin.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tfar = tFar;
  ray.mask = mask;
  if (!isTraceable(scene.reach(), origin.x, origin.y, origin.z, direction.x, direction.y,
                   direction.z)) {
    ray.org_x = ray.org_y = ray.org_z = 0.25f * scene.reach();
    ray.dir_x = ray.dir_y = 0;
    ray.dir_z = 1;
    ray.tfar = -1;
  }
  return ray;
}

RTCRayHit singleRayHit(const EmbreeScene& scene, const Vec3f& origin, const Vec3f& direction) {
  RTCRayHit rayHit{};
  rayHit.ray =
      singleRay(scene, origin, direction, std::numeric_limits<float>::infinity(), kSeenMask);
  rayHit.hit.geomID = rayHit.hit.primID = RTC_INVALID_GEOMETRY_ID;
  rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return rayHit;
}

template <typename Columns>
Vec3f originAt(const Columns& c, std::size_t i) {
  return {c.orgX[i], c.orgY[i], c.orgZ[i]};
}
template <typename Columns>
Vec3f directionAt(const Columns& c, std::size_t i) {
  return {c.dirX[i], c.dirY[i], c.dirZ[i]};
}

}  // namespace

Accel::Accel(const Scene& scene, const AccelOptions& options, Progress* progress)
    : parts_(std::make_unique<Parts>(scene, options, progress)) {
  const RTCDevice device = parts_->embree.device();
  const bool native16 = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED);
  const bool native8 = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED);
  const int widest = native16 ? 16 : native8 ? 8 : 4;
  const int wanted = options.packet;
  if (wanted != 0 && wanted != 1 && wanted != 4 && wanted != 8 && wanted != 16) {
    throwUsage("--packet takes auto, 1, 4, 8 or 16");
  }
  parts_->packet = wanted == 0 ? widest : wanted;
  const auto version = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION);
  parts_->description = std::to_string(version / 10000) + "." +
                        std::to_string(version / 100 % 100) + "." + std::to_string(version % 100) +
                        " " +
                        (native16  ? "avx512"
                         : native8 ? "avx2"
                                   : "sse4.2");
}

Accel::~Accel() = default;

void Accel::findHits(const RayColumns& rays, std::size_t n, bool coherent, const HitColumns& hits,
                     TraceMeter& meter) const noexcept {
  meter.tally->rays += n;
  if (meter.log) {
    static const std::vector<float> unbounded(kGroup, std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < n; i += kGroup) {
      const float* const columns[7] = {rays.orgX + i, rays.orgY + i, rays.orgZ + i,   rays.dirX + i,
                                       rays.dirY + i, rays.dirZ + i, unbounded.data()};
      meter.log->append(false, coherent, columns, std::min(kGroup, n - i));
    }
  }
  switch (parts_->packet) {
    case 16:
      traceHits<16>(parts_->embree, rays, n, coherent, hits, meter);
      break;
    case 8:
      traceHits<8>(parts_->embree, rays, n, coherent, hits, meter);
      break;
    case 4:
      traceHits<4>(parts_->embree, rays, n, coherent, hits, meter);
      break;
    default: {
      const Clock::time_point start = Clock::now();
      for (std::size_t i = 0; i < n; ++i) {
        RTCRayHit r = singleRayHit(parts_->embree, originAt(rays, i), directionAt(rays, i));
        QueryContext context(coherent);
        intersect(nullptr, parts_->embree.top(), context, r);
        const bool placed = r.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
        const std::uint32_t instance = r.hit.instID[0] - kFirstInstanceId;
        hits.t[i] = r.ray.tfar;
        hits.u[i] = r.hit.u;
        hits.v[i] = r.hit.v;
        hits.triangle[i] =
            r.hit.geomID == RTC_INVALID_GEOMETRY_ID
                ? kMiss
                : parts_->embree.triangleBase(placed ? 1 + instance : 0)[r.hit.geomID] +
                      r.hit.primID;
        if (hits.instance) hits.instance[i] = placed ? instance : kMiss;
      }
      meter.embreeMs += milliseconds(Clock::now() - start);
      meter.tally->lanes += n;
    }
  }
  if (parts_->packet != 1) settleEdges(rays, n, hits);
  if (enclosed_) retryMisses(rays, n, hits);
}

void Accel::checkShadows(const ShadowColumns& shadows, std::size_t n, bool coherent, float* visible,
                         TraceMeter& meter) const noexcept {
  meter.tally->rays += n;
  if (meter.log) {
    const float* const columns[7] = {shadows.orgX, shadows.orgY, shadows.orgZ, shadows.dirX,
                                     shadows.dirY, shadows.dirZ, shadows.tFar};
    meter.log->append(true, coherent, columns, n);
  }
  switch (parts_->packet) {
    case 16:
      return traceShadows<16>(parts_->embree, shadows, n, coherent, visible, meter);
    case 8:
      return traceShadows<8>(parts_->embree, shadows, n, coherent, visible, meter);
    case 4:
      return traceShadows<4>(parts_->embree, shadows, n, coherent, visible, meter);
    default:
      break;
  }
  const Clock::time_point start = Clock::now();
  for (std::size_t i = 0; i < n; ++i) {
    RTCRay ray = singleRay(parts_->embree, originAt(shadows, i), directionAt(shadows, i),
                           shadows.tFar[i], kShadowMask);
    QueryContext context(coherent);
    whit::occluded(nullptr, parts_->embree.top(), context, ray);
    visible[shadows.slot[i]] = ray.tfar >= 0 ? 1.0f : 0.0f;
  }
  meter.embreeMs += milliseconds(Clock::now() - start);
  meter.tally->lanes += n;
}

bool Accel::findHit(const Vec3f& origin, const Vec3f& direction, std::uint32_t& triangle,
                    std::uint32_t& instance, float& t, float& u, float& v) const noexcept {
  RTCRayHit r = singleRayHit(parts_->embree, origin, direction);
  QueryContext context(false);
  intersect(nullptr, parts_->embree.top(), context, r);
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  const bool placed = r.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  instance = placed ? r.hit.instID[0] - kFirstInstanceId : kMiss;
  triangle = parts_->embree.triangleBase(placed ? 1 + instance : 0)[r.hit.geomID] + r.hit.primID;
  t = r.ray.tfar;
  u = r.hit.u;
  v = r.hit.v;
  return true;
}

bool Accel::occluded(const Vec3f& origin, const Vec3f& direction, float tFar) const noexcept {
  RTCRay ray = singleRay(parts_->embree, origin, direction, tFar, kShadowMask);
  QueryContext context(false);
  whit::occluded(nullptr, parts_->embree.top(), context, ray);
  return ray.tfar < 0;
}

int Accel::packet() const { return parts_->packet; }
std::string Accel::description() const { return parts_->description; }
std::uint64_t Accel::memoryBytes() const { return parts_->embree.memoryBytes(); }

}  // namespace whit
