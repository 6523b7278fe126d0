// Tables and summaries of made-up frames, whose numbers are known.
#include "command_line/progress_bar.h"
#include "core/text.h"
#include "output/frame_summary.h"
#include "output/json_report.h"
#include "run_command.h"

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

// RunJson has lanes and rates of other numbers.
TEST(Summary, OfNoRaysAndNoTimeIsZero) {
  EXPECT_EQ(lanesFilled({0, 0}), 0);
  EXPECT_EQ(mraysPerSecond(1, 0), 0);
}

// A film whose numbers are known by heart.
RunSummary measuredRun() {
  RunSummary run = madeUpRun(3);     // 10, 20 and 30 ms
  run.frames[1].meter.embreeMs = 8;  // of two workers
  run.frames[1].meter.tally[0] = {300'000, 400'000};
  run.frames[1].meter.tally[1] = {100'000, 100'000};
  run.effects = EffectSet().with(Effect::shadows);
  run.loadMs = 1234;
  run.buildMs = 56;
  run.floorMs = {16};
  run.updateMs = {7};
  run.writingMs = {30, 50, 40};
  run.waitedMs = {5, 30, 40};
  run.tracedAndWrittenMs = 150;
  constexpr double kRays = 2 * (2048 + 300) + 400'000;
  run.events = {750 * kRays, 500 * kRays, kRays / 4};
  return run;
}

// Every number of the table with its unit.
TEST(StageTable, HasTheseWords) {
  RunSummary run = measuredRun();
  std::string stages;
  for (std::size_t i = 0; i < kStageCount; ++i) {
    const double percent = static_cast<double>(i + 1);
    stages += formatted("  %-34s%10.3f%8.1f\n", kStageNames[i].data(), percent / 5, percent);
  }
  EXPECT_EQ(
      stageTable(run),
      "made-up  64x32  12 triangles  2 threads  packets of 8, avx2, a tile at a time\n"
      "  frame 20.00 ms (50.0 a second traced, 20.0 a second traced and written), least 10.00, "
      "95 % within 30.00, of 3 frames; load 1234 ms, build 56 ms\n"
      "  stage                                     ms       %\n" +
          stages +
          "  between the stages, waiting           12.800    64.0\n"
          "  of all this inside Embree              4.000    20.0\n"
          "  updateScene, before the frame          7.000\n"
          "  writing the image                     40.000          30.000 waited for\n"
          "  rays                traced    Mray/s  lanes filled %\n"
          "  primary             300000     15.00            75.0\n"
          "  shadow              100000      5.00           100.0\n"
          "  all                 400000     20.00\n"
          "  floor 16.00 ms (Embree alone, the same rays); frame over floor 1.25\n"
          "  instructions a ray 750\n"
          "  cycles a ray 500\n"
          "  cache_misses a ray 0.25\n");

  // Counters that do not count say why.
  run.events.clear();
  run.noEvents = "the kernel forbids it";
  EXPECT_TRUE(hasText(stageTable(run),
                      "\n  instructions, cycles and cache misses a ray are not counted: the kernel "
                      "forbids it\n"));
  EXPECT_EQ(runJson(run)["per_ray"], nullptr);
  EXPECT_EQ(runJson(run)["no_per_ray"], run.noEvents);
}

