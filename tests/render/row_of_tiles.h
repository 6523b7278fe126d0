// Surfaces of many kinds in one picture, and how nearly its pixels agree with those of the
// reference.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <initializer_list>
#include <string>
#include <utility>

#include "inspect/reference_frame.h"
#include "reference/small_scenes.h"
#include "render/data_map.h"
#include "render/pipeline_laws.h"
#include "render/plan.h"

namespace whit::test {

// Places six squares [0, 1]^2 of the floor y = 0 side by side, each as make(i) gives it, and the
// same squares again before them. They are seen from above, lit by a lamp and from all sides.
template <typename Make>
Scene rowOfTiles(SceneBuilder& builder, Make&& make) {
  Object tiles;
  for (int i = 0; i < 6; ++i) {
    Mesh mesh = make(i);
    for (Vec3f& p : mesh.positions)
      p.x += static_cast<float>(i) - 3.03f;  // no edge passes a column of pixel centers
    tiles.meshes.push_back(std::move(mesh));
  }

  builder.place(std::move(tiles), {Affine(), Affine::translation({0, 0, 1.5})});
  lightEvenly(builder, 0.25f);
  builder.description.lights = {lightAt({0.5f, 2, 0.5f}, 5)};
  Camera& camera = builder.lookFrom({0, 5, 1}, {0, 0, 0.25f});
  camera.up = {0, 0, -1};
  return builder.build();
}

// The square [0, 1]^2 of the floor y = 0. The first u runs along x and v along -z; the second u
// runs along -z and v along -x.
inline Mesh tile(std::uint32_t material) {
  Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}, material);
  mesh.secondUvs = {{0, 1}, {0, 0}, {1, 0}, {1, 1}};
  return mesh;
}

inline RenderOptions withSampledLobes(int samples = 2) {
  RenderOptions o = smallOptions();
  o.glossy = samples;
  return o;
}

// A map of four colors.
inline std::int32_t addColors(SceneBuilder& builder) {
  return builder.add(makeTexture(TexelFormat::color, 2, 2,
                                 {1023u, 700u << 10 | 300u, 341u | 341u << 10 | 341u << 20, 900u}));
}

// Another surface may be hit at edges, in 0.1 % of the picture.
inline constexpr std::size_t kPixelsAtEdges = 7;

inline void expectThePictureOfTheReference(const Scene& scene, const RenderOptions& o) {
  const auto [packets, reference] = renderBoth(scene, o);
  EXPECT_LE(pixelsApart(packets.image, reference.image, 1e-3f), kPixelsAtEdges);
}

// Compares the picture and each of its stages.
inline void expectTheReferenceOnEveryTarget(const Scene& scene, RenderOptions options) {
  expectStagesAgreeOnEveryTarget(scene, options);
  forEachTarget([&](const std::string& target) {
    options.simd = target;
    expectThePictureOfTheReference(scene, options);
  });
}

// Expects the reference with every filter of textures, and the same bits whatever the queues.
inline void expectTheLawsOfMaps(const Scene& scene, RenderOptions options = smallOptions()) {
  expectBitsWhateverTheQueues(scene, options);
  for (const TextureFilter filter :
       {TextureFilter::nearest, TextureFilter::bilinear, TextureFilter::trilinear}) {
    options.shading.textureFilter = filter;
    expectTheReferenceOnEveryTarget(scene, options);
  }
}

// Expects the step in the plan, but neither without any of the effects nor in `plain`.
inline void expectStep(const char* step, const Scene& scene, const RenderOptions& options,
                       std::initializer_list<Effect> effects, const Scene* plain = nullptr) {
  EXPECT_NE(makePlan(scene, options).find(step), nullptr) << step;
  for (const Effect effect : effects) {
    RenderOptions o = options;
    o.disable = {effect};
    EXPECT_EQ(makePlan(scene, o).find(step), nullptr) << step;
  }
  if (plain) {
    EXPECT_EQ(makePlan(*plain, options).find(step), nullptr) << step;
  }
}

// Expects the picture of the reference without each of the effects.
inline void expectTheReferenceWithout(const Scene& scene, std::initializer_list<Effect> effects) {
  for (const Effect effect : effects) {
    RenderOptions o = smallOptions();
    o.disable = {effect};
    SCOPED_TRACE(nameOf(effect));
    expectThePictureOfTheReference(scene, o);
  }
}

}  // namespace whit::test
