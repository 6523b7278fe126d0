// Edits of the panel are settings: they change the scene in place, and a scene that is read with
// them is the edited one, bit for bit.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <type_traits>

#include "cli/run_program.h"
#include "core/error.h"
#include "engine/engine.h"
#include "io/image/image_file.h"
#include "io/load_scene.h"
#include "make/studio_sky.h"
#include "scene/members.h"
#include "viewer/session/scene_edit.h"

namespace whit::view {
namespace {

std::shared_ptr<OpenScene> openWith(const std::string& name, const LoadOptions& load = {}) {
  return openScene({name, nullptr}, load, false);
}

void expectSame(const Material& a, const Material& b) {
  EXPECT_EQ(a.pointer, b.pointer);
  forEachMember<Material>([&](const auto& member) {
    bool same = a.*member.field == b.*member.field;
    // A texture that no material uses any more still has its number.
    if constexpr (std::is_same_v<decltype(member.field), std::int32_t Material::*>) {
      const bool isMap = member.rules.kind == MemberKind::map;
      if (isMap) same = (a.*member.field == kNoTexture) == (b.*member.field == kNoTexture);
    }
    EXPECT_TRUE(same) << member.name << " of " << a.pointer;
  });
}

void expectSame(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t i = 0; i < a.materials.size(); ++i) expectSame(a.materials[i], b.materials[i]);
  ASSERT_EQ(a.lights.size(), b.lights.size());
  for (std::size_t i = 0; i < a.lights.size(); ++i) {
    EXPECT_TRUE(sameMembers(a.lights[i], b.lights[i])) << a.lights[i].pointer;
  }

  EXPECT_EQ(a.sky.kind, b.sky.kind);
  EXPECT_EQ(a.sky.name, b.sky.name);
  EXPECT_TRUE(sameMembers(a.sky, b.sky));
  EXPECT_EQ(a.sky.image.r, b.sky.image.r);
  EXPECT_EQ(a.blurredSky.r, b.blurredSky.r);
  EXPECT_EQ(a.ambient, b.ambient);
  EXPECT_EQ(a.effects, b.effects);
}

// A scene and its edits, in place and as settings of another reading.
class Editing {
 public:
  explicit Editing(const std::string& name, const LoadOptions& load = {})
      : open_(openWith(name, load)), engine_(open_), scene(editedScene(*open_)) {}

  // Applies the settings.
  void apply(const std::vector<std::string>& settings) {
    EditedScene next = editedScene(*open_);
    addEdit(settings, next);
    become(next);
    EXPECT_EQ(engine_.opened(), open_) << "the scene was read again for " << settings.front();
  }
  // Has the settings of `next` alone. The scene is read again where some are gone.
  void become(const EditedScene& next) {
    engine_.setSettings(editedLoad({engine_.opened(), next.settings, next.givenSky}));
    const OpenScene& now = *engine_.opened();
    EXPECT_EQ(now.load.settings, next.settings);
    expectSame(engine_.scene(), openWith(now.source.name, now.load)->scene);
  }
  void applySky(const Sky& sky) {
    scene.sky = sky;
    std::vector<std::string> settings;
    addSkySetting(scene, settings);
    apply(settings);
    scene = editedScene(*open_);
  }
  const Scene& now() const { return engine_.scene(); }
  const std::vector<std::string>& settings() const { return engine_.opened()->load.settings; }

 private:
  std::shared_ptr<OpenScene> open_;
  Engine engine_;

 public:
  EditedScene scene;
};

// Changes some members of materials and lights that the panel can change, at random.
class RandomEdit {
 public:
  explicit RandomEdit(unsigned seed) : random_(seed) {}

  // Returns the settings of the edit.
  std::vector<std::string> change(EditedScene& scene) {
    std::vector<std::string> settings;
    for (Material& m : scene.materials) {
      const Material before = m;
      for (Rgb* c : {&m.diffuse, &m.specular, &m.emission, &m.mirror, &m.mirrorGrazing,
                     &m.transmission, &m.absorption}) {
        if (chance()) *c = chance() ? Rgb(0.0f) : Rgb{unit(), unit(), unit()};
      }
      if (chance()) m.roughness = unit();
      if (chance()) m.ior = 1 + unit();
      addMemberSettings(before, m, scene.origin, settings);
    }
    for (Light& light : scene.lights) {
      const Light before = light;
      change(light);
      addMemberSettings(before, light, scene.origin, settings);
    }
    return settings;
  }

