#include "accel/accel.h"

#include "accel/accel_parts.h"
#include "core/error.h"

namespace whit {

Accel::Accel(const Scene& scene, const AccelOptions& options, Progress* progress)
    : scene_(scene), parts_(std::make_unique<Parts>(scene, options, progress)) {
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

bool Accel::isCutAway(std::uint32_t triangle, double u, double v) const noexcept {
  const TriangleRecord& record = scene_.triangles[triangle];
  const Mask mask = maskOf(scene_.materials[record.material], parts_->embree.alphaMaps());
  return !isOpaqueAt<&Mask::cutoff>(mask, record.uv, static_cast<float>(u), static_cast<float>(v));
}

void Accel::sceneMoved() { parts_->embree.update(scene_); }

int Accel::packet() const { return parts_->packet; }
std::string Accel::description() const { return parts_->description; }
std::uint64_t Accel::memoryBytes() const { return parts_->embree.memoryBytes(); }
std::uint64_t Accel::sphereBytes() const { return parts_->embree.sphereBytes(); }

}  // namespace whit
