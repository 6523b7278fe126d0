// --channels as users run it.
#include <gtest/gtest.h>

#include "command_json.h"
#include "has_text.h"
#include "io/image/image_file.h"
#include "io/image/image_layers.h"
#include "picture_file.h"
#include "run_command.h"

namespace whit::cli {
namespace {

namespace fs = std::filesystem;

const std::string kAll = "depth,position,normal,albedo,uv,object,material,triangle,rays";

class Channels : public TinySceneTest {
 protected:
  // A refused command writes nothing.
  void expectRefused(int status, const std::string& why, const Words& words) const {
    const auto count = [&] {
      return std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator());
    };
    const auto before = count();
    expectFailure(words, status, why);
    EXPECT_EQ(count(), before);
  }
};

TEST_F(Channels, AreBesideThePicture) {
  const std::string exr = folder_ / "a.exr";
  succeed({"render", tiny_, "-o", exr, "-o", folder_ / "a.png", "-o", folder_ / "a.depth.png", "-o",
           folder_ / "normal.png", "--channels", kAll, "--quiet"});
  succeed({"render", tiny_, "-o", folder_ / "plain.exr", "-o", folder_ / "plain.png", "--quiet"});

  EXPECT_EQ(readLayers(exr, ImageLimits()).size(), 17u);
  EXPECT_TRUE(readLayers(folder_ / "plain.exr", ImageLimits()).empty());
  // Channels change nothing in the pictures.
  EXPECT_EQ(readFile(folder_ / "a.png"), readFile(folder_ / "plain.png"));
  EXPECT_NE(readFile(folder_ / "a.depth.png"), readFile(folder_ / "plain.png"));

  EXPECT_EQ(metadataOf(exr).at("channels"), kAll);
  EXPECT_EQ(Json::parse(metadataOf(exr).at("objects")),
            (Json{{"0", "/scene/0"}, {"1", "/scene/1"}}));
  const Json materials = Json::parse(metadataOf(exr).at("materials"));

  // The numbers in the channels are those that whit info lists.
  const Outcome info = runWhit({"info", tiny_, "--json", "-"});
  const Json said = Json::parse(info.out);
  EXPECT_EQ(said["objects"], 2);
  EXPECT_EQ(said["object_names"], (Json{"/scene/0", "/scene/1"}));
  ASSERT_EQ(said["material_names"].size(), materials.size());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    EXPECT_EQ(said["material_names"][i], materials[std::to_string(i)]);
  }
}

// The name of an image asks for its channel. The gray EXR is what programs without knowledge of
// channels read; its values are those of the layers beside a picture.
TEST_F(Channels, AnImageNamedByOneHoldsItAlone) {
  succeed({"render", tiny_, "-o", folder_ / "a.png", "-o", folder_ / "a.depth.png", "-o",
           folder_ / "a.depth.exr", "-o", folder_ / "a.normal.exr", "-o", folder_ / "a.uv.exr",
           "-o", folder_ / "a.object.exr", "--quiet"});
  succeed({"render", tiny_, "-o", folder_ / "b.exr", "-o", folder_ / "b.depth.png", "--channels",
           "depth,normal,uv,object", "--quiet"});
  succeed({"render", tiny_, "-o", folder_ / "depth.png", "--quiet"});
  EXPECT_EQ(readFile(folder_ / "a.depth.png").size(), readFile(folder_ / "b.depth.png").size());
  EXPECT_EQ(readFile(folder_ / "depth.png").size(), readFile(folder_ / "a.png").size());

  const std::vector<ImageLayer> all = readLayers(folder_ / "b.exr", ImageLimits());
  const auto layer = [&](const std::string& name) {
    const auto found = std::ranges::find(all, name, &ImageLayer::name);
    return found->countsThings ? std::vector<float>(found->words.begin(), found->words.end())
                               : found->floats();
  };
  const auto expectColors = [&](const std::string& file, std::array<std::string, 3> names) {
    const Image image = readImage(folder_ / file, ImageLimits());
    for (std::size_t c = 0; c < 3; ++c) {
      if (names[c].empty()) continue;
      const std::vector<float> expected = layer(names[c]);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        const bool isNothing = names[c] == "object.id" && expected[i] > 1e9f;
        ASSERT_EQ(image.pixels[i][static_cast<int>(c)], isNothing ? -1 : expected[i])
            << file << " " << names[c] << " " << i;
      }
    }
  };
  expectColors("a.depth.exr", {"depth.Z", "depth.Z", "depth.Z"});
  expectColors("a.object.exr", {"object.id", "object.id", "object.id"});
  expectColors("a.normal.exr", {"normal.X", "normal.Y", "normal.Z"});
  expectColors("a.uv.exr", {"uv.U", "uv.V", ""});
}

