#include "scene/camera.h"

#include <algorithm>
#include <numbers>

#include "scene/members.h"

namespace whit {

namespace {

// Cubic Hermite basis at s in [0, 1]; tangents are per unit of s.
Vec3f hermite(const Vec3d& p0, const Vec3d& m0, const Vec3d& p1, const Vec3d& m1, double s) {
  const double s2 = s * s, s3 = s2 * s;
  return Vec3f(p0 * (2 * s3 - 3 * s2 + 1) + m0 * (s3 - 2 * s2 + s) + p1 * (3 * s2 - 2 * s3) +
               m1 * (s3 - s2));
}

float between(float a, float b, double s) { return static_cast<float>(a * (1 - s) + b * s); }
Vec3f between(const Vec3f& a, const Vec3f& b, double s) {
  return Vec3f(Vec3d(a) * (1 - s) + Vec3d(b) * s);
}

// Velocity at keyframe i: the slope between its neighbors, or towards the only one there is.
Vec3d velocity(const std::vector<Keyframe>& path, std::size_t i, Vec3f Camera::*point) {
  const Keyframe& before = path[i == 0 ? 0 : i - 1];
  const Keyframe& after = path[std::min(i + 1, path.size() - 1)];
  const double seconds = static_cast<double>(after.time) - before.time;
  return (Vec3d(after.camera.*point) - Vec3d(before.camera.*point)) / seconds;
}

// Replaces an `up` that is parallel to the view: +y is up; a vertical view is that of a level
// camera that looked along -z before it was tilted.
Vec3d fallbackRight(const Vec3d& forward) {
  const bool vertical = std::abs(forward.y) > 0.999;
  return normalized(cross(forward, vertical ? Vec3d{0, 0, forward.y} : Vec3d{0, 1, 0}));
}

}  // namespace

bool sameView(const Camera& a, const Camera& b) { return sameMembers(a, b); }

double Camera::focusDistance() const {
  return focus > 0 ? double{focus} : length(Vec3d(at) - Vec3d(eye));
}

Camera cameraAt(const std::vector<Keyframe>& path, double time) {
  if (!(time > path.front().time)) return path.front().camera;
  if (time >= path.back().time) return path.back().camera;
  // The first keyframe after `time`; there is one on either side.
  std::size_t next = 1;
  while (!(path[next].time > time)) ++next;
  const Keyframe &a = path[next - 1], &b = path[next];
  const double seconds = static_cast<double>(b.time) - a.time, s = (time - a.time) / seconds;
  const auto along = [&](Vec3f Camera::*point) {
    return hermite(Vec3d(a.camera.*point), velocity(path, next - 1, point) * seconds,
                   Vec3d(b.camera.*point), velocity(path, next, point) * seconds, s);
  };
  Camera camera = a.camera;
  forEachMember<Camera>([&](const auto& member) {
    auto& value = camera.*member.field;
    value = between(value, b.camera.*member.field, s);
  });
  camera.eye = along(&Camera::eye);
  camera.at = along(&Camera::at);
  // A plane through `at` and one that is given by its distance are mixed by their distances.
  if ((a.camera.focus > 0) != (b.camera.focus > 0)) {
    camera.focus =
        static_cast<float>(a.camera.focusDistance() * (1 - s) + b.camera.focusDistance() * s);
  }
  return camera;
}

CameraFrame makeCameraFrame(const Camera& camera, int width, int height) {
  // Closer to parallel than this, rounding of the float `up` decides where it points.
  constexpr double kParallel = 1e-6;
  const Vec3d eye = isFinite(camera.eye) ? Vec3d(camera.eye) : Vec3d{};
  const Vec3d forward = normalized(Vec3d(camera.at) - eye, Vec3d{0, 0, -1});
  const Vec3d across = cross(forward, normalized(Vec3d(camera.up)));
  const Vec3d right = length(across) > kParallel ? normalized(across) : fallbackRight(forward);
  const double asked = camera.fov;
  const double fov = asked > kLeastFov ? std::min(asked, kLargestFov) : kLeastFov;
  const bool orthographic = camera.orthographicHeight > 0;
  const double pixel =
      (orthographic ? camera.orthographicHeight : 2 * std::tan(fov * (std::numbers::pi / 360))) /
      height;
  CameraFrame frame{eye, forward, right * pixel, cross(right, forward) * pixel, width, height,
                    {},  0,       orthographic};
  if (orthographic) frame.reach = abs(frame.right * (width / 2.0)) + abs(frame.up * (height / 2.0));
  if (!camera.hasLens()) return frame;
  frame.aperture = camera.aperture;
  const double focus = camera.focusDistance();
  if (focus > 0 && std::isfinite(focus)) frame.focus = focus;
  frame.reach += (abs(right) + abs(cross(right, forward))) * frame.aperture;
  return frame;
}

RayCone pixelCone(const CameraFrame& camera) {
  const double pixel = length(camera.up);
  return camera.orthographic ? RayCone{pixel, 0} : RayCone{0, pixel};
}

}  // namespace whit
