// Tables and summaries of made-up frames, whose numbers are known.
#include <gtest/gtest.h>

#include "command_line/progress_bar.h"
#include "output/frame_summary.h"

namespace whit::cli {
namespace {

// Frames of 10, 20, ... ms on two workers; stage i takes i + 1 percent of the frame.
RunSummary madeUpRun(int frames) {
  RunSummary run;
  run.scene = "made-up";
  run.width = 64;
  run.height = 32;
  run.triangles = 12;
  run.machine = {"avx2", "3.13.5 avx2", 8, 2};
  run.effects = EffectSet::all();

  for (int f = frames; f >= 1; --f) {
    FrameStats frame;
    frame.frameMs = 10.0 * f;
    frame.workers = 2;
    for (std::size_t i = 0; i < kStageCount; ++i) {
      frame.stageWorkerMs[i] = 2 * frame.frameMs * static_cast<double>(i + 1) / 100;
    }
    frame.meter.tally[0] = {2048, 2048};
    frame.meter.tally[1] = {300, 400};
    run.frames.push_back(frame);
  }
  return run;
}

TEST(Summary, QuantilesByNearestRank) {
  EXPECT_EQ(quantile({5, 1, 4, 2, 3}, 0.5), 3);
  EXPECT_EQ(quantile({4, 1, 3, 2}, 0.5), 2);
  EXPECT_EQ(quantile({1, 2, 3, 4}, 1.0), 4);
  EXPECT_EQ(quantile({2, 1}, 1e-9), 1);

  std::vector<double> hundred;
  for (int i = 1; i <= 100; ++i) hundred.push_back(i);
  EXPECT_EQ(quantile(hundred, 0.95), 95);
  EXPECT_EQ(quantile({}, 0.5), 0);
}

TEST(Summary, MedianFrameIsOneOfTheFrames) {
  EXPECT_EQ(medianFrame(madeUpRun(5)).frameMs, 30);
  EXPECT_EQ(medianFrame(madeUpRun(4)).frameMs, 20);
  EXPECT_EQ(medianFrame(madeUpRun(1)).frameMs, 10);
}

TEST(Summary, LanesAndRates) {
  EXPECT_EQ(lanesFilled({300, 400}), 0.75);
  EXPECT_EQ(lanesFilled({0, 0}), 0);
  EXPECT_EQ(mraysPerSecond(3'000'000, 1000), 3);
  EXPECT_EQ(mraysPerSecond(1, 0), 0);
}

TEST(StageTable, NamesStagesTimesAndRays) {
  RunSummary run = madeUpRun(3);
  run.floorMs = {16};
  const std::string table = stageTable(run);
  for (const std::string_view name : kStageNames) {
    EXPECT_NE(table.find(name), std::string::npos) << name;
  }
  for (const RayKindRow& kind : kRayKinds) {
    EXPECT_NE(table.find(kind.name), std::string::npos) << kind.name;
  }

  EXPECT_NE(table.find("frame 20.00 ms (50.0 a second), least 10.00, 95 % within 30.00"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find("     1.600     8.0\n"), std::string::npos) << table;  // 8 % of 20 ms
  EXPECT_NE(table.find("75.0\n"), std::string::npos) << table;
  EXPECT_NE(table.find("frame over floor 1.25"), std::string::npos) << table;
}

TEST(LoadText, TellsOfABusyMachine) {
  RunSummary run = madeUpRun(3);  // 10, 20 and 30 ms
  run.processors = 2;
  run.otherTasks = {20, 21, 22};
  EXPECT_EQ(
      loadText(run),
      "  machine busy or throttled: 21 other tasks for 2 processors, 95 % of the frames within "
      "3.00 times the least\n");
  EXPECT_NE(stageTable(run).find("throttled: 21 other"), std::string::npos) << stageTable(run);
  run.floorMs = {5, 5, 5};
  EXPECT_TRUE(loadText(run).ends_with("the least; frame over floor is too high\n"));

  // Two threads and six other tasks fit on eight processors, but the frames differ by much.
  run.processors = 8;
  run.otherTasks = {6, 6, 6};
  EXPECT_TRUE(loadText(run).starts_with("  machine busy or throttled: 6 other tasks for 8 proc"));
  for (FrameStats& frame : run.frames) frame.frameMs = 10;
  EXPECT_EQ(loadText(run), "");

  // Nobody has looked at the machine.
  run = madeUpRun(3);
  EXPECT_EQ(stageTable(run).find("machine busy"), std::string::npos) << stageTable(run);
}

// Of all frames, not of the one that stands for them in the table.
TEST(PictureWarnings, CountTheFramesTogether) {
  RunSummary run = madeUpRun(3);
  EXPECT_TRUE(pictureWarnings(run).empty());

  run.options.maxRays = 77;
  run.frames[0].limitedPixels = 3;
  run.frames[2].limitedPixels = 4;
  run.frames[1].nonFinitePixels = 1;
  const std::vector<std::string> warnings = pictureWarnings(run);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_TRUE(warnings[0].starts_with("7 pixels have samples of more than 77 rays"));
  EXPECT_EQ(warnings[1], "1 pixel is not finite");
}

// The table leaves out the kinds of rays that the scene's effects do not trace.
TEST(StageTable, TellsOfNoRaysThatTheSceneDoesNotCallFor) {
  RunSummary run = madeUpRun(1);
  const auto told = [&](EffectSet effects) {
    run.effects = effects;
    const std::string table = stageTable(run);
    std::vector<std::string> kinds;
    for (const RayKindRow& kind : kRayKinds) {
      if (table.find("\n  " + std::string(kind.name) + " ") != std::string::npos)
        kinds.emplace_back(kind.name);
    }
    return kinds;
  };

  using Kinds = std::vector<std::string>;
  EXPECT_EQ(told(EffectSet()), Kinds({"primary"}));
  const EffectSet mirrors = EffectSet().with(Effect::shadows).with(Effect::mirror);
  EXPECT_EQ(told(mirrors), Kinds({"primary", "shadow", "reflection"}));
  EXPECT_EQ(told(EffectSet().with(Effect::glossyReflection)), Kinds({"primary", "reflection"}));
  EXPECT_EQ(told(EffectSet().with(Effect::transmission)), Kinds({"primary", "refraction"}));
  EXPECT_EQ(told(EffectSet().with(Effect::indirect)), Kinds({"primary", "indirect"}));
  EXPECT_EQ(told(EffectSet().with(Effect::ambientOcclusion)), Kinds({"primary", "occlusion"}));
}

TEST(StageTable, ReferenceHasNoStages) {
  RunSummary run = madeUpRun(1);
  run.options.mode = Mode::reference;
  const std::string table = stageTable(run);
  EXPECT_EQ(table.find("addShading"), std::string::npos) << table;
  EXPECT_NE(table.find("scalar reference"), std::string::npos) << table;
}

TEST(StageTable, TellsTheRateThatIsTrueOfAFilm) {
  RunSummary run = madeUpRun(3);
  EXPECT_EQ(stageTable(run).find("writ"), stageTable(run).find("writeEmitted")) << stageTable(run);

  run.writingMs = {30, 50, 40};
  run.waitedMs = {5, 30, 40};
  run.tracedAndWrittenMs = 150;

  const std::string table = stageTable(run);
  EXPECT_NE(table.find("(50.0 a second traced, 20.0 a second traced and written), least"),
            std::string::npos)
      << table;
  EXPECT_NE(
      table.find("  writing the image                     40.000          30.000 waited for\n"),
      std::string::npos)
      << table;
}

TEST(StageTable, NoRateIsZero) {
  RunSummary run = madeUpRun(1);
  for (const auto& [ms, said] : {std::pair{20.0, "(50.0 a second)"},
                                 {24100.0, "(2.5 a minute)"},
                                 {3.6e6, "(1.0 an hour)"}}) {
    run.frames[0].frameMs = ms;
    EXPECT_NE(stageTable(run).find(said), std::string::npos) << stageTable(run);
  }
}

TEST(ProgressText, TellsTheTimeLeftOnceThereIsSomethingToTellItFrom) {
  EXPECT_EQ(timeLeft(30'000, 0.25), ", 1:30 left");
  EXPECT_EQ(timeLeft(1000, 0.5), ", 0:01 left");
  EXPECT_EQ(timeLeft(3'600'000, 0.25), ", 3:00:00 left");
  for (const auto& [ms, fraction] :
       {std::pair{999.0, 0.5}, {5000.0, 0.0}, {5000.0, 1.0}, {5000.0, std::nan("")}, {1e9, 1e-9}}) {
    EXPECT_EQ(timeLeft(ms, fraction), "") << fraction;
  }
}

TEST(ProgressText, FillsUpAndStaysInRange) {
  EXPECT_EQ(progressText("decoding", 0.25), "[#####---------------]  25 % decoding");
  EXPECT_EQ(progressText("", 7), "[####################] 100 % ");
  EXPECT_EQ(progressText("", -1), "[--------------------]   0 % ");
  EXPECT_EQ(progressText("", std::nan("")), "[--------------------]   0 % ");
}

}  // namespace
}  // namespace whit::cli
