#include "reference/generate_rays.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core/image.h"
#include "reference/media.h"
#include "sampling/random_streams.h"

namespace whit::reference {

namespace {

// The point of the unit disk that belongs to a point of the unit square, such that equal areas stay
// equal and neighbors stay neighbors (Shirley and Chiu 1997, "A low distortion map between disk and
// square"). Squares about the center become circles.
std::array<double, 2> diskPoint(const UnitPoint& square) {
  const double a = 2 * double{square.u} - 1, b = 2 * double{square.v} - 1;
  if (a == 0 && b == 0) return {0, 0};
  constexpr double kEighth = std::numbers::pi / 4;  // of a turn
  const bool byA = std::fabs(a) > std::fabs(b);
  const double radius = byA ? a : b;
  const double turn = byA ? kEighth * (b / a) : 2 * kEighth - kEighth * (a / b);
  return {radius * std::cos(turn), radius * std::sin(turn)};
}

// The ray that starts at the path's point of the lens and meets `central`, which starts at the
// center of the lens, in the plane of focus.
Ray throughLens(const CameraFrame& camera, const Ray& central, const Path& path) {
  if (!(camera.aperture > 0)) return central;
  const auto [x, y] =
      diskPoint(saltedPoint(path.number, lightSampling(0, 1, path.sample), kLensSalt, 0));
  const Vec3d aside = (normalized(camera.right) * x + normalized(camera.up) * y) * camera.aperture;
  const Vec3d toFocus = central.direction * (camera.focus / dot(central.direction, camera.forward));
  return {central.origin + aside, normalized(toFocus - aside, central.direction), central.cone};
}

}  // namespace

Ray generateRay(const CameraFrame& camera, double x, double y) {
  if (camera.orthographic) {
    const Vec3d aside =
        camera.right * (x - camera.width / 2.0) - camera.up * (y - camera.height / 2.0);
    return {camera.eye + aside, camera.forward, pixelCone(camera)};
  }
  const Vec3d through = camera.forward + camera.right * (x - camera.width / 2.0) -
                        camera.up * (y - camera.height / 2.0);
  return {camera.eye, normalized(through, camera.forward), pixelCone(camera)};
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
  put(ray.origin, row.orgX, row.orgY, row.orgZ);
  put(ray.direction, row.dirX, row.dirY, row.dirZ);
  put(Vec3d(1.0), row.weightR, row.weightG, row.weightB);
  row.throughput = 1;
  row.parent = static_cast<std::uint32_t>(slot);
  row.media = mediaAtStart(world.scene, world.effects, world.intersector, world.camera, ray);
  row.cone = ray.cone.width;
  return row;
}

}  // namespace whit::reference
