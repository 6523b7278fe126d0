// Random scenes that mix all effects. Light is linear in them, and the mean radiance of blocks of
// pixels is compared between whit and the oracle. Both sides are random, so a difference is
// measured in its standard errors, which follow from how the differences of single pixels spread.
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

class Mixed : public Agreement {
 protected:
  Material sheet() {
    Material material = painted();
    material.coverage = between(0.2, 0.95);
    if (chance(0.5)) material.coverageMap = addMask();
    material.castsShadow = material.coverage >= 0.5;
    return material;
  }

  Material cutOut() {
    Material material = painted();
    material.alphaMap = addMask();
    return material;
  }

  Material glassy() {
    Material material = glass(between(1.2, 1.8));
    material.thin = chance(0.3);
    if (chance(0.3)) material.specular = color(0.05, 0.3);
    return material;
  }

  Material polished() {
    Material material = mirror();
    if (chance(0.4)) material.specular = color(0.05, 0.4);
    return material;
  }

  Material shining() {
    Material material = matte();
    material.emission = color(0.2, 2);
    return material;
  }

  // Roughness is high, because few samples would see a narrow highlight.
  Material anyMaterial() {
    using Kind = Material (Mixed::*)();
    const Kind kind = oneOf<Kind>({&Mixed::matte, &Mixed::glossy, &Mixed::painted, &Mixed::polished,
                                   &Mixed::glassy, &Mixed::sheet, &Mixed::cutOut, &Mixed::shining});

    Material material = (this->*kind)();
    material.roughness = between(0.4, 0.9);
    if (chance(0.3)) material.glossyReflection = oneOf({Choice::no, Choice::yes});
    material.diffuseReflection = chance(0.8);
    material.frosted = material.transmits() && chance(0.3);
    return material;
  }

  // Returns an exact sphere, which transforms make an ellipsoid, a quad or a solid of triangles.
  int anyObject() {
    const Material material = anyMaterial();
    const int kind = below(5);
    if (kind < 2) return addSphere(between(0.4, 0.6), material);
    return addObject(kind == 2 ? pane() : kind == 3 ? tetrahedron() : box(), material);
  }

  Motion anyMotion(double reach, double turn) {
    Motion motion;
    motion.axis = inBox({-1, 0.3, -1}, {1, 1, 1});
    motion.inSteps = chance(0.2);
    for (int i = 0; i < 3; ++i) {
      Motion::Key& key = motion.keys.emplace_back();
      key.time = i * 0.75;
      key.degrees = between(-turn, turn);
      key.translate = inBox(gray(-reach), gray(reach));
    }
    return motion;
  }

  void addBodies() {
    const int objects[] = {anyObject(), anyObject(), anyObject(), anyObject()};

    const int bodies = 5 + below(4);
    for (int i = 0; i < bodies; ++i) {
      Transform transform = standing(i % 5, 5);
      if (i >= 5) transform.translate += {0, 0.6, -1.4};
      transform.translate = asFloat(transform.translate);
      if (chance(0.4)) transform.scale = asFloat(transform.scale * gray(1.4));
      if (chance(0.3)) transform.scale.x = asFloat(-0.7 * transform.scale.x);

      place(objects[i % 4], transform);
      if (chance(0.25)) scene.bodies.back().motion = anyMotion(0.2, 60);
    }
  }

  void addLights() {
    const int lights = 1 + below(3);
    for (int i = 0; i < lights; ++i) {
      const int kind = below(4);
      if (kind == 3) addSun(0.5, 2);
      Light& light = kind == 3 ? scene.lights.back() : addLamp();
      light.radius = between(0.05, 1.2);
      if (kind == 2) makeSpot(light);
      if (chance(0.25)) light.motion = anyMotion(0.3, 10);
    }
  }

  void setSky() {
    if (chance(0.2)) {
      skyImage(20, 255);
    } else if (chance(0.5)) {
      scene.ambient.fromSky = between(0.2, 0.8);
    }
    scene.sky.scale = between(0.2, 1.2);
    if (chance(0.6)) scene.ambient.occlusion = between(0.3, 3);
  }

  void setCamera() {
    Camera& camera = scene.camera;
    camera.fov = between(25, 42);
    if (chance(0.15)) camera.orthographicHeight = between(2.5, 4);
    if (chance(0.6)) camera.aperture = between(0.05, 0.4);
    if (chance(0.5)) camera.focus = between(3, 8);
    if (chance(0.15)) camera.motion = anyMotion(0.2, 3);
  }

