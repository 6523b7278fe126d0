// Every member of a scene file's cameras, materials and lights can be given through whit.h: a
// member of the library's structures makes the picture that the same member of a scene file makes.
// A member that is in no table here fails.
#include <array>
#include <functional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "library_scenes.h"
#include "scene/members.h"

namespace whit::api {
namespace {

using Names = std::set<std::string>;

// The noun at the beginning, the member's name and value in scene files, and the same in C++.
template <typename Noun>
struct Row {
  const char *name, *value;
  std::function<void(Noun&)> set;
  Noun base = {};
  std::vector<std::pair<const char*, const char*>> also = {};  // what comes with the value in files
};

template <typename Noun, typename Value>
std::function<void(Noun&)> to(Value Noun::*member, const std::type_identity_t<Value>& value) {
  return [=](Noun& noun) { noun.*member = value; };
}

// SceneBuilder::set() alone gives these.
const Names kOnlyByPointer{"alphaCutoff", "diffuseReflection", "priority", "coat", "doubleSided"};

Material with(const std::function<void(Material&)>& change) {
  Material material;
  material.diffuse = {0.2, 0.2, 0.2};
  change(material);
  return material;
}
const Material kGlossy = with([](Material& m) {
  m.specular = {0.5, 0.5, 0.5};
  m.roughness = 0.4;
});
const Material kMirror = with([](Material& m) { m.mirror = {0.6, 0.6, 0.6}; });
const Material kGlass = with([](Material& m) { m.transmission = {0.8, 0.8, 0.8}; });
const Material kFrosted = with([](Material& m) {
  m.transmission = {0.8, 0.8, 0.8};
  m.specular = {0.04, 0.04, 0.04};
  m.roughness = 0.4;
});
const Material kGlowing = with([](Material& m) { m.emission = {1, 1, 1}; });

const std::vector<Row<Material>> kMaterialRows{
    {"diffuse", "[0.8, 0.1, 0.1]", to(&Material::diffuse, {0.8, 0.1, 0.1})},
    {"diffuseMap", "\"dots\"", to(&Material::diffuseMap, "dots")},
    {"specular", "[0.4, 0.4, 0.4]", to(&Material::specular, {0.4, 0.4, 0.4})},
    {"specularMap", "\"dots\"", to(&Material::specularMap, "dots"), kGlossy},
    {"roughness", "0.2", to(&Material::roughness, 0.2), kGlossy},
    {"roughnessMap", "\"data\"", to(&Material::roughnessMap, "data"), kGlossy},
    {"emission", "[0, 0.5, 0]", to(&Material::emission, {0, 0.5, 0})},
    {"emissionMap", "\"dots\"", to(&Material::emissionMap, "dots"), kGlowing},
    {"normalMap", "\"dents\"", to(&Material::normalMap, "dents")},
    {"occlusionMap", "\"data\"", to(&Material::occlusionMap, "data")},
    {"alphaMap", "\"mask\"", to(&Material::alphaMap, "mask")},
    {"coverage", "0.4", to(&Material::coverage, 0.4)},
    {"coverageMap", "\"mask\"", to(&Material::coverageMap, "mask")},
    {"mirror", "[0.5, 0.5, 0.5]", to(&Material::mirror, Vector{0.5, 0.5, 0.5})},
    {"mirrorMap", "\"dots\"", to(&Material::mirrorMap, "dots"), kMirror},
    {"mirrorGrazing", "0.1", to(&Material::mirrorGrazing, Vector{0.1, 0.1, 0.1}), kMirror},
    {"transmission", "[0.9, 0.5, 0.2]", to(&Material::transmission, Vector{0.9, 0.5, 0.2})},
    {"transmissionMap", "\"dots\"", to(&Material::transmissionMap, "dots"), kGlass},
    {"thin", "true", to(&Material::thin, true), kGlass},
    {"frosted", "true", to(&Material::frosted, true), kFrosted},
    {"ior", "1.2", to(&Material::ior, 1.2), kGlass},
    {"absorption", "[2, 1, 0]", to(&Material::absorption, Vector{2, 1, 0}), kGlass},
    {"glossyReflection", "false", to(&Material::glossyReflection, false), kGlossy},
    {"castsShadow", "false", to(&Material::castsShadow, false)},
};

Camera looking(const std::function<void(Camera&)>& change) {
  Camera camera;
  camera.eye = {0, 1.6, 4};
  camera.at = {0, 0.7, 0};
  change(camera);
  return camera;
}
const Camera kPlain = looking([](Camera&) {});
const Camera kLens = looking([](Camera& c) { c.aperture = 0.5; });
const Camera kMatrix = looking([](Camera& c) {
  c.k = {30, 30, 18, 12};
  c.kSize = {36, 24};
});
const Camera kCircle = looking([](Camera& c) { c.projection = "equidistant"; });
const Camera kTable = looking([](Camera& c) {
  c.projection = "directions";
  c.azimuths = {-20, 0, 20};
  c.elevations = {-30, 0};
});
const Camera kPair = looking([](Camera& c) { c.stereo = "leftRight"; });

const std::vector<Row<Camera>> kCameraRows{
    {"eye", "[1, 2, 5]", to(&Camera::eye, {1, 2, 5}), kPlain},
    {"at", "[0, 0, 0]", to(&Camera::at, {0, 0, 0}), kPlain},
    {"up", "[1, 1, 0]", to(&Camera::up, {1, 1, 0}), kPlain},
    {"projection", "\"panorama\"", to(&Camera::projection, "panorama"), kPlain},
    {"fov", "30", to(&Camera::fov, 30), kPlain},
    {"orthographicHeight", "3", to(&Camera::orthographicHeight, 3), kPlain},
    {"aspect", "2", to(&Camera::aspect, 2), kPlain},
    {"aperture", "0.5", to(&Camera::aperture, 0.5), kPlain},
    {"focus", "1", to(&Camera::focus, 1), kLens},
    {"k", "[60, 60, 18, 12]", to(&Camera::k, {60, 60, 18, 12}), kMatrix},
    {"kSize", "[72, 48]", to(&Camera::kSize, {72, 48}), kMatrix},
    {"distortion", "[0.2, 0.1, 0, 0]", to(&Camera::distortion, {0.2, 0.1, 0, 0}), kMatrix},
    {"angle", "90", to(&Camera::angle, 90), kCircle},
    {"azimuths", "[-10, 0, 40]", to(&Camera::azimuths, {-10, 0, 40}), kTable},
    {"elevations", "[-10, 0]", to(&Camera::elevations, {-10, 0}), kTable},
    {"stereo", "\"leftRight\"", to(&Camera::stereo, "leftRight"), kPlain},
    {"eyeDistance", "0.5", to(&Camera::eyeDistance, 0.5), kPair},
};

Light shining(Light::Type type) {
  Light light;
  light.type = type;
  light.position = {1, 3, 2};
  light.direction = {-0.2, -1, -0.4};
  light.intensity = {20, 20, 20};
  light.outerConeAngle = 25;
  return light;
}
const Light kPoint = shining(Light::Type::point), kSpot = shining(Light::Type::spot),
            kSun = shining(Light::Type::directional);

const std::vector<Row<Light>> kLightRows{
    {"type",
     "\"spot\"",
     to(&Light::type, Light::Type::spot),
     kPoint,
     {{"direction", "[-0.2, -1, -0.4]"}, {"outerConeAngle", "25"}}},
    {"position", "[-2, 3, 1]", to(&Light::position, {-2, 3, 1}), kPoint},
    {"intensity", "[9, 20, 30]", to(&Light::intensity, {9, 20, 30}), kPoint},
    {"radius", "0.8", to(&Light::radius, 0.8), kPoint},
    {"direction", "[0.3, -1, 0]", to(&Light::direction, {0.3, -1, 0}), kSpot},
    {"irradiance", "[0.5, 0, 0]", to(&Light::intensity, {0.5, 0, 0}), kSun},
    {"innerConeAngle", "15", to(&Light::innerConeAngle, 15), kSpot},
    {"outerConeAngle", "40", to(&Light::outerConeAngle, 40), kSpot},
};

constexpr std::array<std::uint8_t, 12> kDots{200, 30, 10, 20, 180, 90, 5, 60, 220, 255, 255, 255};

SceneBuilder yard() {
  SceneBuilder builder("yard", R"({
    "cameras": {"main": {"eye": [0, 1.6, 4], "at": [0, 0.7, 0]}},
    "sky": {"zenith": [0.2, 0.4, 0.9], "horizon": [1, 0.9, 0.8], "ground": [0.3, 0.2, 0.1]},
    "ambient": {"up": 0.2, "down": 0.1},
    "textures": {"data": {"array": "data", "as": "data"},
                 "dents": {"pattern": "bricksNormals", "size": 32, "depth": 0.05},
                 "mask": {"pattern": "leafMask", "size": 32}},
    "materials": {"floor": {"diffuse": 0.5}, "a": {}},
    "scene": [{"shape": "quad", "width": 9, "depth": 9, "material": "floor"},
              {"shape": "icosphere", "radius": 0.6, "level": 2, "material": "a",
               "transform": {"translate": [-0.2, 0.7, 0]}},
              {"shape": "quad", "width": 1.2, "depth": 1.2, "material": "a",
               "transform": {"rotate": [1, 0, 0, 80], "translate": [-1.4, 0.8, 0.4]}}]})");
  ImageArrays image{2, 2, 3};
  image.codes = kDots;
  builder.addTexture("dots", image).addTexture("data", image);
  return builder;
}

// Each returns the JSON pointer to the noun.
std::string add(SceneBuilder& builder, const Camera& camera) {
  return builder.addCamera("main", camera);
}
std::string add(SceneBuilder& builder, const Material& material) {
  builder.addLight(kPoint);
  return builder.addMaterial("a", material);
}
std::string add(SceneBuilder& builder, const Light& light) { return builder.addLight(light); }

Image pictureOf(const SceneBuilder& builder) {
  // Frosted glass needs glossy samples, and the radius of a light samples of it.
  return smallRenderer(builder.build())
      .set("spp", "2")
      .set("glossy", "1")
      .set("light-samples", "2")
      .render();
}

// Expects that each row's member of the structure is the member of scene files.
template <typename Noun>
Names expectSamePictures(const std::vector<Row<Noun>>& rows) {
  Names names;
  for (const Row<Noun>& row : rows) {
    SCOPED_TRACE(row.name);
    names.insert(row.name);
    SceneBuilder before = yard(), byText = yard(), byMember = yard();
    add(before, row.base);

    const std::string noun = add(byText, row.base) + "/";
    byText.set(noun + row.name, row.value);
    for (const auto& [name, value] : row.also) byText.set(noun + name, value);

    Noun changed = row.base;
    row.set(changed);
    add(byMember, changed);

    const Image picture = pictureOf(byMember);
    EXPECT_TRUE(samePictures(picture, pictureOf(byText)));
    EXPECT_FALSE(samePictures(picture, pictureOf(before)));
  }
  return names;
}

template <typename Noun>
void expectAll(const Names& names) {
  forEachMember<Noun>([&](const auto& member) {
    if (!member.rules.inFiles) return;
    EXPECT_NE(names.contains(member.name), kOnlyByPointer.contains(member.name))
        << member.name << " is in no row, or in two";
  });
}

TEST(EveryMember, OfAMaterialIsOneOfTheLibrary) {
  expectAll<whit::Material>(expectSamePictures(kMaterialRows));
}

TEST(EveryMember, OfACameraIsOneOfTheLibrary) {
  expectAll<whit::Camera>(expectSamePictures(kCameraRows));
}

TEST(EveryMember, OfALightIsOneOfTheLibrary) {
  expectAll<whit::Light>(expectSamePictures(kLightRows));
}

}  // namespace
}  // namespace whit::api
