// Normal maps in the vector pipeline: against closed forms and the reference.
#include <gtest/gtest.h>

#include "inspect/reference_frame.h"
#include "pi.h"
#include "render/row_of_tiles.h"

namespace whit::test {
namespace {

// A light's direction is rounded to float, and a dozen operations are rounded.
constexpr double kShaded = 1e-6;

// The normal of the floor leans by 45 degrees along u, which runs along x over `u` units of texture
// space; v runs along -z over `v`. The floor is seen from above, in sunlight from +x and from
// above.
std::pair<Scene, double> floorAndRadiance(float u, float v) {
  SceneBuilder builder;
  Material m = diffuseMaterial(0.5f);
  const float lean = 0.5f + 0.5f * std::sqrt(0.5f);
  m.normalMap =
      builder.add(makeTexture(TexelFormat::data, 1, 1, {encodeDataTexel(lean, 0.5f, lean, 1)}));

  Mesh mesh = floorAt(0, 8, builder.add(m));
  for (Vec2f& uv : mesh.uvs) uv = {uv.x * u, uv.y * v};
  builder.add(std::move(mesh));
  builder.description.lights = {whit::test::sun({-1, -1, 0}, 2)};

  // The diagonal of the floor passes no pixel's center.
  builder.lookFrom({0.03f, 3, 0}, {0.03f, 0, 0}).up = {0, 0, -1};

  // The texel is rounded to eight bits, of which 128 does not decode to 0.
  const double x = std::round(lean * 255) / 127.5 - 1, y = 128 / 127.5 - 1;
  const double cosine = dot(normalized(Vec3d{x, x, -y}), normalized(Vec3d{1, 1, 0}));
  return {builder.build(), 0.5 / kPi * 2 * cosine};
}

// The directions of u and v count, but not the lengths of their spans: products of spans may vanish
// in a float, or overflow.
TEST(NormalMaps, ApplyWhateverTheSpanOfTheirCoordinates) {
  constexpr float kSpans[][2] = {{1, 1},      {1e-15f, 1e-15f}, {1e-20f, 1e-20f}, {1e-30f, 1e-30f},
                                 {1e-30f, 1}, {1, 1e-30f},      {1e-36f, 1e-30f}, {1e30f, 1e30f}};

  for (const auto& [u, v] : kSpans) {
    const auto [scene, wanted] = floorAndRadiance(u, v);
    const auto [packets, reference] = renderBoth(scene, smallOptions());
    for (const Image* image : {&packets.image, &reference.image}) {
      for (const Rgb& pixel : image->pixels) ASSERT_NEAR(pixel.x, wanted, kShaded) << u << " " << v;
    }
    expectStagesAgreeOnEveryTarget(scene, smallOptions());
  }
}

}  // namespace
}  // namespace whit::test