  void mixedScene() {
    room();
    scene.width = kWidth;
    scene.height = kHeight;
    scene.time = between(-0.2, 1.7);

    setSky();
    setCamera();
    addBodies();

    // The scene is closed and shows no sky.
    if (chance(0.25)) place(addSphere(12, anyMaterial()), placement({0, 1, 0}, 1));

    floor(anyMaterial(), 0.05);
    addLights();
  }

  // Gives the material parts of every kind, with a coat or without, whatever kind it is of.
  void mixParts(Material& material) {
    if (chance(0.3)) material.specular = color(0, 1);
    if (chance(0.3)) material.mirror = material.mirrorGrazing = color(0, 0.4);
    if (chance(0.3)) material.mirrorGrazing = color(0, 1);
    if (chance(0.2)) material.transmission = color(0, 1);
    if (chance(0.2)) material.emission = color(0, 1);

    material.roughness = between(0, 1);
    material.glossyReflection = oneOf({Choice::no, Choice::yes, Choice::yes});
    material.coat = chance(0.3);
    material.thin = chance(0.3);
    material.frosted = chance(0.5);
  }

  // Puts out one of two halves of what shines, or nothing. What is out stays in its list, because
  // the number of a light decides on its random points.
  void putOut(int half) {
    const auto isOut = [&] { return below(2) == half; };
    for (Light& light : scene.lights) {
      if (isOut()) light.intensity = {};
    }
    for (Material& material : scene.materials) {
      if (isOut()) material.emission = {};
    }
    if (isOut()) scene.sky.scale = 0;
    if (isOut()) scene.ambient.up = scene.ambient.down = {};
  }

  Options mixedOptions() {
    Options options;
    options.depth = 1 + below(4);
    options.glossy = below(4);
    options.indirect = oneOf({0, 0, 1, 2});
    options.lightSamples = oneOf({1, 2, 4});
    options.ambientSamples = oneOf({0, 1, 3});
    options.roulette = oneOf({0.0, 0.0, 0.3});
    options.filter = chance(0.3) ? Filter::nearest : Filter::bilinear;
    options.schlickFresnel = chance(0.25);
    options.spp = kSpp * numberOf("WHIT_ORACLE_SAMPLES", 1);
    return options;
  }
};

bool moves(const Scene& scene) {
  const auto isMoved = [](const auto& thing) { return !thing.motion.keys.empty(); };
  return std::ranges::any_of(scene.bodies, isMoved) || std::ranges::any_of(scene.lights, isMoved) ||
         isMoved(scene.camera);
}

// The time at which a scene is rendered, if anything in it moves.
std::optional<double> timeOf(const Scene& scene) {
  if (moves(scene)) return scene.time;
  return {};
}

// Names the groups in which a scene is counted.
std::vector<std::string> effectsOf(const Scene& scene, const Options& options) {
  const bool occluded = scene.ambient.occlusion > 0 && options.ambientSamples > 0;
  const bool isDirect = options.indirect == 0;
  const auto isSpot = [](const Light& light) { return light.kind == Light::Kind::spot; };
  const std::pair<const char*, bool> all[] = {
      {"all scenes", true},
      {"indirect light", !isDirect},
      {"ambient occlusion", isDirect && occluded},
      {"plain ambient light", isDirect && !occluded},
      {"soft lights", options.lightSamples > 1},
      {"sampled lobes", options.glossy > 0},
      {"indirect light and sampled lobes", !isDirect && options.glossy > 0},
      {"roulette", options.roulette > 0},
      {"lens", scene.camera.aperture > 0},
      {"parallel rays", scene.camera.orthographicHeight > 0},
      {"motion", moves(scene)},
      {"spot lights", std::ranges::any_of(scene.lights, isSpot)}};

  std::vector<std::string> effects;
  for (const auto& [name, has] : all) {
    if (has) effects.emplace_back(name);
  }
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
           const std::string& file) {
    const whit::api::Image image = render(options, file, mode_, timeOf(scene));
    std::array<Paired, kWidth / kBlock*(kHeight / kBlock)> blocks;
    Paired picture;
    std::array<Paired, 2> halves;  // every other pixel
    double mean = 0;

    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const Color got = colorOf(image, i), off = got - wanted[i];
      const std::size_t x = i % kWidth, y = i / kWidth;
      blocks[y / kBlock * (kWidth / kBlock) + x / kBlock].add(off);
      picture.add(off);
      halves[(x + y) % 2].add(off);
      mean += dot(got + wanted[i], gray(1.0 / 6)) / double(wanted.size());
    }

    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const Color t = standardErrors(blocks[i].mean(), blocks[i].variance(), kRounding * mean);
      const double most = largest(magnitudes(t));
      EXPECT_LE(most, kLargestOfBlocks)
          << "standard errors: block " << i << " of " << mode_ << " of " << file;
      largest_ = std::max(largest_, most);
      for (const double channel : {t.x, t.y, t.z}) {
        ++numbers_;
        squares_ += channel * channel;
        many_ += std::abs(channel) > kManyErrors;
      }
    }

    const Color t = standardErrors(picture.mean(), picture.variance(), kRounding * mean);
    EXPECT_LE(largest(magnitudes(t)), kLargestOfPictures)
        << "standard errors: the picture of " << mode_ << " of " << file;
    largestOfPictures_ = std::max(largestOfPictures_, largest(magnitudes(t)));
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
      EXPECT_LE(largest(magnitudes(t)), kLargestOfEffects)
          << "standard errors: scenes of " << mode_ << " with " << name;

      const Color off = all.off * (100 / all.weights);
      const double error = 100 * std::sqrt(largest(all.variance)) / all.weights;
      std::printf("  %s: %d scenes, %+.3f %+.3f %+.3f %% off, standard error %.3f %%, t %.2f\n",
                  name.c_str(), all.scenes, off.x, off.y, off.z, error, largest(magnitudes(t)));
    }
  }

 private:
  std::string mode_;
  int numbers_ = 0, many_ = 0;
  double squares_ = 0, largest_ = 0, largestOfPictures_ = 0;
  std::map<std::string, Together> effects_;
};