 private:
  void change(Light& light) {
    if (light.kind != Light::Kind::point && chance()) light.direction = {unit(), -1, unit()};
    if (light.kind == Light::Kind::spot && chance()) {
      light.innerConeAngle = 10 * unit();
      light.outerConeAngle = 20 + 30 * unit();
    }
    if (light.kind == Light::Kind::directional) {
      if (chance()) light.intensity = Rgb{unit(), unit(), 0};
      return;
    }
    if (chance()) light.position = {1e3f * unit() - 500, -1e-3f * unit(), 1e9f * unit()};
    if (chance()) light.intensity = Rgb{unit(), 1e6f * unit(), 0};
  }
  bool chance() { return random_() % 2 == 0; }
  float unit() { return static_cast<float>(random_() % 16'777'216) / 16'777'216; }
  std::mt19937 random_;
};

void expectEditsInPlace(const std::string& name) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Editing editing(name);
    RandomEdit random(seed);
    for (int i = 0; i < 3; ++i) editing.apply(random.change(editing.scene));

    // The panel shows what the scene has.
    std::vector<std::string> differences;
    for (std::size_t k = 0; k < editing.now().lights.size(); ++k) {
      addMemberSettings(editing.now().lights[k], editing.scene.lights[k], {}, differences);
    }
    for (std::size_t k = 0; k < editing.now().materials.size(); ++k) {
      addMemberSettings(editing.now().materials[k], editing.scene.materials[k], {}, differences);
    }
    EXPECT_EQ(differences, std::vector<std::string>());

    EditedScene fewer = editing.scene;
    fewer.settings = editing.settings();
    fewer.settings.resize(fewer.settings.size() / 2);
    editing.become(fewer);
  }
}

TEST(EditSettings, OfASceneFile) { expectEditsInPlace("glass"); }

// The image of a sky that is chosen has a negative value, which the reader repairs.
TEST(EditSettings, WarnAsTheReaderDoes) {
  const cli::TemporaryFolder folder;
  Image sky(4, 2);
  sky.pixels[3] = {-1, 0, 0};
  writeExr(folder / "sky.exr", sky, {});
  std::ofstream(folder / "s.json") << R"({"whit": 1, "scene": [{"shape": "sphere"}]})";
  Engine engine(openWith(folder / "s.json"));
  const OpenScene* const before = engine.opened().get();
  ASSERT_TRUE(before->warnings.entries().empty());

  for (const char* scale : {"2", "3"}) {
    engine.edit(std::string(R"(/sky={"image": "sky.exr", "scale": )") + scale + "}");
    EXPECT_EQ(engine.opened().get(), before) << "it was read again";
    const auto warnings = before->warnings.entries();
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings.begin()->second.count, 1u) << "each kind is noted once";
  }
}

TEST(EditSettings, WarnOfMaterialsThatSendOutMoreThanTheyGet) {
  const cli::TemporaryFolder folder;
  std::ofstream(folder / "s.json") << R"({"whit": 1, "materials": {"m": {"diffuse": 0.5}}, "scene":
    [{"shape": "sphere", "material": "m"}]})";
  Engine engine(openWith(folder / "s.json"));
  const OpenScene* const before = engine.opened().get();
  ASSERT_TRUE(before->warnings.entries().empty());

  engine.edit("/materials/m/mirror=0.9");
  EXPECT_EQ(engine.opened().get(), before) << "it was read again";
  const auto warnings = before->warnings.entries();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings.begin()->first.starts_with("material whose parts exceed 1 in sum"));
  EXPECT_EQ(warnings.begin()->second.first,
            folder / "s.json#/materials/m: mirror 0.9 + diffuse 0.5 = 1.4");
}

