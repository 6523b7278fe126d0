#include "viewer/session/camera_control.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/sphere.h"

namespace whit::view {

namespace {

double halfHeightAtOne(const Camera& camera) {
  return std::tan(double{camera.fov} * std::numbers::pi / 360);
}

void grow(Box& box, const Box& other) {
  box.add(other.lower);
  box.add(other.upper);
}

// Returns true if a triangle of this size is level and reaches across half of the room.
bool isFloor(const Vec3f& triangle, const Vec3f& room, int up) {
  constexpr float kLevel = 1e-3f, kFar = 0.5f;
  for (int axis = 0; axis < 3; ++axis) {
    const bool fits =
        axis == up ? triangle[axis] <= kLevel * room[axis] : triangle[axis] >= kFar * room[axis];
    if (!fits) return false;
  }
  return true;
}

// Returns the bounds of a geometry in its own space, without its floor.
Box boundsAboveFloor(const Scene& scene, const Geometry& geometry) {
  const int up = largestAxis(abs(scene.cameras.front().up));
  Box box;
  for (const auto& corners : geometry.index) {
    Box triangle;
    for (const std::uint32_t i : corners) triangle.add(geometry.position[i]);
    const bool left = isFloor(triangle.upper - triangle.lower, scene.upper - scene.lower, up);
    if (!left) grow(box, triangle);
  }
  for (std::uint32_t i = 0; i < geometry.spheres; ++i) {
    grow(box, sphereBounds(sphereMap(scene.triangles[geometry.firstSphere + i])));
  }
  return box;
}

}  // namespace

double cruisingSpeed(const Scene& scene) {
  constexpr double kSeconds = 12, kLeast = 1e-3;
  const double size = Box{scene.lower, scene.upper}.diagonal();
  return std::isfinite(size) ? std::max(size / kSeconds, kLeast) : 1;
}

Box subjectOf(const Scene& scene) {
  const Box all{scene.lower, scene.upper};
  if (scene.isModel) return all;

  std::vector<Box> boxes;
  for (const Geometry& geometry : scene.geometries) {
    boxes.push_back(boundsAboveFloor(scene, geometry));
  }

  Box box = boxes.front();  // bounds of the world; the other geometries are placed by instances
  for (const InstanceRecord& instance : scene.instances) {
    const Box& own = boxes[instance.geometry];
    for (int i = 0; i < 8; ++i) box.add(Vec3f(instance.toWorld.point(Vec3d(own.corner(i)))));
  }
  return box.empty() ? all : box;
}

Box boundsToOrbit(const Box& subject, const Camera& camera) {
  const double size = subject.diagonal();
  const bool inside = min(max(camera.eye, subject.lower), subject.upper) == camera.eye;
  return !inside && size > 0 && std::isfinite(size) ? subject : Box();
}

void CameraControl::set(const Camera& camera, const Box& model) {
  camera_ = camera;
  model_ = model;

  // The view is kept as an elevation above the plane perpendicular to up_, and a direction in that
  // plane, which right_ gives.
  const CameraFrame frame = makeCameraFrame(camera, 1, 1);
  eye_ = frame.eye;
  up_ = normalized(Vec3d(camera.up), Vec3d{0, 1, 0});
  const Vec3d across = normalized(frame.right);
  right_ = normalized(across - up_ * dot(across, up_), across);
  elevation_ = std::asin(std::clamp(dot(frame.forward, up_), -1.0, 1.0));

  // The point to orbit is the camera's `at`, or the point of the view's axis closest to the model's
  // center.
  double distance = length(Vec3d(camera.at) - eye_);
  if (orbits() && !camera.hasLens()) {  // a lens may be focused at `at`
    const double ahead = dot(model_.center() - eye_, frame.forward);
    if (ahead > 0) distance = ahead;
  }
  distance_ = distance > 0 && std::isfinite(distance) ? distance : 1;
  reach_ = model_;
  reach_.add(Vec3f(center()));
}

Vec3d CameraControl::forward() const {
  return cross(up_, right_) * std::cos(elevation_) + up_ * std::sin(elevation_);
}

void CameraControl::turn(double rightwards, double upwards) {
  right_ = normalized(right_ * std::cos(rightwards) - cross(up_, right_) * std::sin(rightwards));

  // A view that began steeper may stay so.
  elevation_ = std::clamp(elevation_ + upwards, std::min(-kSteepestRadians, elevation_),
                          std::max(kSteepestRadians, elevation_));
}

void CameraControl::writeCamera() {
  camera_.eye = Vec3f(eye_);
  camera_.at = Vec3f(center());
}

void CameraControl::lookFrom(const Vec3d& center, double distance) {
  distance_ = distance;
  eye_ = center - forward() * distance;
}

bool CameraControl::drag(const CameraMotion& m) {
  const double zoom = orbits() ? std::pow(kZoomFactor, m.wheel) : 1;
  if (m.turnX == 0 && m.turnY == 0 && m.panX == 0 && m.panY == 0 && zoom == 1) return false;

  Vec3d middle = center();
  turn(m.turnX * kRadiansPerPixel, -m.turnY * kRadiansPerPixel);

  // Panning shifts the middle so that it follows the pointer: a share of the picture's height there
  // is a length of the scene.
  const bool parallel = camera_.orthographicHeight > 0;
  const double height =
      parallel ? double{camera_.orthographicHeight} : 2 * halfHeightAtOne(camera_) * distance_;
  const Vec3d shift = (cross(right_, forward()) * m.panY - right_ * m.panX) * height;
  if (!orbits()) {
    eye_ = eye_ + shift;
    return true;
  }

  // A model does not get lost: the middle stays in its bounds, and the zoom has limits.
  middle = min(max(middle + shift, Vec3d(reach_.lower)), Vec3d(reach_.upper));
  const double size = model_.diagonal();
  const auto zoomed = [&](double length) {
    return std::clamp(length * zoom, std::min(kNearest * size, length),
                      std::max(kFarthest * size, length));
  };
  if (parallel) camera_.orthographicHeight = static_cast<float>(zoomed(height));
  lookFrom(middle, parallel ? distance_ : zoomed(distance_));
  return true;
}

bool CameraControl::step(const CameraMotion& m, double seconds) {
  // The view turns while arrow keys are held.
  const double arrows = kRadiansPerSecond * seconds;
  const bool turns = arrows > 0 && (m.turnRight != 0 || m.turnUp != 0);
  if (turns) turn(m.turnRight * arrows, m.turnUp * arrows);

  // The eye moves after that, but stays in the range of coordinates that scenes may have.
  const Vec3d before = eye_;
  bool changed = drag(m) || turns;
  const Vec3d direction =
      normalized(forward() * m.forward + right_ * m.right + up_ * m.up);  // zero when at rest
  if (seconds > 0) eye_ = eye_ + direction * (speed_ * seconds * (m.fast ? kFastFactor : 1));

  // The wheel goes forward in a room; around a model it has moved closer already.
  if (!orbits()) eye_ = eye_ + forward() * (speed_ * kNotchSeconds * m.wheel);

  const auto largest = static_cast<double>(kLargestCoordinate);
  if (!(maxComponent(abs(eye_)) + distance_ < largest)) eye_ = before;
  changed |= eye_ != before;
  if (!changed) return false;
  reach_.add(Vec3f(center()));
  writeCamera();
  return true;
}

void CameraControl::fit(double aspect) {
  const Vec3d ahead = forward(), above = cross(right_, ahead);
  const Vec3d middle = model_.center();
  const double half = halfHeightAtOne(fitted(camera_, aspect));

  // A corner is in the picture if its distance from the axis is at most `half` times its depth,
  // which gives a lower bound of the distance for each corner.
  double distance = 0, height = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p = Vec3d(model_.corner(corner)) - middle;

    const double away = std::max(std::abs(dot(p, right_)) / aspect, std::abs(dot(p, above)));
    distance = std::max(distance, away / half - dot(p, ahead));
    height = std::max(height, 2 * away);
  }

  // An orthographic view is fitted by its height; the eye only has to be outside the model.
  if (camera_.orthographicHeight > 0) {
    camera_.orthographicHeight = static_cast<float>(height);
    distance = std::max(distance, model_.diagonal());
  }

  lookFrom(middle, distance);
  reach_ = model_;
  writeCamera();
}

}  // namespace whit::view
