// A plane casts no shadow on itself, whatever its size, its place and its direction (hard case H2).
// Rays have to start farther from a large triangle than the coordinates of its points suggest,
// because Embree's distances to it are rounded in proportion to its edges.
#include <gtest/gtest.h>

#include <algorithm>

#include "reference/small_scenes.h"
#include "render/shipped_scene.h"

namespace whit::test {
namespace {

struct View {
  Affine turn;
  Vec3d center;
  double size = 0;
  double distance() const { return std::min(size / 20, 1.0); }  // from the plane to the light
};

// Makes two by two squares of half the view's size around its center, facing along the second axis
// of its turn.
Mesh squares(const View& view) {
  return sheetOf(3, 3, [&](int x, int z) {
    const Vec3d p = Vec3d(x - 1, 0, z - 1) * (view.size / 2);
    return Vec3f(view.turn.vector(p) + view.center);
  });
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

// Expects light in each pixel of a picture of the mesh, which lies in the plane of the view. Two
// placements make instances.
void expectLit(const View& view, Mesh mesh, const std::vector<Affine>& placements = {Affine()}) {
  SceneBuilder builder;
  mesh.materials = {builder.add(diffuseMaterial(0.8f))};
  builder.place({"plane", {std::move(mesh)}}, placements);

  const double away = view.distance();
  const auto beside = [&](const Vec3d& d) {
    return Vec3f(view.center + view.turn.vector(d) * away);
  };
  builder.description.lights = {lightAt(beside({0, 1, 0}), static_cast<float>(away * away))};
  builder.description.cameras = {{.eye = beside({2.4, 6.4, 0.8}),
                                  .at = Vec3f(view.center),
                                  .up = Vec3f(view.turn.vector({0, 0, 1})),
                                  .orthographicHeight = static_cast<float>(6 * away)}};

  RenderOptions options;
  options.size = ImageSize{96, 72};
  options.threads = 2;
  const auto [packets, reference] = renderBoth(builder.build(), options);
  for (const Image* image : {&packets.image, &reference.image}) {
    EXPECT_EQ(std::ranges::count_if(image->pixels, [](const Rgb& p) { return !(p.x > 0); }), 0)
        << "size " << view.size << ", center " << view.center.x << " " << view.center.y << " "
        << view.center.z << (image == &packets.image ? ", packets" : ", reference");
  }
}

TEST(TiltedPlanes, H2_lieInNoShadowOfTheirOwn) {
  for (const View& view : views({1e-3, 20, 100, 300, 1e3, 1e4, 1e6}, 1e5)) {
    // Vertices of a small plane far away are rounded to points that make it rough.
    if (view.center != Vec3d{} && view.size < 20) continue;
    expectLit(view, squares(view));
  }
}

TEST(TiltedPlanes, H11_norAsInstances) {
  for (const View& view : views({20, 1e3, 1e5}, 0)) {
    const Vec3d below = view.turn.vector({0, -10 * view.size, 0});
    expectLit(view, squares(view), {Affine::scaling(Vec3d(1.5)), Affine::translation(below)});
  }
}

// A needle is as long as a plane is large, and its normal is the least certain.
TEST(TiltedPlanes, H25_norAsNeedles) {
  for (const View& view : views({20, 1e3, 1e5}, 0)) {
    // Needles side by side make up a strip that is wider than the view.
    constexpr int kNeedles = 64;
    const double width = 12 * view.distance() / kNeedles;
    expectLit(view, sheetOf(2, kNeedles + 1, [&](int end, int i) {
                const double x = width * (i - kNeedles / 2.0), z = view.size * (end - 0.5);
                return Vec3f(view.turn.vector({x, 0, z}));
              }));
  }
}

}  // namespace
}  // namespace whit::test
