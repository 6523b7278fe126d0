// The JSON results have the keys that tools rely on, and numbers that agree with each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "command_json.h"
#include "core/machine_limits.h"
#include "has_text.h"
#include "run_command.h"

namespace whit::cli {
namespace {

void expectKeys(const Json& json, const Words& keys) {
  for (const std::string& key : keys) EXPECT_TRUE(json.contains(key)) << key;
}

class JsonResults : public TinySceneTest {};

void checkRun(const Json& run) {
  expectKeys(run,
             {"scene",       "size",         "threads",     "packet",    "simd",      "mode",
              "batch",       "robust",       "effects",     "triangles", "frames",    "frame_ms",
              "fps",         "build_ms",     "load_ms",     "stages_ms", "embree_ms", "rays",
              "mrays_per_s", "lanes_filled", "peak_rss_mb", "image_hash"});

  expectKeys(run["frame_ms"], {"median", "min", "p95"});
  expectKeys(run["stages_ms"], {"generateRays", "findIntersections",
                                "writeEmittedAndReflectiveAmbient", "findRadianceAndShadowRays",
                                "checkShadows", "addShading", "addImpulses", "updateImage"});
  EXPECT_EQ(run["stages_ms"].size(), 8u);

  for (const char* kind :
       {"primary", "shadow", "reflection", "refraction", "indirect", "occlusion"}) {
    EXPECT_GE(run["rays"][kind].get<double>(), 0) << kind;
    EXPECT_GE(run["lanes_filled"][kind].get<double>(), 0) << kind;
    EXPECT_LE(run["lanes_filled"][kind].get<double>(), 1) << kind;
  }

  EXPECT_LE(run["frame_ms"]["min"].get<double>(), run["frame_ms"]["median"].get<double>());
  EXPECT_LE(run["frame_ms"]["median"].get<double>(), run["frame_ms"]["p95"].get<double>());
  EXPECT_GT(run["peak_rss_mb"].get<double>(), 1);
}

TEST_F(JsonResults, Bench) {
  const Json json = jsonOf({"bench", tiny_, tiny_, "--frames", "3"});
  EXPECT_EQ(json["schema"], 1);
  expectKeys(json["machine"], {"cpu", "cores", "simd", "embree", "compiler", "commit"});
  EXPECT_GE(json["machine"]["cores"].get<int>(), 1);
  ASSERT_EQ(json["runs"].size(), 2u);
  for (const Json& run : json["runs"]) checkRun(run);

  EXPECT_EQ(json["runs"][0]["image_hash"], json["runs"][1]["image_hash"]);
  // Another picture has another hash.
  EXPECT_NE(json["runs"][0]["image_hash"],
            jsonOf({"bench", tiny_, "--frames", "1", "--exposure", "0", "--depth", "0", "--size",
                    "9x7"})["runs"][0]["image_hash"]);

  const Json& run = json["runs"][0];
  EXPECT_EQ(run["scene"], "tiny");
  EXPECT_EQ(run["size"], Json({48, 32}));
  EXPECT_EQ(run["frames"], 3);
  EXPECT_EQ(run["mode"], "packets");
  EXPECT_EQ(run["batch"], "tile");
  EXPECT_EQ(run["robust"], true);
  EXPECT_EQ(run["rays"]["primary"], 48 * 32);
  EXPECT_GT(run["rays"]["shadow"].get<int>(), 0);
  EXPECT_GT(run["rays"]["reflection"].get<int>(), 0);
  EXPECT_EQ(run["rays"]["refraction"], 0);

  EXPECT_FALSE(run.contains("floor_ms"));
}

TEST_F(JsonResults, BenchFloorAndWidths) {
  const Json json = jsonOf({"bench", tiny_, "--frames", "2", "--floor", "--widths"});
  ASSERT_EQ(json["runs"].size(), 4u);
  const int widths[] = {1, 4, 8, 16};
  for (std::size_t i = 0; i < 4; ++i) {
    const Json& run = json["runs"][i];
    checkRun(run);
    EXPECT_EQ(run["packet"], widths[i]);
    EXPECT_GT(run["floor_ms"].get<double>(), 0);
    EXPECT_NEAR(run["frame_over_floor"].get<double>() * run["floor_ms"].get<double>(),
                run["frame_ms"]["median"].get<double>(), 1e-6);
  }
}

// The table has a line for each run, with the numbers of the JSON.
TEST_F(JsonResults, BenchAsATable) {
  const std::string file = folder_ / "bench.csv";
  const Json json =
      jsonOf({"bench", tiny_, "whitted", "--frames", "2", "--size", "16x10", "--csv", file});
  const std::string csv = readFile(file);
  EXPECT_EQ(std::ranges::count(csv, '\n'), 3) << csv;
  EXPECT_TRUE(csv.starts_with("scene,name,size,threads,packet,simd,mode,batch,robust,")) << csv;
  EXPECT_TRUE(
      hasText(csv, ",frame_ms_median,frame_ms_min,frame_ms_p95,fps,stages_ms_generateRays,"));
  EXPECT_TRUE(hasText(csv, "\ntiny,,16x10,"));
  for (const Json& run : json["runs"]) {
    EXPECT_TRUE(hasText(csv, run["image_hash"].get<std::string>()));
    EXPECT_GE(run["other_tasks"].get<double>(), 0);
  }

  EXPECT_EQ(runWhit({"bench", tiny_, "--csv", folder_ / "bench.txt"}).status, 2);
}

TEST_F(JsonResults, BenchOfPowersOfTwoThreads) {
  const Json json = jsonOf({"bench", tiny_, "--frames", "1", "--threads-scaling"});

  const int all = usableThreads();
  int expected = 1;
  for (const Json& run : json["runs"]) {
    EXPECT_EQ(run["threads"], expected);
    EXPECT_EQ(run["image_hash"], json["runs"][0]["image_hash"]);
    expected = expected == all ? 0 : std::min(2 * expected, all);
  }
  EXPECT_EQ(expected, 0) << "the last run has all threads";

  // The table divides the speed-up by the threads; the tolerance is that of its digits.
  const std::string table = runWhit({"bench", tiny_, "--frames", "1", "--threads-scaling"}).out;
  std::istringstream rows(table.substr(table.find("efficiency %\n") + 13));
  double threads = 0, ms = 0, speedUp = 0, efficiency = 0;
  std::string scene;
  while (rows >> threads >> ms >> speedUp >> efficiency >> scene) {
    EXPECT_NEAR(efficiency, 100 * speedUp / threads, 0.051 + 0.5 / threads) << table;
  }
  EXPECT_EQ(threads, all) << table;
}

TEST_F(JsonResults, BenchOfTheReferenceTakesOneFrame) {
  const Json json = jsonOf({"bench", tiny_, "--mode", "reference"});
  ASSERT_EQ(json["runs"].size(), 1u);
  checkRun(json["runs"][0]);
  EXPECT_EQ(json["runs"][0]["frames"], 1);
  EXPECT_EQ(json["runs"][0]["mode"], "reference");
  EXPECT_EQ(json["runs"][0]["rays"]["primary"], 48 * 32);
}

const Words kCompareKeys{"rmse",      "relmse",
                         "psnr_db",   "flip_mean",
                         "max_code",  "pixels_ge_1_code_pct",
                         "nonfinite", "pixels_ge_2_codes_pct",
                         "time_ms",   "path_flips_per_mpx"};

TEST_F(JsonResults, CompareScene) {
  const Json json = jsonOf({"compare", tiny_, "--stages", "--depth", "3"});
  expectKeys(json, kCompareKeys);
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["scene"], "tiny");
  EXPECT_EQ(json["size"], Json({48, 32}));
  EXPECT_EQ(json["options"]["depth"], "3");
  EXPECT_GT(json["time_ms"]["a"].get<double>(), 0);
  EXPECT_GT(json["time_ms"]["b"].get<double>(), 0);
  EXPECT_GE(json["path_flips_per_mpx"].get<double>(), 0);
  EXPECT_EQ(json["nonfinite"], 0);

