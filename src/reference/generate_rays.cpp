#include "reference/generate_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/image.h"
#include "core/index.h"
#include "sampling/random_streams.h"
#include "surfaces/initial_media.h"

namespace whit::reference {

namespace {

// The point of the unit disk that belongs to a point of the unit square, such that equal areas stay
// equal and neighbors stay neighbors (Shirley and Chiu 1997, "A low distortion map between disk and
// square"). Squares about the center become circles.
std::array<double, 2> diskPoint(const UnitPoint& square) {
  const double a = 2 * double{square.u} - 1, b = 2 * double{square.v} - 1;
  if (a == 0 && b == 0) return {0, 0};
  constexpr double kEighth = std::numbers::pi / 4;  // an eighth of a turn

  // The larger coordinate becomes the radius, so squares about the center become circles.
  const bool byA = std::fabs(a) > std::fabs(b);
  const double radius = byA ? a : b;

  // The smaller one becomes the angle, at most an eighth of a turn from the axis.
  const double turn = byA ? kEighth * (b / a) : 2 * kEighth - kEighth * (a / b);
  return {radius * std::cos(turn), radius * std::sin(turn)};
}

// The ray that starts at the path's point of the lens and meets `central`, which starts at the
// center of the lens, in the plane of focus.
Ray throughLens(const CameraFrame& camera, const Ray& central, const Path& path) {
  if (!(camera.aperture > 0) || central.direction == Vec3d()) return central;

  const auto [x, y] = diskPoint(saltedPoint(path.number, lensSampling(path.sample), kLensSalt, 0));
  const Vec3d aside = (normalized(camera.right) * x + normalized(camera.up) * y) * camera.aperture;
  const Vec3d toFocus = central.direction * (camera.focus / dot(central.direction, camera.forward));
  return {central.origin + aside, normalized(toFocus - aside, central.direction), central.cone};
}

// The point that OpenCV's model of a lens distorts to (u, v), both with y downwards. There is none
// where Newton's method, by the radial part's derivative, does not find one, or finds one beyond a
// fold of the picture.
std::optional<std::array<double, 2>> undistorted(const CameraFrame& camera, double u, double v) {
  const auto [k1, k2, p1, p2, k3, k4, k5, k6] = camera.distortion;

  // Newton's method starts at the distorted point.
  double x = u, y = v;
  for (int step = 0;; ++step) {
    const double r2 = x * x + y * y;

    // The radial part of OpenCV's model scales by a quotient of polynomials in r^2.
    const double above = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double below = 1 + r2 * (k4 + r2 * (k5 + r2 * k6));
    const double scale = above / below;

    // The scale changes by `slope` * r with r, and the distorted radius by `radial`.
    const double change =
        k1 + r2 * (2 * k2 + r2 * 3 * k3) - scale * (k4 + r2 * (2 * k5 + r2 * 3 * k6));
    const double slope = 2 * change / below, radial = scale + r2 * slope;

    // The residual is the model's image of (x, y), with the tangential part, minus (u, v).
    const double offX = x * scale + 2 * p1 * x * y + p2 * (r2 + 2 * x * x) - u;
    const double offY = y * scale + 2 * p2 * x * y + p1 * (r2 + 2 * y * y) - v;

    // The result counts if it is precise and does not lie beyond a fold of the picture.
    if (step == kLensSteps) {
      const bool found = std::max(std::fabs(offX), std::fabs(offY)) < kLensError;
      if (!(found && std::min({scale, below, radial}) > 0)) return std::nullopt;
      return std::array{x, y};
    }

    // The step inverts the radial part's Jacobian, scale * I + slope * p * p^T, by Sherman and
    // Morrison's formula.
    const double share = slope * (x * offX + y * offY) / radial;
    x -= (offX - x * share) / scale;
    y -= (offY - y * share) / scale;
  }
}

// Returns the angle to the axis of the ray that a fisheye images at a distance of `radius` focal
// lengths from the center; NaN where there is none.
double fisheyeAngle(const CameraFrame& camera, double radius) {
  // In an equisolid projection r = 2 sin(angle / 2).
  if (camera.projection == Projection::equisolid) return 2 * std::asin(radius / 2);

  // The others have OpenCV's r = angle * (1 + k1 angle^2 + k2 angle^4 + ...), which Newton's method
  // inverts.
  const double k1 = camera.distortion[0], k2 = camera.distortion[1];
  const double k3 = camera.distortion[2], k4 = camera.distortion[3];
  double angle = radius;
  for (int step = 0;; ++step) {
    const double a2 = angle * angle;
    const double off = angle * (1 + a2 * (k1 + a2 * (k2 + a2 * (k3 + a2 * k4)))) - radius;
    const double slope = 1 + a2 * (3 * k1 + a2 * (5 * k2 + a2 * (7 * k3 + a2 * 9 * k4)));

    if (step == kLensSteps) {
      return std::fabs(off) < kLensError && slope > 0 ? angle : std::nan("");
    }

    angle -= off / slope;
  }
}

// Interpolates the entries of a table that is stretched over `pixels` pixels at one place. Entries
// stand for the centers of equal spans of pixels; the first and the last one hold beyond them.
double entryAt(const std::vector<float>& table, double pixel, int pixels) {
  const auto last = static_cast<double>(table.size() - 1);
  const double at = std::clamp(pixel * static_cast<double>(table.size()) / pixels - 0.5, 0.0, last);
  const auto before = static_cast<std::size_t>(at);
  const double a = table[before], b = table[std::min(before + 1, table.size() - 1)];
  return a + (b - a) * (at - static_cast<double>(before));
}

Vec3d towards(double azimuth, double elevation) {
  return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
          std::cos(azimuth) * std::cos(elevation)};
}

// Returns radians to the right of the view, for projections by azimuth and elevation.
double azimuthAt(const CameraFrame& camera, double rightward) {
  if (camera.projection == Projection::panorama) return rightward * length(camera.right);
  const double degrees =
      entryAt(camera.azimuths, rightward + camera.viewWidth / 2.0, camera.viewWidth);
  return degrees * (std::numbers::pi / 180);
}

// Returns the direction along right, up and forward through the point that lies so far right of and
// above the center in pixels; 0 where nothing is seen.
Vec3d projectedDirection(const CameraFrame& camera, double rightward, double upward) {
  constexpr double kRadians = std::numbers::pi / 180;
  const double x = rightward * length(camera.right), y = upward * length(camera.up);

  switch (camera.projection) {
    case Projection::perspective: {
      const auto point = undistorted(camera, x, -y);
      if (!point) return Vec3d();
      return normalized(Vec3d{(*point)[0], -(*point)[1], 1});
    }
    case Projection::panorama:
      return towards(azimuthAt(camera, rightward), y);
    case Projection::directions:
      return towards(azimuthAt(camera, rightward),
                     kRadians * entryAt(camera.elevations, camera.viewHeight / 2.0 - upward,
                                        camera.viewHeight));
    default: {
      const double radius = std::hypot(x, y), angle = fisheyeAngle(camera, radius);
      if (!(angle <= camera.limit)) return {};
      const double across = radius > 0 ? std::sin(angle) / radius : 0;
      return {x * across, y * across, std::cos(angle)};
    }
  }
}

}  // namespace

