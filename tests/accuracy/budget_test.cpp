// --budget and --target: what they read, choose and say. Times are never compared with a clock.
#include "inspect/budget.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/option_table.h"
#include "has_text.h"
#include "inspect/knobs.h"
#include "inspect/metrics.h"
#include "render/shipped_scene.h"
#include "unit/scene_builder.h"

namespace whit {
namespace {

using test::load;
using Values = std::vector<std::pair<std::string, std::string>>;

// The options with these values.
RenderOptions with(const Values& values, RenderOptions options = {}) {
  for (const auto& [name, value] : values) setOption(options, name, value);
  return options;
}

struct Chosen {
  Receipt receipt;
  Image image;
};

Chosen chooseFor(const Scene& scene, const Budget& budget, const std::set<std::string>& fixed = {},
                 RenderOptions options = {}) {
  options.size = ImageSize{64, 48};
  options.threads = 2;
  Renderer renderer(scene, options);
  Film film = makeFilm(scene, options);
  const Camera camera = chooseCamera(scene, options);

  Chosen chosen{chooseOptions(renderer, camera, fixed, budget, film), {}};
  renderer.render(camera, film);
  assess(chosen.receipt, renderer, camera, 1000, film);
  EXPECT_EQ(film.channels.channels(), options.channels);
  chosen.image = film.image;
  return chosen;
}

TEST(Budgets, AreRead) {
  for (const auto& [text, ms] : {std::pair{"50ms", 50}, {"1.5s", 1500}, {"2min", 120000}}) {
    EXPECT_EQ(parseBudget(text, "").ms, ms);
  }
  EXPECT_EQ(parseBudget("", "flip=0.01").error, 0.01);
  EXPECT_FALSE(parseBudget("", "flip=0.01").inCodes);
  EXPECT_EQ(parseBudget("", "0.5codes").error, 0.5);
  EXPECT_TRUE(parseBudget("", "0.5codes").inCodes);
  EXPECT_FALSE(parseBudget("", "").isSet());
}

TEST(Budgets, OfOtherWordsAreRefused) {
  const auto expectRefused = [](const char* time, const char* target, const char* said) {
    SCOPED_TRACE(std::string(time) + target);
    test::expectError(ExitStatus::usage, {said}, [&] { parseBudget(time, target); });
  };
  for (const char* time : {"50", "ms", "-1s", "0ms", "1h", "nans", "1e99s"}) {
    expectRefused(time, "", "--budget: expected a time of at least 1 ms");
  }
  for (const char* target : {"0.5", "flip", "flip=0", "flip=2", "-1codes", "codes"}) {
    expectRefused("", target, "--target: expected an error above 0");
  }
}

TEST(BestWithin, IsTheLeastErrorThatFits) {
  const std::vector<CostAndError> points{{5, 1}, {2, 3}, {1, 3}, {9, 0}, {1, std::nan("")}};
  EXPECT_EQ(bestWithin(points, 6), 0u);
  EXPECT_EQ(bestWithin(points, 4), 2u) << "the cheaper of equal errors";
  EXPECT_EQ(bestWithin(points, 9), 3u);
  EXPECT_EQ(bestWithin(points, 0.5), std::nullopt);
}

// The options that the receipt names are all that is needed for the same picture. A scene that
// states samples of its own has them named even where the choice takes none.
TEST(Budgets, ChooseOptionsThatMakeTheSamePicture) {
  for (const auto& [name, ms] :
       {std::pair{"whitted", 200.0}, {"cornell", 1.0}, {"cornell", 300.0}}) {
    SCOPED_TRACE(name);
    const Scene scene = load(name);
    RenderOptions same;
    applySceneOptions(scene.options, {}, same);
    const auto [receipt, image] = chooseFor(scene, {.ms = ms}, {}, same);

    same = with(receipt.chosen, same);
    same.size = receipt.options.size;
    same.threads = receipt.options.threads;
    EXPECT_EQ(same, receipt.options);
    EXPECT_EQ(test::render(scene, same).image.pixels, image.pixels);
    EXPECT_LE(receipt.low, receipt.error);
    EXPECT_GE(receipt.high, receipt.error);
  }
}

TEST(Budgets, KeepWhatIsGiven) {
  const Scene scene = load("mirrors");
  const RenderOptions options = with({{"spp", "3"}, {"depth", "5"}});
  const Receipt receipt = chooseFor(scene, {.ms = 100}, {"spp", "depth", "size"}, options).receipt;
  EXPECT_EQ(receipt.options.spp, 3);
  EXPECT_EQ(receipt.options.depth, 5);
  for (const auto& [name, value] : receipt.chosen) {
    EXPECT_NE(name, "spp");
    EXPECT_NE(name, "depth");
  }
}

TEST(Budgets, ThatAreTooSmallSaySo) {
  const Receipt receipt = chooseFor(load("cornell"), {.ms = 1}).receipt;
  EXPECT_TRUE(hasText(receipt.note, "too small"));
  EXPECT_EQ(receipt.options.spp, 1);
}

// Whatever was measured: which of these budgets are too small depends on the machine.
TEST(Budgets, ThatAreTooSmallTakeNoSamplesOfLights) {
  LoadOptions soft;
  soft.settings = {"/lights/0/radius=0.5"};
  const Scene scene = test::repaired(test::described("matte", soft));

  for (double ms = 1; ms <= 64; ms *= 1.5) {
    const Receipt receipt = chooseFor(scene, {.ms = ms}).receipt;
    if (!hasText(receipt.note, "too small")) continue;
    EXPECT_EQ(receipt.options.lightSamples, 1) << ms << " ms";
  }
}

// The true error lies within the interval that the receipt estimates from the picture's own
// samples. What takes time is given, so that the choice is the same on slow machines. Paths lose
// much light at their ends only if the given depth is small.
TEST(Budgets, TellTheErrorOfThePicture) {
  const Scene scene = load("cornell");
  RenderOptions options = with({{"spp", "16"}, {"ambient-samples", "1"}});
  const std::set<std::string> fixed{"spp", "depth", "ambient-samples"};
  const Chosen chosen = chooseFor(scene, {.ms = 300}, fixed, options);

  // A picture of many samples with exact options stands for the truth.
  RenderOptions many = chosen.receipt.options;
  many.spp = 1024;
  for (const auto& knob : chosen.receipt.approximate) setOption(many, knob.name, knob.exact);
  const double flip =
      compareImages(chosen.image, test::render(scene, many).image, 0, many.toneCurve).flipMean;
  EXPECT_GE(flip, chosen.receipt.low);
  EXPECT_LE(flip, chosen.receipt.high);

  const auto endedAt = [&](int depth) {
    options.depth = depth;
    return chooseFor(load("mirrors"), {.ms = 300}, fixed, options).receipt.ended.value();
  };
  EXPECT_GT(endedAt(0), 0.05);
  EXPECT_LT(endedAt(64), 0.01);
}

// Each pixel of the view of chooseFor() has a shining square that covers this share of it,
// somewhere in the pixel, before a sky of the radiance `behind`.
Scene lattice(double share, const Rgb& radiance, const Rgb& behind = {}) {
  Mesh squares;
  squares.materials = {0};

  std::mt19937 random;
  const double side = std::sqrt(share);
  std::uniform_real_distribution<double> place(0, 1 - side);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      // The square lies anywhere within its pixel.
      const double left = x - 32 + place(random), low = y - 24 + place(random);
      const auto first = size32(squares.positions);
      for (const Vec3f& corner : test::square().positions) {
        squares.positions.emplace_back(Vec3d{left + corner.x * side, low + corner.y * side, 0});
      }
      squares.triangles.push_back({first, first + 1, first + 2});
      squares.triangles.push_back({first, first + 2, first + 3});
    }
  }