  ASSERT_FALSE(json["stages"].empty());
  for (const Json& row : json["stages"]) {
    expectKeys(row, {"stage", "column", "slots", "worst_ulp", "limit_ulp", "pixel", "depth"});
    EXPECT_EQ(row["pixel"].size(), 2u);
  }
}

TEST_F(JsonResults, CompareFiles) {
  const std::string a = folder_ / "a.exr";
  succeed({"render", tiny_, "-o", a});
  const Json json = jsonOf({"compare", a, a, "--exposure", "1"});

  expectKeys(json, kCompareKeys);
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["a"], a);
  EXPECT_EQ(json["b"], a);
  EXPECT_EQ(json["size"], Json({48, 32}));
  EXPECT_EQ(json["options"], Json({{"exposure", "1"}, {"tonemap", "none"}}));
  EXPECT_EQ(json["rmse"], 0);
  EXPECT_EQ(json["max_code"], 0);
  EXPECT_TRUE(json["psnr_db"].is_null());  // infinite
  EXPECT_TRUE(json["path_flips_per_mpx"].is_null());
  EXPECT_FALSE(json.contains("stages"));

  // Two pictures of which one is darker have no code in common, or are both black.
  const std::string b = folder_ / "b.exr";
  succeed({"render", tiny_, "-o", b, "--set", "/lights/0/intensity=[1,1,1]"});
  EXPECT_GT(jsonOf({"compare", a, b})["max_code"], 0);
  EXPECT_EQ(jsonOf({"compare", a, b, "--exposure", "-60"})["max_code"], 0);
}