Ray generateRay(const CameraFrame& camera, double x, double y) {
  // In a stereo pair or a cube map the pixel belongs to one of the views.
  CameraView view{{}, camera.forward, camera.right, camera.up};
  int number = 0;
  if (!camera.views.empty()) {
    const int columns = camera.viewColumns, rows = camera.viewRows;
    const int column = std::min(static_cast<int>(x / camera.viewWidth), columns - 1);
    const int row = std::min(static_cast<int>(y / camera.viewHeight), rows - 1);
    number = row * columns + column;
    view = camera.views[number];
    x -= column * camera.viewWidth;
    y -= row * camera.viewHeight;
  }

  const Vec3d start = camera.eye + view.aside;

  // The place counts pixels right of and above the principal point.
  y = camera.centerY - y;
  x = x - camera.centerX + camera.skew * y;

  // Orthographic rays differ in their starts, all others in their directions.
  if (camera.orthographic) {
    return {start + (view.right * x + view.up * y), view.forward, pixelCone(camera)};
  }
  if (camera.isStraight()) {
    const Vec3d through = view.forward + view.right * x + view.up * y;
    return {start, normalized(through, view.forward), pixelCone(camera)};
  }

  const Vec3d d = projectedDirection(camera, x, y), right = normalized(view.right);
  const Vec3d direction = right * d.x + normalized(view.up) * d.y + view.forward * d.z;
  if (camera.turning == 0) return {start, direction, pixelCone(camera)};

  // Omni-directional stereo (Google 2015, "Rendering omni-directional stereo content"): the eyes
  // stand on the tangent to the circle where the azimuth meets it; the left eye has the first view.
  const double azimuth = azimuthAt(camera, x);
  const double side = number == 0 ? -camera.turning : camera.turning;
  const Vec3d tangent = right * std::cos(azimuth) - view.forward * std::sin(azimuth);
  return {start + tangent * side, direction, pixelCone(camera)};
}

PrimaryRay primaryRay(const CameraFrame& camera, int x, int y, const Vec2f& at,
                      std::size_t sample) {
  const auto number = static_cast<std::uint32_t>(sample);
  const Path path{streamOfPixel(packedPixel(x, y), number), number};
  const Ray central = generateRay(camera, x + double{at.x}, y + double{at.y});
  return {throughLens(camera, central, path), path};
}

RayRow generateRays(const World& world, const Chunk& chunk, std::size_t slot) {
  const std::uint32_t pixel = chunk.pixels[chunk.first + slot];
  const Ray central = generateRay(world.camera, pixelX(pixel) + double{chunk.sample.x},
                                  pixelY(pixel) + double{chunk.sample.y});

  RayRow row;
  row.path = streamOfPixel(pixel, chunk.sampleNumber, chunk.frame->seed);
  const Ray ray = throughLens(world.camera, central, {row.path, chunk.sampleNumber});

  row.org = ray.origin;
  row.dir = ray.direction;

  // A primary ray has the weight 1, and its parent is the slot of its pixel.
  row.weight = Vec3d(1.0);
  row.throughput = 1;
  row.parent = static_cast<std::uint32_t>(slot);

  row.media = mediaAtStart(world.scene, world.effects, world.intersector, world.camera, ray);
  row.cone = ray.cone.width;
  return row;
}

}  // namespace whit::reference