  SceneDescription d = test::sceneOf(squares);
  d.materials[0].diffuse = Rgb(0.0f);
  d.materials[0].emission = radiance;
  d.sky.kind = Sky::Kind::color;
  d.sky.zenith = behind;

  d.cameras = {{.eye = {0, 0, 10}, .orthographicHeight = 48}};
  return test::finalized(d);
}

// The picture of 16 samples, whose error is told in codes.
Chosen ofSixteenSamples(const Scene& scene) {
  return chooseFor(scene, {.error = 1, .inCodes = true}, {"spp"}, with({{"spp", "16"}}));
}

// The root mean square of codes by which an image differs from one color.
double codesFrom(const Rgb& color, const Image& image) {
  Image even = image;
  even.pixels.assign(even.pixels.size(), color);
  return 255 * std::pow(10, -compareImages(image, even).psnrDb / 20);
}

// Red and green squares of equal brightness: the mean of red, green and blue has no noise.
TEST(Targets, CountTheNoiseOfEachColor) {
  const Rgb red{0.8f, 0.05f, 0.05f}, green{0.05f, 0.8f, 0.05f};
  const Chosen chosen = ofSixteenSamples(lattice(0.5, red, green));

  const double error = codesFrom((red + green) / 2.0f, chosen.image);
  EXPECT_GT(error, 1);
  EXPECT_LE(error, chosen.receipt.high) << receiptText(chosen.receipt, "");
}

// The error against the closed form lies below the receipt's bound, or the receipt has none. Where
// one sample in 256 hits a square, 16 samples that all miss say nothing about their pixel's error.
TEST(Targets, OfPixelsThatFewSamplesDecideAreNotKnown) {
  constexpr double kGray = 0.2;
  for (const double share : {0.5, 1.0 / 256}) {
    const Chosen chosen = ofSixteenSamples(lattice(share, Rgb(static_cast<float>(kGray / share))));
    const double error = codesFrom(Rgb(static_cast<float>(kGray)), chosen.image);

    const Receipt& receipt = chosen.receipt;
    EXPECT_EQ(std::isinf(receipt.high), share < 0.1) << receiptText(receipt, "");
    EXPECT_LE(error, receipt.high);

    EXPECT_EQ(hasText(receipt.note, "the error is not known"), share < 0.1) << receipt.note;
  }
}

