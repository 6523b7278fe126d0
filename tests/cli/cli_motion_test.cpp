// Films of a scene that moves: each frame follows from its time alone.
#include <gtest/gtest.h>

#include "command_json.h"
#include "has_text.h"
#include "io/gltf_files.h"
#include "picture_file.h"
#include "run_command.h"

namespace whit::cli {
namespace {

// A triangle that rises, and one that shrinks away to nothing.
std::string writeMoving(const TemporaryFolder& folder) {
  GltfBuilder b;
  const std::string shown = triangle(b);
  const std::string times =
      b.accessor(b.view(bytesOf<float>({0, 2})), 5126, "SCALAR", 2, ",\"min\":[0],\"max\":[2]");
  const std::string up = b.positions({0, 0, 0, 0, 2, 0}), away = b.positions({1, 1, 1, 0, 0, 0});
  const auto channel = [](int sampler, int node, const std::string& path) {
    return "{\"sampler\":" + std::to_string(sampler) +
           ",\"target\":{\"node\":" + std::to_string(node) + ",\"path\":\"" + path + "\"}}";
  };
  const auto sampler = [&](const std::string& output) {
    return "{\"input\":" + times + ",\"output\":" + output + "}";
  };

  std::ofstream(folder / "moving.gltf") << b.json(
      "\"meshes\":[{\"primitives\":[" + shown +
      "]}],\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[2,0,0]}],\"animations\":[{"
      "\"name\":\"up\",\"channels\":[" +
      channel(0, 0, "translation") + "," + channel(1, 1, "scale") + "],\"samplers\":[" +
      sampler(up) + "," + sampler(away) + "]}]");
  return folder / "moving.gltf";
}

class Motion : public TinySceneTest {
 protected:
  const std::string moving_ = writeMoving(folder_);
};

TEST_F(Motion, AFrameIsTheSameAloneAndInAFilm) {
  const auto film = [&](const std::string& name, const std::string& frames,
                        const std::string& threads) {
    succeed({"render", moving_, "-o", folder_ / (name + "#.exr"), "--frames", frames, "--fps", "2",
             "--size", "64x40", "--threads", threads, "--quiet"});
  };

  film("film", "0..4", "2");
  film("alone", "3", "1");
  film("many", "3", "8");
  const std::string third = readFile(folder_ / "film3.exr");
  EXPECT_NE(third, readFile(folder_ / "film2.exr"));
  EXPECT_TRUE(third == readFile(folder_ / "alone3.exr"));

  const auto pixels = [&](const std::string& name) { return storedIn(folder_ / name).values; };
  EXPECT_EQ(pixels("film3.exr"), pixels("many3.exr"));

  // The option --time gives the picture of the frame at that time.
  succeed({"render", moving_, "-o", folder_ / "instant.exr", "--time", "1.5", "--size", "64x40",
           "--exposure", "0", "--quiet"});
  succeed({"render", moving_, "-o", folder_ / "frame#.exr", "--frames", "3", "--fps", "2", "--size",
           "64x40", "--exposure", "0", "--quiet"});
  EXPECT_EQ(pixels("instant.exr"), pixels("frame3.exr"));
}

TEST_F(Motion, AShippedFilmHasTheSameFramesInParts) {
  const auto film = [&](const std::string& name, const std::string& frames,
                        const std::string& threads) {
    succeed({"render", "orrery", "-o", folder_ / (name + "##.exr"), "--frames", frames, "--size",
             "32x20", "--threads", threads, "--quiet"});
  };
  const auto pixels = [&](const std::string& name) { return storedIn(folder_ / name).values; };

  film("whole", "0..99", "2");
  film("one", "57", "1");
  film("eight", "57", "8");
  EXPECT_NE(pixels("whole57.exr"), pixels("whole56.exr"));
  EXPECT_EQ(pixels("whole57.exr"), pixels("one57.exr"));
  EXPECT_EQ(pixels("whole57.exr"), pixels("eight57.exr"));
}

TEST_F(Motion, IsTimedAndListed) {
  const Outcome info = runWhit({"info", moving_});
  EXPECT_TRUE(hasText(info.out, "animation   up: 2 s, moves 2 nodes\n"));
  const Json listed = jsonOf({"info", moving_})["animations"];
  EXPECT_EQ(listed, Json::parse(R"([{"name": "up", "seconds": 2, "nodes": 2}])"));

  const Outcome film = runWhit({"render", moving_, "-o", folder_ / "f#.png", "--frames", "0..1",
                                "--size", "32x20", "--stats", "--json", folder_ / "f.json"});
  EXPECT_TRUE(hasText(film.err, "updateScene"));
  EXPECT_GT(Json::parse(readFile(folder_ / "f.json"))["updateScene_ms"], 0);
}

TEST_F(Motion, ACameraPathIsLookedAlongAtAnInstant) {
  succeed({"render", tiny_, "-o", folder_ / "t.png", "--time", "0.5", "--quiet"});
  succeed({"render", tiny_, "-o", folder_ / "f#.png", "--frames", "1", "--fps", "2", "--quiet"});

  const auto codes = [&](const std::string& name) { return storedIn(folder_ / name).codes; };
  EXPECT_EQ(codes("t.png"), codes("f1.png"));
}

TEST_F(Motion, WrongUsageIsTold) {
  expectFailure(
      {"render", moving_, "-o", folder_ / "f#.png", "--frames", "0..1", "--animation", "upp"}, 2,
      "did you mean 'up'?");
  std::ofstream(folder_ / "still.obj") << kTriangleObj;
  expectFailure({"render", folder_ / "still.obj", "-o", folder_ / "m.png", "--time", "1"}, 2,
                "nothing moves in still");
}

}  // namespace
}  // namespace whit::cli
