// Random scenes that mix all effects. The mean radiance of blocks of pixels is compared between
// whit and the oracle. Both sides are random, so a difference is measured in its standard errors,
// which follow from how the differences of single pixels spread.
//
// whit renders with --cutoff 0 and --light-cutoff 0, and the oracle ends its paths at the same
// --depth: with these settings both estimate the same number, with and without --roulette. Scenes
// have no vertex normals and no normal maps, because rays that these send below the surface are
// turned back by rules of whit's own.
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "oracle/agreement.h"
#include "oracle/paired.h"
#include "oracle/shapes.h"
#include "sanitized.h"

namespace oracle {
namespace {

constexpr int kScenes = 100;
// The scalar reference is slower, and it shares its random numbers with the packets: it renders
// every fourth scene.
constexpr int kScenesPerReference = 4;
constexpr int kWidth = 32, kHeight = 24, kBlock = 8;  // pixels
// Samples of a pixel by whit and by the oracle.
constexpr int kSpp = 16, kDrawn = 16;

// A block has 64 pixels, so its difference in standard errors follows Student's distribution of 63
// degrees of freedom. By this one of the 3,600 numbers (blocks and channels) exceeds 5.5 with a
// probability of 0.0025, each of them exceeds 3 with 0.39 %, and the mean of their squares is 63
// / 61. The last two may be five standard errors off, where the three channels count as one number.
constexpr double kLargestOfBlocks = 5.5, kManyErrors = 3, kShareOfMany = 0.0039;
constexpr double kMeanSquare = 63.0 / 61, kSpreadOfSquare = 1.6;
// The mean of a picture exceeds 5.2 with a probability of 2e-7, and that of all scenes with an
// effect exceeds 4.5 with 7e-6.
constexpr double kLargestOfPictures = 5.2, kLargestOfEffects = 4.5;
// Rounding may move a mean by this part of the picture's mean.
constexpr double kRounding = 1e-4;
// Variance of a scene's relative mean below which no scene gets a larger weight.
constexpr double kLeastSpread = 1e-6;

double numberOf(const char* variable, double preset) {
  const char* asked = std::getenv(variable);
  return asked == nullptr ? preset : std::max(1.0, std::atof(asked));
}

template <typename Value, std::size_t count>
Value oneOf(SceneMaker& maker, const std::array<Value, count>& values) {
  return values[static_cast<std::size_t>(maker.random.below(static_cast<int>(count)))];
}

Material sheet(SceneMaker& maker) {
  Material material = maker.painted();
  material.coverage = maker.random.between(0.2, 0.95);
  if (maker.random.chance(0.5)) {
    material.coverageMap = maker.addData(16, 8, {}, {255.99, 1, 1});
  }

  material.castsShadow = material.coverage >= 0.5;
  return material;
}

Material cutOut(SceneMaker& maker) {
  Material material = maker.painted();
  material.alphaMap = maker.addData(16, 8, {}, {255.99, 1, 1});
  return material;
}

Material glassy(SceneMaker& maker) {
  Material material = maker.glass(maker.random.between(1.2, 1.8));
  material.thin = maker.random.chance(0.3);
  if (maker.random.chance(0.3)) material.specular = maker.random.color(0.05, 0.3);
  return material;
}

Material coated(SceneMaker& maker) {
  Material material = maker.mirror();
  if (maker.random.chance(0.4)) material.specular = maker.random.color(0.05, 0.4);
  return material;
}

Material shining(SceneMaker& maker) {
  Material material = maker.matte();
  material.emission = maker.random.color(0.2, 2);
  return material;
}

// Roughness is high, because few samples would see a narrow highlight.
Material anyMaterial(SceneMaker& maker) {
  Material (*const kinds[])(SceneMaker&) = {[](SceneMaker& m) { return m.matte(); },
                                            [](SceneMaker& m) { return m.glossy(); },
                                            [](SceneMaker& m) { return m.painted(); },
                                            coated,
                                            glassy,
                                            sheet,
                                            cutOut,
                                            shining};

  Material material = kinds[maker.random.below(8)](maker);
  material.roughness = maker.random.between(0.4, 0.9);
  if (maker.random.chance(0.3)) {
    material.glossyReflection = maker.random.chance(0.5) ? Choice::yes : Choice::no;
  }

  material.diffuseReflection = maker.random.chance(0.8);
  material.frosted = material.transmits() && maker.random.chance(0.3);
  return material;
}

// Returns an exact sphere, which transforms make an ellipsoid, a quad or a solid of triangles.
int anyObject(SceneMaker& maker) {
  const Material material = anyMaterial(maker);
  switch (maker.random.below(5)) {
    case 0:
    case 1:
      return maker.addSphere(maker.random.between(0.4, 0.6), material);
    case 2:
      return maker.addObject(pane(), material);
    case 3:
      return maker.addObject(tetrahedron(), material);
    default:
      return maker.addObject(box(), material);
  }
}

Motion anyMotion(SceneMaker& maker, double reach, double turn) {
  Motion motion;
  motion.axis = maker.random.inBox({-1, 0.3, -1}, {1, 1, 1});
  motion.inSteps = maker.random.chance(0.2);

  for (int i = 0; i < 3; ++i) {
    Motion::Key key;
    key.time = i * 0.75;
    key.degrees = maker.random.between(-turn, turn);
    key.translate = maker.random.inBox(gray(-reach), gray(reach));
    motion.keys.push_back(key);
  }
  return motion;
}

void addBodies(SceneMaker& maker) {
  const int objects[] = {anyObject(maker), anyObject(maker), anyObject(maker), anyObject(maker)};

  const int bodies = 5 + maker.random.below(4);
  for (int i = 0; i < bodies; ++i) {
    Transform transform = maker.standing(i % 5, 5);
    if (i >= 5) transform.translate += {0, 0.6, -1.4};
    transform.translate = asFloat(transform.translate);
    if (maker.random.chance(0.4)) transform.scale = asFloat(transform.scale * gray(1.4));
    if (maker.random.chance(0.3)) transform.scale.x = asFloat(-0.7 * transform.scale.x);

    maker.place(objects[i % 4], transform);
    if (maker.random.chance(0.25)) maker.scene.bodies.back().motion = anyMotion(maker, 0.2, 60);
  }
}

void addLights(SceneMaker& maker) {
  const int lights = 1 + maker.random.below(3);
  for (int i = 0; i < lights; ++i) {
    Light light = maker.lamp();
    light.kind = oneOf(maker, std::array{Light::Kind::point, Light::Kind::point, Light::Kind::spot,
                                         Light::Kind::directional});
    light.intensity = maker.random.color(8, 25);
    light.radius = maker.random.between(0.05, 1.2);

    if (light.kind == Light::Kind::spot) {
      light.direction = asFloat(maker.random.inBox({-1, 0, -1}, {1, 1, 1}) - light.position);
      light.innerConeAngle = maker.random.between(0, 15);
      light.outerConeAngle = maker.random.between(20, 50);
    }

    if (light.kind == Light::Kind::directional) {
      light.direction = maker.random.inBox({-1, -2, -1}, {1, -0.5, 0.2});
      light.intensity = maker.random.color(0.5, 2);
    }

    if (maker.random.chance(0.25)) light.motion = anyMotion(maker, 0.3, 10);
    maker.scene.lights.push_back(light);
  }
}

void setSky(SceneMaker& maker) {
  Sky& sky = maker.scene.sky;
  sky.scale = maker.random.between(0.2, 1.2);
  if (maker.random.chance(0.2)) {
    sky.kind = Sky::Kind::image;
    sky.width = 7;
    sky.height = 4;
    sky.rotation = maker.random.between(-180, 360);
    for (int i = 0; i < sky.width * sky.height; ++i) {
      const Color c = maker.random.color(20, 255);
      sky.texels.push_back(Color{std::floor(c.x), std::floor(c.y), std::floor(c.z)} / 256);
    }
  } else if (maker.random.chance(0.5)) {
    maker.scene.ambient.fromSky = maker.random.between(0.2, 0.8);
  }

  if (maker.random.chance(0.6)) maker.scene.ambient.occlusion = maker.random.between(0.3, 3);
}

void setCamera(SceneMaker& maker) {
  Camera& camera = maker.scene.camera;
  camera.fov = maker.random.between(25, 42);
  if (maker.random.chance(0.15)) camera.orthographicHeight = maker.random.between(2.5, 4);
  if (maker.random.chance(0.6)) camera.aperture = maker.random.between(0.05, 0.4);
  if (maker.random.chance(0.5)) camera.focus = maker.random.between(3, 8);
  if (maker.random.chance(0.15)) camera.motion = anyMotion(maker, 0.2, 3);
}

void mixedScene(SceneMaker& maker) {
  maker.room();
  maker.scene.width = kWidth;
  maker.scene.height = kHeight;
  maker.scene.time = maker.random.between(-0.2, 1.7);

  setSky(maker);
  setCamera(maker);
  addBodies(maker);

  if (maker.random.chance(0.25)) {  // the scene is closed and shows no sky
    const int shell = maker.addSphere(12, anyMaterial(maker));
    maker.place(shell, maker.random.placement({0, 1, 0}, 1));
  }

  maker.floor(anyMaterial(maker));
  maker.scene.bodies.back().transform.translate.y = 0.05;
  addLights(maker);
}

Options mixedOptions(SceneMaker& maker) {
  Options options;
  options.depth = 1 + maker.random.below(4);
  options.glossy = oneOf(maker, std::array{0, 1, 2, 3});
  options.indirect = oneOf(maker, std::array{0, 0, 1, 2});
  options.lightSamples = oneOf(maker, std::array{1, 2, 4});
  options.ambientSamples = oneOf(maker, std::array{0, 1, 3});
  options.roulette = oneOf(maker, std::array{0.0, 0.0, 0.3});
  options.filter = maker.random.chance(0.3) ? Filter::nearest : Filter::bilinear;
  options.schlickFresnel = maker.random.chance(0.25);
  options.spp = kSpp * static_cast<int>(numberOf("WHIT_ORACLE_SAMPLES", 1));
  return options;
}

bool moves(const Scene& scene) {
  const auto any = [](const auto& things) {
    for (const auto& thing : things) {
      if (!thing.motion.keys.empty()) return true;
    }
    return false;
  };
  return any(scene.bodies) || any(scene.lights) || !scene.camera.motion.keys.empty();
}

// Names the groups in which a scene is counted.
std::vector<std::string> effectsOf(const Scene& scene, const Options& options) {
  std::vector<std::string> effects{"all scenes"};
  const auto add = [&](bool is, const char* name) {
    if (is) effects.emplace_back(name);
  };

  const bool occluded = scene.ambient.occlusion > 0 && options.ambientSamples > 0;
  add(options.indirect > 0, "indirect light");
  add(options.indirect == 0 && occluded, "ambient occlusion");
  add(options.indirect == 0 && !occluded, "plain ambient light");
  add(options.lightSamples > 1, "soft lights");
  add(options.glossy > 0, "sampled lobes");
  add(options.indirect > 0 && options.glossy > 0, "indirect light and sampled lobes");
  add(options.roulette > 0, "roulette");
  add(scene.camera.aperture > 0, "lens");
  add(scene.camera.orthographicHeight > 0, "parallel rays");
  add(moves(scene), "motion");
  add(std::any_of(scene.lights.begin(), scene.lights.end(),
                  [](const Light& light) { return light.kind == Light::Kind::spot; }),
      "spot lights");
  return effects;
}

// The weighted mean of the relative differences of several scenes. The weight of one half of a
// picture's pixels is the inverse of the variance of the other half: a weight from the same pixels
// would depend on the noise that it weighs, and the mean would be biased.
struct Together {
  void add(const std::array<Paired, 2>& halves, double mean) {
    ++scenes;
    for (std::size_t half = 0; half < halves.size(); ++half) {
      const double weight =
          1 / (largest(halves[1 - half].variance()) / (mean * mean) + kLeastSpread);
      weights += weight;
      off += halves[half].mean() * (weight / mean);
      variance += halves[half].variance() * (weight / mean * (weight / mean));
    }
  }

