#include "oracle/placement.h"

#include <numbers>

namespace oracle {

namespace {

Vec turned(const Vec& v, const Transform& transform) {
  const Vec k = normalized(transform.axis);
  const double angle = transform.degrees * std::numbers::pi / 180;
  const double c = std::cos(angle), s = std::sin(angle);
  return v * c + cross(k, v) * s + k * (dot(k, v) * (1 - c));  // Rodrigues
}

}  // namespace

Vec placed(Vec point, std::span<const Transform> transforms) {
  for (std::size_t i = transforms.size(); i-- > 0;) {
    point = turned(point * transforms[i].scale, transforms[i]) + transforms[i].translate;
  }
  return point;
}

Vec placedDifference(Vec difference, std::span<const Transform> transforms) {
  for (std::size_t i = transforms.size(); i-- > 0;) {
    difference = turned(difference * transforms[i].scale, transforms[i]);
  }
  return difference;
}

Vec placedNormal(Vec n, std::span<const Transform> transforms) {
  for (std::size_t i = transforms.size(); i-- > 0;) {
    const Vec& s = transforms[i].scale;
    n = normalized(turned({n.x / s.x, n.y / s.y, n.z / s.z}, transforms[i]));
  }
  return n;
}

bool areMirroring(std::span<const Transform> transforms) {
  bool mirroring = false;
  for (const auto& [scale, axis, degrees, translate] : transforms) {
    mirroring = mirroring != (scale.x * scale.y * scale.z < 0);
  }
  return mirroring;
}

Transform placeAt(const Motion& motion, double time) {
  const std::vector<Motion::Key>& keys = motion.keys;
  std::size_t next = 0;  // the first key behind `time`
  while (next < keys.size() && keys[next].time <= time) ++next;
  const Motion::Key& from = keys[next == 0 ? 0 : next - 1];
  const Motion::Key& to = next == keys.size() ? from : keys[next];

  const double way = to.time - from.time;
  const double t = next == 0 || !(way > 0) || motion.inSteps ? 0 : (time - from.time) / way;
  return {from.scale * (1 - t) + to.scale * t, motion.axis, from.degrees * (1 - t) + to.degrees * t,
          from.translate * (1 - t) + to.translate * t};
}

Scene atItsTime(Scene scene) {
  for (Light& light : scene.lights) {
    if (light.motion.keys.empty()) continue;
    const std::array by{placeAt(light.motion, scene.time)};
    light.position = placed(light.position, by);
    light.direction = placedDifference(light.direction, by);
  }

  Camera& camera = scene.camera;
  if (!camera.motion.keys.empty()) {
    const std::array by{placeAt(camera.motion, scene.time)};
    camera.eye = placed(camera.eye, by);
    camera.at = placed(camera.at, by);
    camera.up = placedDifference(camera.up, by);
  }

  return scene;
}

}  // namespace oracle