// The options are of all kinds but those that look at the brightness of the picture: --adaptive,
// and --light-cutoff, by which a light may be too dark to count.
TEST_F(Mixed, LightIsLinear) {
  // Sanitizers look for faults of memory, which few scenes show as well as many.
  const int scenes = whit::kSanitized ? 40 : 200;
  for (int i = 0; i < scenes; ++i) {
    const std::string mode = i % kScenesPerReference == 0 ? "reference" : "packets";
    std::vector<whit::api::Image> images;
    for (const int half : {0, 1, kNone}) {
      const std::string file = writeNew(7000 + i, [&] {
        mixedScene();
        for (Material& material : scene.materials) mixParts(material);
        putOut(half);
        scene.width = 12;
        scene.height = 8;
      });

      Options options = mixedOptions();
      options.spp = oneOf({1, 2, 4});
      options.cutoff = oneOf({0.0, 1e-3});
      options.terminator = chance(0.5);
      options.blurredSky = chance(0.5);
      images.push_back(render(options, file, mode, timeOf(scene)));
    }

    double brightest = 0, worst = 0;
    for (std::size_t k = 0; k < images[0].rgb().size() / 3; ++k) {
      const Color both = colorOf(images[2], k);
      const double off = differenceOf(colorOf(images[0], k) + colorOf(images[1], k), both);
      brightest = std::max(brightest, largest(both));
      worst = std::max(worst, off / (0.1 + largest(both)));
    }

    // Roundings of the sums of a path.
    EXPECT_LT(worst, 1e-5) << "scene " << i << " by " << mode;
    EXPECT_GT(brightest, 0) << i;
  }
}

TEST_F(Mixed, MeansOfAllEffectsTogether) {
  const int scenes = numberOf("WHIT_ORACLE_SCENES", whit::kSanitized ? 20 : kScenes);
  const int drawn = kDrawn * numberOf("WHIT_ORACLE_SAMPLES", 1);
  Comparison packets("packets"), reference("reference");
  for (int i = 0; i < scenes; ++i) {
    const std::string file = writeNew(5000 + i, [&] { mixedScene(); });
    const Options options = mixedOptions();

    // The mean of what the oracle draws for each pixel.
    const std::unique_ptr<Tracer> tracer = makeTracer(scene, options);
    Random random(90000 + i);
    std::vector<Color> wanted;
    forEachPixel(kWidth, kHeight, [&](int x, int y) {
      Color sum;
      for (int k = 0; k < drawn; ++k) sum += tracer->sample(x, y, random);
      wanted.push_back(sum / drawn);
    });

    for (Comparison* comparison : {&packets, &reference}) {
      if (comparison == &reference && i % kScenesPerReference != 0) continue;
      comparison->add(scene, options, wanted, file);
    }
  }

  packets.conclude();
  reference.conclude();
}

}  // namespace
}  // namespace oracle