  int scenes = 0;
  double weights = 0;
  Color off, variance;
};

class Comparison {
 public:
  explicit Comparison(std::string mode) : mode_(std::move(mode)) {}

  void add(const Scene& scene, const Options& options, const std::vector<Color>& wanted,
           const whit::api::Image& image, const std::string& file) {
    std::array<Paired, kWidth / kBlock*(kHeight / kBlock)> blocks;
    Paired picture;
    std::array<Paired, 2> halves;  // every other pixel
    double mean = 0;

    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const Color got{image.rgb()[3 * i], image.rgb()[3 * i + 1], image.rgb()[3 * i + 2]};
      const std::size_t x = i % kWidth, y = i / kWidth;
      blocks[y / kBlock * (kWidth / kBlock) + x / kBlock].add(got - wanted[i]);
      picture.add(got - wanted[i]);
      halves[(x + y) % 2].add(got - wanted[i]);
      mean += dot(got + wanted[i], gray(1.0 / 6)) / static_cast<double>(wanted.size());
    }

    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const Color t = standardErrors(blocks[i].mean(), blocks[i].variance(), kRounding * mean);
      const double most = largestOf(t);
      EXPECT_LE(most, kLargestOfBlocks)
          << "standard errors: block " << i << " of " << mode_ << " of " << file;
      largest_ = std::max(largest_, most);
      for (const double channel : {t.x, t.y, t.z}) {
        ++numbers_;

        squares_ += channel * channel;
        if (std::abs(channel) > kManyErrors) ++many_;
      }
    }

