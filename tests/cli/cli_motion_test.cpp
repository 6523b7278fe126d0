// Films of a scene that moves: each frame follows from its time alone.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/gltf_files.h"
#include "io/image/image_file.h"
#include "run_program.h"

namespace whit::cli {
namespace {

// A triangle that rises, and one that shrinks away to nothing.
std::string writeMoving(const TemporaryFolder& folder) {
  GltfBuilder b;
  const std::string shown = triangle(b);
  const int times =
      b.accessor(b.view(bytesOf<float>({0, 2})), 5126, "SCALAR", 2, ",\"min\":[0],\"max\":[2]");
  const int up = b.positions({0, 0, 0, 0, 2, 0}), away = b.positions({1, 1, 1, 0, 0, 0});
  const auto channel = [](int sampler, int node, const std::string& path) {
    return "{\"sampler\":" + std::to_string(sampler) +
           ",\"target\":{\"node\":" + std::to_string(node) + ",\"path\":\"" + path + "\"}}";
  };
  const auto sampler = [&](int output) {
    return "{\"input\":" + std::to_string(times) + ",\"output\":" + std::to_string(output) + "}";
  };

  std::ofstream(folder / "moving.gltf") << b.json(
      "\"meshes\":[{\"primitives\":[" + shown +
      "]}],\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[2,0,0]}],\"animations\":[{"
      "\"name\":\"up\",\"channels\":[" +
      channel(0, 0, "translation") + "," + channel(1, 1, "scale") + "],\"samplers\":[" +
      sampler(up) + "," + sampler(away) + "]}]");
  return folder / "moving.gltf";
}

void expectFilmed(const std::vector<std::string>& words) {
  const Outcome outcome = runWhit(words);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

TEST(Motion, AFrameIsTheSameAloneAndInAFilm) {
  const TemporaryFolder folder;
  const std::string moving = writeMoving(folder);
  const auto film = [&](const std::string& name, const std::string& frames,
                        const std::string& threads) {
    expectFilmed({"render", moving, "-o", folder / (name + "#.exr"), "--frames", frames, "--fps",
                  "2", "--size", "64x40", "--threads", threads, "--quiet"});
  };

  film("film", "0..4", "2");
  film("alone", "3", "1");
  film("many", "3", "8");
  const std::string third = readFile(folder / "film3.exr");
  EXPECT_NE(third, readFile(folder / "film2.exr"));
  EXPECT_TRUE(third == readFile(folder / "alone3.exr"));

  const auto pixels = [&](const std::string& name) {
    Warnings warnings;
    return readRawImage(folder / name, ImageLimits(), warnings).values;
  };
  EXPECT_EQ(pixels("film3.exr"), pixels("many3.exr"));

  // The option --time gives the picture of the frame at that time.
  expectFilmed({"render", moving, "-o", folder / "instant.exr", "--time", "1.5", "--size", "64x40",
                "--exposure", "0", "--quiet"});
  expectFilmed({"render", moving, "-o", folder / "frame#.exr", "--frames", "3", "--fps", "2",
                "--size", "64x40", "--exposure", "0", "--quiet"});
  EXPECT_EQ(pixels("instant.exr"), pixels("frame3.exr"));
}

TEST(Motion, AShippedFilmHasTheSameFramesInParts) {
  const TemporaryFolder folder;
  const auto film = [&](const std::string& name, const std::string& frames,
                        const std::string& threads) {
    expectFilmed({"render", "orrery", "-o", folder / (name + "##.exr"), "--frames", frames,
                  "--size", "32x20", "--threads", threads, "--quiet"});
  };
  const auto pixels = [&](const std::string& name) {
    Warnings warnings;
    return readRawImage(folder / name, ImageLimits(), warnings).values;
  };

  film("whole", "0..99", "2");
  film("one", "57", "1");
  film("eight", "57", "8");
  EXPECT_NE(pixels("whole57.exr"), pixels("whole56.exr"));
  EXPECT_EQ(pixels("whole57.exr"), pixels("one57.exr"));
  EXPECT_EQ(pixels("whole57.exr"), pixels("eight57.exr"));
}

TEST(Motion, IsTimedAndListed) {
  const TemporaryFolder folder;
  const std::string moving = writeMoving(folder);

  const Outcome info = runWhit({"info", moving});
  EXPECT_NE(info.out.find("animation   up: 2 s, moves 2 nodes\n"), std::string::npos) << info.out;
  const nlohmann::json listed =
      nlohmann::json::parse(runWhit({"info", moving, "--json", "-"}).out)["animations"];
  EXPECT_EQ(listed, nlohmann::json::parse(R"([{"name": "up", "seconds": 2, "nodes": 2}])"));

  const Outcome film = runWhit({"render", moving, "-o", folder / "f#.png", "--frames", "0..1",
                                "--size", "32x20", "--stats", "--json", folder / "f.json"});
  EXPECT_NE(film.err.find("updateScene"), std::string::npos) << film.err;
  EXPECT_GT(nlohmann::json::parse(readFile(folder / "f.json"))["updateScene_ms"], 0);
}

TEST(Motion, ACameraPathIsLookedAlongAtAnInstant) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder);
  expectFilmed({"render", tiny, "-o", folder / "t.png", "--time", "0.5", "--quiet"});
  expectFilmed({"render", tiny, "-o", folder / "f#.png", "--frames", "1", "--fps", "2", "--quiet"});

  const auto codes = [&](const std::string& name) {
    Warnings warnings;
    return readRawImage(folder / name, ImageLimits(), warnings).codes;
  };
  EXPECT_EQ(codes("t.png"), codes("f1.png"));
}

TEST(Motion, WrongUsageIsTold) {
  const TemporaryFolder folder;
  const std::string moving = writeMoving(folder), f = folder / "f#.png";
  const auto refused = [](const std::vector<std::string>& words, const std::string& why) {
    const Outcome outcome = runWhit(words);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
  };

  refused({"render", moving, "-o", f, "--frames", "0..1", "--time", "1"}, "give one");
  refused({"render", moving, "-o", f, "--frames", "0..1", "--animation", "upp"},
          "did you mean 'up'?");
  std::ofstream(folder / "still.obj") << kTriangleObj;
  refused({"render", folder / "still.obj", "-o", folder / "m.png", "--time", "1"},
          "nothing moves in still");
  refused({"render", folder / "still.obj", "-o", f, "--frames", "0..1"}, "nothing moves in");
  refused({"render", moving, "-o", folder / "m.png", "--time", "soon"}, "--time");
}

}  // namespace
}  // namespace whit::cli
