#include "inspect/ray_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "core/vec3.h"

namespace whit {

namespace {

// Only the end of a primary ray counts, because the eye may be far away.
Box extentOf(const RayTree& tree, const Camera& camera) {
  Box box;
  for (const RayNode& n : tree.nodes) {
    if (n.kind != RayKind::primary) box.add(Vec3f(n.origin));
    if (n.triangle != kMiss) box.add(Vec3f(n.position));
  }
  if (!box.empty()) return box;

  // If no ray hits anything, the box reaches to the point that the camera looks at.
  const RayNode& n = tree.nodes.front();
  box.add(Vec3f(n.origin));
  box.add(Vec3f(n.origin + n.direction * length(Vec3d(camera.at) - Vec3d(camera.eye))));
  return box;
}

RayLook lookOf(const LightContribution& light) {
  return {shadowKind(light.light == kAmbientLight), !light.visible};
}

struct SeenPoint {
  Vec3d position;  // a little before the surface
  double weight = 0;
};

std::vector<SeenPoint> pointsToSee(const RayTree& tree, double before) {
  constexpr std::size_t kMost = 48;
  constexpr double kLeast = 0.02;  // weight of a point that adds nothing to the pixel
  constexpr double kEye = 0.4;     // weight of the eye against all hits
  std::vector<SeenPoint> points;
  double sum = 0;

  for (std::size_t i = 0; i < tree.nodes.size() && points.size() < kMost; ++i) {
    const RayNode& n = tree.nodes[i];
    if (n.triangle == kMiss) continue;
    const double weight = kLeast + std::min(1.0, maxComponent(weightAtEye(tree, i)));
    const double back = std::min(before, 0.5 * n.distance * length(n.direction));
    points.push_back({n.position - normalized(n.direction) * back, weight});
    sum += weight;
  }

  // The eye has a fixed share of the weight of all hits.
  const double eye = std::max(kEye * sum, kLeast);
  points.push_back({tree.nodes.front().origin, eye});

  // Weights are normalized to a sum of 1.
  for (SeenPoint& point : points) point.weight /= sum + eye;
  return points;
}

// Returns the share of the points, by weight, that the camera sees, and adds up to a tenth if they
// are far apart in its picture.
double shareSeen(const std::vector<SeenPoint>& points, const Camera& camera, const Accel& accel) {
  constexpr int kWidth = 480, kHeight = 300;
  constexpr double kMargin = 8, kApart = 0.1;
  const LineView view(camera, kWidth, kHeight);
  double share = 0, left = kWidth, right = 0, top = kHeight, bottom = 0;

  for (const SeenPoint& point : points) {
    const auto at = view.see(point.position, point.position);
    if (!at || at->x1 < kMargin || at->x1 > kWidth - kMargin || at->y1 < kMargin ||
        at->y1 > kHeight - kMargin) {
      continue;
    }

    // A point counts unless a surface hides it from the camera.
    const Vec3f toEye = Vec3f(Vec3d(camera.eye) - point.position);
    const Hit hit = accel.closest(Vec3f(point.position), toEye);
    if (hit.found() && hit.t < 1) continue;

    share += point.weight;
    left = std::min(left, at->x1);
    right = std::max(right, at->x1);
    top = std::min(top, at->y1);
    bottom = std::max(bottom, at->y1);
  }

  const double across = std::hypot(std::max(right - left, 0.0), std::max(bottom - top, 0.0));
  return share > 0 ? share + kApart * std::min(across / kHeight, 1.0) : 0;
}

}  // namespace

std::vector<RayLook> looksOf(const std::vector<RayLine>& lines) {
  std::vector<RayLook> looks(lines.size());
  std::ranges::transform(lines, looks.begin(), &RayLine::look);

  std::ranges::sort(looks, {},
                    [](RayLook l) { return std::tuple(isDashed(l), l.kind, l.blocked); });
  looks.erase(std::unique(looks.begin(), looks.end()), looks.end());
  return looks;
}

std::vector<RayLine> linesOf(const RayTree& tree, const Camera& camera) {
  constexpr double kShownOfEndless = 0.2, kWidest = 2.5, kNarrowest = 0.4, kShadow = 0.5;
  const double extent = std::max(extentOf(tree, camera).diagonal(), 1e-6);
  std::vector<RayLine> lines;

  // Nodes are visited in reverse, so that parents are drawn over their children.
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

Camera cameraAside(const RayTree& tree, const Camera& camera, const Accel& accel) {
  constexpr std::array kAways{1.0, 0.7, 0.4, 0.2}, kElevations{0.35, 0.0, 0.9, -0.3};
  constexpr int kAzimuths = 16;

  const Box box = extentOf(tree, camera);
  const Vec3d center = box.center();
  const Vec3d toEye = Vec3d(camera.eye) - center;
  const Vec3d up = normalized(Vec3d(camera.up), Vec3d{0, 1, 0});
  const Vec3d aside = normalized(cross(up, toEye), Vec3d{1, 0, 0});
  const double away = std::max(length(toEye), box.diagonal());
  const std::vector<SeenPoint> points = pointsToSee(tree, 1e-3 * away);

  Camera seen;
  seen.up = camera.up;
  seen.at = Vec3f(center);
  Camera best = seen;
  double most = -1;

  // Positions are tried in order of preference: a later one has to show more.
  for (const double share : kAways) {
    for (const double elevation : kElevations) {
      for (int i = 0; i < kAzimuths; ++i) {
        // The first direction is the usual one; the next ones alternate between both sides.
        const double turn = (i % 2 == 0 ? i : -i - 1) * std::numbers::pi / kAzimuths - 0.9;
        const Vec3d level = cross(aside, up) * -std::cos(turn) - aside * std::sin(turn);
        seen.eye = Vec3f(center + normalized(level + up * elevation) * (1.2 * share * away));
        const double shown = shareSeen(points, seen, accel);
        if (shown <= most) continue;
        most = shown;
        best = seen;
      }
    }
  }

  return best;
}

LineView::LineView(const Camera& camera, int width, int height)
    : frame_(makeCameraFrame(camera, width, height)),
      near_(1e-3 * length(Vec3d(camera.at) - Vec3d(camera.eye))) {}

std::optional<ScreenLine> LineView::see(Vec3d from, Vec3d to) const {
  if (!frame_.isLinear()) return std::nullopt;  // lines are curves there
  double a = dot(from - frame_.eye, frame_.forward), b = dot(to - frame_.eye, frame_.forward);
  if (std::max(a, b) < near_) return std::nullopt;

  // The part of the line behind the near plane is cut off.
  if (a > b) {
    std::swap(a, b);
    std::swap(from, to);
  }
  if (a < near_) from = from + (to - from) * ((near_ - a) / (b - a));

  const auto [x1, y1] = imagePlace(frame_, from);
  const auto [x2, y2] = imagePlace(frame_, to);
  return ScreenLine{x1, y1, x2, y2};
}

bool clip(ScreenLine& line, double width, double height) {
  // Each edge of the window bounds the line's parameter t from one side (Liang and Barsky 1984).
  double from = 0, to = 1;
  const double dx = line.x2 - line.x1, dy = line.y2 - line.y1;
  const auto keep = [&](double step, double room) {  // step * t <= room
    if (step == 0) return room >= 0;
    const double t = room / step;
    if (step > 0) {
      to = std::min(to, t);
    } else {
      from = std::max(from, t);
    }
    return from <= to;
  };

  const bool seen = keep(-dx, line.x1) && keep(dx, width - line.x1) && keep(-dy, line.y1) &&
                    keep(dy, height - line.y1);
  if (!seen) return false;

  line = {line.x1 + from * dx, line.y1 + from * dy, line.x1 + to * dx, line.y1 + to * dy};
  return true;
}

}  // namespace whit