    const Color t = standardErrors(picture.mean(), picture.variance(), kRounding * mean);
    EXPECT_LE(largestOf(t), kLargestOfPictures)
        << "standard errors: the picture of " << mode_ << " of " << file;
    largestOfPictures_ = std::max(largestOfPictures_, largestOf(t));
    for (const std::string& effect : effectsOf(scene, options)) {
      effects_[effect].add(halves, mean);
    }
  }

  void conclude() const {
    const double count = numbers_, alike = 3;  // channels
    const double most = kShareOfMany * count + 5 * std::sqrt(alike * kShareOfMany * count);
    EXPECT_LE(many_, most) << "blocks and channels of " << mode_ << " beyond " << kManyErrors
                           << " standard errors";

    const double spread = kSpreadOfSquare * std::sqrt(alike / count);
    EXPECT_NEAR(squares_ / count, kMeanSquare, 5 * spread) << "mean square of t of " << mode_;

    std::printf(
        "%s: %d blocks, the worst %.2f standard errors off (picture %.2f); %d of %d "
        "channels beyond %.0f (at most %.0f); mean square %.3f (%.3f +- %.3f)\n",
        mode_.c_str(), numbers_ / 3, largest_, largestOfPictures_, many_, numbers_, kManyErrors,
        most, squares_ / count, kMeanSquare, 5 * spread);

    for (const auto& [name, all] : effects_) {
      const Color t = standardErrors(all.off, all.variance, kRounding * all.weights);
      EXPECT_LE(largestOf(t), kLargestOfEffects)
          << "standard errors: scenes of " << mode_ << " with " << name;

      const Color off = all.off * (100 / all.weights);
      const double error = 100 * std::sqrt(largest(all.variance)) / all.weights;
      std::printf("  %s: %d scenes, %+.3f %+.3f %+.3f %% off, standard error %.3f %%, t %.2f\n",
                  name.c_str(), all.scenes, off.x, off.y, off.z, error, largestOf(t));
    }
  }