// A frame's number may stand before the channel's name or behind it.
TEST_F(Channels, FramesHoldTheChannelTheyAreNamedBy) {
  const std::string model = folder_ / "model.obj";
  std::ofstream(model) << "v -1 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n";
  succeed({"render", tiny_, "--frames", "0..1", "-o", folder_ / "f##.depth.png", "-o",
           folder_ / "f##.depth.exr", "-o", folder_ / "g.depth.##.exr", "--quiet"});
  succeed({"turntable", model, "--count", "2", "--size", "24x16", "-o", folder_ / "tt.##.depth.exr",
           "--quiet"});

  for (const char* file : {"f01.depth.exr", "g.depth.01.exr", "tt.01.depth.exr"}) {
    EXPECT_EQ(metadataOf(folder_ / file).at("channel"), "depth") << file;
  }
  EXPECT_EQ(readFile(folder_ / "f01.depth.exr"), readFile(folder_ / "g.depth.01.exr"));
  constexpr std::size_t kDepthAt = 24, kColorTypeAt = 25;  // in the head of a PNG
  const std::string png = readFile(folder_ / "f01.depth.png");
  EXPECT_EQ(png.at(kDepthAt), 16);
  EXPECT_EQ(png.at(kColorTypeAt), 0) << "gray";
}

TEST_F(Channels, DepthsBeyondWhat16BitsHoldAreRefused) {
  expectRefused(5, "does not fit into 16 bits",
                {"render", tiny_, "-o", folder_ / "a.depth.png", "--channels", "depth", "--eye",
                 "0,100,0", "--at", "0,0,0.1", "--quiet"});
}

TEST_F(Channels, OfCropsAreMerged) {
  const auto part = [&](const std::string& name, const Words& more) {
    succeed(
        joined({"render", tiny_, "-o", folder_ / name, "--channels", kAll, "--spp", "2", "--quiet"},
               more));
  };

  part("whole.exr", {});
  part("left.exr", {"--crop", "0,0,20,32"});
  part("right.exr", {"--crop", "20,0,48,32"});
  succeed({"merge", folder_ / "merged.exr", folder_ / "left.exr", folder_ / "right.exr"});
  EXPECT_EQ(metadataOf(folder_ / "merged.exr").at("objects"),
            metadataOf(folder_ / "whole.exr").at("objects"));

  const Outcome compared = succeed({"compare", folder_ / "merged.exr", folder_ / "whole.exr",
                                    "--tolerance", "0", "--json", "-"});
  const Json channels = Json::parse(compared.out)["channels"];
  ASSERT_EQ(channels.size(), 17u);
  for (const Json& c : channels) EXPECT_EQ(c["pixels_differing"], 0) << c;

  // Parts must have the same channels.
  succeed({"render", tiny_, "-o", folder_ / "bare.exr", "--crop", "0,0,20,32", "--quiet"});
  expectRefused(2, "bare.exr: lacks the channel",
                {"merge", folder_ / "m.exr", folder_ / "bare.exr", folder_ / "right.exr"});
}

TEST_F(Channels, AreComparedExactly) {
  succeed({"render", tiny_, "-o", folder_ / "a.exr", "--channels", "depth,object", "--quiet"});
  succeed({"render", tiny_, "-o", folder_ / "b.exr", "--channels", "depth,object,normal", "--set",
           "/scene/1/transform/translate=[0,1,0.5]", "--quiet"});
  const Outcome outcome =
      succeed({"compare", folder_ / "a.exr", folder_ / "b.exr", "--json", folder_ / "c.json"});
  EXPECT_TRUE(hasText(outcome.out, "object.id"));
  const Json channels = Json::parse(readFile(folder_ / "c.json"))["channels"];
  ASSERT_EQ(channels.size(), 6u);  // the channels that both files have, and the others
  EXPECT_FALSE(channels[2].contains("only_in"));
  EXPECT_EQ(channels[5]["only_in"], "B");

  Warnings warnings;
  // The number of pixels that differ is counted once more by hand.
  const auto a = readLayers(folder_ / "a.exr", ImageLimits());
  const auto b = readLayers(folder_ / "b.exr", ImageLimits());
  std::size_t differing = 0;
  for (std::size_t i = 0; i < a[2].words.size(); ++i) {
    differing += a[2].words[i] != b[5].words[i];
  }
  EXPECT_GT(differing, 0u);

  EXPECT_EQ(channels[2]["channel"], "object.id");
  EXPECT_EQ(channels[2]["pixels_differing"], differing);
  EXPECT_FALSE(channels[2].contains("max"));
  // The ball is half a unit nearer.
  EXPECT_EQ(channels[0]["channel"], "depth.Z");
  EXPECT_GT(channels[0]["max"], 0.3);
  EXPECT_GT(channels[0]["rms"], 0.0);
}

