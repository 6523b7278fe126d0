// A model without a scene file: its sky, its exposure, and how the program reports them.
#include <gtest/gtest.h>

#include <map>

#include "command_json.h"
#include "has_text.h"
#include "picture_file.h"
#include "run_command.h"

namespace whit::cli {
namespace {

// A bent plate.
std::string writeModel(const TemporaryFolder& folder) {
  std::ofstream(folder / "model.obj") << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 1\nv 2 1 1\n"
                                         "f 1 2 3 4\nf 2 5 6 3\n";
  return folder / "model.obj";
}

class Models : public TinySceneTest {
 protected:
  std::vector<std::uint8_t> codesOf(const std::string& scene, const Words& more = {}) const {
    const std::string picture = folder_ / "codes.png";
    succeed(joined({"render", scene, "-o", picture, "--size", "48x30", "--quiet"}, more));
    return storedIn(picture).codes;
  }

  const std::string model_ = writeModel(folder_);
};

TEST_F(Models, InfoNamesTheSky) {
  const auto sky = [](const Words& more) {
    return jsonOf(joined({"info"}, more))["sky"].get<std::string>();
  };

  EXPECT_EQ(sky({model_}), "studio");
  EXPECT_EQ(sky({model_, "--sky", "none"}), "none");
  EXPECT_EQ(sky({tiny_}), "none");
  EXPECT_EQ(sky({tiny_, "--sky", "studio"}), "studio");
  const std::string said = runWhit({"info", model_}).out;
  EXPECT_TRUE(hasText(said, "sky         studio"));
  EXPECT_TRUE(hasText(said, "exposure auto (model)"));
}

// The triangle is black, except in the variant "glowing \"red\"".
TEST_F(Models, VariantsAreListedAndChosen) {
  const std::string model = folder_ / "variants.gltf", picture = folder_ / "p.png";
  std::ofstream(model) << R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0},
      "material": 0, "extensions": {"KHR_materials_variants": {"mappings": [
        {"material": 1, "variants": [1]}]}}}]}],
    "materials": [{"name": "dark", "emissiveFactor": [0, 0, 0]},
                  {"name": "red", "emissiveFactor": [1, 0, 0]}],
    "extensions": {"KHR_materials_variants": {"variants": [
      {"name": "plain"}, {"name": "glowing \"red\""}]}},
    "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3,
      "min": [0, 0, 0], "max": [1, 1, 0]}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";

  const Json listed = jsonOf({"info", model})["variants"];
  EXPECT_EQ(listed, Json::parse(R"(["plain", "glowing \"red\""])"));
  EXPECT_TRUE(hasText(runWhit({"info", model}).out, "variant     plain\n"));

  const auto effects = [&](const std::string& variant) {
    const Outcome info = runWhit({"info", model, "--variant", variant, "--json", "-"});
    return Json::parse(info.out)["effects"]["emission"]["on"].get<bool>();
  };
  EXPECT_FALSE(effects("plain"));
  EXPECT_TRUE(effects("glowing \"red\""));

  const Outcome refused = runWhit({"render", model, "-o", picture, "--variant", "blue"});
  EXPECT_NE(refused.status, 0);
  EXPECT_TRUE(hasText(refused.err, "/variant: expected one of \"plain\", \"glowing \"red\"\""));

  const Outcome ofScene = runWhit({"info", folder_ / "tiny.json", "--variant", "plain"});
  EXPECT_TRUE(hasText(ofScene.err,
                      "tiny.json#/variant: variants are those of glTF files: a scene states "
                      "one in the item of the model, as {\"model\": \"shoe.glb\", \"vari"));
}

