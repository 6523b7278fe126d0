// Distance does not change the mean: a plane of each kind of texture, seen at 1 to 32 texels a
// pixel with one sample a pixel, has the mean of an integral over the texture. The integral shares
// no code with the renderer.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "oracle/bilinear.h"
#include "pi.h"
#include "reference/small_scenes.h"
#include "render/shipped_scene.h"

namespace whit::test {
namespace {

constexpr int kTexelsAcross = 96;  // texels
constexpr int kPoints = 8;         // of the integral, a side of a texel
constexpr int kPixels = 120;

// Returns a texel in the test's own numbers, linear light or data, from 0 to 1.
using Pattern = std::function<oracle::Color(int x, int y)>;

std::int32_t add(SceneBuilder& builder, const Pattern& pattern, TexelFormat format) {
  std::vector<std::uint32_t> texels;
  for (int y = 0; y < kTexelsAcross; ++y) {
    for (int x = 0; x < kTexelsAcross; ++x) {
      const oracle::Color c = pattern(x, y);
      const Rgb value(Vec3d{c.x, c.y, c.z});
      texels.push_back(format == TexelFormat::data ? encodeDataTexel(value.x, value.y, value.z, 1)
                                                   : encodeColorTexel(value));
    }
  }
  return builder.add(makeTexture(format, kTexelsAcross, kTexelsAcross, std::move(texels)));
}

// The leaves have 12x32 texels and cover 21 % of the texture.
int leafAt(int x, int y) {
  constexpr int kCorners[][2] = {{3, 5}, {40, 12}, {70, 50}, {22, 60}, {55, 62}};
  for (int leaf = 0; leaf < 5; ++leaf) {
    const int right = x - kCorners[leaf][0], down = y - kCorners[leaf][1];
    if (right >= 0 && right < 12 && down >= 0 && down < 32) return leaf;
  }
  return -1;
}

oracle::Color opacity(int x, int y) { return oracle::gray(leafAt(x, y) >= 0 ? 1 : 0); }

// The leaves are opaque in the middle and thinner towards either side.
oracle::Color softOpacity(int x, int y) {
  if (leafAt(x, y) < 0) return oracle::gray(0);
  const bool inside = leafAt(x - 3, y) >= 0 && leafAt(x + 3, y) >= 0;
  return oracle::gray(inside ? 1 : 0.3);
}

Pattern leavesOn(oracle::Color clear) {
  return [=](int x, int y) {
    const int leaf = leafAt(x, y);
    return leaf < 0 ? clear : oracle::Color{0.1 * leaf, 0.3 + 0.1 * leaf, 0.1};
  };
}

// Returns a number from 0 to 1 that is independent of those of neighboring texels.
double noise(int x, int y, int channel) {
  const double s = std::sin(x * 12.9898 + y * 78.233 + channel * 37.719) * 43758.5453;
  return s - std::floor(s);
}

oracle::Color at(const Pattern& pattern, double x, double y) {
  return oracle::bilinear(x, y, [&](int i, int j) {
    return pattern(oracle::wrapped(i, kTexelsAcross), oracle::wrapped(j, kTexelsAcross));
  });
}

// A value at a point of the texture, in texels.
using Value = std::function<double(double x, double y)>;

// Returns the mean over the texture.
double integral(const Value& value) {
  double sum = 0;
  const double step = 1.0 / kPoints;
  for (int j = 0; j < kTexelsAcross * kPoints; ++j) {
    for (int i = 0; i < kTexelsAcross * kPoints; ++i)
      sum += value((i + 0.5) * step, (j + 0.5) * step);
  }
  return sum / std::pow(kTexelsAcross * kPoints, 2);
}

// Returns the mean green of a picture from above. The step from pixel to pixel and the period of
// the texture are incommensurable, so that all points of the texture are seen alike.
double meanSeen(Scene& scene, double texelsPerPixel, bool packets) {
  constexpr double kUneven = 1.0137;
  scene.cameras[0].orthographicHeight = static_cast<float>(texelsPerPixel * kUneven * kPixels);
  RenderOptions o = smallOptions({kPixels, kPixels});

  const Image image = render(scene, o, packets).image;
  double sum = 0;
  for (const Rgb& pixel : image.pixels) sum += double{pixel.y};
  return sum / static_cast<double>(image.pixels.size());
}

// The floor has one texel a unit and the material. It sends the mean of `value`.
void expectTheSameFromAfar(const std::string& what, SceneBuilder& builder, const Material& material,
                           double bound, const Value& value) {
  constexpr float kHalf = 40 * kTexelsAcross;
  Mesh floor = floorAt(0, kHalf, builder.add(material));
  for (Vec2f& uv : floor.uvs) uv = {uv.x * 80, uv.y * 80};
  builder.add(std::move(floor));
  builder.lookFrom({0.37f, 10, 0.21f}, {0.37f, 0, 0.21f}).up = {0.23f, 0, -1};
  Scene scene = builder.build();

  const double wanted = integral(value);
  for (const double texels : {1, 2, 4, 8, 16, 32}) {
    const double seen = meanSeen(scene, texels, true);
    EXPECT_NEAR(seen, wanted, bound * wanted) << what << " at " << texels << " texels a pixel";
    if (texels == 4 || texels == 32) {
      EXPECT_NEAR(meanSeen(scene, texels, false), wanted, bound * wanted)
          << what << ", reference, " << texels;
    }
  }
}

struct Leaves {
  SceneBuilder builder;
  Material material = emittingMaterial(1);

