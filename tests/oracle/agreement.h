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

struct Kind {
  std::string name;
  std::function<void(SceneMaker&)> make;
  Options options{};
  double rounding = 1;  // by how much more whit rounds than about the origin
};

// $WHIT_ORACLE_SCENES, if set, is how many scenes there are of each kind. Else sanitizers, which
// watch the code and not the numbers, have a few.
inline int scenesOfAKind(int usual) {
  const char* asked = std::getenv("WHIT_ORACLE_SCENES");
  if (asked != nullptr) return std::max(1, std::atoi(asked));
  return whit::kSanitized ? 2 : usual;
}

inline double differenceOf(const Color& a, const Color& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

// Of one scene in one mode.
struct Tally {
  int pixels = 0, leftOut = 0, wrong = 0;
  double worst = 0;  // of those that are not left out
  std::string firstWrong;
  std::map<const Face*, Sum> sums;  // by what the pixels show
  Sum sampled;                      // the pixels that have samples
};

class Agreement : public testing::Test {
 protected:
  Agreement() {
    std::string name = (std::filesystem::temp_directory_path() / "whit-oracle-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = name;
  }
  ~Agreement() override {
    if (!HasFailure()) std::filesystem::remove_all(folder_);
  }

  void expectAgreementWithEachFilter(const Kind& kind) {
    for (const auto& [filter, name] : {std::pair{Filter::bilinear, "bilinear"},
                                       {Filter::nearest, "nearest texels"},
                                       {Filter::trilinear, "trilinear"}}) {
      Kind filtered = kind;
      filtered.name += std::string(", ") + name;
      filtered.options.filter = filter;
      expectAgreement(filtered);
    }
  }

  void expectAgreement(const Kind& kind) {
    Tally reference, packets;
    const int scenes = scenesOfAKind(usualScenes_);
    for (int i = 0; i < scenes; ++i) {
      SceneMaker maker(static_cast<std::uint32_t>(1000 + i));
      kind.make(maker);
      const std::string folder = folder_ + "/" + std::to_string(i);
      std::filesystem::create_directory(folder);
      const std::string file = writeScene(maker.scene, folder);
      const Seen seen = look(maker.scene, kind.options);
      compare(kind, seen, file, "reference", kReferenceTolerance, reference);
      compare(kind, seen, file, "packets", kPacketTolerance, packets);
    }

    expectNoBias(reference.sampled, kind.name + ", reference");
    expectNoBias(packets.sampled, kind.name + ", packets");
    std::printf("%s: %d scenes, %d pixels; reference %.1e off, %d left out; packets %.1e, %d\n",
                kind.name.c_str(), scenes, packets.pixels, reference.worst, reference.leftOut,
                packets.worst, packets.leftOut);

    const auto describeSum = [](const char* mode, const Sum& sum) {
      if (sum.pixels() == 0) return;
      std::printf("  %d with samples, together: %s %.2f of what is allowed, which is %.1e\n",
                  sum.pixels(), mode, sum.worst(), sum.largestTolerance());
    };
    describeSum("reference", reference.sampled);
    describeSum("packets", packets.sampled);
  }

  std::string folder_;    // kept if the test fails
  int usualScenes_ = 10;  // of each kind

  // A picture of whit's, by exactly these options.
  static whit::api::Image render(const Options& options, const std::string& file,
                                 const std::string& mode, std::optional<double> time = {}) {
    whit::api::LoadOptions load;
    load.moves = time.has_value();
    const whit::api::Scene scene = whit::api::loadScene(file, load);
    for (const std::string& warning : scene.warnings()) {
      EXPECT_EQ(warning.find("material whose parts exceed 1"), 0u) << warning;
    }
    whit::api::Renderer renderer(scene);

    // The blurred sky is no light transport but stands for it; its own tests have a closed form.
    renderer.set("mode", mode).set("cutoff", "0").set("threads", "2").set("disable", "blurredSky");
    renderer.set("spp", std::to_string(options.spp));
    renderer.set("depth", std::to_string(options.depth));
    renderer.set("glossy", std::to_string(options.glossy));
    renderer.set("indirect", std::to_string(options.indirect));
    renderer.set("roulette", std::to_string(options.roulette));
    renderer.set("light-samples", std::to_string(options.lightSamples));
    renderer.set("ambient-samples", std::to_string(options.ambientSamples));
    renderer.set("terminator", options.terminator ? "on" : "off");
    renderer.set("fresnel", options.schlickFresnel ? "schlick" : "exact");
    renderer.set("texture-filter", nameOf(options.filter));

    if (time) renderer.setTime(*time);
    return renderer.render();
  }

 private:
  static std::string nameOf(Filter filter) {
    if (filter == Filter::trilinear) return "trilinear";
    return filter == Filter::nearest ? "nearest" : "bilinear";
  }

  // What the oracle sees of a scene.
  struct Seen {
    Tracer tracer;
    const Scene& scene;
    std::vector<Sight> sights;  // of the pixels' centers
    double mean = 0, brightest = 0;
  };

  static Seen look(const Scene& scene, const Options& options) {
    Seen seen{Tracer(scene, options), scene, {}};
    for (int y = 0; y < scene.height; ++y) {
      for (int x = 0; x < scene.width; ++x) {
        seen.sights.push_back(seen.tracer.look(x + 0.5, y + 0.5));
        seen.mean += largest(seen.sights.back().radiance);
        seen.brightest = std::max(seen.brightest, seen.sights.back().brightest);
      }
    }

    seen.mean /= static_cast<double>(seen.sights.size());
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
          seen.tracer.look(x + 0.5 + beside * std::cos(angle), y + 0.5 + beside * std::sin(angle));
      if (isUndecided(seen, other, tolerance)) return true;
      if (differenceOf(other.radiance, center.radiance) > tolerance) return true;
    }
    return false;
  }

  static void compare(const Kind& kind, const Seen& seen, const std::string& file,
                      const std::string& mode, double tolerance, Tally& all) {
    const whit::api::Image image = render(kind.options, file, mode);
    const int width = seen.scene.width, height = seen.scene.height;
    ASSERT_EQ(image.rgb().size(), static_cast<std::size_t>(3 * width * height));

    Tally tally;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto i = static_cast<std::size_t>(y * width + x);
        const Color got{image.rgb()[3 * i], image.rgb()[3 * i + 1], image.rgb()[3 * i + 2]};
        const Sight& wanted = seen.sights[i];
        const double unit = seen.mean + largest(wanted.radiance);
        const double rounding = tolerance * kind.rounding * unit + kTableError * wanted.tabled;
        const double off = differenceOf(got, wanted.radiance);

        ++tally.pixels;
        if (off >
            rounding + chance(largest(wanted.variance), largestSample(wanted, seen.brightest))) {
          if (tally.wrong < kEnoughWrong &&
              decidedByAnEdge(seen, x, y, wanted, kBeside * kind.rounding, 0.5 * rounding)) {
            ++tally.leftOut;
            continue;
          }
          if (tally.wrong++ == 0) tally.firstWrong = describe(x, y, got, wanted.radiance);
        }
        tally.worst = std::max(tally.worst, off / unit);

        // Where the oracle cannot tell, the noise of a pixel may hide what adds up over a face.
        if (isUndecided(seen, wanted, 0.5 * rounding)) continue;
        tally.sums[seen.tracer.nearest(x + 0.5, y + 0.5)].add(got, wanted, rounding,
                                                              seen.brightest);
        if (largest(wanted.variance) > 0) all.sampled.add(got, wanted, rounding, seen.brightest);
      }
    }

    for (const auto& [face, sum] : tally.sums) expectNoBias(sum, mode + " of " + file);
    EXPECT_EQ(tally.wrong, 0) << "of " << tally.pixels << " pixels of " << mode << " of " << file
                              << ", the worst off by " << tally.worst << "; the first is "
                              << tally.firstWrong;
    EXPECT_LE(tally.leftOut, kLargestShareLeftOut * tally.pixels) << mode << " of " << file;

    all.pixels += tally.pixels;
    all.leftOut += tally.leftOut;
    all.worst = std::max(all.worst, tally.worst);
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