// A single sample of random paths says nothing about its error.
TEST(Budgets, OfOneSampleOfPathsAreNotKnown) {
  const Receipt paths =
      chooseFor(load("cornell"), {.ms = 100}, {"spp"}, with({{"indirect", "1"}})).receipt;
  EXPECT_TRUE(std::isinf(paths.high));
  EXPECT_TRUE(hasText(receiptText(paths, ""), "not known"));

  const Receipt direct = chooseFor(load("matte"), {.ms = 100}, {"spp"}).receipt;
  EXPECT_FALSE(std::isinf(direct.high));
}

// The error of knobs that shorten random paths is measured with one sample a pixel, most of which
// are black.
TEST(Budgets, OfPathsThatKnobsCutAreNotKnown) {
  const Scene scene = load("cornell");
  const RenderOptions options =
      with({{"size", "32x32"}, {"spp", "400"}, {"indirect", "1"}, {"channels", "error"}});
  Renderer renderer(scene, options);
  Film film = makeFilm(scene, options);
  const Camera camera = chooseCamera(scene, options);
  renderer.render(camera, film);

  for (const double bias : {0.0, 0.4}) {
    Receipt receipt;
    receipt.options = options;
    receipt.bias = bias;
    receipt.error = receipt.high = 0.45;
    assess(receipt, renderer, camera, 1000, film);
    EXPECT_EQ(std::isinf(receipt.high), bias > 0) << receiptText(receipt, "");
  }
}

TEST(Budgets, AreKeptByTheSmallestPictures) {
  const Chosen chosen = chooseFor(load("cornell"), {.ms = 50}, {}, with({{"crop", "3,3,5,4"}}));
  EXPECT_EQ(chosen.image.pixels.size(), 2u);
}

TEST(Budgets, SayNothingOfTheEndsOfPathsWithAdaptiveSampling) {
  const Receipt receipt =
      chooseFor(load("whitted"), {.ms = 100}, {"adaptive"}, with({{"adaptive", "on"}})).receipt;
  EXPECT_FALSE(receipt.ended);
  EXPECT_FALSE(hasText(receiptText(receipt, ""), "left out at most"));
}

// Every pixel has a single color, so that one sample is as good as many.
TEST(Budgets, ThatBuyNothingEndEarly) {
  SceneDescription plain;
  plain.cameras.resize(1);
  const Receipt receipt = chooseFor(test::finalized(plain), {.ms = 2000}).receipt;
  EXPECT_EQ(receipt.options.spp, 1);
  EXPECT_TRUE(hasText(receipt.note, "done early"));
}

TEST(Targets, NeedMoreSamplesForLessError) {
  const Scene scene = load("matte");
  const Receipt coarse = chooseFor(scene, {.error = 0.05}).receipt;
  const Receipt fine = chooseFor(scene, {.error = 0.01}).receipt;
  EXPECT_LT(coarse.options.spp, fine.options.spp);
  EXPECT_LE(coarse.error, 0.05);
  EXPECT_LE(fine.error, 0.01);

  const Receipt codes = chooseFor(scene, {.error = 0.5, .inCodes = true}).receipt;
  EXPECT_LE(codes.error, 0.5);
}

TEST(Targets, OutOfReachSaySo) {
  const Receipt receipt = chooseFor(load("matte"), {.error = 1e-6}, {"spp"}).receipt;
  EXPECT_TRUE(hasText(receipt.note, "out of reach"));
}

TEST(Receipts, HaveTheCommandWithoutTheBudget) {
  Receipt receipt;
  receipt.budget.ms = 100;
  receipt.chosen = {{"spp", "4"}, {"depth", "8"}};
  receipt.approximate = {{"depth", "8", "64", 0.002}};
  receipt.probeMs = 10;
  receipt.measuredMs = 85;
  receipt.expectedMs = 80;
  receipt.error = 0.02;
  receipt.low = 0.015;
  receipt.high = 0.025;
  receipt.ended = 0.001;

  EXPECT_EQ(receiptText(receipt, " atrium"),
            "  chosen --spp 4 --depth 8\n"
            "  left out depth 64 (FLIP 0.0020)\n"
            "  time 95 ms: 10 to choose, 85 for the picture (expected 80), 95 % of the budget\n"
            "  error 0.0200 FLIP, between 0.0150 and 0.0250; --depth and --cutoff left out at most "
            "0.0010\n"
            "  the same picture: whit render --spp 4 --depth 8 atrium\n");

  receipt.high = kInfinity;
  EXPECT_TRUE(
      hasText(receiptText(receipt, ""), "error 0.0200 FLIP, by what the samples tell; not known"));
}

}  // namespace
}  // namespace whit