TEST_F(Models, ThePictureTellsItsExposureAndIsMadeAgainWithIt) {
  const std::string a = folder_ / "a.png", b = folder_ / "b.png";

  const Outcome first = succeed({"render", model_, "-o", a, "--size", "48x30", "--json", "-"});
  const std::string ev = metadataOf(a).at("exposure");
  EXPECT_NE(ev, "auto");
  EXPECT_NE(ev, "0");
  EXPECT_EQ(metadataOf(a).at("terminator"), "on");
  EXPECT_EQ(Json::parse(first.out)["exposure_ev"].get<float>(), std::stof(ev));
  EXPECT_TRUE(hasText(first.err, "exposure "));
  EXPECT_FALSE(hasText(first.err, "exposure 0"));

  // The exposure that the first picture states makes the same picture.
  succeed({"render", model_, "-o", b, "--size", "48x30", "--quiet", "--exposure", ev,
           "--terminator", "on"});
  EXPECT_EQ(readFile(a), readFile(b));

  EXPECT_EQ(runWhit({"render", model_, "-o", a, "--quiet"}).err, "");
  EXPECT_EQ(metadataOf(a).at("exposure"), ev) << "of another size";
}

TEST_F(Models, ASceneFileCanShowOneAsTheCommandDoes) {
  const std::string scene = folder_ / "scene.json";
  const auto write = [&](const std::string& more) {
    std::ofstream(scene) << R"({"whit": 1, "view": "model", "scene": [{"model": "model.obj"}])"
                         << more << "}";
    return scene;
  };

  const auto shown = codesOf(model_);
  EXPECT_EQ(codesOf(write("")), shown);
  EXPECT_EQ(codesOf(scene, {"--sky", "none"}), codesOf(model_, {"--sky", "none"}));

  // The studio suits the lights, whether it is named or not.
  write(R"(, "lights": [{"position": [0, 9, 0], "intensity": 0.01}])");
  EXPECT_EQ(codesOf(scene, {"--sky", "studio"}), codesOf(scene));

  // What the file has is kept.
  const auto dark = codesOf(write(R"(, "options": {"exposure": -3})"));
  EXPECT_EQ(dark, codesOf(model_, {"--exposure", "-3"}));
  EXPECT_NE(dark, shown);
  for (const char* own : {R"("sky": {"color": [1, 0, 0]})", R"("ambient": {"color": [1, 0, 0]})",
                          R"("lights": [{"position": [0, 9, 0], "intensity": 50}])",
                          R"("cameras": {"near": {"eye": [0.5, 0.5, 1], "at": [0.5, 0.5, 0]}})"}) {
    const std::string members = std::string(", \"options\": {\"exposure\": 0}, ") + own;
    EXPECT_NE(codesOf(write(members)), codesOf(model_, {"--exposure", "0"})) << own;
  }

  std::ofstream(scene) << R"({"whit": 1, "view": "round", "scene": [{"model": "model.obj"}]})";
  expectFailure({"info", scene}, 3, "scene.json#/view: expected");
}

constexpr char kPose[] = R"({"eye": [0.5, 1.5, 4], "at": [0.8, 0.5, 0], "k": [40, 44, 23, 16],
                             "kSize": [48, 30], "distortion": [0.1, 0.02]})";

