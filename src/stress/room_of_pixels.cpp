#include "stress/room_of_pixels.h"

#include <vector>

#include "core/pixel.h"
#include "simd/kernels.h"
#include "stages/columns.h"

namespace whit::stress {

Mesh roomOfPixels(const CameraFrame& frame) {
  const int columns = frame.width + 2, rows = frame.height + 2;
  std::vector<std::uint32_t> pixels;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) pixels.push_back(packedPixel(x, y));
  }
  // One pixel up and left of the picture, which the middle of this larger one makes good.
  CameraRays rays = cameraRays(frame);
  rays.halfWidth += 1;
  rays.halfHeight += 1;
  const std::size_t count = pixels.size();
  const ColumnStore<RayColumns> directions = raysThrough(pixels, rays);
  Mesh mesh;
  mesh.materials = {0};
  for (std::size_t i = 0; i < count; ++i) {
    mesh.positions.push_back(Vec3f{directions->dirX[i], directions->dirY[i], directions->dirZ[i]} *
                             4.0f);
  }
  const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * columns + x); };
  const auto behind = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back({0, 0, 4});
  for (int y = 0; y + 1 < rows; ++y) {
    for (int x = 0; x + 1 < columns; ++x) {
      mesh.triangles.push_back({at(x, y), at(x, y + 1), at(x + 1, y + 1)});
      mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x + 1, y)});
    }
    mesh.triangles.push_back({at(0, y), at(0, y + 1), behind});
    mesh.triangles.push_back({at(columns - 1, y), at(columns - 1, y + 1), behind});
  }
  for (int x = 0; x + 1 < columns; ++x) {
    mesh.triangles.push_back({at(x, 0), at(x + 1, 0), behind});
    mesh.triangles.push_back({at(x, rows - 1), at(x + 1, rows - 1), behind});
  }
  return mesh;
}

}  // namespace whit::stress