 private:
  std::string mode_;
  int numbers_ = 0, many_ = 0;
  double squares_ = 0, largest_ = 0, largestOfPictures_ = 0;
  std::map<std::string, Together> effects_;
};

class Mixed : public Agreement {};

TEST_F(Mixed, MeansOfAllEffectsTogether) {
  const int scenes =
      static_cast<int>(numberOf("WHIT_ORACLE_SCENES", whit::kSanitized ? 20 : kScenes));
  const int drawn = kDrawn * static_cast<int>(numberOf("WHIT_ORACLE_SAMPLES", 1));
  Comparison packets("packets"), reference("reference");
  for (int i = 0; i < scenes; ++i) {
    SceneMaker maker(static_cast<std::uint32_t>(5000 + i));
    mixedScene(maker);

    const Scene& scene = maker.scene;
    const Options options = mixedOptions(maker);
    const std::string folder = folder_ + "/" + std::to_string(i);
    std::filesystem::create_directory(folder);
    const std::string file = writeScene(scene, folder);

    // The mean of what the oracle draws for each pixel.
    const Tracer tracer(scene, options);
    Random random(static_cast<std::uint32_t>(90000 + i));
    std::vector<Color> wanted;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        Color sum;
        for (int k = 0; k < drawn; ++k) sum += tracer.sample(x, y, random);
        wanted.push_back(sum / drawn);
      }
    }

    const auto time = moves(scene) ? std::optional(scene.time) : std::nullopt;
    packets.add(scene, options, wanted, render(options, file, "packets", time), file);
    if (i % kScenesPerReference != 0) continue;
    reference.add(scene, options, wanted, render(options, file, "reference", time), file);
  }

  packets.conclude();
  reference.conclude();
}

}  // namespace
}  // namespace oracle
