// The JSON results have the keys that tools rely on, and numbers that agree with each other.
// RunJson has the numbers of a run.
#include <algorithm>
#include <sstream>

#include "core/machine_limits.h"
#include "run_command.h"

namespace whit::cli {
namespace {

// Expects that the JSON has these keys, which blanks separate.
void expectKeys(const Json& json, const std::string& keys) {
  for (const std::string& key : split(keys)) EXPECT_TRUE(json.contains(key)) << key;
}

class JsonResults : public TinySceneTest {};

TEST_F(JsonResults, Bench) {
  const Json json = jsonOf("bench tiny.json tiny.json --frames 3");
  EXPECT_EQ(json["schema"], 1);
  expectKeys(json["machine"], "cpu cores simd embree compiler commit");
  EXPECT_GE(json["machine"]["cores"], 1);
  ASSERT_EQ(json["runs"].size(), 2u);

  const Json& run = json["runs"][0];
  EXPECT_EQ(run["image_hash"], json["runs"][1]["image_hash"]);
  // Another picture has another hash.
  EXPECT_NE(run["image_hash"],
            jsonOf("bench tiny.json --frames 1 --depth 0 --size 9x7")["runs"][0]["image_hash"]);

  expectMembers(run, {{"scene", "tiny"},
                      {"size", {48, 32}},
                      {"frames", 3},
                      {"mode", "packets"},
                      {"batch", "tile"},
                      {"robust", true}});
  EXPECT_EQ(run["rays"]["primary"], 48 * 32);
  EXPECT_GT(run["rays"]["shadow"], 0);
  EXPECT_GT(run["rays"]["reflection"], 0);
  EXPECT_EQ(run["rays"]["refraction"], 0);
  EXPECT_FALSE(run.contains("floor_ms"));
}

TEST_F(JsonResults, BenchFloorAndWidths) {
  const Json runs = jsonOf("bench tiny.json --frames 2 --floor --widths")["runs"];
  ASSERT_EQ(runs.size(), 4u);
  const int widths[] = {1, 4, 8, 16};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(runs[i]["packet"], widths[i]);
    EXPECT_GT(runs[i]["floor_ms"], 0);
  }
}

// The table has a line for each run, with the numbers of the JSON. Spheres are counted as such.
TEST_F(JsonResults, BenchAsATable) {
  const Outcome outcome =
      succeed("bench tiny.json whitted --frames 2 --size 16x10 --csv bench.csv --json -");
  EXPECT_TRUE(hasText(outcome.err, "2 triangles, 3 spheres  "));
  const Json runs = Json::parse(outcome.out)["runs"];
  EXPECT_EQ(runs[1]["spheres"], 3);

  const std::string csv = bytesOf("bench.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 3) << csv;
  EXPECT_TRUE(csv.starts_with("scene,name,size,threads,packet,simd,mode,batch,robust,")) << csv;
  EXPECT_TRUE(
      hasText(csv, ",frame_ms_median,frame_ms_min,frame_ms_p95,fps,stages_ms_generateRays,"));
  EXPECT_TRUE(hasText(csv, "\ntiny,,16x10,"));
  for (const Json& run : runs) {
    EXPECT_TRUE(hasText(csv, run["image_hash"].get<std::string>()));
    EXPECT_GE(run["other_tasks"], 0);
  }
}

TEST_F(JsonResults, BenchOfPowersOfTwoThreads) {
  const std::string line = "bench tiny.json --frames 1 --threads-scaling";
  const Json runs = jsonOf(line)["runs"];
  const int all = usableThreads();
  int expected = 1;
  for (const Json& run : runs) {
    EXPECT_EQ(run["threads"], expected);
    EXPECT_EQ(run["image_hash"], runs[0]["image_hash"]);
    expected = expected == all ? 0 : std::min(2 * expected, all);
  }
  EXPECT_EQ(expected, 0) << "the last run has all threads";

  // The table divides the speed-up by the threads; the tolerance is that of its digits.
  const std::string table = run(line).out;
  std::istringstream rows(table.substr(table.find("efficiency %\n") + 13));
  double threads = 0, ms = 0, speedUp = 0, efficiency = 0;
  std::string scene;
  while (rows >> threads >> ms >> speedUp >> efficiency >> scene) {
    EXPECT_NEAR(efficiency, 100 * speedUp / threads, 0.051 + 0.5 / threads) << table;
  }
  EXPECT_EQ(threads, all) << table;
}

TEST_F(JsonResults, BenchOfTheReferenceTakesOneFrame) {
  const Json runs = jsonOf("bench tiny.json --mode reference")["runs"];
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0]["frames"], 1);
  EXPECT_EQ(runs[0]["mode"], "reference");
  EXPECT_EQ(runs[0]["rays"]["primary"], 48 * 32);
}