TEST_F(JsonResults, Info) {
  const Json json = jsonOf({"info", tiny_, "--disable", "shadows"});
  expectKeys(json, {"triangles", "instances", "bounds", "materials", "lights", "textures",
                    "memory_mb", "warnings", "effects", "stages", "kernels"});
  EXPECT_EQ(json["triangles"], 2 + 20 * 4 * 4);  // quad, icosahedron split twice
  EXPECT_EQ(json["lights"], 1);
  EXPECT_GT(json["memory_mb"].get<double>(), 0);

  EXPECT_EQ(json["effects"]["mirror"]["on"], true);
  EXPECT_NE(json["effects"]["mirror"]["because"], "");
  EXPECT_EQ(json["effects"]["shadows"]["on"], false);
  EXPECT_EQ(json["effects"]["shadows"]["because"], "disabled by --disable");
  EXPECT_EQ(json["effects"]["transmission"]["on"], false);

  for (const Json& stage : json["stages"]) EXPECT_NE(stage, "checkShadows");
  ASSERT_FALSE(json["kernels"].empty());
  for (const Json& kernel : json["kernels"]) expectKeys(kernel, {"stage", "target"});
  EXPECT_EQ(json["spheres"], 0);
}

TEST_F(JsonResults, Scenes) {
  const Json json = jsonOf({"scenes"});
  EXPECT_EQ(json["schema"], 1);
  const auto atrium = std::ranges::find_if(
      json["scenes"], [](const Json& scene) { return scene["name"] == "atrium"; });
  ASSERT_NE(atrium, json["scenes"].end());
  EXPECT_TRUE((*atrium)["about"].get<std::string>().starts_with("A two-storeyed court"));
  EXPECT_TRUE(std::filesystem::exists((*atrium)["file"].get<std::string>()));
}

TEST_F(JsonResults, BenchCountsSpheres) {
  const Outcome outcome =
      runWhit({"bench", "whitted", "--size", "16x10", "--frames", "1", "--json", "-"});
  EXPECT_TRUE(hasText(outcome.err, "2 triangles, 3 spheres  "));
  EXPECT_EQ(Json::parse(outcome.out)["runs"][0]["spheres"], 3);
}

TEST_F(JsonResults, InfoOfSpheres) { EXPECT_EQ(jsonOf({"info", "whitted"})["spheres"], 3); }

TEST_F(JsonResults, RenderWritesAFile) {
  const std::string image = folder_ / "a.png", file = folder_ / "a.json";
  succeed({"render", tiny_, "-o", image, "--depth", "3", "--json", file});
  const Json json = Json::parse(readFile(file), nullptr, false);
  ASSERT_FALSE(json.is_discarded());
  checkRun(json);

  EXPECT_EQ(json["files"], Json({image}));
  EXPECT_EQ(json["kept"], 0);
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["options"]["depth"], "3");
  expectKeys(json["writing_ms"], {"spent", "waited"});
  EXPECT_GT(json["writing_ms"]["spent"].get<double>(), 0);
  EXPECT_GT(json["written_per_s"].get<double>(), 0);
}

TEST_F(JsonResults, RenderOfNothingButWhatIsThere) {
  const std::string image = folder_ / "a.png";
  succeed({"render", tiny_, "-o", image, "--resume"});
  const Json json = jsonOf({"render", tiny_, "-o", image, "--resume"});
  EXPECT_EQ(json["scene"], "tiny");
  EXPECT_EQ(json["frames"], 0);
  EXPECT_EQ(json["files"], Json::array());
  EXPECT_EQ(json["kept"], 1);
  EXPECT_FALSE(json.contains("frame_ms"));
  expectKeys(json, {"size", "threads", "load_ms", "build_ms", "machine"});
}

}  // namespace
}  // namespace whit::cli