// The same in the JSON.
TEST(RunJson, HasTheseNumbers) {
  EXPECT_FALSE(runJson(madeUpRun(1)).contains("per_ray"));
  const Json json = runJson(measuredRun());
  const std::pair<const char*, double> numbers[] = {{"/frame_ms/median", 20},
                                                    {"/frame_ms/min", 10},
                                                    {"/frame_ms/p95", 30},
                                                    {"/fps", 50},
                                                    {"/embree_ms", 4},
                                                    {"/outside_embree_ms", 16},
                                                    {"/rays/primary", 300'000},
                                                    {"/lanes_filled/primary", 0.75},
                                                    {"/mrays_per_s", 20},
                                                    {"/floor_ms", 16},
                                                    {"/frame_over_floor", 1.25},
                                                    {"/updateScene_ms", 7},
                                                    {"/writing_ms/spent", 40},
                                                    {"/writing_ms/waited", 30},
                                                    {"/written_per_s", 20},
                                                    {"/load_ms", 1234},
                                                    {"/build_ms", 56},
                                                    {"/stages_ms/generateRays", 0.2},
                                                    {"/stages_ms/updateImage", 1.6},
                                                    {"/per_ray/instructions", 750},
                                                    {"/per_ray/cycles", 500},
                                                    {"/per_ray/cache_misses", 0.25}};

  for (const auto& [pointer, value] : numbers) {
    EXPECT_NEAR(json[Json::json_pointer(pointer)].get<double>(), value, 1e-9) << pointer;
  }
  EXPECT_EQ(json["stages_ms"].size(), kStageCount);
  for (const char* ofKinds : {"rays", "lanes_filled"}) {
    EXPECT_EQ(json[ofKinds].size(), kRayKindCount) << ofKinds;
  }
  // This process takes more than a megabyte and less than a hundred gigabytes.
  EXPECT_GT(json["peak_rss_mb"].get<double>(), 1);
  EXPECT_LT(json["peak_rss_mb"].get<double>(), 1e5);
}

class MemoryMb : public TinySceneTest {};

// 1024 x 1024 texels of 4 bytes are 4.2 MB. Mip levels and the tables of kernels hold no more than
// twice as much again.
TEST_F(MemoryMb, IsInMillionsOfBytes) {
  const auto memoryOf = [&](int side) {
    // An uncompressed TGA with 24 bits a pixel.
    const char low = static_cast<char>(side % 256), high = static_cast<char>(side / 256);
    const std::string head{0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, low, high, low, high, 24, 0x20};
    save("a.tga", head + std::string(3 * std::size_t(side) * side, 'x'));
    return jsonOf("info a.json")["memory_mb"].get<double>();
  };
  save("a.json",
       "{'whit': 1, 'textures': {'t': {'image': 'a.tga'}},"
       "'materials': {'m': {'diffuseMap': 't'}}, 'scene': [{'shape': 'quad', 'material': 'm'}]}");
  const double more = memoryOf(1024) - memoryOf(16);
  EXPECT_GT(more, 4.1);
  EXPECT_LT(more, 4.2 * 3);
}

TEST(LoadText, TellsOfABusyMachine) {
  RunSummary run = madeUpRun(3);  // 10, 20 and 30 ms
  run.processors = 2;
  run.otherTasks = {20, 21, 22};
  EXPECT_EQ(
      loadText(run),
      "  machine busy or throttled: 21 other tasks for 2 processors, 95 % of the frames within "
      "3.00 times the least\n");
  EXPECT_TRUE(hasText(stageTable(run), "throttled: 21 other"));
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
  EXPECT_FALSE(hasText(stageTable(run), "machine busy"));
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
  EXPECT_FALSE(hasText(table, "addShading"));
  EXPECT_TRUE(hasText(table, "scalar reference"));
}

TEST(StageTable, SaysNothingOfPicturesThatAreNotWritten) {
  const std::string table = stageTable(madeUpRun(3));
  EXPECT_EQ(table.find("writ"), table.find("writeEmitted")) << table;
}

TEST(StageTable, OfOnePictureTellsOneRate) {
  RunSummary run = madeUpRun(1);
  run.writingMs = {8};
  run.waitedMs = {0.5};
  EXPECT_TRUE(hasText(stageTable(run), "  frame 10.00 ms (100.0 a second); load "));
}

TEST(StageTable, NoRateIsZero) {
  RunSummary run = madeUpRun(1);
  for (const auto& [ms, said] : {std::pair{20.0, "(50.0 a second)"},
                                 {24100.0, "(2.5 a minute)"},
                                 {3.6e6, "(1.0 an hour)"}}) {
    run.frames[0].frameMs = ms;
    EXPECT_TRUE(hasText(stageTable(run), said));
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
