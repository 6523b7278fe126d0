// --reciprocal: how far estimates of 1 / sqrt are off, stage by stage.
#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

#include "inspect/metrics.h"
#include "inspect/stage_comparison.h"
#include "render/shipped_scene.h"
#include "simd/kernels.h"

namespace whit::test {
namespace {

// Relative errors of 1 / sqrt, in units in the last place of 1 (2^-23). The estimate of x86-64 is
// good to 1.5 * 2^-12, that of AVX-512 (avx3) to 2^-14, and a step of Newton's method squares that
// and multiplies by 1.5; a unit of rounding for each of its products comes to that. Highway's
// estimate without SIMD is the integer trick with a step of its own, within 1.8e-3. NEON's is good
// to 2^-8 and gets two steps.
double boundInUlps(Reciprocal how, const std::string& target) {
  constexpr double kUlp = 0x1p-23;
  const bool scalar = target == "scalar", neon = target == "neon";
  const bool avx512 = target.starts_with("avx3") || target.starts_with("avx10");
  const double estimate = scalar ? 1.8e-3 : neon ? 0x1p-8 : avx512 ? 0x1p-14 : 1.5 * 0x1p-12;
  if (how == Reciprocal::approximate) return estimate / kUlp;
  const double step = 1.5 * estimate * estimate;
  return (neon ? 1.5 * step * step : step) / kUlp + 4;
}

RenderOptions withReciprocal(Reciprocal how, const std::string& target) {
  RenderOptions o = smallOptions();
  o.size = ImageSize{61, 37};
  o.simd = target;
  o.shading.reciprocal = how;
  return o;
}

const StageDifference& rowOf(const std::vector<StageDifference>& rows, Stage stage,
                             const std::string& column) {
  for (const StageDifference& row : rows) {
    if (row.stage == stage && row.column == column) return row;
  }
  throw std::runtime_error("no row of " + column);
}

class ReciprocalRoot : public testing::Test {
 protected:
  void TearDown() override { simd::chooseTarget("auto"); }
};

// How much nearer a step of Newton's method brings an estimate, at the least: it doubles the bits,
// and the best estimate has 14 of them.
constexpr double kStepGain = 100;

// Each stage against its twin on the same input: normals, and the directions of mirrored rays.
TEST_F(ReciprocalRoot, H53_errorsStayWithinTheBoundOnEveryTarget) {
  const Scene scene = load("mirrors");
  for (const std::string& target : simd::availableTargets()) {
    std::map<std::string, double> refinedUlps;
    for (const Reciprocal how : {Reciprocal::refined, Reciprocal::approximate}) {
      const RenderOptions o = withReciprocal(how, target);
      Renderer renderer(scene, o);
      const auto rows = compareStages(renderer, chooseCamera(scene, o), makeFilm(scene, o));
      const double bound = boundInUlps(how, target);
      for (const auto& [stage, column] :
           {std::pair<Stage, const char*>{Stage::findIntersections, "geometricNormal"},
            {Stage::addImpulses, "direction"}}) {
        const StageDifference& row = rowOf(rows, stage, column);
        std::printf("%s %s %s: %.4g ulp (at most %.4g)\n", target.c_str(),
                    how == Reciprocal::refined ? "refined" : "approximate", column, row.worstUlp,
                    bound + row.limitUlp);
        EXPECT_LE(row.worstUlp, bound + row.limitUlp) << target << " " << column;
        if (how == Reciprocal::refined) {
          refinedUlps[column] = row.worstUlp;
        } else {
          EXPECT_GT(row.worstUlp, kStepGain * refinedUlps[column]) << target << " " << column;
        }
      }
    }
  }
}

// With a step of Newton's method pictures agree as those of exact roots do.
TEST_F(ReciprocalRoot, RefinedPicturesAgreeWithTheReference) {
  for (const char* name : {"mirrors", "glass", "matte"}) {
    const Scene scene = load(name);
    const RenderOptions o = withReciprocal(Reciprocal::refined, "auto");
    Renderer renderer(scene, o);
    Film packets = makeFilm(scene, o), reference = makeFilm(scene, o);
    renderer.render(chooseCamera(scene, o), packets);
    renderer.renderReference(chooseCamera(scene, o), reference);
    const ImageDifference d = compareImages(packets.image, reference.image);
    std::printf("%s: %.4f %% of pixels off by two codes or more (at most 0.1)\n", name,
                d.pixelsGe2CodesPct);
    EXPECT_LE(d.pixelsGe2CodesPct, 0.1) << name;
  }
}

// The reference does not know the option.
TEST_F(ReciprocalRoot, TheReferenceIsExactAlways) {
  const Scene scene = load("mirrors");
  Image pictures[2];
  for (const Reciprocal how : {Reciprocal::exact, Reciprocal::approximate}) {
    const RenderOptions o = withReciprocal(how, "auto");
    Renderer renderer(scene, o);
    Film film = makeFilm(scene, o);
    renderer.renderReference(chooseCamera(scene, o), film);
    pictures[how == Reciprocal::exact ? 0 : 1] = film.image;
  }
  EXPECT_EQ(pictures[0].pixels, pictures[1].pixels);
}

}  // namespace
}  // namespace whit::test
