// Films of a scene that moves: each frame follows from its time alone.
#include "core/text.h"
#include "io/gltf_files.h"
#include "run_command.h"

namespace whit::cli {
namespace {

// A triangle that rises, and one that shrinks away to nothing.
std::string movingModel() {
  GltfBuilder b;
  const std::string up = b.animation(
      {{"translation", {0, 2}, {0, 0, 0, 0, 2, 0}}, {"scale", {0, 2}, {1, 1, 1, 0, 0, 0}, 1}});
  return b.json("'meshes':[{'primitives':[" + primitive(b.positions(kTriangleXyz)) +
                "]}],'nodes':[{'mesh':0},{'mesh':0,'translation':[2,0,0]}]" +
                b.played(b.named("up", up)));
}

class Motion : public TinySceneTest {
 protected:
  Motion() { save("moving.gltf", movingModel()); }
  std::vector<float> valuesOf(const std::string& name) const { return storedIn(name).values; }
};

TEST_F(Motion, AFrameIsTheSameAloneAndInAFilm) {
  struct Film {
    std::string line, frames;
    int frame;
  };
  for (const Film& film : {Film{"render moving.gltf --fps 2 --size 64x40", "0..4", 3},
                           Film{"render orrery --size 32x20", "40..60", 57},
                           Film{"turntable moving.gltf --count 5 --size 24x16", "0..4", 1}}) {
    SCOPED_TRACE(film.line);
    const std::string at = std::to_string(film.frame);
    succeed(film.line + " -o film#.exr --threads 2 --frames " + film.frames);
    succeed(film.line + " -o alone#.exr --threads 1 --frames " + at);
    succeed(film.line + " -o many#.exr --threads 8 --frames " + at);

    const std::string whole = bytesOf("film" + at + ".exr");
    EXPECT_NE(valuesOf("film" + at + ".exr"), valuesOf(formatted("film%d.exr", film.frame - 1)));
    EXPECT_TRUE(whole == bytesOf("alone" + at + ".exr"));
    EXPECT_FALSE(exists(formatted("alone%d.exr", film.frame - 1)));
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
            Json::parse(asJson("[{'name': 'up', 'seconds': 2, 'nodes': 2}]")));

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
