// A plane casts no shadow on itself, whatever its size, its place and its direction (hard case H2).
// Rays have to start farther from a large triangle than the coordinates of its points suggest,
// because Embree's distances to it are rounded in proportion to its edges.
#include <gtest/gtest.h>

#include "inspect/reference_frame.h"
#include "reference/small_scenes.h"
#include "render/renderer.h"
#include "render/shipped_scene.h"

namespace whit::test {
namespace {

// Makes two by two squares of side size / 2 around `center`, facing along the second axis of
// `turn`.
Mesh squares(const Affine& turn, const Vec3d& center, double size) {
  Mesh mesh;
  for (int i = 0; i < 9; ++i) {
    const Vec3d p{(i % 3 - 1) * size / 2, 0, (i / 3 - 1) * size / 2};
    mesh.positions.emplace_back(turn.vector(p) + center);
  }
  for (const std::uint32_t i : {0u, 1u, 3u, 4u}) {
    mesh.triangles.push_back({i, i + 3, i + 4});
    mesh.triangles.push_back({i, i + 4, i + 1});
  }
  return mesh;
}

struct View {
  Affine turn;
  Vec3d center;
  double size = 0;
  double distance() const { return std::min(size / 20, 1.0); }  // from the plane to the light
};

Camera cameraOf(const View& view) {
  const Vec3d away = view.turn.vector({0.3, 0.8, 0.1}) * (8 * view.distance());
  return {.eye = Vec3f(view.center + away),
          .at = Vec3f(view.center),
          .up = Vec3f(view.turn.vector({0, 0, 1})),
          .orthographicHeight = static_cast<float>(6 * view.distance())};
}

Light lightOf(const View& view) {
  const Vec3d up = view.turn.vector({0, 1, 0}) * view.distance();
  return lightAt(Vec3f(view.center + up), static_cast<float>(view.distance() * view.distance()));
}

// Counts the pixels without light; all of them see the plane.
int darkPixels(const Scene& scene, Mode mode) {
  RenderOptions options;
  options.size = ImageSize{96, 72};
  options.threads = 2;
  options.mode = mode;

  Renderer renderer(scene, options);
  Film film = makeFilm(scene, options);
  renderFrame(renderer, mode, scene.cameras.front(), film);
  int dark = 0;
  for (const Rgb& pixel : film.image.pixels) dark += pixel.x > 0 ? 0 : 1;
  return dark;
}

void expectLit(const Scene& scene, const View& view) {
  for (const Mode mode : {Mode::packets, Mode::reference}) {
    EXPECT_EQ(darkPixels(scene, mode), 0)
        << "size " << view.size << ", center " << view.center.x << " " << view.center.y << " "
        << view.center.z << (mode == Mode::packets ? ", packets" : ", reference");
  }
}

std::vector<View> views(std::initializer_list<double> sizes, double farthest) {
  Numbers numbers(7);
  std::vector<View> views;
  for (const double size : sizes) {
    for (int i = 0; i < 4; ++i) {
      const Affine turn = Affine::rotation(numbers.direction(), numbers.in(0, 360));
      views.push_back({turn, numbers.direction() * (i < 2 ? 0 : farthest), size});
    }
  }
  return views;
}

TEST(TiltedPlanes, H2_lieInNoShadowOfTheirOwn) {
  for (const View& view : views({1e-3, 20, 100, 300, 1e3, 1e4, 1e6}, 1e5)) {
    // Vertices of a small plane far away are rounded to points that make it rough.
    if (view.center != Vec3d{} && view.size < 20) continue;
    SceneBuilder builder;
    Mesh mesh = squares(view.turn, view.center, view.size);
    mesh.materials = {builder.add(diffuseMaterial(0.8f))};
    builder.add(std::move(mesh));
    builder.description.lights = {lightOf(view)};
    builder.description.cameras = {cameraOf(view)};
    expectLit(builder.build(), view);
  }
}

TEST(TiltedPlanes, H11_norAsInstances) {
  for (const View& view : views({20, 1e3, 1e5}, 0)) {
    SceneBuilder builder;
    Mesh mesh = squares(view.turn, {}, view.size);
    mesh.materials = {builder.add(diffuseMaterial(0.8f))};
    Object object;
    object.meshes.push_back(std::move(mesh));
    const Vec3d below = view.turn.vector({0, -10 * view.size, 0});
    builder.place(std::move(object), {Affine::scaling(Vec3d(1.5)), Affine::translation(below)});

    builder.description.lights = {lightOf(view)};
    builder.description.cameras = {cameraOf(view)};
    expectLit(builder.build(), view);
  }
}

// A needle is as long as a plane is large, and its normal is the least certain.
TEST(TiltedPlanes, H25_norAsNeedles) {
  for (const View& view : views({20, 1e3, 1e5}, 0)) {
    SceneBuilder builder;
    Mesh mesh;
    mesh.materials = {builder.add(diffuseMaterial(0.8f))};

    // Needles side by side make up a strip that is wider than the view.
    constexpr std::uint32_t kNeedles = 64;
    const double width = 12 * view.distance() / kNeedles;
    for (std::uint32_t i = 0; i <= kNeedles; ++i) {
      const double x = width * (i - kNeedles / 2.0);
      for (const double z : {-view.size / 2, view.size / 2}) {
        mesh.positions.emplace_back(view.turn.vector({x, 0, z}));
      }

      if (i == 0) continue;
      mesh.triangles.push_back({2 * i - 2, 2 * i - 1, 2 * i + 1});
      mesh.triangles.push_back({2 * i - 2, 2 * i + 1, 2 * i});
    }

    builder.add(std::move(mesh));
    builder.description.lights = {lightOf(view)};
    builder.description.cameras = {cameraOf(view)};
    expectLit(builder.build(), view);
  }
}

}  // namespace
}  // namespace whit::test
