// A model without a scene file: its sky, its exposure, and how the program reports them.
#include "io/gltf_files.h"
#include "run_command.h"

namespace whit::cli {
namespace {

class Models : public TinySceneTest {
 protected:
  Models() {
    save("model.obj",
         "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 1\nv 2 1 1\nf 1 2 3 4\nf 2 5 6 3\n");
  }
  using Codes = std::vector<std::uint8_t>;
  Codes codesOf(const std::string& words) const {
    succeed("render -o codes.png --size 24x15 " + words);
    return storedIn("codes.png").codes;
  }
};

TEST_F(Models, InfoNamesTheSky) {
  const auto sky = [&](const std::string& words) { return jsonOf("info " + words)["sky"]; };
  EXPECT_EQ(sky("model.obj"), "studio");
  EXPECT_EQ(sky("model.obj --sky none"), "none");
  EXPECT_EQ(sky("tiny.json"), "none");
  EXPECT_EQ(sky("tiny.json --sky studio"), "studio");
  const std::string said = succeed("info model.obj").out;
  EXPECT_TRUE(hasText(said, "sky         studio"));
  EXPECT_TRUE(hasText(said, "exposure auto (model)"));
}

// The triangle is black, except in the variant "glowing \"red\"".
TEST_F(Models, VariantsAreListedAndChosen) {
  GltfBuilder b;
  const std::string mapped =
      primitive(b.positions(kTriangleXyz), "",
                ",'material':0,'extensions':{'KHR_materials_variants':{'mappings':[{'material':1,"
                "'variants':[1]}]}}");
  save("variants.gltf",
       b.json(oneMesh(mapped) +
              ",'materials': [{'name': 'dark', 'emissiveFactor': [0, 0, 0]},"
              "               {'name': 'red', 'emissiveFactor': [1, 0, 0]}],"
              "'extensions': {'KHR_materials_variants': {"
              "  'variants': [{'name': 'plain'}, {'name': 'glowing \\\"red\\\"'}]}}"));

  EXPECT_EQ(jsonOf("info variants.gltf")["variants"], Json({"plain", "glowing \"red\""}));
  EXPECT_TRUE(hasText(succeed("info variants.gltf").out, "variant     plain\n"));

  const auto glows = [&](const std::string& variant) {
    return jsonOf("info variants.gltf --variant " + variant)["effects"]["emission"]["on"];
  };
  EXPECT_EQ(glows("plain"), false);
  EXPECT_EQ(glows(R"("glowing \"red\"")"), true);

  const Outcome refused = run("render variants.gltf -o p.png --variant blue");
  EXPECT_NE(refused.status, 0);
  EXPECT_TRUE(hasText(refused.err, "/variant: expected one of \"plain\", \"glowing \"red\"\""));

  EXPECT_TRUE(hasText(run("info tiny.json --variant plain").err,
                      "tiny.json#/variant: variants are those of glTF files: a scene states "
                      "one in the item of the model, as {\"model\": \"shoe.glb\", \"vari"));
}

TEST_F(Models, ThePictureTellsItsExposureAndIsMadeAgainWithIt) {
  const std::string line = "render model.obj --size 48x30 ";
  const Outcome first = succeed(line + "-o a.png --json -");
  auto metadata = metadataOf("a.png");
  const std::string ev = metadata["exposure"];
  EXPECT_NE(ev, "auto");
  EXPECT_NE(ev, "0");
  EXPECT_EQ(metadata["terminator"], "on");
  EXPECT_EQ(Json::parse(first.out)["exposure_ev"].get<float>(), std::stof(ev));
  EXPECT_TRUE(hasText(first.err, "exposure "));
  EXPECT_FALSE(hasText(first.err, "exposure 0"));

  // The exposure that the first picture states makes the same picture.
  succeed(line + "-o b.png --terminator on --exposure " + ev);
  EXPECT_EQ(bytesOf("a.png"), bytesOf("b.png"));

  EXPECT_EQ(succeed("render model.obj -o a.png --quiet").err, "");
  EXPECT_EQ(metadataOf("a.png")["exposure"], ev) << "of another size";
}

TEST_F(Models, ASceneFileCanShowOneAsTheCommandDoes) {
  // The codes of a scene that shows the model and has these members.
  const auto shownWith = [&](const std::string& members, const std::string& words = "") {
    save("scene.json",
         "{'whit': 1, 'view': 'model', 'scene': [{'model': 'model.obj'}]" + members + "}");
    return codesOf("scene.json " + words);
  };

  const Codes shown = codesOf("model.obj");
  EXPECT_EQ(shownWith(""), shown);
  EXPECT_EQ(shownWith("", "--sky none"), codesOf("model.obj --sky none"));

  // The studio suits the lights, whether it is named or not.
  const std::string lights = ", 'lights': [{'position': [0, 9, 0], 'intensity': 0.01}]";
  EXPECT_EQ(shownWith(lights, "--sky studio"), shownWith(lights));

  // What the file has is kept.
  const Codes dark = shownWith(", 'options': {'exposure': -3}");
  EXPECT_EQ(dark, codesOf("model.obj --exposure -3"));
  EXPECT_NE(dark, shown);
  const Codes unexposed = codesOf("model.obj --exposure 0");
  for (const char* own : {"'sky': {'color': [1, 0, 0]}", "'ambient': {'color': [1, 0, 0]}",
                          "'lights': [{'position': [0, 9, 0], 'intensity': 50}]",
                          "'cameras': {'near': {'eye': [0.5, 0.5, 1], 'at': [0.5, 0.5, 0]}}"}) {
    EXPECT_NE(shownWith(", 'options': {'exposure': 0}, " + std::string(own)), unexposed) << own;
  }
}

// One camera by three ways: a file of its own, a setting, and a scene file.
TEST_F(Models, TakeACameraFromAFile) {
  const std::string pose = asJson(
      "{'eye':[0.5,1.5,4],'at':[0.8,0.5,0],'k':[40,44,23,16],'kSize':[48,30],"
      "'distortion':[0.1,0.02]}");
  save("pose.json", pose);
  save("scene.json",
       "{'whit': 1, 'view': 'model', 'scene': [{'model': 'model.obj'}], 'cameras': {'own': " +
           pose + "}}");

  const Codes seen = codesOf("model.obj --camera pose.json");
  EXPECT_NE(seen, codesOf("model.obj"));
  EXPECT_EQ(codesOf("model.obj --camera mine --set /cameras/mine=" + pose), seen);
  EXPECT_EQ(codesOf("scene.json"), seen);
  // A scene takes one as well.
  codesOf("tiny.json --camera pose.json --set /cameras/pose/k=[9,9,9,9]");
}

TEST_F(Models, TheirCamerasHaveMembersToSet) {
  const Json cameras = jsonOf("info model.obj")["cameras"];
  ASSERT_EQ(cameras.size(), 1u);
  const std::string set = "model.obj --set /cameras/" + cameras[0].get<std::string>();
  const Codes narrow = codesOf(set + "/fov=20");
  EXPECT_EQ(narrow, codesOf("model.obj --fov 20"));
  EXPECT_NE(narrow, codesOf("model.obj"));

  // An orthographic camera becomes perspective.
  EXPECT_EQ(narrow, codesOf(set + "/orthographicHeight=3 --fov 20 --ortho 0"));
}

TEST_F(Models, FramesOfAPathAreExposedAlike) {
  const std::string line = "render tiny.json --fps 1 --exposure auto ";
  succeed(line + "-o f#.png --frames 0..1");
  EXPECT_EQ(metadataOf("f0.png")["exposure"], metadataOf("f1.png")["exposure"]);
  succeed(line + "-o g#.png --frames 1");
  EXPECT_EQ(bytesOf("g1.png"), bytesOf("f1.png"));
}

TEST_F(Models, TheSkyAskedForIsKeptInThePicture) {
  succeed("render tiny.json -o a.png --sky studio");
  auto metadata = metadataOf("a.png");
  EXPECT_EQ(metadata["sky"], "studio");
  EXPECT_EQ(metadata["exposure"], "0") << "a scene file";

  succeed("render tiny.json -o a.png");
  EXPECT_FALSE(metadataOf("a.png").contains("sky"));
}

// The tone curve that is reported is the one that the codes have. Rounding moves some of these by
// one.
TEST_F(Models, AreComparedAsTheyAreShown) {
  const std::string line = "compare chess.glb --size 96x60 --sky none --exposure 1";
  Json shown = jsonOf(line), stated = jsonOf(line + " --tonemap filmic");
  EXPECT_EQ(shown["options"]["tonemap"], "filmic");

  for (Json* json : {&shown, &stated}) json->erase("time_ms");
  EXPECT_EQ(shown, stated);
}

}  // namespace
}  // namespace whit::cli
