// Films of a scene that moves: each frame follows from its time alone.
#include "core/text.h"
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
  struct Film {
    std::string scene, frames;
    int frame;
  };
  for (const Film& film : {Film{"moving.gltf --fps 2 --size 64x40", "0..4", 3},
                           Film{"orrery --size 32x20", "40..60", 57}}) {
    SCOPED_TRACE(film.scene);
    const std::string line = "render " + film.scene, at = std::to_string(film.frame);
    succeed(line + " -o film#.exr --threads 2 --frames " + film.frames);
    succeed(line + " -o alone#.exr --threads 1 --frames " + at);
    succeed(line + " -o many#.exr --threads 8 --frames " + at);

    const std::string whole = bytesOf("film" + at + ".exr");
    EXPECT_NE(valuesOf("film" + at + ".exr"), valuesOf(formatted("film%d.exr", film.frame - 1)));
    EXPECT_TRUE(whole == bytesOf("alone" + at + ".exr"));
    EXPECT_EQ(valuesOf("film" + at + ".exr"), valuesOf("many" + at + ".exr"));
  }
}

// The option --time gives the picture of the frame at that time, of a path of the camera as well.
TEST_F(Motion, AnInstantIsTheFrameAtItsTime) {
  for (const std::string scene : {"moving.gltf", "tiny.json", "orrery"}) {
    const std::string line = "render " + scene + " --fps 2 --size 64x40 --exposure 0 ";
    succeed(line + "-o instant.exr --time 0.5");
    succeed(line + "-o frame#.exr --frames 1");
    EXPECT_EQ(valuesOf("instant.exr"), valuesOf("frame1.exr")) << scene;
  }
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

TEST_F(Motion, WrongUsageIsTold) {
  expectFailure("render moving.gltf -o f#.png --frames 0..1 --animation upp", 2,
                "did you mean 'up'?");
  save("still.obj", kTriangleObj);
  expectFailure("render still.obj -o m.png --time 1", 2, "nothing moves in still");
}

}  // namespace
}  // namespace whit::cli
