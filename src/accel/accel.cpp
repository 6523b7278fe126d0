#include "accel/accel.h"

#include <limits>
#include <vector>

#include "accel/bad_rays.h"
#include "accel/embree_scene.h"
#include "accel/parts.h"
#include "accel/trace_packets.h"
#include "core/error.h"

namespace whit {

namespace {

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
      const auto start = TraceClock::now();
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
      meter.embreeMs += millisecondsSince(start);
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
  switch (parts_->shadowPacket(coherent)) {
    case 16:
      return traceShadows<16>(parts_->embree, shadows, n, coherent, visible, meter);
    case 8:
      return traceShadows<8>(parts_->embree, shadows, n, coherent, visible, meter);
    case 4:
      return traceShadows<4>(parts_->embree, shadows, n, coherent, visible, meter);
    default:
      break;
  }
  const auto start = TraceClock::now();
  for (std::size_t i = 0; i < n; ++i) {
    RTCRay ray = singleRay(parts_->embree, originAt(shadows, i), directionAt(shadows, i),
                           shadows.tFar[i], kShadowMask);
    QueryContext context(coherent);
    whit::occluded(nullptr, parts_->embree.top(), context, ray);
    visible[shadows.slot[i]] = ray.tfar >= 0 ? 1.0f : 0.0f;
  }
  meter.embreeMs += millisecondsSince(start);
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
