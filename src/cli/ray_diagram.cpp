#include "cli/ray_diagram.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "accuracy/report.h"
#include "core/box.h"
#include "core/formatted.h"

namespace whit::cli {

namespace {

// Of primary rays only the end counts: the eye may be far away.
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

class Canvas {
 public:
  Canvas(const Camera& camera, int width, int height)
      : frame_(makeCameraFrame(camera, width, height)), near_(1e-3 * distanceOf(camera)) {}

  // What is seen of the line, as the end points of an SVG line; nothing if all of it lies behind.
  std::string line(Vec3d from, Vec3d to) const {
    double a = dot(from - frame_.eye, frame_.forward), b = dot(to - frame_.eye, frame_.forward);
    if (std::max(a, b) < near_) return {};
    if (a > b) std::swap(a, b), std::swap(from, to);
    if (a < near_) from = from + (to - from) * ((near_ - a) / (b - a));
    const auto [x1, y1] = project(from);
    const auto [x2, y2] = project(to);
    return formatted("x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\"", x1, y1, x2, y2);
  }

 private:
  static double distanceOf(const Camera& camera) {
    return length(Vec3d(camera.at) - Vec3d(camera.eye));
  }
  std::pair<double, double> project(const Vec3d& p) const {
    const Vec3d d = p - frame_.eye;
    const double depth = frame_.orthographic ? 1 : dot(d, frame_.forward);
    const double x = dot(d, frame_.right) / (dot(frame_.right, frame_.right) * depth);
    const double y = dot(d, frame_.up) / (dot(frame_.up, frame_.up) * depth);
    return {frame_.width / 2.0 + x, frame_.height / 2.0 - y};
  }

  CameraFrame frame_;
  double near_;
};

const char* colorOf(RayKind kind) {
  switch (kind) {
    case RayKind::reflection:
      return "#ff4040";
    case RayKind::refraction:
      return "#40a0ff";
    default:
      return "#ffffff";
  }
}

std::string drawn(const std::string& line, const char* color, double width, const char* dashes) {
  if (line.empty()) return {};
  return formatted("<line %s stroke=\"%s\" stroke-width=\"%.2f\"%s/>\n", line.c_str(), color, width,
                   dashes);
}

}  // namespace

Camera diagramCamera(const RayTree& tree, const Camera& camera) {
  const Box box = extentOf(tree);
  const Vec3d center = (Vec3d(box.lower) + Vec3d(box.upper)) * 0.5;
  const Vec3d toEye = Vec3d(camera.eye) - center;
  const Vec3d up = normalized(Vec3d(camera.up), Vec3d{0, 1, 0});
  const Vec3d aside = normalized(cross(up, toEye), Vec3d{1, 0, 0});
  const double away = std::max(length(toEye), diagonalOf(box));
  Camera seen = camera;
  seen.eye = Vec3f(center + normalized(toEye + aside * (0.8 * away) + up * (0.35 * away), up) *
                                (1.2 * away));
  seen.at = Vec3f(center);
  seen.fov = 45;
  seen.orthographicHeight = 0;
  return seen;
}

std::string rayDiagram(const RayTree& tree, const Camera& camera, int width, int height,
                       const std::string& picture) {
  constexpr double kShownOfEndless = 0.2, kWidest = 2.5, kNarrowest = 0.4;
  const double extent = std::max(diagonalOf(extentOf(tree)), 1e-6);
  const Canvas canvas(camera, width, height);
  std::string svg = formatted(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
      "viewBox=\"0 0 %d %d\">\n<image width=\"%d\" height=\"%d\" href=\"",
      width, height, width, height, width, height);
  svg += accuracy::dataUri(picture) + "\"/>\n";
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {  // what weighs most comes last
    const RayNode& n = tree.nodes[i];
    const double weight = std::min(1.0, maxComponent(weightAtEye(tree, i)));
    const double stroke = kNarrowest + (kWidest - kNarrowest) * std::sqrt(std::max(weight, 0.0));
    for (const LightOfRay& light : n.lights) {
      if (!light.traced) continue;
      svg +=
          drawn(canvas.line(light.origin, light.origin + light.toLight),
                light.visible ? "#ffe040" : "#000000", stroke * 0.5, " stroke-dasharray=\"4 3\"");
    }
    const bool ends = n.triangle != kMiss;
    const Vec3d end = ends ? n.position : n.origin + n.direction * (kShownOfEndless * extent);
    svg += drawn(canvas.line(n.origin, end), colorOf(n.kind), stroke, "");
  }
  return svg + "</svg>\n";
}

}  // namespace whit::cli
