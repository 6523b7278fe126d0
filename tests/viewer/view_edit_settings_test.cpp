// Edits as settings: a scene that is read with them is the edited one, bit for bit.
#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "cli/run_program.h"
#include "io/image/image_file.h"
#include "io/load_scene.h"
#include "viewer/session/frame_tracer.h"

namespace whit::view {
namespace {

ShadingEdit readEdit(const std::string& name, const std::vector<std::string>& settings = {}) {
  LoadOptions options;
  options.settings = settings;
  Warnings warnings;
  const SceneDescription scene = loadScene(name, options, warnings);
  const auto open = std::make_shared<OpenScene>(false);
  open->scene.origin = scene.origin;
  return {open, scene.materials, scene.lights, {}, {}, settings};
}

template <typename Item, typename Field>
void expectSame(const Item& a, const Item& b, Field Item::*field, const char* what) {
  EXPECT_TRUE(a.*field == b.*field) << what << " of " << a.pointer;
}

void expectSame(const ShadingEdit& a, const ShadingEdit& b) {
  ASSERT_EQ(a.materials.size(), b.materials.size());
  ASSERT_EQ(a.lights.size(), b.lights.size());
  for (std::size_t i = 0; i < a.materials.size(); ++i) {
    const Material &x = a.materials[i], &y = b.materials[i];
    EXPECT_EQ(x.pointer, y.pointer);
    expectSame(x, y, &Material::diffuse, "diffuse");
    expectSame(x, y, &Material::specular, "specular");
    expectSame(x, y, &Material::roughness, "roughness");
    expectSame(x, y, &Material::emission, "emission");
    expectSame(x, y, &Material::mirror, "mirror");
    expectSame(x, y, &Material::mirrorGrazing, "mirrorGrazing");
    expectSame(x, y, &Material::transmission, "transmission");
    expectSame(x, y, &Material::ior, "ior");
    expectSame(x, y, &Material::absorption, "absorption");
    expectSame(x, y, &Material::castsShadow, "castsShadow");
    expectSame(x, y, &Material::glossyReflection, "glossyReflection");
    if (x.hasGlossy()) expectSame(x, y, &Material::specularMap, "specularMap");
    expectSame(x, y, &Material::diffuseMap, "diffuseMap");
  }

  for (std::size_t i = 0; i < a.lights.size(); ++i) {
    expectSame(a.lights[i], b.lights[i], &Light::position, "position");
    expectSame(a.lights[i], b.lights[i], &Light::intensity, "intensity");
    expectSame(a.lights[i], b.lights[i], &Light::radius, "radius");
    expectSame(a.lights[i], b.lights[i], &Light::direction, "direction");
    expectSame(a.lights[i], b.lights[i], &Light::innerConeAngle, "innerConeAngle");
    expectSame(a.lights[i], b.lights[i], &Light::outerConeAngle, "outerConeAngle");
  }
}

// Changes some members of materials and lights that the panel can change, at random.
class RandomEdit {
 public:
  explicit RandomEdit(unsigned seed) : random_(seed) {}

  ShadingEdit of(ShadingEdit scene) {
    for (Material& m : scene.materials) {
      for (Rgb* c : {&m.diffuse, &m.specular, &m.emission, &m.mirror, &m.mirrorGrazing,
                     &m.transmission, &m.absorption}) {
        if (chance()) *c = chance() ? Rgb(0.0f) : Rgb{unit(), unit(), unit()};
      }
      if (chance()) m.roughness = unit();
      if (chance()) m.ior = 1 + unit();
    }
    for (Light& light : scene.lights) {
      if (light.kind != Light::Kind::point && chance()) light.direction = {unit(), -1, unit()};
      if (light.kind == Light::Kind::spot && chance()) {
        light.innerConeAngle = 10 * unit();
        light.outerConeAngle = 20 + 30 * unit();
      }
      if (light.kind == Light::Kind::directional) {
        if (chance()) light.intensity = Rgb{unit(), unit(), 0};
        continue;
      }
      if (chance()) light.position = {1e3f * unit() - 500, -1e-3f * unit(), 1e9f * unit()};
      if (chance()) light.intensity = Rgb{unit(), 1e6f * unit(), 0};
    }
    return scene;
  }

 private:
  bool chance() { return random_() % 2 == 0; }
  float unit() { return static_cast<float>(random_() % 16'777'216) / 16'777'216; }
  std::mt19937 random_;
};

void expectThatEditsComeBack(const std::string& name) {
  const ShadingEdit plain = readEdit(name);
  EXPECT_TRUE(editSettings(plain, plain).empty());
  // The settings of an edit make the edited scene, and nothing is left to set then.
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const ShadingEdit edited = RandomEdit(seed).of(plain);
    const std::vector<std::string> settings = editSettings(plain, edited);
    EXPECT_FALSE(settings.empty());

    const ShadingEdit again = readEdit(name, settings);
    expectSame(edited, again);
    EXPECT_TRUE(editSettings(edited, again).empty());
  }
}

TEST(EditSettings, OfASceneFile) { expectThatEditsComeBack("glass"); }

TEST(EditSettings, OfItemsWithoutAMaterial) {
  const cli::TemporaryFolder folder;
  std::ofstream(folder / "s.json")
      << R"({"whit": 1, "scene": [{"shape": "quad"}, {"shape": "box"}]})";
  expectThatEditsComeBack(folder / "s.json");
}

// Its lights are moved with it, and back.
TEST(EditSettings, OfAFarModel) {
  const cli::TemporaryFolder folder;
  std::ofstream(folder / "far.obj") << "v 4000000 0 0\nv 4000001 0 0\nv 4000000 1 0\nf 1 2 3\n";
  expectThatEditsComeBack(folder / "far.obj");
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
  const std::vector<Material> materials = readEdit(folder_ / "m.obj").materials;
  EXPECT_EQ(materials[0].specularMap, kNoTexture);
  EXPECT_NE(materials[1].specularMap, kNoTexture);
  expectThatEditsComeBack(folder_ / "m.obj");
}

TEST_F(EditedModel, InAScene) {
  std::ofstream(folder_ / "s.json") << R"({"whit": 1, "lights": [
    {"position": [1, 2, 3], "intensity": 5}, {"type": "directional", "direction": [0, -1, 1],
    "irradiance": 2}, {"type": "spot", "position": [0, 1, 0], "direction": [0, -1, 0],
    "intensity": 3}], "scene": [{"group": [{"model": "m.obj",
    "materials": {"*": {"mirror": 0.2}, "it's=1": {"transmission": 0.5, "ior": 1.3}}}]}]})";
  expectThatEditsComeBack(folder_ / "s.json");
}

}  // namespace
}  // namespace whit::view