// One camera by three ways: a file of its own, a setting, and a scene file.
TEST_F(Models, TakeACameraFromAFile) {
  const std::string pose = folder_ / "pose.json";
  std::ofstream(pose) << kPose;
  std::ofstream(folder_ / "scene.json")
      << R"({"whit": 1, "view": "model", "scene": [{"model": "model.obj"}], "cameras": {"own": )"
      << kPose << "}}";

  const auto seen = codesOf(model_, {"--camera", pose});
  EXPECT_NE(seen, codesOf(model_));
  EXPECT_EQ(codesOf(model_, {"--camera", "mine", "--set", "/cameras/mine=" + std::string(kPose)}),
            seen);
  EXPECT_EQ(codesOf(folder_ / "scene.json"), seen);
  EXPECT_EQ(codesOf(tiny_, {"--camera", pose, "--set", "/cameras/pose/k=[9,9,9,9]"}).size(),
            seen.size())
      << "a scene takes one as well";

  std::ofstream(pose) << R"({"eye": [0, 0, 1], "at": [0, 0, 0], "lens": 3})";
  expectFailure({"info", model_, "--camera", pose}, 3, "pose.json#/lens: ");
  std::ofstream(pose)
      << R"({"eye": [0, 0, 1], "at": [0, 0, 0], "motion": {"keys": [{"time": "soon"}]}})";
  expectFailure({"info", model_, "--camera", pose}, 3, "pose.json#/motion/keys/0/time: ");
  std::ofstream(pose)
      << R"({"eye": [0, 0, 1], "at": [0, 0, 0], "lens": 3, "motion": {"keys": [{"time": 0}]}})";
  expectFailure({"info", model_, "--camera", pose}, 3, "pose.json#/lens: ");
  std::ofstream(pose) << "{\n\"eye\" [";
  expectFailure({"info", model_, "--camera", pose}, 3, "pose.json:2");
  EXPECT_EQ(runWhit({"info", model_, "--camera", folder_ / "none.json"}).status, 4);
}

TEST_F(Models, TheirCamerasHaveMembersToSet) {
  const auto cameras = jsonOf({"info", model_})["cameras"];
  ASSERT_EQ(cameras.size(), 1u);
  const std::string pointer = "/cameras/" + cameras[0].get<std::string>();
  const auto narrow = codesOf(model_, {"--set", pointer + "/fov=20"});
  EXPECT_EQ(narrow, codesOf(model_, {"--fov", "20"}));
  EXPECT_NE(narrow, codesOf(model_));

  // An orthographic camera becomes perspective.
  const std::string parallel = pointer + "/orthographicHeight=3";
  EXPECT_EQ(narrow, codesOf(model_, {"--set", parallel, "--fov", "20", "--ortho", "0"}));
}

TEST_F(Models, ACropIsExposedAsTheWhole) {
  const auto codes = [&](const std::string& scene, const Words& more) {
    succeed(joined(
        {"render", scene, "-o", folder_ / "x.png", "--size", "40x25", "--exposure", "auto"}, more));
    return storedIn(folder_ / "x.png").codes;
  };

  for (const std::string& scene : {model_, tiny_}) {
    const auto whole = codes(scene, {}), corner = codes(scene, {"--crop", "0,0,40,3"});
    // The crop holds the first rows, so its codes are the first of the whole picture.
    ASSERT_GE(whole.size(), corner.size());
    EXPECT_TRUE(std::equal(corner.begin(), corner.end(), whole.begin())) << scene;
  }
}

TEST_F(Models, FramesOfAPathAreExposedAlike) {
  succeed({"render", tiny_, "-o", folder_ / "f#.png", "--frames", "0..1", "--fps", "1",
           "--exposure", "auto", "--quiet"});

  const std::string ev = metadataOf(folder_ / "f0.png").at("exposure");
  EXPECT_EQ(metadataOf(folder_ / "f1.png").at("exposure"), ev);
  succeed({"render", tiny_, "-o", folder_ / "g#.png", "--frames", "1", "--fps", "1", "--exposure",
           "auto", "--quiet"});
  EXPECT_EQ(readFile(folder_ / "g1.png"), readFile(folder_ / "f1.png"));
}

TEST_F(Models, TheSkyAskedForIsKeptInThePicture) {
  const std::string a = folder_ / "a.png";
  succeed({"render", tiny_, "-o", a, "--sky", "studio", "--quiet"});
  EXPECT_EQ(metadataOf(a).at("sky"), "studio");
  EXPECT_EQ(metadataOf(a).at("exposure"), "0") << "a scene file";

  succeed({"render", tiny_, "-o", a, "--quiet"});
  EXPECT_EQ(metadataOf(a).count("sky"), 0u);
}

TEST_F(Models, AreCompared) { succeed({"compare", model_, "--size", "24x16", "--quiet"}); }

}  // namespace
}  // namespace whit::cli
