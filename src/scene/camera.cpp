#include "scene/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>

#include "core/index.h"
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
std::vector<float> between(std::vector<float> a, const std::vector<float>& b, double s) {
  if (a.size() != b.size()) return a;
  for (const auto i : indices(a)) a[i] = between(a[i], b[i], s);
  return a;
}
template <typename Enum>
requires std::is_enum_v<Enum> Enum between(Enum a, Enum /*b*/, double /*s*/) { return a; }

// Velocity at keyframe i: the slope between its neighbors, or towards the only one there is.
Vec3d velocity(const std::vector<Keyframe>& path, std::size_t i, Vec3f Camera::*point) {
  const Keyframe& before = path[i == 0 ? 0 : i - 1];
  const Keyframe& after = path[std::min(i + 1, path.size() - 1)];
  const double seconds = double{after.time} - before.time;
  return (Vec3d(after.camera.*point) - Vec3d(before.camera.*point)) / seconds;
}

// Right vector for an `up` that is parallel to the view. The world's +y is up instead; a vertical
// view takes the one of a level camera that looked along -z before it was tilted.
Vec3d fallbackRight(const Vec3d& forward) {
  const bool vertical = std::abs(forward.y) > 0.999;
  return normalized(cross(forward, vertical ? Vec3d{0, 0, forward.y} : Vec3d{0, 1, 0}));
}

// Mean step in radians between the entries of a table of degrees that is stretched over `pixels`
// pixels.
double meanStep(const std::vector<float>& degrees, int pixels) {
  constexpr double kLeast = 1e-6;  // step of a table with one entry
  if (degrees.empty()) return kLeast;
  const double span = double{degrees.back()} - double{degrees.front()};
  return std::max(std::abs(span) * (std::numbers::pi / 180) / pixels, kLeast);
}

// Extent of a pixel at the center of a picture of this size, in the units of the projection:
// tangents or radians.
std::array<double, 2> pixelSteps(const Camera& camera, const CameraFrame& frame, int width,
                                 int height) {
  if (!camera.k.empty() && hasMatrix(camera)) {
    return {camera.kSize[0] / (double{camera.k[0]} * width),
            camera.kSize[1] / (double{camera.k[1]} * height)};
  }

  const double radius = std::min(width, height) / 2.0;  // radius of a fisheye's image circle
  switch (camera.projection) {
    case Projection::perspective:
      break;
    case Projection::equidistant:
    case Projection::fisheye:
      return {frame.limit / radius, frame.limit / radius};
    case Projection::equisolid:
      return {2 * std::sin(frame.limit / 2) / radius, 2 * std::sin(frame.limit / 2) / radius};
    case Projection::panorama:
      return {2 * std::numbers::pi / width, std::numbers::pi / height};
    case Projection::directions:
      return {meanStep(camera.azimuths, width), meanStep(camera.elevations, height)};
    case Projection::cubeMap:
      return {2.0 / width, 2.0 / height};
  }

  // An orthographic picture has its height in scene units, another one a vertical field of view.
  const double asked = camera.fov;
  const double fov = asked > kLeastFov ? std::min(asked, kLargestFov) : kLeastFov;
  const double pixel = (frame.orthographic ? double{camera.orthographicHeight}
                                           : 2 * std::tan(fov * (std::numbers::pi / 360))) /
                       height;
  return {pixel, pixel};
}

// True if the picture shows all azimuths, so that no two places of the eyes serve them all.
bool turnsEyes(const Camera& camera) {
  const bool byAzimuth = camera.projection == Projection::panorama || isTable(camera);
  return isStereo(camera) && byAzimuth;
}

// Views of a stereo pair, or of a cube map: right, left, up, down, forward and backward, each as it
// is seen when one turns there from the forward view.
std::vector<CameraView> viewsOf(const Camera& camera, const CameraFrame& frame) {
  const Vec3d &f = frame.forward, &r = frame.right, &u = frame.up;
  if (camera.projection == Projection::cubeMap) {
    const double step = length(r), tall = length(u);
    const Vec3d right = normalized(r), up = normalized(u);
    return {{{}, right, f * -step, u},
            {{}, -right, f * step, u},
            {{}, up, r, f * -tall},
            {{}, -up, r, f * tall},
            {{}, f, r, u},
            {{}, -f, -r, u}};
  }

  if (!isStereo(camera)) return {};
  const Vec3d aside = turnsEyes(camera) ? Vec3d() : normalized(r) * (camera.eyeDistance / 2.0);
  return {{-aside, f, r, u}, {aside, f, r, u}};
}

// The views of a cube map or of a stereo pair share the picture in a grid.
void divideIntoViews(const Camera& camera, CameraFrame& frame) {
  frame.viewColumns = camera.stereo == Stereo::leftRight ? 2 : 1;
  frame.viewRows = camera.stereo == Stereo::topBottom ? 2 : 1;
  if (camera.projection == Projection::cubeMap) {
    const bool inRow = frame.width >= 4 * frame.height;
    frame.viewColumns = inRow ? 6 : 3;
    frame.viewRows = inRow ? 1 : 2;
  }

  frame.viewWidth = std::max(frame.width / frame.viewColumns, 1);
  frame.viewHeight = std::max(frame.height / frame.viewRows, 1);
}

}  // namespace

