// The oracle against whit, pixel by pixel, over some random scenes of a kind.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "library/whit.h"
#include "oracle/bilinear.h"
#include "oracle/chance.h"
#include "oracle/random_parts.h"
#include "oracle/tracer.h"
#include "oracle/write_scene.h"
#include "sanitized.h"

namespace oracle {

// Differences count in parts of the pixel's radiance plus the picture's mean: near black, a part of
// the pixel alone would ask for digits that no picture shows.
//
// The reference computes in double from the same floats; what it rounds is the picture, the corners
// of bodies that are moved, and the starts of rays, off their surface by some 1e-5 of the
// coordinates.
inline constexpr double kReferenceTolerance = 1e-4;
// Packets round each step to float, and curved glass and narrow highlights magnify that.
inline constexpr double kPacketTolerance = 1e-3;
// A pixel may differ where the oracle itself sees something else this far beside, in pixels: there
// an edge decides. It is far more than rounding moves a ray, and covers little of the picture.
inline constexpr double kBeside = 2e-3;
// Radiance that a branch of which the oracle cannot tell may bring, in means of the picture.
inline constexpr double kBrightest = 20;
// Pixels that may be left out so: edges are where they are in some of them only.
inline constexpr double kLargestShareLeftOut = 0.01;

// The greatest error of the table of albedos, as the page states it.
inline constexpr double kTableError = 0.005;

// Enough wrong pixels of a picture: the rest of them are not looked at more closely.
inline constexpr int kEnoughWrong = 30;

// Returns the whole number that the variable of the environment asks for, which is at least 1, or
// else the preset.
inline int numberOf(const char* variable, int preset) {
  const char* asked = std::getenv(variable);
  return asked == nullptr ? preset : std::max(1, std::atoi(asked));
}

// $WHIT_ORACLE_SCENES, if set, is how many scenes there are of each kind. Else sanitizers, which
// watch the code and not the numbers, have a few.
inline int scenesOfAKind(int usual) {
  return numberOf("WHIT_ORACLE_SCENES", whit::kSanitized ? 2 : usual);
}

inline double differenceOf(const Color& a, const Color& b) { return largest(magnitudes(a - b)); }

// The pixel of a picture of whit's.
inline Color colorOf(const whit::api::Image& image, std::size_t pixel) {
  const auto rgb = image.rgb().subspan(3 * pixel);
  return {rgb[0], rgb[1], rgb[2]};
}

inline const std::map<Filter, const char*> kFilters{
    {Filter::bilinear, "bilinear"}, {Filter::nearest, "nearest"}, {Filter::trilinear, "trilinear"}};

// A picture of whit's, by exactly these options.
inline whit::api::Image render(const Options& options, const std::string& file,
                               const std::string& mode, std::optional<double> time = {}) {
  whit::api::LoadOptions load;
  load.moves = time.has_value();
  const whit::api::Scene scene = whit::api::loadScene(file, load);
  for (const std::string& warning : scene.warnings()) {
    EXPECT_TRUE(warning.starts_with("material whose parts exceed 1") ||
                warning.starts_with("scene is black"))
        << warning;
  }
  whit::api::Renderer renderer(scene);

  // The blurred sky is no light transport but stands for it; its own tests have a closed form.
  if (!options.blurredSky) renderer.set("disable", "blurredSky");
  renderer.set("mode", mode).set("threads", "2");
  const std::pair<const char*, double> numbers[] = {{"spp", options.spp},
                                                    {"depth", options.depth},
                                                    {"glossy", options.glossy},
                                                    {"indirect", options.indirect},
                                                    {"roulette", options.roulette},
                                                    {"cutoff", options.cutoff},
                                                    {"light-samples", options.lightSamples},
                                                    {"ambient-samples", options.ambientSamples}};
  for (const auto& [name, value] : numbers) {
    char text[40];
    std::snprintf(text, sizeof(text), "%g", value);
    renderer.set(name, text);
  }
  renderer.set("terminator", options.terminator ? "on" : "off");
  renderer.set("fresnel", options.schlickFresnel ? "schlick" : "exact");
  renderer.set("texture-filter", kFilters.at(options.filter));

  if (time) renderer.setTime(*time);
  return renderer.render();
}

// What was compared in one mode.
struct Tally {
  std::string mode;
  double tolerance = 0;
  int pixels = 0, leftOut = 0;
  double worst = 0;  // of the pixels that are not left out
  Sum sampled{};     // the pixels that have samples
};

// The test's scene is filled by the members of SceneMaker.
class Agreement : public testing::Test, public SceneMaker {
 protected:
  Agreement() : SceneMaker(0) {
    std::string name = (std::filesystem::temp_directory_path() / "whit-oracle-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = name;
  }
  ~Agreement() override {
    if (!HasFailure()) std::filesystem::remove_all(folder_);
  }

  void expectAgreementWithEachFilter(const std::string& name, const std::function<void()>& make) {
    for (const auto& [filter, how] : kFilters) {
      expectAgreement(name + ", " + how, {.filter = filter}, make);
    }
  }

  void expectAgreement(const std::string& name, const std::function<void()>& make) {
    expectAgreement(name, {}, make);
  }
  void expectAgreement(const std::string& name, const Options& options,
                       const std::function<void()>& make, double rounding = 1) {
    Tally reference{"reference", kReferenceTolerance * rounding},
        packets{"packets", kPacketTolerance * rounding};
    const int scenes = scenesOfAKind(usualScenes_);
    for (int i = 0; i < scenes; ++i) {
      const std::string file = writeNew(1000 + i, make);
      const Seen seen = look(scene, options);
      for (Tally* tally : {&reference, &packets}) compare(seen, file, options, rounding, *tally);
    }

    std::printf("%s: %d scenes, %d pixels; reference %.1e off, %d left out; packets %.1e, %d\n",
                name.c_str(), scenes, packets.pixels, reference.worst, reference.leftOut,
                packets.worst, packets.leftOut);
    for (const Tally& tally : {reference, packets}) {
      const Sum& sum = tally.sampled;
      expectNoBias(sum, name + ", " + tally.mode);
      if (sum.pixels() == 0) continue;
      std::printf("  %d with samples, together: %s %.2f of what is allowed, which is %.1e\n",
                  sum.pixels(), tally.mode.c_str(), sum.worst(), sum.largestTolerance());
    }
  }

  // Makes the scene of this number, and returns its file.
  std::string writeNew(int number, const std::function<void()>& make) {
    static_cast<SceneMaker&>(*this) = SceneMaker(number);
    make();
    const std::string folder = folder_ + "/" + std::to_string(number);
    std::filesystem::create_directory(folder);
    return writeScene(scene, folder);
  }

  int usualScenes_ = 10;  // of each kind

 private:
  std::string folder_;  // kept if the test fails

  // What the oracle sees of a scene.
  struct Seen {
    std::unique_ptr<Tracer> tracer;
    const Scene& scene;
    std::vector<Sight> sights;  // of the pixels' centers
    double mean = 0, brightest = 0;
  };

  static Seen look(const Scene& scene, const Options& options) {
    Seen seen{makeTracer(scene, options), scene, {}};
    forEachPixel(scene.width, scene.height, [&](int x, int y) {
      const Sight& sight = seen.sights.emplace_back(seen.tracer->look(x + 0.5, y + 0.5));
      seen.mean += largest(sight.radiance);
      seen.brightest = std::max(seen.brightest, sight.brightest);
    });

    seen.mean /= double(seen.sights.size());
    return seen;
  }

  // Whether the oracle states no value, for example of a view along the surface.
  static bool isUndecided(const Seen& seen, const Sight& sight, double tolerance) {
    return sight.undecided * kBrightest * seen.mean > tolerance;
  }

  // Whether the oracle sees something else beside the pixel's center, or cannot tell.
  static bool decidedByAnEdge(const Seen& seen, int x, int y, const Sight& center, double beside,
                              double tolerance) {
    if (isUndecided(seen, center, tolerance)) return true;

    for (int i = 0; i < 8; ++i) {
      const double angle = (i + 0.5) * 0.785398163;
      const Sight other =
          seen.tracer->look(x + 0.5 + beside * std::cos(angle), y + 0.5 + beside * std::sin(angle));
      if (isUndecided(seen, other, tolerance)) return true;
      if (differenceOf(other.radiance, center.radiance) > tolerance) return true;
    }
    return false;
  }

  static void compare(const Seen& seen, const std::string& file, const Options& options,
                      double rounding, Tally& all) {
    const whit::api::Image image = render(options, file, all.mode);
    const int width = seen.scene.width, height = seen.scene.height;
    ASSERT_EQ(image.rgb().size(), 3 * seen.sights.size());

    const std::string what = all.mode + " of " + file;
    int leftOut = 0, wrong = 0;
    double worst = 0;
    std::string firstWrong;
    std::map<const Face*, Sum> sums;  // by what the pixels show

    forEachPixel(width, height, [&](int x, int y) {
      const std::size_t i = y * width + x;
      const Color got = colorOf(image, i);
      const Sight& wanted = seen.sights[i];
      const double unit = seen.mean + largest(wanted.radiance);
      const double allowed = all.tolerance * unit + kTableError * wanted.tabled;
      const double noise =
          oracle::chance(largest(wanted.variance), largestSample(wanted, seen.brightest));
      const double off = differenceOf(got, wanted.radiance);

      if (off > allowed + noise) {
        if (wrong < kEnoughWrong &&
            decidedByAnEdge(seen, x, y, wanted, kBeside * rounding, 0.5 * allowed)) {
          ++leftOut;
          return;
        }
        if (wrong++ == 0) firstWrong = describe(x, y, got, wanted.radiance);
      }
      worst = std::max(worst, off / unit);

      // Where the oracle cannot tell, the noise of a pixel may hide what adds up over a face.
      if (isUndecided(seen, wanted, 0.5 * allowed)) return;
      sums[seen.tracer->nearest(x + 0.5, y + 0.5)].add(got, wanted, allowed, seen.brightest);
      if (largest(wanted.variance) > 0) all.sampled.add(got, wanted, allowed, seen.brightest);
    });

    for (const auto& [face, sum] : sums) expectNoBias(sum, what);
    EXPECT_EQ(wrong, 0) << "pixels of " << what << ", the worst off by " << worst
                        << "; the first is " << firstWrong;
    EXPECT_LE(leftOut, kLargestShareLeftOut * width * height) << what;

    all.pixels += width * height;
    all.leftOut += leftOut;
    all.worst = std::max(all.worst, worst);
  }

  static void expectNoBias(const Sum& sum, const std::string& what) {
    EXPECT_LE(sum.worst(), 1) << "of what chance allows, pixels of " << what << " taken together";
  }

  static std::string describe(int x, int y, const Color& got, const Color& wanted) {
    char text[200];
    std::snprintf(text, sizeof(text), "%d,%d: %.6g %.6g %.6g, where the oracle has %.6g %.6g %.6g",
                  x, y, got.x, got.y, got.z, wanted.x, wanted.y, wanted.z);
    return text;
  }
};

}  // namespace oracle
