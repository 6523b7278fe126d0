// Debug views of scenes whose every pixel is known.
#include <gtest/gtest.h>

#include <cmath>

#include "core/display.h"
#include "inspect/metrics.h"
#include "render/debug_frame.h"
#include "shipped_scene.h"

namespace whit::test {
namespace {

using Code = std::array<int, 3>;

// A wall at z = 0 of the color (0.5, 0.25, 0.1) fills the view from z = 5; there is one light.
SceneDescription wall() {
  verify::SceneBuilder builder;
  Material material;
  material.diffuse = {0.5f, 0.25f, 0.1f};
  builder.add(verify::quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}, 0), material);
  builder.description.lights = {verify::lightAt({0, 0, 4}, 1)};
  builder.lookFrom({0, 0, 5});
  return builder.describe();
}

struct Viewed {
  DebugFrame frame;
  Film film;
  Code code(int x, int y) const {
    const std::size_t at = 4 * static_cast<std::size_t>(y * film.display.width + x);
    return {film.display.rgba[at], film.display.rgba[at + 1], film.display.rgba[at + 2]};
  }
};

Viewed view(const SceneDescription& description, DebugView what,
            const RenderOptions& options = smallOptions()) {
  const Scene scene = repaired(description);
  Renderer renderer(scene, options);
  Viewed viewed{{}, makeFilm(scene, options)};
  viewed.frame = renderDebugView(renderer, chooseCamera(scene, options), viewed.film, what);
  return viewed;
}

// Every pixel has the same code.
void expectAll(const Viewed& viewed, const Code& code) {
  forEachPixel(viewed.film.image,
               [&](int x, int y) { ASSERT_EQ(viewed.code(x, y), code) << x << ',' << y; });
}

TEST(DebugView, NormalsOfAWallFaceTheViewer) {
  expectAll(view(wall(), DebugView::normals), {128, 128, 255});  // (0 + 1) / 2, (1 + 1) / 2
}

TEST(DebugView, AlbedoIsTheMaterials) {
  expectAll(view(wall(), DebugView::albedo), {srgbCode(0.5), srgbCode(0.25), srgbCode(0.1)});
}

TEST(DebugView, DepthBeginsWhereTheWallIsNearest) {
  const Viewed viewed = view(wall(), DebugView::depth);
  EXPECT_EQ(viewed.frame.legend.substr(0, 17), "distance, from 5 ");
  EXPECT_GT(viewed.code(viewed.film.image.width / 2, viewed.film.image.height / 2)[0],
            viewed.code(0, 0)[0]);  // the middle is nearer

  // A camera that looks away from the wall sees nothing.
  SceneDescription away = wall();
  away.cameras[0].at = {0, 0, 10};
  expectAll(view(away, DebugView::depth), {0, 0, 0});
}

TEST(DebugView, CountsRays) {
  const auto legendOf = [](const SceneDescription& description, int spp = 1) {
    RenderOptions o = smallOptions();
    o.spp = spp;
    return view(description, DebugView::rays, o).frame.legend;
  };

  // Every pixel has a primary ray and a shadow ray.
  SceneDescription d = wall();
  EXPECT_EQ(legendOf(d), "rays a pixel and sample, from 2 to 2");
  d.lights.clear();
  EXPECT_EQ(legendOf(d), "rays a pixel and sample, from 1 to 1");

  // In the dark, the ray that a mirror reflects leaves the scene.
  d.materials[0].mirror = d.materials[0].mirrorGrazing = {1, 1, 1};
  EXPECT_EQ(legendOf(d, 4), "rays a pixel and sample, from 2 to 2");
}

TEST(DebugView, FullPacketsAreBright) {
  RenderOptions options = smallOptions();
  // In whole tiles no packet is partly filled.
  options.size = ImageSize{96, 64};
  expectAll(view(wall(), DebugView::occupancy, options), {255, 245, 170});

  options.size = ImageSize{1, 1};
  options.packet = 8;
  // One ray fills an eighth of its packet.
  const Code alone = view(wall(), DebugView::occupancy, options).code(0, 0);
  EXPECT_LT(alone[0] + alone[1] + alone[2], 128);
}

// The reference is given: it has other codes than the packets at three of the 15 pixels.
TEST(DebugView, DifferencesFromTheReferenceHaveAScale) {
  RenderOptions options = smallOptions({5, 3});
  const Scene scene = repaired(wall());
  Renderer renderer(scene, options);
  Film film = render(renderer);

  std::optional<Film> reference = film;
  const auto change = [&](std::size_t pixel, int codes) {
    std::uint8_t& green = reference->display.rgba[4 * pixel + 1];
    green = static_cast<std::uint8_t>(green < 128 ? green + codes : green - codes);
  };
  change(0, 1);
  change(1, 3);
  change(2, 41);
  reference->image.pixels[1].y += 0.25f;

  DebugPicture picture;
  watchReference(renderer, scene.cameras[0], film, DebugView::difference, reference, picture, {});
  EXPECT_EQ(picture.largest, 41);
  EXPECT_DOUBLE_EQ(picture.mean, 3);  // 45 / 15
  EXPECT_EQ(picture.legend(),
            "8-bit codes off the reference, from 0 to 16 (logarithmic); largest 41, mean 3");
  EXPECT_EQ(picture.textOf(1), "3 codes off the reference, 0.25 linear");

  const auto colorOf = [&](std::size_t pixel) {
    const std::uint8_t* const code = &film.display.rgba[4 * pixel];
    return std::array<std::uint8_t, 3>{code[0], code[1], code[2]};
  };
  EXPECT_EQ(colorOf(0), heatColor(std::log2(2.0) / std::log2(17.0)));
  EXPECT_EQ(colorOf(1), heatColor(std::log2(4.0) / std::log2(17.0)));
  EXPECT_EQ(colorOf(2), heatColor(1));
  EXPECT_EQ(colorOf(3), heatColor(0));
}

TEST(DebugView, ThePictureItselfIsAsEver) {
  const Picture picture = render(load("whitted"), smallOptions());
  for (const DebugView what : {DebugView::rays, DebugView::cost, DebugView::occupancy}) {
    const Viewed viewed = view(described("whitted"), what);
    EXPECT_EQ(firstDifference(viewed.film, picture), "");
    EXPECT_GT(viewed.frame.stats.frameMs, 0);
  }
}

}  // namespace
}  // namespace whit::test