TEST(EditSettings, OfItemsWithoutAMaterial) {
  const cli::TemporaryFolder folder;
  std::ofstream(folder / "s.json")
      << R"({"whit": 1, "scene": [{"shape": "quad"}, {"shape": "box"}]})";
  expectEditsInPlace(folder / "s.json");
}

// Its lights are moved with it, and back.
TEST(EditSettings, OfAFarModel) {
  const cli::TemporaryFolder folder;
  std::ofstream(folder / "far.obj") << "v 4000000 0 0\nv 4000001 0 0\nv 4000000 1 0\nf 1 2 3\n";
  expectEditsInPlace(folder / "far.obj");
}

// The model has maps that count only where a material is glossy, and names with characters that
// pointers and shells treat specially.
class EditedModel : public testing::Test {
 protected:
  EditedModel() {
    std::ofstream(folder_ / "m.mtl") << "newmtl a/b~c\nKd 1 0.5 0\nillum 1\nmap_Ks t.png\n"
                                        "newmtl it's=1\nKs 0.5 0.5 0.5\nmap_Ks t.png\n";
    writePng(folder_ / "t.png", DisplayImage{1, 1, {128, 128, 128, 255}}, {});
    std::ofstream(folder_ / "m.obj") << "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
                                        "usemtl a/b~c\nf 1/1 2/1 3/1\nusemtl it's=1\n"
                                        "f 1/1 2/1 3/1\n";
  }
  cli::TemporaryFolder folder_;
};

TEST_F(EditedModel, Alone) {
  const std::vector<Material> materials = openWith(folder_ / "m.obj")->scene.materials;
  EXPECT_EQ(materials[0].specularMap, kNoTexture);
  EXPECT_NE(materials[1].specularMap, kNoTexture);
  expectEditsInPlace(folder_ / "m.obj");
}

TEST_F(EditedModel, InAScene) {
  std::ofstream(folder_ / "s.json") << R"({"whit": 1, "lights": [
    {"position": [1, 2, 3], "intensity": 5}, {"type": "directional", "direction": [0, -1, 1],
    "irradiance": 2}, {"type": "spot", "position": [0, 1, 0], "direction": [0, -1, 0],
    "intensity": 3}], "scene": [{"group": [{"model": "m.obj",
    "materials": {"*": {"mirror": 0.2}, "it's=1": {"transmission": 0.5, "ior": 1.3}}}]}]})";
  expectEditsInPlace(folder_ / "s.json");
}

// A roughness that is set is meant as it stands, so that the map of a model's material goes.
TEST_F(EditedModel, LosesMapsThatMultiplyWhatIsSet) {
  writePng(folder_ / "r.png", DisplayImage{2, 1, {0, 50, 0, 255, 0, 200, 0, 255}}, {});
  std::ofstream(folder_ / "m.gltf")
      << R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1},
      "material": 0}]}],
    "materials": [{"name": "m", "pbrMetallicRoughness": {"metallicRoughnessTexture":
      {"index": 0}}}],
    "textures": [{"source": 0}], "images": [{"uri": "r.png"}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
      "min": [0, 0, 0], "max": [1, 1, 0]},
      {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36,
      "byteLength": 24}],
    "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,)"
      << "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/"
      << R"("}]})";
  Editing editing(folder_ / "m.gltf");
  EXPECT_NE(editing.now().materials[0].roughnessMap, kNoTexture);
  editing.apply({"/materials/m/diffuse=[0.5, 0.25, 1]"});
  EXPECT_NE(editing.now().materials[0].roughnessMap, kNoTexture);
  editing.apply({"/materials/m/roughness=0.25"});
  EXPECT_EQ(editing.now().materials[0].roughnessMap, kNoTexture);
}

