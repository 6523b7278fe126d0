// A model far from the origin looks as it does at the origin, and all that is said of it is in
// coordinates of its file.
#include <gtest/gtest.h>

#include <array>
#include <iomanip>
#include <sstream>

#include "command_json.h"
#include "has_text.h"
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
  std::ostringstream text;
  text << std::setprecision(17) << R"({"asset": {"version": "2.0"}, "nodes": [{"translation": [)"
       << share * kAway[0] - 0.5 << ",0," << share * kAway[2]
       << R"(], "children": [1, 2]}, {"mesh": 0}, {"camera": 0, "translation": [0.5, 0.5, 4]}],
    "scenes": [{"nodes": [0]}], "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5}}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "animations": [{"samplers": [{"input": 1, "output": 0}],
      "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3,
      "min": [0, 0, 0], "max": [1, 1, 0]}, {"bufferView": 1, "componentType": 5126,
      "type": "SCALAR", "count": 3, "min": [0], "max": [2]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 12}],
    "buffers": [{"byteLength": 48, "uri": "data:application/octet-stream;base64,)"
       // (0, 0, 0), (1, 0, 0), (0, 1, 0); 0, 1, 2
       << R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAABA"}]})";
  return text.str();
}

struct Format {
  const char* extension;
  std::string (*text)(double share);
};
constexpr Format kFormats[] = {{"obj", objOf}, {"ply", plyOf}, {"gltf", gltfOf}};

class FarModels : public testing::Test {
 protected:
  std::string save(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  // The hash of the picture, and what was said.
  std::string hashOf(const Words& words, std::string* said = nullptr) const {
    const std::string json = folder_ / "report.json";
    const Outcome outcome = succeed(
        joined({"render", "--size", "96x64", "-o", folder_ / "p.exr", "--json", json}, words));
    if (said) *said = outcome.err;
    return Json::parse(readFile(json))["image_hash"];
  }
  // The rays of the pixel in the middle.
  Json explained(const Words& words) const {
    const Words all =
        joined({"explain", "--size", "96x64", "--pixel", "48,32", "--json", "-"}, words);
    return Json::parse(runWhit(all).out);
  }

  TemporaryFolder folder_;
};

const std::string kNote = "model far from the origin: origin moved by 4000000,0,500000";

TEST_F(FarModels, LookAsAtTheOrigin) {
  for (const auto& [extension, text] : kFormats) {
    for (const char* mode : {"packets", "reference"}) {
      const std::string there = save(std::string("far.") + extension, text(1));
      const std::string here = save(std::string("near.") + extension, text(0));
      std::string said, nothing;
      EXPECT_EQ(hashOf({there, "--mode", mode}, &said), hashOf({here, "--mode", mode}, &nothing))
          << extension << " " << mode;
      EXPECT_TRUE(hasText(said, kNote));
      EXPECT_FALSE(hasText(nothing, "far from the origin"));
    }
  }
}

TEST_F(FarModels, LookAsAtTheOriginWhileTheyMove) {
  const std::string there = save("far.gltf", gltfOf(1)), here = save("near.gltf", gltfOf(0));
  EXPECT_EQ(hashOf({there, "--time", "0.75"}), hashOf({here, "--time", "0.75"}));
  EXPECT_NE(hashOf({there, "--time", "0.75"}), hashOf({there}));
}

// A scene file says itself where its models are.
TEST_F(FarModels, LookAsAtTheOriginInScenesThatBringThemBack) {
  const auto scene = [](const std::string& item) {
    return R"({"whit": 1, "cameras": {"c": {"eye": [2, 2, 4], "at": [0, 0, 0]}},
      "lights": [{"position": [3, 6, 4], "intensity": 60}], "scene": [{"model": )" +
           item + "}]}";
  };
  for (const auto& [extension, text] : kFormats) {
    const std::string ending = std::string(".") + extension;
    save("far" + ending, text(1));
    save("near" + ending, text(0));
    std::string said;
    const std::string there =
        save("far.json",
             scene("\"far" + ending + R"(", "transform": {"translate": [-4000000, 0, -500000]})"));
    EXPECT_EQ(hashOf({there}, &said), hashOf({save("near.json", scene("\"near" + ending + "\""))}));
    EXPECT_FALSE(hasText(said, "far from the origin"));
  }
}

TEST_F(FarModels, AreSeenFromTheEyeInTheirFile) {
  const std::string there = save("far.obj", objOf(1)), here = save("near.obj", objOf(0));
  EXPECT_EQ(hashOf({there, "--eye", "4000000.5,2.25,500003", "--at", "4000000.125,0.5,500000"}),
            hashOf({here, "--eye", "0.5,2.25,3", "--at", "0.125,0.5,0"}));
}

TEST_F(FarModels, TakeCamerasInTheirFile) {
  const std::string there = save("far.obj", objOf(1)), here = save("near.obj", objOf(0));
  const std::string far = save("pose.json", R"({"eye": [4000000.5, 2.25, 500003],
                                               "at": [4000000.125, 0.5, 500000], "fov": 50})");
  const std::string near =
      R"(/cameras/c={"eye": [0.5, 2.25, 3], "at": [0.125, 0.5, 0], "fov": 50})";
  EXPECT_EQ(hashOf({there, "--camera", far}), hashOf({here, "--set", near, "--camera", "c"}));
}

TEST_F(FarModels, AreMeasuredInTheirFile) {
  const std::string there = save("far.obj", objOf(1)), here = save("near.obj", objOf(0));
  const auto info = [](const std::string& model) { return jsonOf({"info", model}); };
  EXPECT_EQ(info(there)["origin"], Json::parse("[4000000, 0, 500000]"));
  EXPECT_EQ(info(there)["bounds"]["lower"], Json::parse("[3999999, 0, 499999]"));
  EXPECT_EQ(info(here)["origin"], Json::parse("[0, 0, 0]"));
  EXPECT_TRUE(
      hasText(runWhit({"info", there}).out, "  origin      moved by [4000000.0,0.0,500000.0]\n"));
  EXPECT_FALSE(hasText(runWhit({"info", here}).out, "origin"));

  const auto numbers = [](const Json& json, double share) {
    auto three = json.get<std::array<double, 3>>();
    for (std::size_t i = 0; i < 3; ++i) three[i] -= share * kAway[i];
    return three;
  };
  const Json far = explained({there}), near = explained({here});
  for (const char* mode : {"packets", "reference"}) {
    const Json& a = far[mode]["samples"][0];
    const Json& b = near[mode]["samples"][0];
    // Numbers of millions have steps of 2^-31.
    constexpr double kStep = 0x1p-31;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(numbers(a["origin"], 1)[i], numbers(b["origin"], 0)[i], kStep);
      EXPECT_NEAR(numbers(a["surface"]["position"], 1)[i], numbers(b["surface"]["position"], 0)[i],
                  kStep);
    }

    // The channel is in single precision.
    hashOf({there, "--mode", mode, "--channels", "position"});
    for (const ImageLayer& layer : readLayers(folder_ / "p.exr", ImageLimits())) {
      if (!layer.name.starts_with("position.")) continue;
      const auto axis = static_cast<std::size_t>(layer.name.back() - 'X');
      const double position = a["surface"]["position"][axis];
      EXPECT_NEAR(layer.floats().at(32 * 96 + 48), position, 1e-4 + 0x1p-23 * position);
    }
  }
}

}  // namespace
}  // namespace whit::cli
