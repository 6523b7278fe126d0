// --channels as users run it.
#include "io/image/image_layers.h"
#include "run_command.h"

namespace whit::cli {
namespace {

const std::string kAll = "depth,position,normal,albedo,uv,object,material,triangle,rays";

class Channels : public TinySceneTest {
 protected:
  std::vector<ImageLayer> layersOf(const std::string& name) const {
    return readLayers(folder_ / name, ImageLimits());
  }
};

TEST_F(Channels, AreBesideThePicture) {
  succeed("render tiny.json -o a.exr -o a.png -o a.depth.png -o normal.png --channels " + kAll);
  succeed("render tiny.json -o plain.exr");

  EXPECT_EQ(layersOf("a.exr").size(), 17u);
  EXPECT_TRUE(layersOf("plain.exr").empty());

  auto metadata = metadataOf("a.exr");
  EXPECT_EQ(metadata["channels"], kAll);
  EXPECT_EQ(Json::parse(metadata["objects"]), (Json{{"0", "/scene/0"}, {"1", "/scene/1"}}));
  const Json materials = Json::parse(metadata["materials"]);

  // The numbers in the channels are those that whit info lists.
  const Json said = jsonOf("info tiny.json");
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
  succeed(
      "render tiny.json -o a.png -o a.depth.png -o a.depth.exr -o a.normal.exr -o a.uv.exr "
      "-o a.object.exr");
  succeed("render tiny.json -o b.exr -o b.depth.png --channels depth,normal,uv,object");
  succeed("render tiny.json -o depth.png");
  EXPECT_EQ(bytesOf("a.depth.png").size(), bytesOf("b.depth.png").size());
  EXPECT_EQ(bytesOf("depth.png").size(), bytesOf("a.png").size());

  const std::vector<ImageLayer> all = layersOf("b.exr");
  const auto layer = [&](const std::string& name) {
    const auto found = std::ranges::find(all, name, &ImageLayer::name);
    return found->countsThings ? std::vector<float>(found->words.begin(), found->words.end())
                               : found->floats();
  };
  const auto expectColors = [&](const std::string& file, const Words& names) {
    const Image image = imageIn(file);
    for (std::size_t c = 0; c < names.size(); ++c) {
      const std::vector<float> expected = layer(names[c]);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        const bool isNothing = names[c] == "object.id" && expected[i] > 1e9f;
        ASSERT_EQ(image.pixels[i][static_cast<int>(c)], isNothing ? -1 : expected[i])
            << file << " " << names[c] << " " << i;
      }
    }
  };
  expectColors("a.depth.exr", Words(3, "depth.Z"));
  expectColors("a.object.exr", Words(3, "object.id"));
  expectColors("a.normal.exr", {"normal.X", "normal.Y", "normal.Z"});
  expectColors("a.uv.exr", {"uv.U", "uv.V"});
}

// A frame's number may stand before the channel's name or behind it.
TEST_F(Channels, FramesHoldTheChannelTheyAreNamedBy) {
  save("model.obj", "v -1 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
  succeed("render tiny.json --frames 0..1 -o f##.depth.png -o f##.depth.exr -o g.depth.##.exr");
  succeed("turntable model.obj --count 2 --size 24x16 -o tt.##.depth.exr");

  for (const char* file : {"f01.depth.exr", "g.depth.01.exr", "tt.01.depth.exr"}) {
    EXPECT_EQ(metadataOf(file)["channel"], "depth") << file;
  }
  EXPECT_EQ(bytesOf("f01.depth.exr"), bytesOf("g.depth.01.exr"));
  constexpr std::size_t kDepthAt = 24, kColorTypeAt = 25;  // in the head of a PNG
  const std::string png = bytesOf("f01.depth.png");
  EXPECT_EQ(png.at(kDepthAt), 16);
  EXPECT_EQ(png.at(kColorTypeAt), 0) << "gray";
}

TEST_F(Channels, DepthsBeyondWhat16BitsHoldAreRefused) {
  expectFailure("render tiny.json -o a.depth.png --eye 0,100,0 --at 0,0,0.1", 5,
                "does not fit into 16 bits");
  EXPECT_FALSE(exists("a.depth.png"));
}

TEST_F(Channels, OfCropsAreMerged) {
  const auto part = [&](const std::string& words) {
    succeed("render tiny.json --spp 2 --channels " + kAll + " -o " + words);
  };

  part("whole.exr");
  part("left.exr --crop 0,0,20,32");
  part("top.exr --crop 20,0,48,10");
  part("rest.exr --crop 20,10,48,32");
  succeed("merge merged.exr left.exr top.exr rest.exr");
  EXPECT_EQ(metadataOf("merged.exr")["objects"], metadataOf("whole.exr")["objects"]);

  const Json channels = jsonOf("compare merged.exr whole.exr --tolerance 0")["channels"];
  ASSERT_EQ(channels.size(), 17u);
  for (const Json& c : channels) EXPECT_EQ(c["pixels_differing"], 0) << c;

  // What mergeImages() refuses leaves no file.
  expectFailure("merge m.exr left.exr top.exr", 2, "open");
  EXPECT_FALSE(exists("m.exr"));
}

TEST_F(Channels, AreComparedExactly) {
  succeed("render tiny.json -o a.exr --channels depth,object");
  succeed(
      "render tiny.json -o b.exr --channels depth,object,normal "
      "--set /scene/1/transform/translate=[0,1,0.5]");
  EXPECT_TRUE(hasText(succeed("compare a.exr b.exr --json c.json").out, "object.id"));
  const Json channels = jsonIn("c.json")["channels"];
  ASSERT_EQ(channels.size(), 6u);  // the channels that both files have, and the others
  EXPECT_FALSE(channels[2].contains("only_in"));
  EXPECT_EQ(channels[5]["only_in"], "B");

  // The number of pixels that differ is counted once more by hand.
  const auto a = layersOf("a.exr")[2].words, b = layersOf("b.exr")[5].words;
  std::size_t differing = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differing += a[i] != b[i];
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
  const Json channels = jsonOf("compare tiny.json --channels depth,object")["channels"];
  ASSERT_EQ(channels.size(), 3u);
  EXPECT_LT(channels[0]["max"], 1e-4);
  EXPECT_EQ(channels[2]["pixels_differing"], 0);
}

TEST_F(Channels, OfFramesAreThoseOfEachAlone) {
  const auto film = [&](const std::string& words) {
    succeed("render tiny.json --fps 4 --channels " + kAll + ",roughness,metallic,motion " + words);
  };

  film("-o film#.exr -o film.depth-#.png --frames 0..3");
  film("-o alone#.exr -o alone.depth-#.png --frames 2");
  EXPECT_EQ(bytesOf("film2.exr"), bytesOf("alone2.exr"));
  EXPECT_EQ(bytesOf("film.depth-2.png"), bytesOf("alone.depth-2.png"));
  EXPECT_NE(bytesOf("film.depth-2.png"), bytesOf("film.depth-1.png"));

  // An instant has the motion since the frame before it.
  succeed("render tiny.json --fps 4 -o instant.motion.exr --time 0.5");
  succeed("render tiny.json --fps 4 -o frame.motion-#.exr --frames 2..2");
  const auto motions = imageIn("instant.motion.exr").pixels;
  EXPECT_EQ(motions, imageIn("frame.motion-2.exr").pixels);
  EXPECT_TRUE(std::ranges::any_of(motions, [](const Rgb& m) { return m != Rgb(0.0f); }));
}

// Eight pixels are a unit, and the ball moves by (0.5, -0.25) units a second.
TEST_F(Channels, MotionIsThatOfOneFrame) {
  save("ball.json",
       "{'whit': 1, 'size': [64, 64], 'ambient': {'color': 1}, 'cameras': {'c':"
       "{'eye': [0, 0, 9], 'at': [0, 0, 0], 'orthographicHeight': 8}}, 'scene': [{'shape':"
       "'sphere', 'motion': {'keys': [{'time': 0}, {'time': 4, 'translate': [2, -1, 0]}]}}]}");
  succeed("render ball.json -o a.motion.exr --time 2 --fps 4");

  const Image image = imageIn("a.motion.exr");
  const Rgb seen = image.at(32 + 8, 32 + 4);
  constexpr double kRounding = 1e-5;  // of positions in float, in pixels
  EXPECT_NEAR(seen.x, 8 * 0.5 / 4, kRounding);
  EXPECT_NEAR(seen.y, 8 * 0.25 / 4, kRounding);
  EXPECT_EQ(image.at(0, 0), Rgb(0.0f));
}

TEST_F(Channels, AreNamedInAnyCase) {
  for (const std::string name : {"a.depth.exr", "a.Depth.exr", "a.DEPTH.exr"}) {
    succeed("render tiny.json -o " + name);
    EXPECT_EQ(metadataOf(name)["channel"], "depth") << name;
  }
}

TEST_F(Channels, ResumingAsksForTheSameOnes) {
  const auto kept = [&](const std::string& channels) {
    return jsonOf("render tiny.json -o a.exr -o a.depth.png --resume --channels " +
                  channels)["kept"]
        .get<int>();
  };

  EXPECT_EQ(kept("depth"), 0);
  EXPECT_EQ(kept("depth"), 1);
  EXPECT_EQ(kept("depth,object"), 0);
  EXPECT_EQ(kept("depth,object"), 1);
}

}  // namespace
}  // namespace whit::cli