  Leaves(const Pattern& color, const Pattern& alpha) {
    material.emissionMap = add(builder, color, TexelFormat::color);
    material.alphaMap = add(builder, alpha, TexelFormat::data);
  }
};

// The integral samples the area of the leaves, and texels are rounded to codes.
constexpr double kSampled = 0.02;

// Full-size lookups mix leaves with the texels beside them, within half a texel of their edges.
// That is 4 % of the light of leaves 12 texels wide, and smaller levels have none of it.
constexpr double kEdges = 0.05;

TEST(Distance, ColorsKeepTheirMean) {
  SceneBuilder builder;
  Material m = emittingMaterial(1);
  const Pattern color = leavesOn({0, 0.02, 0});
  m.emissionMap = add(builder, color, TexelFormat::color);
  expectTheSameFromAfar("color", builder, m, kSampled,
                        [&](double x, double y) { return at(color, x, y).y; });
}

const oracle::Color kGreen{0, 0.5, 0}, kBlack;

TEST(Distance, MasksKeepTheirArea) {
  for (const oracle::Color& clear : {kGreen, kBlack}) {
    const Pattern color = leavesOn(clear);
    Leaves leaves(color, opacity);
    expectTheSameFromAfar("mask", leaves.builder, leaves.material, kEdges, [&](double x, double y) {
      return at(opacity, x, y).x >= 0.5 ? at(color, x, y).y : 0;
    });
  }
}

// The alpha covers as in glTF's BLEND and as the coverageMap of a scene file.
TEST(Distance, CoverageCountsOnce) {
  for (const auto& alpha : {opacity, softOpacity}) {
    for (const oracle::Color& clear : {kGreen, kBlack}) {
      const Pattern color = leavesOn(clear);
      Leaves leaves(color, alpha);
      leaves.material.coverageMap = leaves.material.alphaMap;
      leaves.material.passClearTexels();
      expectTheSameFromAfar(
          "blend", leaves.builder, leaves.material, kEdges,
          [&](double x, double y) { return at(alpha, x, y).x * at(color, x, y).y; });
    }
  }
}

// One map cuts and another one covers.
TEST(Distance, MasksAndCoverageTogether) {
  const Pattern color = leavesOn({}), covers = [](int x, int y) {
    return oracle::gray(x / 24 % 2 == 0 ? 0.8 : 0.2 + 0.1 * (y / 48));
  };
  Leaves leaves(color, opacity);
  leaves.material.coverageMap = add(leaves.builder, covers, TexelFormat::data);
  expectTheSameFromAfar("mask and coverage", leaves.builder, leaves.material, kEdges,
                        [&](double x, double y) {
                          if (at(opacity, x, y).x < 0.5) return 0.0;
                          return at(covers, x, y).x * at(color, x, y).y;
                        });
}

// One texture is on an opaque floor and, masked, in the same scene.
TEST(Distance, ATextureMayBeShownInSeveralWays) {
  const Pattern color = leavesOn({0, 0.9, 0});
  Leaves leaves(color, opacity);
  Material opaque = leaves.material;
  opaque.alphaMap = kNoTexture;
  // This material has no surface.
  leaves.builder.add(leaves.material);
  expectTheSameFromAfar("opaque beside a mask", leaves.builder, opaque, kSampled,
                        [&](double x, double y) { return at(color, x, y).y; });
}

oracle::Color bumps(int x, int y) {
  return {0.4 + 0.2 * noise(x, y, 0), 0.4 + 0.2 * noise(x, y, 1), 1};
}

const Light kSlantedSun = sun({-1, -1, -0.3f}, 1);
const oracle::Vec kTowardsSun = normalized(oracle::Vec{1, 1, 0.3});

// The mean of normals is shorter than one and is normalized again, so distant bumps are a little
// brighter: by 1 / length of the mean, 1.3 % for these bumps, which lean by up to 15 degrees.
TEST(Distance, NormalMapsKeepDiffuseLight) {
  SceneBuilder builder;
  builder.description.lights = {kSlantedSun};
  Material m = diffuseMaterial(1);
  m.normalMap = add(builder, bumps, TexelFormat::data);

  expectTheSameFromAfar("normals", builder, m, 0.02, [&](double x, double y) {
    const oracle::Color c = at(bumps, x, y);
    // u runs along x, v, which is the map's y, against z.
    const oracle::Vec n = normalized(oracle::Vec{2 * c.x - 1, 2 * c.z - 1, 1 - 2 * c.y});
    return std::max(0.0, dot(n, kTowardsSun)) / kPi;
  });
}

oracle::Color roughness(int x, int y) { return oracle::gray(0.5 + 0.5 * noise(x / 3, y / 3, 2)); }

// Returns the GGX lobe of reflectance 1 seen along its normal (Walter et al. 2007): D G1 G1 / 4,
// where F = 1.
double ggx(double alpha, double cosine) {
  const double half = std::cos(std::acos(cosine) / 2), square = alpha * alpha;
  const double d = square / (kPi * std::pow(half * half * (square - 1) + 1, 2));
  const double g = 2 * cosine / (cosine + std::sqrt(square + (1 - square) * cosine * cosine));
  return d * g / 4;
}

// A lobe is not linear in its roughness: the mean of lobes is not the lobe of the mean. Here the
// highlight of distant texels is 12 % brighter.
TEST(Distance, RoughnessKeepsTheHighlight) {
  SceneBuilder builder;
  builder.description.lights = {kSlantedSun};
  Material m = glossyMaterial(0, 1, 0.8f);
  m.roughnessMap = add(builder, roughness, TexelFormat::data);

  expectTheSameFromAfar("roughness", builder, m, 0.13, [&](double x, double y) {
    const double r = 0.8 * at(roughness, x, y).y;
    return ggx(r * r, kTowardsSun.y);
  });
}

}  // namespace
}  // namespace whit::test
