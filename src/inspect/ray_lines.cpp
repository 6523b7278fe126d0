#include "inspect/ray_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/box.h"

namespace whit {

namespace {

// Only the end of a primary ray counts, because the eye may be far away.
Box extentOf(const RayTree& tree) {
  Box box;
  for (const RayNode& n : tree.nodes) {
    if (n.kind != RayKind::primary) box.add(Vec3f(n.origin));
    if (n.triangle != kMiss) box.add(Vec3f(n.position));
  }
  if (box.empty()) box.add(Vec3f(tree.nodes.front().origin));
  return box;
}

double diagonalOf(const Box& box) { return length(Vec3d(box.upper) - Vec3d(box.lower)); }

RayLook lookOf(const LightContribution& light) {
  return {shadowKind(light.light == kAmbientLight), !light.visible};
}

}  // namespace

std::vector<RayLook> rayLooks() {
  std::vector<RayLook> looks;
  for (const RayKindRow& row : kRayKinds) {
    looks.push_back({row.kind, false});
    if (row.onlyAsk()) looks.push_back({row.kind, true});
  }
  std::stable_partition(looks.begin(), looks.end(), [](RayLook look) { return !isDashed(look); });
  return looks;
}

std::vector<RayLine> linesOf(const RayTree& tree) {
  constexpr double kShownOfEndless = 0.2, kWidest = 2.5, kNarrowest = 0.4, kShadow = 0.5;
  const double extent = std::max(diagonalOf(extentOf(tree)), 1e-6);
  std::vector<RayLine> lines;
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    const RayNode& n = tree.nodes[i];
    const double weight = std::min(1.0, maxComponent(weightAtEye(tree, i)));
    const double width = kNarrowest + (kWidest - kNarrowest) * std::sqrt(std::max(weight, 0.0));
    for (const LightContribution& light : n.lights) {
      if (!light.traced) continue;
      lines.push_back(
          {light.origin, light.origin + light.toLight, lookOf(light), i, width * kShadow});
    }
    const bool ends = n.triangle != kMiss;
    const Vec3d end = ends ? n.position : n.origin + n.direction * (kShownOfEndless * extent);
    lines.push_back({n.origin, end, RayLook{n.kind}, i, width});
  }
  return lines;
}

Camera cameraAside(const RayTree& tree, const Camera& camera) {
  const Box box = extentOf(tree);
  const Vec3d center = (Vec3d(box.lower) + Vec3d(box.upper)) * 0.5;
  const Vec3d toEye = Vec3d(camera.eye) - center;
  const Vec3d up = normalized(Vec3d(camera.up), Vec3d{0, 1, 0});
  const Vec3d aside = normalized(cross(up, toEye), Vec3d{1, 0, 0});
  const double away = std::max(length(toEye), diagonalOf(box));
  Camera seen;
  seen.up = camera.up;
  seen.eye = Vec3f(center + normalized(toEye + aside * (0.8 * away) + up * (0.35 * away), up) *
                                (1.2 * away));
  seen.at = Vec3f(center);
  return seen;
}

LineView::LineView(const Camera& camera, int width, int height)
    : frame_(makeCameraFrame(camera, width, height)),
      near_(1e-3 * length(Vec3d(camera.at) - Vec3d(camera.eye))) {}

std::optional<ScreenLine> LineView::see(Vec3d from, Vec3d to) const {
  double a = dot(from - frame_.eye, frame_.forward), b = dot(to - frame_.eye, frame_.forward);
  if (std::max(a, b) < near_) return std::nullopt;
  if (a > b) std::swap(a, b), std::swap(from, to);
  if (a < near_) from = from + (to - from) * ((near_ - a) / (b - a));
  const auto [x1, y1] = project(from);
  const auto [x2, y2] = project(to);
  return ScreenLine{x1, y1, x2, y2};
}

std::array<double, 2> LineView::project(const Vec3d& point) const {
  const Vec3d d = point - frame_.eye;
  const double depth = frame_.orthographic ? 1 : dot(d, frame_.forward);
  const double x = dot(d, frame_.right) / (dot(frame_.right, frame_.right) * depth);
  const double y = dot(d, frame_.up) / (dot(frame_.up, frame_.up) * depth);
  return {frame_.width / 2.0 + x, frame_.height / 2.0 - y};
}

}  // namespace whit
