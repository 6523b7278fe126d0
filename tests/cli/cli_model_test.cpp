// A model without a scene file: its sky, its exposure, and how the program reports them.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "io/image/image_file.h"
#include "run_program.h"

namespace whit::cli {
namespace {

// A bent plate.
std::string writeModel(const TemporaryFolder& folder) {
  std::ofstream(folder / "model.obj") << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 1\nv 2 1 1\n"
                                         "f 1 2 3 4\nf 2 5 6 3\n";
  return folder / "model.obj";
}

std::map<std::string, std::string> saidIn(const std::string& path) {
  std::map<std::string, std::string> said;
  for (const auto& [name, text] : readPngMetadata(path)) said[name] = text;
  return said;
}

TEST(Models, InfoNamesTheSky) {
  const TemporaryFolder folder;
  const std::string model = writeModel(folder), tiny = writeTinyScene(folder);
  const auto sky = [](std::vector<std::string> words) {
    words.insert(words.begin(), "info");
    words.insert(words.end(), {"--json", "-"});
    return nlohmann::json::parse(runWhit(words).out)["sky"].get<std::string>();
  };

  EXPECT_EQ(sky({model}), "studio");
  EXPECT_EQ(sky({model, "--sky", "none"}), "none");
  EXPECT_EQ(sky({tiny}), "none");
  EXPECT_EQ(sky({tiny, "--sky", "studio"}), "studio");
  const std::string said = runWhit({"info", model}).out;
  EXPECT_NE(said.find("sky         studio"), std::string::npos);
  EXPECT_NE(said.find("exposure auto (model)"), std::string::npos) << said;
}

// The triangle is black, except in the variant "glowing \"red\"".
TEST(Models, VariantsAreListedAndChosen) {
  const TemporaryFolder folder;
  const std::string model = folder / "variants.gltf", picture = folder / "p.png";
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

  const nlohmann::json listed =
      nlohmann::json::parse(runWhit({"info", model, "--json", "-"}).out)["variants"];
  EXPECT_EQ(listed, nlohmann::json::parse(R"(["plain", "glowing \"red\""])"));
  EXPECT_NE(runWhit({"info", model}).out.find("variant     plain\n"), std::string::npos);

  const auto effects = [&](const std::string& variant) {
    const Outcome info = runWhit({"info", model, "--variant", variant, "--json", "-"});
    return nlohmann::json::parse(info.out)["effects"]["emission"]["on"].get<bool>();
  };
  EXPECT_FALSE(effects("plain"));
  EXPECT_TRUE(effects("glowing \"red\""));

  const Outcome refused = runWhit({"render", model, "-o", picture, "--variant", "blue"});
  EXPECT_NE(refused.status, 0);
  EXPECT_NE(refused.err.find("/variant: expected one of \"plain\", \"glowing \"red\"\""),
            std::string::npos)
      << refused.err;

  writeTinyScene(folder);
  const Outcome ofScene = runWhit({"info", folder / "tiny.json", "--variant", "plain"});
  EXPECT_NE(ofScene.err.find("tiny.json#/variant: variants are those of glTF files: a scene states "
                             "one in the item of the model, as {\"model\": \"shoe.glb\", \"vari"),
            std::string::npos)
      << ofScene.err;
}

TEST(Models, ThePictureTellsItsExposureAndIsMadeAgainWithIt) {
  const TemporaryFolder folder;
  const std::string model = writeModel(folder), a = folder / "a.png", b = folder / "b.png";

  const Outcome first = runWhit({"render", model, "-o", a, "--size", "48x30", "--json", "-"});
  ASSERT_EQ(first.status, 0) << first.err;
  const std::string ev = saidIn(a).at("exposure");
  EXPECT_NE(ev, "auto");
  EXPECT_NE(ev, "0");
  EXPECT_EQ(saidIn(a).at("terminator"), "on");
  EXPECT_EQ(nlohmann::json::parse(first.out)["exposure_ev"].get<float>(), std::stof(ev));
  EXPECT_NE(first.err.find("exposure "), std::string::npos);
  EXPECT_EQ(first.err.find("exposure 0"), std::string::npos);

  // The exposure that the first picture states makes the same picture.
  ASSERT_EQ(runWhit({"render", model, "-o", b, "--size", "48x30", "--quiet", "--exposure", ev,
                     "--terminator", "on"})
                .status,
            0);
  EXPECT_EQ(readFile(a), readFile(b));

  EXPECT_EQ(runWhit({"render", model, "-o", a, "--quiet"}).err, "");
  EXPECT_EQ(saidIn(a).at("exposure"), ev) << "of another size";
}

std::vector<std::uint8_t> codesOf(const std::string& scene, std::vector<std::string> more,
                                  const TemporaryFolder& folder) {
  const std::string picture = folder / "codes.png";
  std::vector<std::string> words{"render", scene, "-o", picture, "--size", "48x30", "--quiet"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = runWhit(words);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  Warnings warnings;
  return readRawImage(picture, ImageLimits(), warnings).codes;
}

TEST(Models, ASceneFileCanShowOneAsTheCommandDoes) {
  const TemporaryFolder folder;
  const std::string model = writeModel(folder), scene = folder / "scene.json";
  const auto write = [&](const std::string& more) {
    std::ofstream(scene) << R"({"whit": 1, "view": "model", "scene": [{"model": "model.obj"}])"
                         << more << "}";
    return scene;
  };

  const auto shown = codesOf(model, {}, folder);
  EXPECT_EQ(codesOf(write(""), {}, folder), shown);
  EXPECT_EQ(codesOf(scene, {"--sky", "none"}, folder), codesOf(model, {"--sky", "none"}, folder));

  // The studio suits the lights, whether it is named or not.
  write(R"(, "lights": [{"position": [0, 9, 0], "intensity": 0.01}])");
  EXPECT_EQ(codesOf(scene, {"--sky", "studio"}, folder), codesOf(scene, {}, folder));

  // What the file has is kept.
  const auto dark = codesOf(write(R"(, "options": {"exposure": -3})"), {}, folder);
  EXPECT_EQ(dark, codesOf(model, {"--exposure", "-3"}, folder));
  EXPECT_NE(dark, shown);
  for (const char* own : {R"("sky": {"color": [1, 0, 0]})", R"("ambient": {"color": [1, 0, 0]})",
                          R"("lights": [{"position": [0, 9, 0], "intensity": 50}])",
                          R"("cameras": {"near": {"eye": [0.5, 0.5, 1], "at": [0.5, 0.5, 0]}})"}) {
    const std::string members = std::string(", \"options\": {\"exposure\": 0}, ") + own;
    EXPECT_NE(codesOf(write(members), {}, folder), codesOf(model, {"--exposure", "0"}, folder))
        << own;
  }

  std::ofstream(scene) << R"({"whit": 1, "view": "round", "scene": [{"model": "model.obj"}]})";
  const Outcome refused = runWhit({"info", scene});
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("scene.json#/view: expected"), std::string::npos) << refused.err;
}

constexpr char kPose[] = R"({"eye": [0.5, 1.5, 4], "at": [0.8, 0.5, 0], "k": [40, 44, 23, 16],
                             "kSize": [48, 30], "distortion": [0.1, 0.02]})";

