// Options that change the scene, in every command that reads one: --set, which images state in
// their metadata, and --sphere-segments.
#include "run_command.h"

namespace whit::cli {
namespace {

class Set : public TinySceneTest {};

TEST_F(Set, ImagesTellOfItAndResumingKnows) {
  const std::string line =
      "render tiny.json -o a.exr --resume --set=/materials/mirror/mirror=0 --set /size=";
  succeed(line + "[40,20]");
  EXPECT_EQ(metadataOf("a.exr")["set"], "/materials/mirror/mirror=0\n/size=[40,20]");
  EXPECT_TRUE(keeps("a.exr", line + "[40,20]"));
  EXPECT_FALSE(keeps("a.exr", line + "[20,40]"));
}

// Program.CompareFailsIfLightIsMissing holds that compare takes it.
TEST_F(Set, EveryCommandTakesIt) {
  // Without the mirror the reports on the scene change.
  const std::string matte = " tiny.json --set /materials/mirror/mirror=0";
  EXPECT_EQ(jsonOf("info" + matte)["effects"]["mirror"]["on"], false);
  EXPECT_EQ(jsonOf("bench --frames 1" + matte)["runs"][0]["rays"]["reflection"], 0);
  succeed("effects --out made --frames 1" + matte);
  EXPECT_FALSE(hasText(bytesOf("made/effects.csv"), "\nmirror,"));
}

class SphereSegments : public TinySceneTest {};

// The option does for all spheres what the member "segments" does for one of them.
TEST_F(SphereSegments, AreThoseOfTheScene) {
  const auto saveBall = [&](const std::string& name, const std::string& shape) {
    saveTiny(name, R"("shape": "icosphere", "radius": 1, "level": 2)",
             R"("shape": "sphere")" + shape);
  };
  saveBall("exact.json", "");
  saveBall("made.json", R"(, "segments": 24)");
  succeed("render made.json -o made.exr");
  succeed("render exact.json -o exact.exr --sphere-segments 24");
  succeed("compare exact.exr made.exr --tolerance 0");
}

}  // namespace
}  // namespace whit::cli
