// Every member of a scene file's cameras, materials and lights can be given through whit.h: a
// member of the library's structures makes the picture that the same member of a scene file makes.
// A member that is in no table here fails.
#include <array>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/json_reader.h"
#include "library_scenes.h"
#include "scene/members.h"

namespace whit::api {
namespace {

using Names = std::set<std::string>;

// A value as scene files have it.
template <typename Value>
std::string textOf(const Value& value) {
  return Json(value).dump();
}
template <typename Value>
std::string textOf(const std::optional<Value>& value) {
  return textOf(value.value());
}
std::string textOf(Light::Type type) {
  return type == Light::Type::spot ? "\"spot\"" : "\"point\"";
}

template <typename Noun>
const Noun& defaultNoun() {
  static const Noun noun{};
  return noun;
}

// A member's name in scene files, and a value that it gets. It belongs to a noun that is at first
// as `base` is.
template <typename Noun>
struct Row {
  using Also = std::vector<std::pair<const char*, const char*>>;

  template <typename Value>
  Row(const char* name, Value Noun::*member, const std::type_identity_t<Value>& value,
      const Noun& base = defaultNoun<Noun>(), Also also = {})
      : name(name), value(textOf(value)), base(&base), changed(base), also(std::move(also)) {
    changed.*member = value;
  }

  std::string name, value;
  const Noun* base;
  Noun changed;
  Also also;  // what comes with the value in files
};

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
    {"diffuse", &Material::diffuse, {0.8, 0.1, 0.1}},
    {"diffuseMap", &Material::diffuseMap, "dots"},
    {"specular", &Material::specular, {0.4, 0.4, 0.4}},
    {"specularMap", &Material::specularMap, "dots", kGlossy},
    {"roughness", &Material::roughness, 0.2, kGlossy},
    {"roughnessMap", &Material::roughnessMap, "data", kGlossy},
    {"emission", &Material::emission, {0, 0.5, 0}},
    {"emissionMap", &Material::emissionMap, "dots", kGlowing},
    {"normalMap", &Material::normalMap, "dents"},
    {"occlusionMap", &Material::occlusionMap, "data"},
    {"alphaMap", &Material::alphaMap, "mask"},
    {"coverage", &Material::coverage, 0.4},
    {"coverageMap", &Material::coverageMap, "mask"},
    {"mirror", &Material::mirror, Vector{0.5, 0.5, 0.5}},
    {"mirrorMap", &Material::mirrorMap, "dots", kMirror},
    {"mirrorGrazing", &Material::mirrorGrazing, Vector{0.1, 0.1, 0.1}, kMirror},
    {"transmission", &Material::transmission, Vector{0.9, 0.5, 0.2}},
    {"transmissionMap", &Material::transmissionMap, "dots", kGlass},
    {"thin", &Material::thin, true, kGlass},
    {"frosted", &Material::frosted, true, kFrosted},
    {"ior", &Material::ior, 1.2, kGlass},
    {"absorption", &Material::absorption, Vector{2, 1, 0}, kGlass},
    {"glossyReflection", &Material::glossyReflection, false, kGlossy},
    {"castsShadow", &Material::castsShadow, false},
};

constexpr Vector kEye{0, 1.6, 4}, kAt{0, 0.7, 0};
const Camera kPlain{.eye = kEye, .at = kAt};
const Camera kLens{.eye = kEye, .at = kAt, .aperture = 0.5};
const Camera kMatrix{.eye = kEye, .at = kAt, .k = {30, 30, 18, 12}, .kSize = {36, 24}};
const Camera kCircle{.eye = kEye, .at = kAt, .projection = "equidistant"};
const Camera kTable{.eye = kEye,
                    .at = kAt,
                    .projection = "directions",
                    .azimuths = {-20, 0, 20},
                    .elevations = {-30, 0}};
const Camera kPair{.eye = kEye, .at = kAt, .stereo = "leftRight"};

const std::vector<Row<Camera>> kCameraRows{
    {"eye", &Camera::eye, {1, 2, 5}, kPlain},
    {"at", &Camera::at, {0, 0, 0}, kPlain},
    {"up", &Camera::up, {1, 1, 0}, kPlain},
    {"projection", &Camera::projection, "panorama", kPlain},
    {"fov", &Camera::fov, 30, kPlain},
    {"orthographicHeight", &Camera::orthographicHeight, 3, kPlain},
    {"aspect", &Camera::aspect, 2, kPlain},
    {"aperture", &Camera::aperture, 0.5, kPlain},
    {"focus", &Camera::focus, 1, kLens},
    {"k", &Camera::k, {60, 60, 18, 12}, kMatrix},
    {"kSize", &Camera::kSize, {72, 48}, kMatrix},
    {"distortion", &Camera::distortion, {0.2, 0.1, 0, 0}, kMatrix},
    {"angle", &Camera::angle, 90, kCircle},
    {"azimuths", &Camera::azimuths, {-10, 0, 40}, kTable},
    {"elevations", &Camera::elevations, {-10, 0}, kTable},
    {"stereo", &Camera::stereo, "leftRight", kPlain},
    {"eyeDistance", &Camera::eyeDistance, 0.5, kPair},
};

Light shining(Light::Type type) {
  return {.type = type,
          .position = {1, 3, 2},
          .direction = {-0.2, -1, -0.4},
          .intensity = {20, 20, 20},
          .outerConeAngle = 25};
}
const Light kPoint = shining(Light::Type::point), kSpot = shining(Light::Type::spot),
            kSun = shining(Light::Type::directional);

const std::vector<Row<Light>> kLightRows{
    {"type",
     &Light::type,
     Light::Type::spot,
     kPoint,
     {{"direction", "[-0.2, -1, -0.4]"}, {"outerConeAngle", "25"}}},
    {"position", &Light::position, {-2, 3, 1}, kPoint},
    {"intensity", &Light::intensity, {9, 20, 30}, kPoint},
    {"radius", &Light::radius, 0.8, kPoint},
    {"direction", &Light::direction, {0.3, -1, 0}, kSpot},
    {"irradiance", &Light::intensity, {0.5, 0, 0}, kSun},
    {"innerConeAngle", &Light::innerConeAngle, 15, kSpot},
    {"outerConeAngle", &Light::outerConeAngle, 40, kSpot},
};

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
  const ImageArrays image{2, 2, 3, kDots};
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
  std::map<const Noun*, Image> unchanged;  // the pictures of the bases
  for (const Row<Noun>& row : rows) {
    SCOPED_TRACE(row.name);
    names.insert(row.name);
    SceneBuilder byText = yard(), byMember = yard();
    const std::string noun = add(byText, *row.base) + "/";
    const auto [before, isNew] = unchanged.try_emplace(row.base);
    if (isNew) before->second = pictureOf(byText);

    byText.set(noun + row.name, row.value);
    for (const auto& [name, value] : row.also) byText.set(noun + name, value);
    add(byMember, row.changed);

    const Image picture = pictureOf(byMember);
    EXPECT_TRUE(samePictures(picture, pictureOf(byText)));
    EXPECT_FALSE(samePictures(picture, before->second));
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
