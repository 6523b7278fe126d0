// Edits of the panel are settings: they change the scene in place, and a scene that is read with
// them is the edited one, bit for bit.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <type_traits>

#include "core/error.h"
#include "engine/engine.h"
#include "io/gltf_files.h"
#include "io/image/image_file.h"
#include "io/load_scene.h"
#include "make/studio_sky.h"
#include "scene/members.h"
#include "viewer/session/scene_edit.h"
#include "viewer_fixture.h"

namespace whit::view {
namespace {

std::shared_ptr<OpenScene> openWith(const std::string& name, const LoadOptions& load = {}) {
  return openScene({name, nullptr}, load, false);
}

LoadOptions withSky(const std::string& sky) {
  LoadOptions load;
  load.sky = sky;
  return load;
}

void expectSame(const Material& a, const Material& b) {
  EXPECT_EQ(a.pointer, b.pointer);
  forEachMember<Material>([&](const auto& member) {
    auto x = a.*member.field, y = b.*member.field;
    // A texture that no material uses any more still has its number.
    if constexpr (std::is_same_v<decltype(x), std::int32_t>) {
      if (member.rules.kind == MemberKind::map && x != kNoTexture && y != kNoTexture) x = y;
    }
    EXPECT_TRUE(x == y) << member.name << " of " << a.pointer;
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

// Expects that a scene is as one that is read with its settings.
void expectAsRead(const Engine& engine) {
  const OpenScene& now = *engine.opened();
  expectSame(engine.scene(), openWith(now.source.name, now.load)->scene);
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
    EXPECT_EQ(settings(), next.settings);
    expectAsRead(engine_);
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

void expectEditsInPlace(const std::string& name, unsigned seeds = 5) {
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    Editing editing(name);
    RandomEdit random(seed);
    for (int i = 0; i < 3; ++i) editing.apply(random.change(editing.scene));

    // The panel shows what the scene has.
    std::vector<std::string> differences;
    const auto compare = [&](const auto& now, const auto& shown) {
      for (std::size_t k = 0; k < now.size(); ++k) {
        addMemberSettings(now[k], shown[k], {}, differences);
      }
    };
    compare(editing.now().lights, editing.scene.lights);
    compare(editing.now().materials, editing.scene.materials);
    EXPECT_EQ(differences, std::vector<std::string>());

    EditedScene fewer = editing.scene;
    fewer.settings = editing.settings();
    fewer.settings.resize(fewer.settings.size() / 2);
    editing.become(fewer);
  }
}

// Glass takes long to read.
TEST(EditSettings, OfASceneFile) {
  expectEditsInPlace("whitted");
  expectEditsInPlace("glass", 1);
}

// The model has maps that count only where a material is glossy, and names with characters that
// pointers and shells treat specially.
class EditedModel : public cli::TinySceneTest {
 protected:
  EditedModel() {
    save("m.mtl",
         "newmtl a/b~c\nKd 1 0.5 0\nillum 1\nmap_Ks t.png\n"
         "newmtl it's=1\nKs 0.5 0.5 0.5\nmap_Ks t.png\n");
    writePng(folder_ / "t.png", DisplayImage{1, 1, {128, 128, 128, 255}}, {});
    save("m.obj",
         "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
         "usemtl a/b~c\nf 1/1 2/1 3/1\nusemtl it's=1\n"
         "f 1/1 2/1 3/1\n");
  }
  std::shared_ptr<OpenScene> open(const char* file) { return openWith(folder_ / file); }

  // Edits s.json in place, which must warn once, and returns that warning.
  std::pair<std::string, Warnings::Entry> warningOf(const std::vector<std::string>& edits) {
    Engine engine(open("s.json"));
    const OpenScene* const before = engine.opened().get();
    EXPECT_TRUE(before->warnings.entries().empty());
    for (const std::string& edit : edits) engine.edit(edit);
    EXPECT_EQ(engine.opened().get(), before) << "it was read again";
    const auto warnings = before->warnings.entries();
    EXPECT_EQ(warnings.size(), 1u);
    return *warnings.begin();
  }
};

// The image of a sky that is chosen has a negative value, which the reader repairs.
TEST_F(EditedModel, WarnsAsTheReaderDoes) {
  Image sky(4, 2);
  sky.pixels[3] = {-1, 0, 0};
  writeExr(folder_ / "sky.exr", sky, {});
  save("s.json", "{'whit': 1, 'scene': [{'shape': 'sphere'}]}");
  const auto warning = warningOf(
      {R"(/sky={"image": "sky.exr", "scale": 2})", R"(/sky={"image": "sky.exr", "scale": 3})"});
  EXPECT_EQ(warning.second.count, 1u) << "each kind is noted once";
}

TEST_F(EditedModel, WarnsOfMaterialsThatSendOutMoreThanTheyGet) {
  save("s.json",
       "{'whit': 1, 'materials': {'m': {'diffuse': 0.5}}, 'scene': "
       "[{'shape': 'sphere', 'material': 'm'}]}");
  const auto [words, warning] = warningOf({"/materials/m/mirror=0.9"});
  EXPECT_TRUE(words.starts_with("material whose parts exceed 1 in sum"));
  EXPECT_EQ(warning.first, folder_ / "s.json#/materials/m: mirror 0.9 + diffuse 0.5 = 1.4");
}

// Items without a material, a far model, whose lights are moved with it and back, and a model alone
// and in a scene.
TEST_F(EditedModel, IsEditedInPlaceAsScenesAre) {
  const std::vector<Material> materials = open("m.obj")->scene.materials;
  EXPECT_EQ(materials[0].specularMap, kNoTexture);
  EXPECT_NE(materials[1].specularMap, kNoTexture);

  save("items.json", "{'whit': 1, 'scene': [{'shape': 'quad'}, {'shape': 'box'}]}");
  save("far.obj", "v 4000000 0 0\nv 4000001 0 0\nv 4000000 1 0\nf 1 2 3\n");
  // save() would take a plain apostrophe for a quotation mark.
  save("s.json",
       "{'whit': 1, 'lights': [{'position': [1, 2, 3], 'intensity': 5}, "
       "{'type': 'directional', 'direction': [0, -1, 1], 'irradiance': 2}, "
       "{'type': 'spot', 'position': [0, 1, 0], 'direction': [0, -1, 0], 'intensity': 3}], "
       "'scene': [{'group': [{'model': 'm.obj', 'materials': {'*': {'mirror': 0.2}, "
       "'it\\u0027s=1': {'transmission': 0.5, 'ior': 1.3}}}]}]}");
  for (const char* file : {"items.json", "far.obj", "m.obj", "s.json"}) {
    SCOPED_TRACE(file);
    expectEditsInPlace(folder_ / file);
  }
}

// A roughness that is set is meant as it stands, so that the map of a model's material goes.
TEST_F(EditedModel, LosesMapsThatMultiplyWhatIsSet) {
  writePng(folder_ / "r.png", DisplayImage{2, 1, {0, 50, 0, 255, 0, 200, 0, 255}}, {});
  GltfBuilder b;
  const std::string uvs = ",'TEXCOORD_0':" + b.floats("VEC2", {0, 0, 1, 0, 0, 1});
  save("m.gltf", b.json(oneMesh(primitive(b.positions(kTriangleXyz), uvs, ",'material':0")) +
                        ",'materials':[{'name':'m','pbrMetallicRoughness':{"
                        "'metallicRoughnessTexture':{'index':0}}}],'textures':[{'source':0}],"
                        "'images':[{'uri':'r.png'}]"));
  Editing editing(folder_ / "m.gltf");
  const auto hasMap = [&] { return editing.now().materials[0].roughnessMap != kNoTexture; };
  EXPECT_TRUE(hasMap());
  editing.apply({"/materials/m/diffuse=[0.5, 0.25, 1]"});
  EXPECT_TRUE(hasMap());
  editing.apply({"/materials/m/roughness=0.25"});
  EXPECT_FALSE(hasMap());
}

class EditedSky : public EditedModel {
 protected:
  EditedSky() {
    writeSky(folder_ / "sky.exr");
    save("s.json",
         "{'whit': 1, 'sky': {'image': 'sky.exr', 'scale': 0.5}, "
         "'ambient': {'fromSky': 0.5}, "
         "'materials': {'glossy': {'specular': 0.5, 'roughness': 0.5}}, "
         "'scene': [{'shape': 'sphere', 'material': 'glossy'}]}");
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
    Engine engine(openWith(folder_ / "m.obj", withSky(sky)));
    engine.edit("/ambient={\"color\": 0.5}");
    EXPECT_THROW(engine.edit("/sky/scale=2"), Error);
    expectAsRead(engine);
  }
}

// A scene that is shown as a model is has a supplied sky, which the lights make brighter.
TEST_F(EditedSky, OfASceneWithTheViewOfAModel) {
  save("s.json",
       "{'whit': 1, 'view': 'model', 'lights': "
       "[{'position': [1, 2, 3], 'intensity': 5}], 'materials': {'m': {'diffuse': 0.5}}, "
       "'scene': [{'model': 'm.obj'}, {'shape': 'sphere', 'material': 'm'}]}");
  const std::string brighter = "/lights/0/intensity=500";

  Editing editing(folder_ / "s.json");
  editing.apply({"/materials/m/roughness=0.25", "/scene/0/materials/it's=1/mirror=0.5"});
  editing.apply({"/ambient={\"fromSky\": 0.25}"});
  expectSkiesInPlace(editing);
  editing.apply({brighter});

  Engine engine(open("s.json"));
  const float before = engine.scene().sky.scale;
  engine.edit(brighter);
  EXPECT_GT(engine.scene().sky.scale, before);
  expectAsRead(engine);
}

TEST_F(EditedSky, TakesThePlaceOfAGivenOne) {
  save("s.json", "{'whit': 1, 'scene': [{'shape': 'sphere'}]}");
  Editing editing(folder_ / "s.json", withSky(folder_ / "sky.exr"));
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
