// Options that change the scene, in every command that reads one: --set, which images state in
// their metadata, and --sphere-segments.
#include "run_command.h"

namespace whit::cli {
namespace {

class Set : public TinySceneTest {};

TEST_F(Set, RendersWhatTheEditedFileRenders) {
  saveTiny("edited.json", "[60, 60, 60]", "[1, 2.5, 60]");
  succeed("render tiny.json -o a.png --set=/lights/0/intensity=[1,2.5,60]");
  succeed("render edited.json -o b.png");
  EXPECT_EQ(storedIn("a.png").codes, storedIn("b.png").codes);

  saveTiny("edited.json", "\"diffuse\": 0.5", "\"diffuse\": [0.1, 0.2, 0.3]");
  succeed("render tiny.json -o a.png --set \"/materials/floor/diffuse=[0.1, 0.2, 0.3]\"");
  succeed("render edited.json -o b.png");
  EXPECT_EQ(storedIn("a.png").codes, storedIn("b.png").codes);
}

TEST_F(Set, ImagesTellOfItAndResumingKnows) {
  const auto numberAt = [&](const std::string& size) {
    succeed("render tiny.json -o a.exr --resume --set /materials/mirror/mirror=0 --set /size=" +
            size);
    return fileNumber("a.exr");
  };

  const ino_t first = numberAt("[40,20]");
  EXPECT_EQ(metadataOf("a.exr")["set"], "/materials/mirror/mirror=0\n/size=[40,20]");

  EXPECT_EQ(numberAt("[40,20]"), first) << "traced again";
  save("keep", "so that the number of the replaced file is not given again");
  EXPECT_NE(numberAt("[20,40]"), first) << "not traced again";
}

TEST_F(Set, EveryCommandTakesIt) {
  // Without the mirror the reports on the scene change.
  const std::string matte = " tiny.json --set /materials/mirror/mirror=0";
  EXPECT_EQ(jsonOf("info" + matte)["effects"]["mirror"]["on"], false);
  EXPECT_EQ(jsonOf("bench --frames 1" + matte)["runs"][0]["rays"]["reflection"], 0);
  EXPECT_EQ(jsonOf("compare" + matte)["nonfinite"], 0);

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

  const auto difference = [&](const std::string& segments) {
    succeed("render exact.json -o exact.exr --sphere-segments " + segments);
    return jsonOf("compare exact.exr made.exr")["rmse"];
  };
  EXPECT_EQ(difference("24"), 0);
  EXPECT_GT(difference("0"), 0);
}

}  // namespace
}  // namespace whit::cli
