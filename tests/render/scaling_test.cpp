// H61: laws that need no oracle, because floating point keeps them exactly.
#include <gtest/gtest.h>

#include <cmath>

#include "render/shipped_scene.h"
#include "verify/scene_builder.h"

namespace whit::test {
namespace {

using namespace verify;

Vec3f scaled(const Vec3f& v, int k) {
  return {std::ldexp(v.x, k), std::ldexp(v.y, k), std::ldexp(v.z, k)};
}

// Multiplies lengths by 2^k and intensities by 4^k, so that irradiance stays the same.
void scale(SceneDescription& d, int k) {
  for (Object& object : d.objects) {
    for (Mesh& mesh : object.meshes) {
      for (Vec3f& p : mesh.positions) p = scaled(p, k);
      for (Affine& s : mesh.spheres) s = Affine::scaling(Vec3d(std::ldexp(1.0, k))) * s;
    }
  }

  for (Instance& instance : d.instances) instance.toWorld.p *= std::ldexp(1.0, k);
  for (Light& light : d.lights) {
    light.position = scaled(light.position, k);
    light.intensity = scaled(light.intensity, 2 * k);
    light.radius = std::ldexp(light.radius, k);
  }

  for (Camera& camera : d.cameras) {
    camera.eye = scaled(camera.eye, k);
    camera.at = scaled(camera.at, k);
  }

  // Absorption is a rate per length.
  for (Material& m : d.materials) m.absorption = scaled(m.absorption, -k);
  d.fog.density = scaled(d.fog.density, -k);
}

class Scaling : public testing::TestWithParam<std::string> {};

TEST_P(Scaling, H61a_aPowerOfTwoLeavesEveryBit) {
  const SceneDescription loaded = described(GetParam());
  const Scene original = repaired(loaded);
  const Image expected = render(original, smallOptions()).image;

  for (const int k : {-20, -7, 1, 20}) {
    SceneDescription d = loaded;
    scale(d, k);
    const Scene scene = repaired(std::move(d));
    EXPECT_EQ(firstDifference(render(scene, smallOptions()).image, expected), "")
        << GetParam() << " times 2^" << k;
  }
}

// Leaves are cut out of triangles before a floor and cast shadows on it.
SceneDescription masked() {
  SceneBuilder builder;
  Material leaf = diffuseMaterial(0.5f);
  leaf.alphaCutoff = 0.5f;

  std::vector<std::uint32_t> texels;
  for (int i = 0; i < 64; ++i) texels.push_back(encodeDataTexel(i % 5 == 0 ? 0.0f : 1.0f, 0, 0, 1));
  leaf.alphaMap = builder.add(makeTexture(TexelFormat::data, 8, 8, std::move(texels)));
  const std::uint32_t leaves = builder.add(leaf);

  for (int i = 0; i < 400; ++i) {
    const float x = 0.01f * static_cast<float>(i % 20), y = 0.01f * static_cast<float>(i / 20);
    builder.add(
        quad({x, y, 0}, {x + 0.01f, y, 0}, {x + 0.01f, y + 0.01f, 0}, {x, y + 0.01f, 0}, leaves));
  }

  builder.add(floorAt(-0.01f, 1, builder.add(diffuseMaterial(0.5f))));
  builder.description.lights = {lightAt({0.3f, 0.5f, 0.4f}, 1)};
  builder.description.cameras = {{.eye = {0.1f, 0.2f, 0.3f}, .at = {0.1f, 0.08f, 0}}};
  return builder.describe();
}

TEST(ScalingOfMasks, H61a_aPowerOfTwoLeavesEveryBit) {
  const Image expected = render(repaired(masked()), smallOptions()).image;
  for (const int k : {-25, -20, -17, 20}) {
    SceneDescription d = masked();
    scale(d, k);
    const Scene scene = repaired(std::move(d));
    EXPECT_EQ(firstDifference(render(scene, smallOptions()).image, expected), "") << "2^" << k;
  }
}

TEST_P(Scaling, H56_lightsTimesAPowerOfTwoScaleTheImageExactly) {
  const SceneDescription loaded = described(GetParam());

  const auto lit = [&](int k) {
    SceneDescription d = loaded;
    // Sky and ambient do not scale with the lights.
    d.sky = Sky{};
    d.ambient = Ambient{};
    for (Material& m : d.materials) m.emission = Rgb(0.0f);
    for (Light& light : d.lights) light.intensity = scaled(light.intensity, k);
    return render(repaired(std::move(d)), smallOptions()).image;
  };

  Image expected = lit(0);
  for (const int k : {-60, 60}) {
    Image image = lit(k);
    for (Rgb& pixel : image.pixels) pixel = scaled(pixel, -k);
    EXPECT_EQ(firstDifference(image, expected), "") << "intensity times 2^" << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, Scaling, testing::ValuesIn(smallScenes()), [](const auto& info) {
  return info.param.substr(0, info.param.find('?'));
});

}  // namespace
}  // namespace whit::test