const std::string kCompareKeys =
    "rmse relmse psnr_db flip_mean max_code nonfinite pixels_ge_1_code_pct pixels_ge_2_codes_pct "
    "time_ms path_flips_per_mpx";

TEST_F(JsonResults, CompareScene) {
  const Json json = jsonOf("compare tiny.json --stages --depth 3");
  expectKeys(json, kCompareKeys);
  expectMembers(json, {{"schema", 1}, {"scene", "tiny"}, {"size", {48, 32}}, {"nonfinite", 0}});
  EXPECT_EQ(json["options"]["depth"], "3");
  EXPECT_GT(json["time_ms"]["a"], 0);
  EXPECT_GT(json["time_ms"]["b"], 0);
  EXPECT_GE(json["path_flips_per_mpx"], 0);

  ASSERT_FALSE(json["stages"].empty());
  for (const Json& row : json["stages"]) {
    expectKeys(row, "stage column slots worst_ulp limit_ulp pixel depth");
    EXPECT_EQ(row["pixel"].size(), 2u);
  }
}

TEST_F(JsonResults, CompareFiles) {
  succeed("render tiny.json -o a.exr");
  const Json json = jsonOf("compare a.exr a.exr --exposure 1");

  expectKeys(json, kCompareKeys);
  expectMembers(json, {{"schema", 1},
                       {"a", "a.exr"},
                       {"b", "a.exr"},
                       {"size", {48, 32}},
                       {"options", {{"exposure", "1"}, {"tonemap", "none"}}},
                       {"rmse", 0},
                       {"max_code", 0},
                       {"psnr_db", nullptr},  // infinite
                       {"path_flips_per_mpx", nullptr}});
  EXPECT_FALSE(json.contains("stages"));

  // Two pictures of which one is darker have no code in common, or are both black.
  succeed("render tiny.json -o b.exr --set /lights/0/intensity=[1,1,1]");
  EXPECT_GT(jsonOf("compare a.exr b.exr")["max_code"], 0);
  EXPECT_EQ(jsonOf("compare a.exr b.exr --exposure -60")["max_code"], 0);
}

TEST_F(JsonResults, Info) {
  const Json json = jsonOf("info tiny.json --disable shadows");
  expectKeys(json,
             "triangles instances bounds materials lights textures memory_mb warnings effects "
             "stages kernels");
  // A quad, and an icosahedron that is split twice.
  expectMembers(json, {{"triangles", 2 + 20 * 4 * 4}, {"spheres", 0}, {"lights", 1}});
  EXPECT_EQ(jsonOf("info whitted")["spheres"], 3);
  EXPECT_GT(json["memory_mb"], 0);

  const Json& effects = json["effects"];
  EXPECT_EQ(effects["mirror"]["on"], true);
  EXPECT_NE(effects["mirror"]["because"], "");
  EXPECT_EQ(effects["shadows"]["on"], false);
  EXPECT_EQ(effects["shadows"]["because"], "disabled by --disable");
  EXPECT_EQ(effects["transmission"]["on"], false);

  for (const Json& stage : json["stages"]) EXPECT_NE(stage, "checkShadows");
  ASSERT_FALSE(json["kernels"].empty());
  for (const Json& kernel : json["kernels"]) expectKeys(kernel, "stage target");
}

TEST_F(JsonResults, Scenes) {
  const Json json = jsonOf("scenes");
  EXPECT_EQ(json["schema"], 1);
  const auto atrium = std::ranges::find_if(
      json["scenes"], [](const Json& scene) { return scene["name"] == "atrium"; });
  ASSERT_NE(atrium, json["scenes"].end());
  EXPECT_TRUE((*atrium)["about"].get<std::string>().starts_with("A two-storeyed court"));
  EXPECT_TRUE(std::filesystem::exists((*atrium)["file"].get<std::string>()));
}

TEST_F(JsonResults, RenderWritesAFile) {
  succeed("render tiny.json -o a.png --depth 3 --json a.json");
  const Json json = jsonIn("a.json");
  expectMembers(json, {{"files", {"a.png"}}, {"kept", 0}, {"schema", 1}});
  EXPECT_EQ(json["options"]["depth"], "3");
  EXPECT_GT(json["writing_ms"]["spent"], 0);
  expectKeys(json["writing_ms"], "waited");
  EXPECT_GT(json["written_per_s"], 0);
}

TEST_F(JsonResults, RenderOfNothingButWhatIsThere) {
  const std::string line = "render tiny.json -o a.png --resume";
  succeed(line);
  const Json json = jsonOf(line);
  expectMembers(json, {{"scene", "tiny"}, {"frames", 0}, {"files", Json::array()}, {"kept", 1}});
  EXPECT_FALSE(json.contains("frame_ms"));
  expectKeys(json, "size threads load_ms build_ms machine");
}

}  // namespace
}  // namespace whit::cli
