// H61: laws that need no oracle, because floating point keeps them exactly.
#include <gtest/gtest.h>

#include "render/data_map.h"
#include "render/scaled_scene.h"

namespace whit::test {
namespace {

using namespace verify;

class Scaling : public testing::TestWithParam<std::string> {};

TEST_P(Scaling, H61a_aPowerOfTwoLeavesEveryBit) {
  expectBitsAtAnyScale(described(GetParam()), {-20, -7, 1, 20});
}

// Leaves are cut out of triangles before a floor and cast shadows on it.
SceneDescription masked() {
  SceneBuilder builder;
  Material leaf = diffuseMaterial(0.5f);
  leaf.alphaCutoff = 0.5f;

  std::vector<float> holes;
  for (int i = 0; i < 64; ++i) holes.push_back(i % 5 == 0 ? 0.0f : 1.0f);
  leaf.alphaMap = builder.add(dataMap(8, holes));
  const std::uint32_t leaves = builder.add(leaf);

  for (int i = 0; i < 400; ++i) {
    const float x = 0.01f * static_cast<float>(i % 20), y = 0.01f * static_cast<float>(i / 20);
    builder.add(
        quad({x, y, 0}, {x + 0.01f, y, 0}, {x + 0.01f, y + 0.01f, 0}, {x, y + 0.01f, 0}, leaves));
  }

  builder.add(floorAt(-0.01f, 1), diffuseMaterial(0.5f));
  builder.description.lights = {lightAt({0.3f, 0.5f, 0.4f}, 1)};
  builder.lookFrom({0.1f, 0.2f, 0.3f}, {0.1f, 0.08f, 0});
  return builder.describe();
}

TEST(ScalingOfMasks, H61a_aPowerOfTwoLeavesEveryBit) {
  expectBitsAtAnyScale(masked(), {-25, -20, -17, 20});
}

TEST_P(Scaling, H56_lightsTimesAPowerOfTwoScaleTheImageExactly) {
  const auto lit = [](int k) {
    SceneDescription d = described(GetParam());
    // Sky and ambient do not scale with the lights.
    d.sky = Sky{};
    d.ambient = Ambient{};
    for (Material& m : d.materials) m.emission = Rgb(0.0f);
    for (Light& light : d.lights) light.intensity = scaled(light.intensity, k);
    return render(repaired(std::move(d)), smallOptions()).image;
  };

  const Image expected = lit(0);
  for (const int k : {-60, 60}) {
    Image image = lit(k);
    for (Rgb& pixel : image.pixels) pixel = scaled(pixel, -k);
    EXPECT_EQ(firstDifference(image, expected), "") << "intensity times 2^" << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, Scaling, testing::ValuesIn(smallScenes()), sceneName);

}  // namespace
}  // namespace whit::test
