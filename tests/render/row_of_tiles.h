// Surfaces of many kinds in one picture, and how nearly its pixels agree with those of the
// reference.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>

#include "reference/small_scenes.h"
#include "render/pipeline_laws.h"
#include "simd/kernels.h"

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
  builder.description.ambient = {Rgb(0.25f), Rgb(0.25f)};
  builder.description.lights = {lightAt({0.5f, 2, 0.5f}, 5)};
  Camera& camera = builder.lookFrom({0, 5, 1}, {0, 0, 0.25f});
  camera.up = {0, 0, -1};
  return builder.build();
}

// Another surface may be hit at edges, in 0.1 % of the picture.
inline constexpr std::size_t kPixelsAtEdges = 7;

inline void expectThePictureOfTheReference(const Scene& scene, const RenderOptions& o,
                                           const std::string& what) {
  Renderer renderer(scene, o);
  Film film = makeFilm(scene, o), reference = makeFilm(scene, o);
  renderer.render(chooseCamera(scene, o), film);
  renderer.renderReference(chooseCamera(scene, o), reference);

  std::size_t differences = 0;
  for (std::size_t i = 0; i < film.image.pixels.size(); ++i) {
    const Rgb apart = abs(film.image.pixels[i] - reference.image.pixels[i]);
    differences += !(maxComponent(apart) < 1e-3f);
  }

  EXPECT_LE(differences, kPixelsAtEdges) << what;
}

// Compares the picture and each of its stages. Leaves the default target chosen.
inline void expectTheReferenceOnEveryTarget(const Scene& scene, RenderOptions options) {
  expectStagesAgreeOnEveryTarget(scene, options);
  for (const std::string& target : simd::availableTargets()) {
    options.simd = target;
    expectThePictureOfTheReference(scene, options, target);
  }
  simd::chooseTarget("auto");
}

}  // namespace whit::test
