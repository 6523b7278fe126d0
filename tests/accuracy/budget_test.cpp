// --budget and --target: what they read, choose and say. Times are never compared with a clock.
#include "inspect/budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/error.h"
#include "core/option_table.h"
#include "has_text.h"
#include "inspect/knobs.h"
#include "inspect/metrics.h"
#include "io/load_scene.h"

namespace whit {
namespace {

Scene load(const std::string& name, const LoadOptions& options = {}) {
  Warnings warnings;
  return Scene::finalize(loadScene(name, options, warnings), warnings);
}

Image rendered(const Scene& scene, const RenderOptions& options) {
  Renderer renderer(scene, options);
  Film film = makeFilm(scene, options);
  renderer.render(chooseCamera(scene, options), film);
  return film.image;
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

RenderOptions withSamples(int spp) {
  RenderOptions options;
  options.spp = spp;
  return options;
}

std::string errorOf(const std::string& time, const std::string& target) {
  try {
    parseBudget(time, target);
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::usage);
    return error.what();
  }
  return "";
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
  for (const char* const time : {"50", "ms", "-1s", "0ms", "1h", "nans", "1e99s"}) {
    EXPECT_TRUE(hasText(errorOf(time, ""), "--budget: expected a time of at least 1 ms")) << time;
  }
  for (const char* const target : {"0.5", "flip", "flip=0", "flip=2", "-1codes", "codes"}) {
    EXPECT_TRUE(hasText(errorOf("", target), "--target: expected an error above 0")) << target;
  }
}

TEST(BestWithin, IsTheLeastErrorThatFits) {
  const std::vector<CostAndError> points{{5, 1}, {2, 3}, {1, 3}, {9, 0}, {1, std::nan("")}};
  EXPECT_EQ(bestWithin(points, 6), 0u);
  EXPECT_EQ(bestWithin(points, 4), 2u) << "the cheaper of equal errors";
  EXPECT_EQ(bestWithin(points, 9), 3u);
  EXPECT_EQ(bestWithin(points, 0.5), std::nullopt);
}

TEST(Budgets, ChooseOptionsThatMakeTheSamePicture) {
  const Scene scene = load("whitted");
  const Chosen chosen = chooseFor(scene, {.ms = 200});
  // The options that the receipt names are all that is needed for the same picture.
  RenderOptions same;
  same.size = ImageSize{64, 48};
  for (const auto& [name, value] : chosen.receipt.chosen) setOption(same, name, value);

  EXPECT_EQ(rendered(scene, same).pixels, chosen.image.pixels);
  EXPECT_LE(chosen.receipt.low, chosen.receipt.error);
  EXPECT_GE(chosen.receipt.high, chosen.receipt.error);
}

// The scene states samples of its own, which the choice has to name even where it takes none.
TEST(Budgets, NameWhatTheSceneStatesOtherwise) {
  const Scene scene = load("cornell");
  RenderOptions stated;
  applySceneOptions(scene.options, {}, stated);
  for (const double ms : {1.0, 300.0}) {
    const Receipt receipt = chooseFor(scene, {.ms = ms}, {}, stated).receipt;
    RenderOptions same = stated;
    for (const auto& [name, value] : receipt.chosen) setOption(same, name, value);
    same.size = receipt.options.size;
    same.threads = receipt.options.threads;
    EXPECT_EQ(same, receipt.options);
  }
}

TEST(Budgets, KeepWhatIsGiven) {
  const Scene scene = load("mirrors");
  RenderOptions options = withSamples(3);
  options.depth = 5;
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
  const Scene scene = load("matte", soft);

  for (double ms = 1; ms <= 64; ms *= 1.5) {
    const Receipt receipt = chooseFor(scene, {.ms = ms}).receipt;
    if (receipt.note.find("too small") == std::string::npos) continue;
    EXPECT_EQ(receipt.options.lightSamples, 1) << ms << " ms";
  }
}

// The true error lies within the interval that the receipt estimates from the picture's own
// samples. What takes time is given, so that the choice is the same on slow machines. Paths lose
// much light at their ends only if the given depth is small.
TEST(Budgets, TellTheErrorOfThePicture) {
  const Scene scene = load("cornell");
  RenderOptions options = withSamples(16);
  options.ambientSamples = 1;
  const std::set<std::string> fixed{"spp", "depth", "ambient-samples"};
  const Chosen chosen = chooseFor(scene, {.ms = 300}, fixed, options);

  // A picture of many samples with exact options stands for the truth.
  RenderOptions many = chosen.receipt.options;
  many.spp = 1024;
  for (const Receipt::Knob& knob : chosen.receipt.approximate) {
    setOption(many, knob.name, knob.exact);
  }
  const double flip =
      compareImages(chosen.image, rendered(scene, many), 0, many.toneCurve).flipMean;
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
  SceneDescription d;
  d.name = "lattice";
  d.materials.resize(1);
  d.materials[0].diffuse = Rgb(0.0f);
  d.materials[0].emission = radiance;
  d.sky.kind = Sky::Kind::color;
  d.sky.zenith = behind;

  Mesh squares;
  squares.materials = {0};

  std::mt19937 random;
  const double side = std::sqrt(share);
  std::uniform_real_distribution<double> place(0, 1 - side);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      // The square lies anywhere within its pixel.
      const double left = x - 32 + place(random), low = y - 24 + place(random);
      const auto first = static_cast<std::uint32_t>(squares.positions.size());
      for (const auto& [right, up] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        squares.positions.emplace_back(Vec3d{left + right * side, low + up * side, 0});
      }
      squares.triangles.push_back({first, first + 1, first + 2});
      squares.triangles.push_back({first, first + 2, first + 3});
    }
  }