Camera fitted(Camera camera, double pictureAspect) {
  const double growth = camera.aspect / pictureAspect;
  camera.aspect = 0;
  if (!(growth > 1)) return camera;

  constexpr double kHalfInRadians = std::numbers::pi / 360;
  // The tangent of half the angle grows with the height of the picture.
  const double half = std::tan(camera.fov * kHalfInRadians) * growth;
  camera.fov = static_cast<float>(std::atan(half) / kHalfInRadians);
  camera.orthographicHeight = static_cast<float>(camera.orthographicHeight * growth);
  return camera;
}

bool sameView(const Camera& a, const Camera& b) { return sameMembers(a, b); }

double Camera::focusDistance() const {
  return focus > 0 ? double{focus} : length(Vec3d(at) - Vec3d(eye));
}

Camera cameraAt(const std::vector<Keyframe>& path, double time) {
  if (!(time > path.front().time)) return path.front().camera;
  if (time >= path.back().time) return path.back().camera;
  // `next` is the first keyframe after `time`. The path has keyframes on both sides of it.
  std::size_t next = 1;
  while (!(path[next].time > time)) ++next;
  const Keyframe &a = path[next - 1], &b = path[next];

  const double seconds = double{b.time} - a.time, s = (time - a.time) / seconds;
  // Catmull-Rom splines are Hermite splines whose tangents come from the neighboring keyframes.
  const auto along = [&](Vec3f Camera::*point) {
    return hermite(Vec3d(a.camera.*point), velocity(path, next - 1, point) * seconds,
                   Vec3d(b.camera.*point), velocity(path, next, point) * seconds, s);
  };

  // All members are interpolated linearly; eye and target are then replaced by points of splines.
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

  CameraFrame frame{eye, forward, right, cross(right, forward), width, height, {}};
  frame.projection = camera.projection;
  frame.orthographic = isPerspective(camera) && camera.orthographicHeight > 0;
  if (isFisheye(camera)) frame.limit = camera.angle * (std::numbers::pi / 360);

  divideIntoViews(camera, frame);
  const int w = frame.viewWidth, h = frame.viewHeight;

  // From here on, `right` and `up` span one pixel.
  const Camera seen = fitted(camera, static_cast<double>(w) / h);
  const auto [stepX, stepY] = pixelSteps(seen, frame, w, h);
  frame.right = frame.right * stepX;
  frame.up = frame.up * stepY;

  frame.centerX = w / 2.0;
  frame.centerY = h / 2.0;
  // The matrix gives the image position of the optical axis, in pixels whose centers lie at whole
  // numbers. Centers lie at half-integers here.
  if (!camera.k.empty() && hasMatrix(camera)) {
    const double scaleX = w / double{camera.kSize[0]}, scaleY = h / double{camera.kSize[1]};
    frame.centerX = (double{camera.k[2]} + 0.5) * scaleX;
    frame.centerY = (double{camera.k[3]} + 0.5) * scaleY;
    if (camera.k.size() > 4) frame.skew = double{camera.k[4]} * scaleX * stepY;
  }

  if (isDistorted(camera) && !frame.orthographic) {
    std::ranges::copy(camera.distortion, frame.distortion.begin());
    frame.distorted = std::ranges::any_of(frame.distortion, [](double c) { return c != 0; });
  }
  if (isTable(camera)) {
    frame.azimuths = camera.azimuths;
    frame.elevations = camera.elevations;
  }

  // `reach` bounds the points where rays start: in a plane, at two eyes, or on the circle on which
  // these turn.
  frame.views = viewsOf(camera, frame);
  if (frame.orthographic) frame.reach = abs(frame.right * (w / 2.0)) + abs(frame.up * (h / 2.0));
  if (!frame.views.empty()) frame.reach += abs(frame.views.front().aside);
  if (turnsEyes(camera)) {
    frame.turning = camera.eyeDistance / 2.0;
    frame.reach += (abs(right) + abs(forward)) * frame.turning;
  }

  if (!camera.hasLens() || !isPerspective(camera)) return frame;
  frame.aperture = camera.aperture;
  const double focus = camera.focusDistance();
  if (focus > 0 && std::isfinite(focus)) frame.focus = focus;
  frame.reach += (abs(right) + abs(cross(right, forward))) * frame.aperture;
  return frame;
}

std::array<double, 2> imagePlace(const CameraFrame& camera, const Vec3d& point) {
  const Vec3d d = point - camera.eye;
  const double depth = camera.orthographic ? 1 : dot(d, camera.forward);
  const double x = dot(d, camera.right) / (dot(camera.right, camera.right) * depth);
  const double y = dot(d, camera.up) / (dot(camera.up, camera.up) * depth);
  return {camera.centerX + x - camera.skew * y, camera.centerY - y};
}

RayCone pixelCone(const CameraFrame& camera) {
  const double width = length(camera.up) * camera.footprint;
  return camera.orthographic ? RayCone{width, 0} : RayCone{0, width};
}

}  // namespace whit
