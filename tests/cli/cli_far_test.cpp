// A model far from the origin looks as it does at the origin, and all that is said of it is in
// coordinates of its file.
#include <array>
#include <iomanip>
#include <sstream>

#include "io/gltf_files.h"
#include "io/image/image_layers.h"
#include "run_command.h"

namespace whit::cli {
namespace {

// A power of two divides it, and so the origin, as the program rounds it, is here.
constexpr std::array<double, 3> kAway{4'000'000, 0, 500'000};

// A roof, two of whose corners are lower than the others: sixteenths, which are exact wherever the
// roof is.
constexpr std::array<std::array<double, 3>, 6> kRoof{
    {{-1, 0.0625, -1}, {1, 0, -1}, {1, 0.6875, 0.0625}, {-1, 0.75, 0}, {1, 0, 1}, {-1, 0, 1}}};

std::string corners(const std::string& before, double share) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(4);
  for (const auto& corner : kRoof) {
    text << before;
    for (std::size_t i = 0; i < 3; ++i) text << (corner[i] + share * kAway[i]) << ' ';
    text << '\n';
  }
  return text.str();
}

// `share` of kAway.
std::string objOf(double share) { return corners("v ", share) + "f 3 2 1\nf 4 3 1\nf 6 5 3 4\n"; }
std::string plyOf(double share) {
  return "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\n"
         "property double z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n" +
         corners("", share) + "3 2 1 0\n3 3 2 0\n4 5 4 2 3\n";
}

// A triangle that sways, seen by a camera of its own.
std::string gltfOf(double share) {
  GltfBuilder b;
  return b.json(joined(
      "'nodes':[{'translation':[", share * kAway[0] - 0.5, ",0,", share * kAway[2],
      "],'children':[1,2]},{'mesh':0},{'camera':0,'translation':[0.5,0.5,4]}],'scenes':[{'nodes':"
      "[0]}],'cameras':[{'type':'perspective','perspective':{'yfov':0.5}}],'meshes':[{"
      "'primitives':[",
      primitive(b.positions(kTriangleXyz)), "]}]",
      b.played(b.animation("translation", {0, 1, 2}, kTriangleXyz, 1))));
}

struct Format {
  const char* extension;
  std::string (*text)(double share);
};
constexpr Format kFormats[] = {{"obj", objOf}, {"ply", plyOf}, {"gltf", gltfOf}};

const std::string kNote = "far from the origin: origin moved by 4000000,0,500000";

class FarModels : public TinySceneTest {
 protected:
  FarModels() {
    for (const auto& [extension, text] : kFormats) {
      save(std::string("far.") + extension, text(1));
      save(std::string("near.") + extension, text(0));
    }
  }

  // Renders, expects that the origin is moved for models far from it alone, and returns the hash.
  Json hashOf(const std::string& line, bool isMoved) const {
    const Outcome outcome =
        succeed("render --size 48x32 -o p.exr --json report.json --channels position " + line);
    EXPECT_EQ(hasText(outcome.err, isMoved ? kNote : "far from the origin"), isMoved)
        << line << outcome.err;
    return jsonIn("report.json")["image_hash"];
  }
  void expectAlike(const std::string& far, const std::string& near) const {
    EXPECT_EQ(hashOf(far, true), hashOf(near, false)) << far;
  }
};

TEST_F(FarModels, LookAsAtTheOrigin) {
  for (const Format& format : kFormats) {
    for (const std::string mode : {" --mode packets", " --mode reference"}) {
      const std::string words = format.extension + mode;
      expectAlike("far." + words, "near." + words);
    }
  }

  // While they move, too.
  expectAlike("far.gltf --time 0.75", "near.gltf --time 0.75");
  EXPECT_NE(hashOf("far.gltf --time 0.75", true), hashOf("far.gltf", true));
}

// A scene file says itself where its models are.
TEST_F(FarModels, LookAsAtTheOriginInScenesThatBringThemBack) {
  const auto scene = [](const std::string& item) {
    return "{'whit': 1, 'cameras': {'c': {'eye': [2, 2, 4], 'at': [0, 0, 0]}},"
           "'lights': [{'position': [3, 6, 4], 'intensity': 60}], 'scene': [{'model': " +
           item + "}]}";
  };
  for (const Format& format : kFormats) {
    const std::string ending = std::string(".") + format.extension + "'";
    save("far.json",
         scene("'far" + ending + ", 'transform': {'translate': [-4000000, 0, -500000]}"));
    save("near.json", scene("'near" + ending));
    EXPECT_EQ(hashOf("far.json", false), hashOf("near.json", false));
  }
}

// The eye, the target and cameras are in the coordinates of the file.
TEST_F(FarModels, AreSeenFromTheEyeInTheirFile) {
  expectAlike("far.obj --eye 4000000.5,2.25,500003 --at 4000000.125,0.5,500000",
              "near.obj --eye 0.5,2.25,3 --at 0.125,0.5,0");

  save("pose.json",
       "{'eye': [4000000.5, 2.25, 500003], 'at': [4000000.125, 0.5, 500000], 'fov': 50}");
  expectAlike(
      "far.obj --camera pose.json",
      R"(near.obj --camera c --set /cameras/c={"eye":[0.5,2.25,3],"at":[0.125,0.5,0],"fov":50})");
}

TEST_F(FarModels, AreMeasuredInTheirFile) {
  const Json info = jsonOf("info far.obj");
  EXPECT_EQ(info["origin"], Json({4000000, 0, 500000}));
  EXPECT_EQ(info["bounds"]["lower"], Json({3999999, 0, 499999}));
  EXPECT_EQ(jsonOf("info near.obj")["origin"], Json({0, 0, 0}));
  EXPECT_TRUE(
      hasText(succeed("info far.obj").out, "  origin      moved by [4000000.0,0.0,500000.0]\n"));
  EXPECT_FALSE(hasText(succeed("info near.obj").out, "origin"));

  // The rays of the pixel in the middle.
  const Json far = jsonOf("explain far.obj --size 48x32 --pixel 24,16");
  const Json near = jsonOf("explain near.obj --size 48x32 --pixel 24,16");
  for (const std::string mode : {"packets", "reference"}) {
    const Json &a = far[mode]["samples"][0], &b = near[mode]["samples"][0];
    hashOf("far.obj --mode " + mode, true);
    const std::vector<ImageLayer> layers = readLayers(folder_ / "p.exr", ImageLimits());

    for (std::size_t i = 0; i < 3; ++i) {
      // Numbers of millions have steps of 2^-31.
      const auto expectFar = [&](const Json& there, const Json& here) {
        EXPECT_NEAR(there[i].get<double>() - kAway[i], here[i].get<double>(), 0x1p-31);
      };
      expectFar(a["origin"], b["origin"]);
      expectFar(a["surface"]["position"], b["surface"]["position"]);

      // The channel is in single precision.
      const std::string name = std::string("position.") + "XYZ"[i];
      const auto layer = std::ranges::find(layers, name, &ImageLayer::name);
      ASSERT_NE(layer, layers.end()) << name;
      const double position = a["surface"]["position"][i];
      EXPECT_NEAR(layer->floats().at(16 * 48 + 24), position, 1e-4 + 0x1p-23 * position);
    }
  }
}

}  // namespace
}  // namespace whit::cli