// One camera by three ways: a file of its own, a setting, and a scene file.
TEST(Models, TakeACameraFromAFile) {
  const TemporaryFolder folder;
  const std::string model = writeModel(folder), pose = folder / "pose.json";
  std::ofstream(pose) << kPose;
  std::ofstream(folder / "scene.json")
      << R"({"whit": 1, "view": "model", "scene": [{"model": "model.obj"}], "cameras": {"own": )"
      << kPose << "}}";

  const auto seen = codesOf(model, {"--camera", pose}, folder);
  EXPECT_NE(seen, codesOf(model, {}, folder));
  EXPECT_EQ(
      codesOf(model, {"--camera", "mine", "--set", "/cameras/mine=" + std::string(kPose)}, folder),
      seen);
  EXPECT_EQ(codesOf(folder / "scene.json", {}, folder), seen);
  EXPECT_EQ(codesOf(writeTinyScene(folder),
                    {"--camera", pose, "--set", "/cameras/pose/k=[9,9,9,9]"}, folder)
                .size(),
            seen.size())
      << "a scene takes one as well";

  std::ofstream(pose) << R"({"eye": [0, 0, 1], "at": [0, 0, 0], "lens": 3})";
  const Outcome refused = runWhit({"info", model, "--camera", pose});
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("pose.json#/lens: "), std::string::npos) << refused.err;
  std::ofstream(pose) << "{\n\"eye\" [";
  const Outcome broken = runWhit({"info", model, "--camera", pose});
  EXPECT_EQ(broken.status, 3);
  EXPECT_NE(broken.err.find("pose.json:2"), std::string::npos) << broken.err;
  EXPECT_EQ(runWhit({"info", model, "--camera", folder / "none.json"}).status, 4);
}