class EditedSky : public EditedModel {
 protected:
  EditedSky() {
    Image sky(4, 2);
    for (std::size_t i = 0; i < sky.pixels.size(); ++i) {
      sky.pixels[i] = {0.2f * static_cast<float>(i), 1, i == 1 ? 5.0f : 0.5f};
    }
    writeExr(folder_ / "sky.exr", sky, {});
    std::ofstream(folder_ / "s.json") << R"({"whit": 1, "sky": {"image": "sky.exr", "scale": 0.5},
      "ambient": {"fromSky": 0.5}, "materials": {"glossy": {"specular": 0.5, "roughness": 0.5}},
      "scene": [{"shape": "sphere", "material": "glossy"}]})";
  }

  // Chooses other skies and goes back.
  static void expectSkiesInPlace(Editing& editing) {
    const Sky own = editing.scene.sky;
    Sky bright = own;
    bright.scale *= 3;
    bright.rotation = 70;
    for (const Sky& sky : {bright, skyFrom(kNoSky), skyFrom(kStudio), bright, own}) {
      editing.applySky(sky);
      EXPECT_TRUE(isSameSky(editing.scene.sky, sky));
    }
  }
};

TEST_F(EditedSky, OfASceneFile) {
  Editing editing(folder_ / "s.json");
  expectSkiesInPlace(editing);
  editing.apply({"/ambient/fromSky=2"});
}

TEST_F(EditedSky, OfAModel) {
  Editing editing(folder_ / "m.obj");
  expectSkiesInPlace(editing);
}

// Settings of a model describe its sky from nothing, for the reader and for edits alike.
TEST_F(EditedSky, OfAModelHasNoMembersOfItsOwn) {
  const cli::TemporaryFolder elsewhere;
  std::filesystem::copy_file(folder_ / "sky.exr", elsewhere / "sky.exr");

  for (const std::string& sky : {std::string(), std::string(elsewhere / "sky.exr")}) {
    LoadOptions load;
    load.sky = sky;
    Engine engine(openWith(folder_ / "m.obj", load));
    engine.edit("/ambient={\"color\": 0.5}");
    EXPECT_THROW(engine.edit("/sky/scale=2"), Error);
    expectSame(engine.scene(), openWith(folder_ / "m.obj", engine.opened()->load)->scene);
  }
}

// A scene that is shown as a model is has a supplied sky, which the lights make brighter.
TEST_F(EditedSky, OfASceneWithTheViewOfAModel) {
  std::ofstream(folder_ / "s.json") << R"({"whit": 1, "view": "model", "lights":
    [{"position": [1, 2, 3], "intensity": 5}], "materials": {"m": {"diffuse": 0.5}},
    "scene": [{"model": "m.obj"}, {"shape": "sphere", "material": "m"}]})";
  const std::string brighter = "/lights/0/intensity=500";

  Editing editing(folder_ / "s.json");
  editing.apply({"/materials/m/roughness=0.25", "/scene/0/materials/it's=1/mirror=0.5"});
  editing.apply({"/ambient={\"fromSky\": 0.25}"});
  expectSkiesInPlace(editing);
  editing.apply({brighter});

  const std::shared_ptr<OpenScene> open = openWith(folder_ / "s.json");
  const float before = open->scene.sky.scale;
  Engine engine(open);
  engine.edit(brighter);
  EXPECT_GT(engine.scene().sky.scale, before);
  expectSame(engine.scene(), openWith(folder_ / "s.json", engine.opened()->load)->scene);
}

TEST_F(EditedSky, TakesThePlaceOfAGivenOne) {
  std::ofstream(folder_ / "s.json") << R"({"whit": 1, "scene": [{"shape": "sphere"}]})";
  LoadOptions load;
  load.sky = folder_ / "sky.exr";
  Editing editing(folder_ / "s.json", load);
  editing.scene.ambient.ofSky = 0.5;
  std::vector<std::string> settings;
  addAmbientSetting(editing.scene, settings);
  editing.apply(settings);
  EXPECT_GT(editing.now().ambient.up.x, 0);
  expectSkiesInPlace(editing);
}

TEST_F(EditedSky, ThatCannotBeReadLeavesAllAsItWas) {
  Editing editing(folder_ / "s.json");
  const Scene before = editing.now();
  EXPECT_THROW(editing.apply({"/materials/glossy/diffuse=0.1", "/sky={\"image\": \"no.exr\"}"}),
               Error);
  expectSame(editing.now(), before);
  editing.apply({"/materials/glossy/diffuse=0.1"});
}

}  // namespace
}  // namespace whit::view
