#include "reference/generate_rays.h"

#include "core/pixel.h"
#include "reference/initial_medium_stack.h"
#include "sampling/random_streams.h"

namespace whit::reference {

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
  return {generateRay(camera, x + double{at.x}, y + double{at.y}),
          {streamOfPixel(packedPixel(x, y), number), number}};
}

RayRow generateRays(const World& world, const Chunk& chunk, std::size_t slot) {
  const std::uint32_t pixel = chunk.pixels[chunk.first + slot];
  const Ray ray = generateRay(world.camera, pixelX(pixel) + double{chunk.sample.x},
                              pixelY(pixel) + double{chunk.sample.y});
  RayRow row;
  put(ray.origin, row.orgX, row.orgY, row.orgZ);
  put(ray.direction, row.dirX, row.dirY, row.dirZ);
  put(Vec3d(1.0), row.weightR, row.weightG, row.weightB);
  row.throughput = 1;
  row.parent = static_cast<std::uint32_t>(slot);
  row.media = mediaAtStart(world.scene, world.effects, world.intersector, world.camera, ray);
  row.path = streamOfPixel(pixel, chunk.sampleNumber, chunk.frame->seed);
  row.cone = ray.cone.width;
  return row;
}

}  // namespace whit::reference