TEST(Models, TheirCamerasHaveMembersToSet) {
  const TemporaryFolder folder;
  const std::string model = writeModel(folder);
  const auto cameras =
      nlohmann::json::parse(runWhit({"info", model, "--json", "-"}).out)["cameras"];
  ASSERT_EQ(cameras.size(), 1u);
  const std::string pointer = "/cameras/" + cameras[0].get<std::string>();
  const auto narrow = codesOf(model, {"--set", pointer + "/fov=20"}, folder);
  EXPECT_EQ(narrow, codesOf(model, {"--fov", "20"}, folder));
  EXPECT_NE(narrow, codesOf(model, {}, folder));
}

TEST(Models, ACropIsExposedAsTheWhole) {
  const TemporaryFolder folder;
  const std::string model = writeModel(folder), tiny = writeTinyScene(folder);
  const auto codes = [&](const std::string& scene, const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", scene,   "-o",         folder / "x.png",
                                   "--size", "40x25", "--exposure", "auto"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(runWhit(words).status, 0);
    Warnings warnings;
    return readRawImage(folder / "x.png", ImageLimits(), warnings).codes;
  };

  for (const std::string& scene : {model, tiny}) {
    const auto whole = codes(scene, {}), corner = codes(scene, {"--crop", "0,0,40,3"});
    // The crop holds the first rows, so its codes are the first of the whole picture.
    ASSERT_GE(whole.size(), corner.size());
    EXPECT_TRUE(std::equal(corner.begin(), corner.end(), whole.begin())) << scene;
  }
}

TEST(Models, FramesOfAPathAreExposedAlike) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder);
  ASSERT_EQ(runWhit({"render", tiny, "-o", folder / "f#.png", "--frames", "0..1", "--fps", "1",
                     "--exposure", "auto", "--quiet"})
                .status,
            0);

  const std::string ev = saidIn(folder / "f0.png").at("exposure");
  EXPECT_EQ(saidIn(folder / "f1.png").at("exposure"), ev);
  ASSERT_EQ(runWhit({"render", tiny, "-o", folder / "g#.png", "--frames", "1", "--fps", "1",
                     "--exposure", "auto", "--quiet"})
                .status,
            0);
  EXPECT_EQ(readFile(folder / "g1.png"), readFile(folder / "f1.png"));
}

TEST(Models, TheSkyAskedForIsKeptInThePicture) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder), a = folder / "a.png";
  ASSERT_EQ(runWhit({"render", tiny, "-o", a, "--sky", "studio", "--quiet"}).status, 0);
  EXPECT_EQ(saidIn(a).at("sky"), "studio");
  EXPECT_EQ(saidIn(a).at("exposure"), "0") << "a scene file";

  ASSERT_EQ(runWhit({"render", tiny, "-o", a, "--quiet"}).status, 0);
  EXPECT_EQ(saidIn(a).count("sky"), 0u);
}

TEST(Models, WrongUsageIsTold) {
  const TemporaryFolder folder;
  const std::string model = writeModel(folder), a = folder / "a.exr";
  const Outcome bad = runWhit({"render", model, "-o", a, "--exposure", "bright"});
  EXPECT_EQ(bad.status, 2);
  EXPECT_NE(bad.err.find("auto or a number from -64 to 64"), std::string::npos) << bad.err;

  const Outcome gone = runWhit({"render", model, "-o", a, "--sky", folder / "gone.hdr"});
  EXPECT_EQ(gone.status, 4);
  EXPECT_NE(gone.err.find("gone.hdr"), std::string::npos) << gone.err;

  ASSERT_EQ(runWhit({"render", model, "-o", a, "--quiet", "--size", "8x8"}).status, 0);
  EXPECT_EQ(runWhit({"compare", a, a, "--sky", "none"}).status, 2);
  EXPECT_EQ(runWhit({"compare", a, a, "--exposure", "auto"}).status, 2);
  EXPECT_EQ(runWhit({"compare", model, "--size", "24x16", "--quiet"}).status, 0);
}

}  // namespace
}  // namespace whit::cli
