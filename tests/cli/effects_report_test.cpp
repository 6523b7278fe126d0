// The cost of effects from made-up frames, whose numbers are known.
#include "cli/effects_report.h"
#include "has_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "embedded_data.h"
#include "output/report_page.h"

namespace whit::cli {
namespace {

// Frames of the given durations, two fifths of each inside Embree.
RunSummary madeUpRun(const std::vector<double>& ms, std::uint64_t reflections) {
  RunSummary run;
  run.scene = "made-up";
  run.width = 64;
  run.height = 32;
  run.machine = {"avx2", "3.13.5 avx2", 8, 2};

  for (const double duration : ms) {
    FrameStats frame;
    frame.frameMs = duration;
    frame.workers = 2;
    frame.meter.embreeMs = 2 * 0.4 * duration;
    frame.meter.tally[0] = {2048, 2048};
    frame.meter.tally[2] = {reflections, reflections};
    run.frames.push_back(frame);
  }
  return run;
}

// The machine slows down threefold in the middle of the measurement.
std::vector<EffectStep> madeUpSteps() {
  return {{"matte", madeUpRun({10, 30, 10, 10, 30}, 0), 1.5},
          {"mirror", madeUpRun({15, 45, 15, 15, 45}, 3000), 1.75}};
}

TEST(RunRatios, AreMediansOfRatiosWithinATurn) {
  const std::vector<EffectStep> steps = madeUpSteps();
  const RunRatio ratio = ratioOf(steps[1].run, steps[0].run);
  EXPECT_DOUBLE_EQ(ratio.frame, 1.5);
  EXPECT_DOUBLE_EQ(ratio.outsideEmbree, 1.5);

  RunSummary first = steps[0].run, second = steps[1].run;
  first.name = "effects auto";
  second.name = "effects all";
  const std::string text = ratioText(first, second);
  EXPECT_TRUE(text.starts_with("made-up, effects all over effects auto, medians of 5 turns\n"))
      << text;
  EXPECT_TRUE(hasText(text, "1.500  (15.00 over 10.00 ms)"));
  EXPECT_TRUE(hasText(text, "1.500  (9.00 over 6.00 ms)"));
}

TEST(EffectsTable, HasARowForEachStep) {
  const std::string table = effectsTable(effectsJson(madeUpSteps(), {}));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3 + 5);
  // The medians of a turn are 10 ms and 5 ms more; the last step alone takes 15 ms.
  EXPECT_TRUE(hasText(table, "come to 15.00 ms; the last frame takes 15.00 ms."));
  EXPECT_TRUE(hasText(table,
                      "+ mirror               15.00      +5.00  +5.00 to +15.00              "
                      "+3.00       +3000"));
}

// Five turns tell no more than the least and the largest difference.
TEST(EffectsRows, SayWhatIsNoise) {
  std::vector<EffectStep> steps = madeUpSteps();
  steps.push_back({"caustics", madeUpRun({15.5, 44, 16, 15.25, 46}, 3000), 1.75});
  nlohmann::ordered_json rows = effectsRows(steps);
  EXPECT_EQ(rows[2]["added_ms"], 0.5);
  EXPECT_EQ(rows[2]["added_ms_low"], -1);
  EXPECT_EQ(rows[2]["added_ms_high"], 1);
  const std::string table = effectsTable(effectsJson(steps, {}));
  EXPECT_TRUE(hasText(table, "~    +0.50  -1.00 to +1.00 "));

  // Of a single turn nothing is known.
  for (EffectStep& step : steps) step.run.frames.resize(1);
  rows = effectsRows(steps);
  EXPECT_TRUE(rows[1]["added_ms_low"].is_null());
  EXPECT_TRUE(hasText(effectsTable(effectsJson(steps, {})), "~    +5.00  unknown "));
}

// The interval has a confidence of 95 %. Of 21 values five are left out at either end, because
// twice the sum of the binomial coefficients of 21 up to the fifth is 55,792, at most a twentieth
// of 2^21; up to the sixth it is 164,320, which would do for 90 %.
TEST(EffectsRows, LeaveOutTheOutermostOfManyTurns) {
  std::vector<double> ms;
  for (int i = 21; i > 0; --i) ms.push_back(i);
  const nlohmann::ordered_json row = effectsRows({{"matte", madeUpRun(ms, 0), 1.5}})[0];
  EXPECT_EQ(row["added_ms_low"], 6);
  EXPECT_EQ(row["added_ms_high"], 16);
}

// The turns in which the machine is slow do not change the medians of the differences.
TEST(EffectsRows, AreTheLinesOfTheCsvFile) {
  EXPECT_EQ(csvOf(effectsRows(madeUpSteps())),
            "effect,frame_ms,added_ms,added_ms_low,added_ms_high,added_outside_embree_ms,"
            "added_outside_embree_ms_low,added_outside_embree_ms_high,primary_rays,"
            "shadow_rays,reflection_rays,refraction_rays,indirect_rays,occlusion_rays,added_rays,"
            "memory_mb,added_memory_mb\n"
            "matte,10,10,10,30,6,6,18,2048,0,0,0,0,0,2048,1.5,1.5\n"
            "mirror,15,5,5,15,3,3,9,2048,0,3000,0,0,0,3000,1.75,0.25\n");
}

TEST(EffectsReport, HasTheRows) {
  const std::vector<EffectStep> steps = madeUpSteps();
  const nlohmann::ordered_json data = effectsJson(steps, {"00-matte.png", "01-mirror.png"});
  EXPECT_EQ(data["effects"], effectsRows(steps));
  EXPECT_EQ(data["pictures"].size(), 2u);
  EXPECT_EQ(data["turns"], 5);
  EXPECT_EQ(embeddedData(reportPage(data)), data);
}

}  // namespace
}  // namespace whit::cli
