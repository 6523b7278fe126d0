// Films of a scene that moves: each frame follows from its time alone.
#include "io/gltf_files.h"
#include "run_command.h"

namespace whit::cli {
namespace {

// A triangle that rises, and one that shrinks away to nothing.
std::string movingModel() {
  GltfBuilder b;
  // The length of an animation is the largest of its times, as the file says.
  const std::string times = b.add<float>("SCALAR", {0, 2}, 0, ",'min':[0],'max':[2]");
  const std::string shown = primitive(b.positions(kTriangleXyz)),
                    up = b.positions({0, 0, 0, 0, 2, 0}), away = b.positions({1, 1, 1, 0, 0, 0});
  const auto channel = [](int i, const std::string& path) {
    return joined("{'sampler':", i, ",'target':{'node':", i, ",'path':'", path, "'}}");
  };
  const auto sampler = [&](const std::string& output) {
    return "{'input':" + times + ",'output':" + output + "}";
  };

  return asJson(b.json(joined("'meshes':[{'primitives':[", shown,
                              "]}],'nodes':[{'mesh':0},{'mesh':0,'translation':[2,0,0]}],"
                              "'animations':[{'name':'up','channels':[",
                              channel(0, "translation"), ",", channel(1, "scale"), "],'samplers':[",
                              sampler(up), ",", sampler(away), "]}]")));
}

class Motion : public TinySceneTest {
 protected:
  Motion() { save("moving.gltf", movingModel()); }
  std::vector<float> valuesOf(const std::string& name) const { return storedIn(name).values; }
};

TEST_F(Motion, AFrameIsTheSameAloneAndInAFilm) {
  const std::string line = "render moving.gltf --fps 2 --size 64x40 ";
  succeed(line + "-o film#.exr --frames 0..4 --threads 2");
  succeed(line + "-o alone#.exr --frames 3 --threads 1");
  succeed(line + "-o many#.exr --frames 3 --threads 8");
  const std::string third = bytesOf("film3.exr");
  EXPECT_NE(third, bytesOf("film2.exr"));
  EXPECT_TRUE(third == bytesOf("alone3.exr"));
  EXPECT_EQ(valuesOf("film3.exr"), valuesOf("many3.exr"));

  // The option --time gives the picture of the frame at that time.
  succeed(line + "-o instant.exr --exposure 0 --time 1.5");
  succeed(line + "-o frame#.exr --exposure 0 --frames 3");
  EXPECT_EQ(valuesOf("instant.exr"), valuesOf("frame3.exr"));
}

TEST_F(Motion, AShippedFilmHasTheSameFramesInParts) {
  const std::string line = "render orrery --size 32x20 ";
  succeed(line + "-o whole##.exr --frames 40..60 --threads 2");
  succeed(line + "-o one##.exr --frames 57 --threads 1");
  succeed(line + "-o eight##.exr --frames 57 --threads 8");
  EXPECT_NE(valuesOf("whole57.exr"), valuesOf("whole56.exr"));
  EXPECT_EQ(valuesOf("whole57.exr"), valuesOf("one57.exr"));
  EXPECT_EQ(valuesOf("whole57.exr"), valuesOf("eight57.exr"));
}

TEST_F(Motion, IsTimedAndListed) {
  EXPECT_TRUE(hasText(succeed("info moving.gltf").out, "animation   up: 2 s, moves 2 nodes\n"));
  EXPECT_EQ(jsonOf("info moving.gltf")["animations"],
            Json::parse(R"([{"name": "up", "seconds": 2, "nodes": 2}])"));

  const Outcome film =
      succeed("render moving.gltf -o f#.png --frames 0..1 --size 32x20 --stats --json f.json");
  EXPECT_TRUE(hasText(film.err, "updateScene"));
  EXPECT_GT(jsonIn("f.json")["updateScene_ms"], 0);
}

TEST_F(Motion, ACameraPathIsLookedAlongAtAnInstant) {
  succeed("render tiny.json -o t.png --time 0.5");
  succeed("render tiny.json -o f#.png --frames 1 --fps 2");
  EXPECT_EQ(storedIn("t.png").codes, storedIn("f1.png").codes);
}

TEST_F(Motion, WrongUsageIsTold) {
  expectFailure("render moving.gltf -o f#.png --frames 0..1 --animation upp", 2,
                "did you mean 'up'?");
  save("still.obj", kTriangleObj);
  expectFailure("render still.obj -o m.png --time 1", 2, "nothing moves in still");
}

}  // namespace
}  // namespace whit::cli
