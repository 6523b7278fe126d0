// Every member of a scene file's cameras, materials and lights can be given through whit.h: a
// member of the library's structures makes the picture that the same member of a scene file makes.
// A member that is in no table here fails.
#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "io/json_reader.h"
#include "io/member_rows.h"
#include "library_scenes.h"
#include "scene/members.h"

namespace whit::api {
namespace {

// Reads a value as scene files have it.
template <typename Value>
void read(const PlainJson& json, Value& value) {
  value = json.get<Value>();
}
template <typename Value>
void read(const PlainJson& json, std::optional<Value>& value) {
  value = json.get<Value>();
}
void read(const PlainJson& json, Light::Type& type) {
  const auto& words = kWords<whit::Light::Kind>;
  const auto* const found = std::ranges::find(words, json.get<std::string>());
  type = static_cast<Light::Type>(found - words.begin());
}

// Reads a member of a structure.
template <typename Noun>
struct Reader {
  template <typename Value>
  Reader(Value Noun::*member)  // NOLINT(google-explicit-constructor): tables name members alone
      : to([=](const PlainJson& json, Noun& noun) { read(json, noun.*member); }) {}

  std::function<void(const PlainJson&, Noun&)> to;
};

template <typename Noun>
using Readers = std::map<std::string, Reader<Noun>>;

// SceneBuilder::set() alone gives these.
const std::set<std::string> kOnlyByPointer{"alphaCutoff", "diffuseReflection", "priority", "coat",
                                           "doubleSided"};

const Readers<Material> kMaterialMembers{
    {"diffuse", &Material::diffuse},
    {"diffuseMap", &Material::diffuseMap},
    {"specular", &Material::specular},
    {"specularMap", &Material::specularMap},
    {"roughness", &Material::roughness},
    {"roughnessMap", &Material::roughnessMap},
    {"emission", &Material::emission},
    {"emissionMap", &Material::emissionMap},
    {"normalMap", &Material::normalMap},
    {"occlusionMap", &Material::occlusionMap},
    {"alphaMap", &Material::alphaMap},
    {"coverage", &Material::coverage},
    {"coverageMap", &Material::coverageMap},
    {"mirror", &Material::mirror},
    {"mirrorMap", &Material::mirrorMap},
    {"mirrorGrazing", &Material::mirrorGrazing},
    {"transmission", &Material::transmission},
    {"transmissionMap", &Material::transmissionMap},
    {"thin", &Material::thin},
    {"frosted", &Material::frosted},
    {"ior", &Material::ior},
    {"absorption", &Material::absorption},
    {"glossyReflection", &Material::glossyReflection},
    {"castsShadow", &Material::castsShadow},
};

const Readers<Camera> kCameraMembers{
    {"eye", &Camera::eye},
    {"at", &Camera::at},
    {"up", &Camera::up},
    {"projection", &Camera::projection},
    {"fov", &Camera::fov},
    {"orthographicHeight", &Camera::orthographicHeight},
    {"aspect", &Camera::aspect},
    {"aperture", &Camera::aperture},
    {"focus", &Camera::focus},
    {"k", &Camera::k},
    {"kSize", &Camera::kSize},
    {"distortion", &Camera::distortion},
    {"angle", &Camera::angle},
    {"azimuths", &Camera::azimuths},
    {"elevations", &Camera::elevations},
    {"stereo", &Camera::stereo},
    {"eyeDistance", &Camera::eyeDistance},
};

const Readers<Light> kLightMembers{
    {"type", &Light::type},
    {"position", &Light::position},
    {"intensity", &Light::intensity},
    {"radius", &Light::radius},
    {"direction", &Light::direction},
    {"irradiance", &Light::intensity},
    {"innerConeAngle", &Light::innerConeAngle},
    {"outerConeAngle", &Light::outerConeAngle},
};

void add(SceneBuilder& builder, const Camera& camera) { builder.addCamera("main", camera); }
void add(SceneBuilder& builder, const Material& material) { builder.addMaterial("a", material); }
void add(SceneBuilder& builder, const Light& light) { builder.addLight(light); }

Image pictureOf(const SceneBuilder& builder) {
  // Frosted glass needs glossy samples, and the radius of a light samples of it.
  return smallRenderer(builder.build())
      .set("spp", "2")
      .set("glossy", "1")
      .set("light-samples", "2")
      .render();
}

// Expects the picture of each row's noun, which `place` leads to in the scene, to be that of a
// structure with the same members.
template <typename Noun>
void expectSamePictures(const MemberRows& rows, const Readers<Noun>& readers, const char* place,
                        const PlainJson& noun, const PlainJson& scene = yard()) {
  for (const MemberRow& row : rows) {
    SCOPED_TRACE(row.name);
    const bool isOnlyByPointer = kOnlyByPointer.contains(row.name);
    ASSERT_NE(isOnlyByPointer, readers.contains(row.name)) << "in no table, or in two";
    if (isOnlyByPointer) continue;

    const auto [before, after] = withoutAndWith(row, noun);
    Noun structure;
    for (const auto& [name, value] : after.items()) readers.at(name).to(value, structure);

    SceneBuilder unchanged("yard", scene.dump()), byText = unchanged, byMember = unchanged;
    unchanged.set(place, before.dump());
    byText.set(place, after.dump());
    add(byMember, structure);

    const Image picture = pictureOf(byMember);
    EXPECT_TRUE(samePictures(picture, pictureOf(byText)));
    EXPECT_FALSE(samePictures(picture, pictureOf(unchanged)));
  }
}

TEST(EveryMember, OfAMaterialIsOneOfTheLibrary) {
  expectSamePictures(kMaterialRows, kMaterialMembers, "/materials/a", yard()["materials"]["a"]);
}

TEST(EveryMember, OfACameraIsOneOfTheLibrary) {
  expectSamePictures(kCameraRows, kCameraMembers, "/cameras/main", yard()["cameras"]["main"]);
}

// Each light is alone.
TEST(EveryMember, OfALightIsOneOfTheLibrary) {
  PlainJson dark = yard();
  const PlainJson lights = std::exchange(dark["lights"], PlainJson::array());
  const MemberRows* const rows[] = {&kPointRows, &kSpotRows, &kSunRows};
  for (const std::size_t i : {0, 1, 2}) {
    expectSamePictures(*rows[i], kLightMembers, "/lights/-", lights[i], dark);
  }
}

}  // namespace
}  // namespace whit::api