  d.objects.push_back({"squares", {squares}});
  d.instances.push_back({0, Affine{}});

  d.cameras.resize(1);
  d.cameras[0].eye = {0, 0, 10};
  d.cameras[0].at = {0, 0, 0};
  d.cameras[0].orthographicHeight = 48;
  Warnings warnings;
  return Scene::finalize(std::move(d), warnings);
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
  const Chosen chosen =
      chooseFor(lattice(0.5, red, green), {.error = 1, .inCodes = true}, {"spp"}, withSamples(16));

  const double error = codesFrom((red + green) / 2.0f, chosen.image);
  EXPECT_GT(error, 1);
  EXPECT_LE(error, chosen.receipt.high) << receiptText(chosen.receipt, "");
}

// The error against the closed form lies below the receipt's bound, or the receipt has none. Where
// one sample in 256 hits a square, 16 samples that all miss say nothing about their pixel's error.
TEST(Targets, OfPixelsThatFewSamplesDecideAreNotKnown) {
  constexpr double kGray = 0.2;
  for (const double share : {0.5, 1.0 / 256}) {
    const Chosen chosen = chooseFor(lattice(share, Rgb(static_cast<float>(kGray / share))),
                                    {.error = 1, .inCodes = true}, {"spp"}, withSamples(16));
    const double error = codesFrom(Rgb(static_cast<float>(kGray)), chosen.image);

    const Receipt& receipt = chosen.receipt;
    EXPECT_EQ(std::isinf(receipt.high), share < 0.1) << receiptText(receipt, "");
    EXPECT_LE(error, receipt.high);

    const bool says = receipt.note.find("the error is not known") != std::string::npos;
    EXPECT_EQ(says, share < 0.1) << receipt.note;
  }
}

// A single sample of random paths says nothing about its error.
TEST(Budgets, OfOneSampleOfPathsAreNotKnown) {
  RenderOptions options;
  options.indirect = 1;
  const Receipt paths = chooseFor(load("cornell"), {.ms = 100}, {"spp"}, options).receipt;
  EXPECT_TRUE(std::isinf(paths.high));
  EXPECT_TRUE(hasText(receiptText(paths, ""), "not known"));

  options.indirect = 0;
  const Receipt direct = chooseFor(load("matte"), {.ms = 100}, {"spp"}, options).receipt;
  EXPECT_FALSE(std::isinf(direct.high));
}

// The error of knobs that shorten random paths is measured with one sample a pixel, most of which
// are black.
TEST(Budgets, OfPathsThatKnobsCutAreNotKnown) {
  const Scene scene = load("cornell");
  RenderOptions options = withSamples(400);
  options.size = ImageSize{32, 32};
  options.indirect = 1;
  options.channels = ChannelSet().with(Channel::error);

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
  RenderOptions options;
  options.crop = Crop{3, 3, 5, 4};
  EXPECT_EQ(chooseFor(load("cornell"), {.ms = 50}, {}, options).image.pixels.size(), 2u);
}

TEST(Budgets, SayNothingOfTheEndsOfPathsWithAdaptiveSampling) {
  RenderOptions options;
  options.adaptive = true;
  const Receipt receipt = chooseFor(load("whitted"), {.ms = 100}, {"adaptive"}, options).receipt;
  EXPECT_FALSE(receipt.ended);
  EXPECT_FALSE(hasText(receiptText(receipt, ""), "left out at most"));
}

// Every pixel has a single color, so that one sample is as good as many.
TEST(Budgets, ThatBuyNothingEndEarly) {
  SceneDescription d;
  d.name = "plain";
  d.cameras.resize(1);
  Warnings warnings;
  const Scene scene = Scene::finalize(std::move(d), warnings);

  const Receipt receipt = chooseFor(scene, {.ms = 2000}).receipt;
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

  EXPECT_EQ(receiptText(receipt, "whit render atrium"),
            "  chosen --spp 4 --depth 8\n"
            "  left out depth 64 (FLIP 0.0020)\n"
            "  time 95 ms: 10 to choose, 85 for the picture (expected 80), 95 % of the budget\n"
            "  error 0.0200 FLIP, between 0.0150 and 0.0250; --depth and --cutoff left out at most "
            "0.0010\n"
            "  the same picture: whit render atrium --spp 4 --depth 8\n");

  receipt.high = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(
      hasText(receiptText(receipt, ""), "error 0.0200 FLIP, by what the samples tell; not known"));
}

}  // namespace
}  // namespace whit