TEST_F(Channels, OfBothModesAreCompared) {
  const Outcome outcome = succeed({"compare", tiny_, "--channels", "depth,object", "--json", "-"});
  const Json channels = Json::parse(outcome.out)["channels"];
  ASSERT_EQ(channels.size(), 3u);
  EXPECT_LT(channels[0]["max"], 1e-4);
  EXPECT_EQ(channels[2]["pixels_differing"], 0);
}

TEST_F(Channels, OfFramesAreThoseOfEachAlone) {
  const auto film = [&](const std::string& name, const std::string& frames) {
    succeed({"render", tiny_, "-o", folder_ / (name + "#.exr"), "-o",
             folder_ / (name + ".depth-#.png"), "--frames", frames, "--fps", "4", "--channels",
             kAll + ",roughness,metallic,motion", "--quiet"});
  };

  film("film", "0..3");
  film("alone", "2");
  EXPECT_EQ(readFile(folder_ / "film2.exr"), readFile(folder_ / "alone2.exr"));
  EXPECT_EQ(readFile(folder_ / "film.depth-2.png"), readFile(folder_ / "alone.depth-2.png"));
  EXPECT_NE(readFile(folder_ / "film.depth-2.png"), readFile(folder_ / "film.depth-1.png"));

  // An instant has the motion since the frame before it.
  succeed({"render", tiny_, "-o", folder_ / "instant.motion.exr", "--time", "0.5", "--fps", "4",
           "--quiet"});
  succeed({"render", tiny_, "-o", folder_ / "frame.motion-#.exr", "--frames", "2..2", "--fps", "4",
           "--quiet"});
  const auto motionsIn = [&](const std::string& file) {
    return readImage(folder_ / file, ImageLimits()).pixels;
  };
  EXPECT_EQ(motionsIn("instant.motion.exr"), motionsIn("frame.motion-2.exr"));
  const auto moves = [](const Rgb& motion) { return motion != Rgb(0.0f); };
  EXPECT_TRUE(std::ranges::any_of(motionsIn("instant.motion.exr"), moves));
}

// Eight pixels are a unit, and the ball moves by (0.5, -0.25) units a second.
TEST_F(Channels, MotionIsThatOfOneFrame) {
  std::ofstream(folder_ / "ball.json") << R"({"whit": 1, "size": [64, 64], "cameras": {"c":
    {"eye": [0, 0, 9], "at": [0, 0, 0], "orthographicHeight": 8}}, "ambient": {"color": 1}, "scene":
    [{"shape": "sphere", "motion": {"keys": [{"time": 0}, {"time": 4, "translate": [2, -1, 0]}]}}]})";
  succeed({"render", folder_ / "ball.json", "-o", folder_ / "a.motion.exr", "--time", "2", "--fps",
           "4", "--quiet"});

  const Image image = readImage(folder_ / "a.motion.exr", ImageLimits());
  const Rgb seen = image.at(32 + 8, 32 + 4), nothing = image.at(0, 0);
  constexpr double kRounding = 1e-5;  // of positions in float, in pixels
  EXPECT_NEAR(seen.x, 8 * 0.5 / 4, kRounding);
  EXPECT_NEAR(seen.y, 8 * 0.25 / 4, kRounding);
  EXPECT_EQ(nothing, Rgb(0.0f));
}

TEST_F(Channels, AreNamedInAnyCase) {
  for (const char* const name : {"a.depth.exr", "a.Depth.exr", "a.DEPTH.exr"}) {
    succeed({"render", tiny_, "-o", folder_ / name, "--quiet"});
    EXPECT_EQ(metadataOf(folder_ / name)["channel"], "depth") << name;
  }
}

TEST_F(Channels, ResumingAsksForTheSameOnes) {
  const auto kept = [&](const std::string& channels) {
    const Outcome outcome =
        succeed({"render", tiny_, "-o", folder_ / "a.exr", "-o", folder_ / "a.depth.png",
                 "--resume", "--channels", channels, "--json", "-"});
    return Json::parse(outcome.out)["kept"].get<int>();
  };

  EXPECT_EQ(kept("depth"), 0);
  EXPECT_EQ(kept("depth"), 1);
  EXPECT_EQ(kept("depth,object"), 0);
  EXPECT_EQ(kept("depth,object"), 1);
}

}  // namespace
}  // namespace whit::cli
