// Every member of a scene file's cameras, materials, lights, sky and ambient light changes the
// picture: from the file to the pixels, on both paths. A member that is not in a table fails.
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "inspect/reference_frame.h"
#include "render/renderer.h"
#include "scene/members.h"
#include "scene_files.h"

namespace whit {
namespace {

using PlainJson = nlohmann::json;
using Names = std::set<std::string>;

// A member in a scene file: the noun's place, the name and a value, and as JSON objects members
// that have to be there as well, and those that come with the value.
struct Row {
  const char *place, *name, *value;
  const char* beside = "{}";
  const char* with = "{}";
};

const char kCamera[] = "/cameras/main", kMaterial[] = "/materials/a", kPoint[] = "/lights/0",
           kSpot[] = "/lights/1", kSun[] = "/lights/2", kSky[] = "/sky", kAmbient[] = "/ambient",
           kFog[] = "/fog";

constexpr const char* kGlossy = R"({"diffuse": 0.2, "specular": 0.5, "roughness": 0.4})";
constexpr const char* kMirror = R"({"diffuse": 0.2, "mirror": 0.6})";
constexpr const char* kGlass = R"({"diffuse": 0.1, "transmission": 0.8})";
constexpr const char* kMatrix = R"({"k": [30, 30, 18, 12], "kSize": [36, 24]})";
constexpr const char* kCircle = R"({"projection": "equidistant"})";
constexpr const char* kTable =
    R"({"projection": "directions", "azimuths": [-20, 0, 20], "elevations": [-30, 0]})";

const Row kRows[] = {
    {kCamera, "eye", "[1, 2, 5]"},
    {kCamera, "at", "[0, 0, 0]"},
    {kCamera, "up", "[1, 1, 0]"},
    {kCamera, "projection", "\"panorama\""},
    {kCamera, "fov", "30"},
    {kCamera, "orthographicHeight", "3"},
    {kCamera, "aspect", "2"},
    {kCamera, "aperture", "0.5"},
    {kCamera, "focus", "1", R"({"aperture": 0.5})"},
    {kCamera, "k", "[60, 60, 18, 12]", kMatrix},
    {kCamera, "kSize", "[72, 48]", kMatrix},
    {kCamera, "distortion", "[0.2, 0.1, 0, 0]", kMatrix},
    {kCamera, "angle", "90", kCircle},
    {kCamera, "azimuths", "[-10, 0, 40]", kTable},
    {kCamera, "elevations", "[-10, 0]", kTable},
    {kCamera, "stereo", "\"leftRight\""},
    {kCamera, "eyeDistance", "0.5", R"({"stereo": "leftRight"})"},

    {kMaterial, "diffuse", "[0.8, 0.1, 0.1]"},
    {kMaterial, "diffuseMap", "\"checker\""},
    {kMaterial, "specular", "0.4"},
    {kMaterial, "specularMap", "\"checker\"", kGlossy},
    {kMaterial, "roughness", "0.2", kGlossy},
    {kMaterial, "roughnessMap", "\"data\"", kGlossy},
    {kMaterial, "emission", "[0, 0.5, 0]"},
    {kMaterial, "emissionMap", "\"checker\"", R"({"emission": 1})"},
    {kMaterial, "normalMap", "\"dents\""},
    {kMaterial, "occlusionMap", "\"data\""},
    {kMaterial, "alphaMap", "\"mask\""},
    {kMaterial, "alphaCutoff", "0.95", R"({"alphaMap": "mask"})"},
    {kMaterial, "coverage", "0.4"},
    {kMaterial, "coverageMap", "\"mask\""},
    {kMaterial, "mirror", "0.5"},
    {kMaterial, "mirrorMap", "\"checker\"", kMirror},
    {kMaterial, "mirrorGrazing", "0.1", kMirror},
    {kMaterial, "transmission", "[0.9, 0.5, 0.2]"},
    {kMaterial, "transmissionMap", "\"checker\"", kGlass},
    {kMaterial, "thin", "true", kGlass},
    {kMaterial, "frosted", "true",
     R"({"diffuse": 0.1, "transmission": 0.8, "specular": 0.04, "roughness": 0.4})"},
    {kMaterial, "ior", "1.2", kGlass},
    {kMaterial, "absorption", "[2, 1, 0]", kGlass},
    {kMaterial, "priority", "5", kGlass},
    {kMaterial, "diffuseReflection", "false"},
    {kMaterial, "glossyReflection", "false", kGlossy},
    {kMaterial, "castsShadow", "false"},
    {kMaterial, "coat", "true", kMirror},
    {kMaterial, "doubleSided", "false"},

    {kPoint, "type", "\"spot\"", "{}", R"({"direction": [0, -1, 0]})"},
    {kPoint, "position", "[-2, 3, 1]"},
    {kPoint, "intensity", "[9, 20, 30]"},
    {kPoint, "radius", "0.8"},
    {kSpot, "direction", "[0.3, -1, 0]"},
    {kSpot, "innerConeAngle", "5"},
    {kSpot, "outerConeAngle", "40"},
    {kSun, "irradiance", "[0.5, 0, 0]"},

    {kSky, "zenith", "[1, 0, 0]"},
    {kSky, "horizon", "[0, 1, 0]"},
    {kSky, "ground", "[0, 0, 1]"},
    {kSky, "scale", "2"},
    {kSky, "rotation", "90", R"({"image": "sky.hdr"})"},

    {kAmbient, "up", "[0, 0.5, 0]"},
    {kAmbient, "down", "[0.5, 0, 0]"},
    {kAmbient, "occlusion", "0.3"},
    {kAmbient, "reflection", "0.2"},

    {kFog, "density", "[0.1, 0, 0]"},
    {kFog, "color", "0.4", R"({"density": 0.1})"},
};

PlainJson yard() {
  return PlainJson::parse(R"({"whit": 1, "size": [36, 24],
    "cameras": {"main": {"eye": [0, 1.6, 4], "at": [0, 0.7, 0], "fov": 50}},
    "lights": [{"type": "point", "position": [2, 3, 2], "intensity": [20, 20, 20], "radius": 0.3},
               {"type": "spot", "position": [-1.5, 4, 1], "direction": [0, -1, 0],
                "intensity": [40, 30, 20], "innerConeAngle": 15, "outerConeAngle": 25},
               {"type": "directional", "direction": [-1, -2, -1], "irradiance": [0.3, 0.3, 0.3]}],
    "sky": {"zenith": [0.2, 0.4, 0.9], "horizon": [1, 0.9, 0.8], "ground": [0.3, 0.2, 0.1]},
    "ambient": {"up": 0.2, "down": 0.1, "occlusion": 1.5, "reflection": 1},
    "textures": {"checker": {"pattern": "checker", "size": 32, "columns": 6, "rows": 6},
                 "data": {"image": "data.tga", "as": "data"},
                 "dents": {"pattern": "bricksNormals", "size": 32, "depth": 0.05},
                 "mask": {"pattern": "leafMask", "size": 32}},
    "materials": {"floor": {"diffuse": 0.5}, "a": {"diffuse": 0.6, "doubleSided": true},
                  "glossy": {"diffuse": 0.1, "specular": 0.6, "roughness": 0.5},
                  "glass": {"diffuse": 0, "transmission": 0.9, "ior": 1.5, "priority": 1}},
    "scene": [{"shape": "quad", "width": 9, "depth": 9, "material": "floor"},
              {"shape": "icosphere", "radius": 0.7, "level": 2, "material": "glossy",
               "transform": {"translate": [1.3, 0.7, 0]}},
              {"shape": "icosphere", "radius": 0.35, "level": 2, "material": "glass",
               "transform": {"translate": [0.2, 0.7, 0.5]}},
              {"shape": "icosphere", "radius": 0.6, "level": 2, "material": "a",
               "transform": {"translate": [-0.2, 0.7, 0]}},
              {"shape": "quad", "width": 1.2, "depth": 1.2, "material": "a",
               "transform": {"rotate": [1, 0, 0, -80], "translate": [-1.4, 0.8, 0.4]}}]})");
}

class EveryMember : public SceneFileTest {
 protected:
  EveryMember() {
    // A sky of two halves; texels are red, green, blue and a common exponent.
    std::string sky = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n";
    for (int i = 0; i < 8; ++i) sky += i % 4 < 2 ? "\x80\x20\x10\x81" : "\x10\x20\x80\x80";
    save("sky.hdr", sky);
    save("data.tga", tga(2, 2, {{255, 255, 255}, {40, 40, 40}, {90, 90, 90}, {200, 200, 200}}));
  }

  // By packets and by the reference, of a scene that is loaded once.
  std::array<Image, 2> picturesOf(const PlainJson& scene) {
    Warnings warnings;
    const Scene loaded =
        Scene::finalize(loadScene(save("s.json", scene.dump()), options_, warnings), warnings);
    RenderOptions options;
    options.spp = 2;
    options.threads = 1;
    options.depth = 4;
    options.lightSamples = options.ambientSamples = 2;
    options.glossy = withRays_ ? 1 : 0;
    options.indirect = indirect_;

    Renderer renderer(loaded, options);
    Film packets = makeFilm(loaded, options), reference = packets;
    const Camera camera = chooseCamera(loaded, options);
    renderer.render(camera, packets);
    renderReference(renderer, camera, reference);
    return {packets.image, reference.image};
  }

  int indirect_ = 0;
  bool withRays_ = false;  // rough surfaces sample their lobe, in place of a blurred sky
};

TEST_F(EveryMember, ChangesThePicture) {
  std::map<std::string, Names> tested;
  std::map<std::string, std::array<Image, 2>> pictures;
  for (const Row& row : kRows) {
    tested[row.place].insert(row.name);
    const PlainJson::json_pointer place(row.place);

    PlainJson before = yard();
    const PlainJson beside = PlainJson::parse(row.beside);
    if (beside.contains("image"))
      before[place] = PlainJson::object();  // the gradient of the sky goes
    before[place].update(beside);
    PlainJson after = before;
    after[place].update(PlainJson::parse(row.with));
    after[place][row.name] = PlainJson::parse(row.value);

    // Samples of the lobe see the material's own members, and the blurred sky the ambient light's.
    withRays_ = std::string(row.name) == "glossyReflection" || std::string(row.name) == "frosted";
    indirect_ = std::string(row.name) == "diffuseReflection" ? 1 : 0;
    SCOPED_TRACE(std::string(row.place) + "/" + row.name);

    // Most rows begin with the same scene.
    const std::string key = before.dump() + std::to_string(indirect_) + std::to_string(withRays_);
    if (!pictures.contains(key)) pictures[key] = picturesOf(before);
    const std::array<Image, 2> changed = picturesOf(after);
    EXPECT_TRUE(pictures[key][0].pixels != changed[0].pixels) << "by packets";
    EXPECT_TRUE(pictures[key][1].pixels != changed[1].pixels) << "by the reference";
  }

  const auto expectTested = [&]<typename Noun>(const Names& names, const Noun*) {
    forEachMember<Noun>([&](const auto& member) {
      if (!member.rules.inFiles) return;
      EXPECT_TRUE(names.contains(member.name)) << member.name << " is in no row";
    });
  };
  Names ofLights = tested[kPoint];
  ofLights.merge(tested[kSpot]);
  ofLights.merge(tested[kSun]);
  expectTested(tested[kCamera], static_cast<const Camera*>(nullptr));
  expectTested(tested[kMaterial], static_cast<const Material*>(nullptr));
  expectTested(ofLights, static_cast<const Light*>(nullptr));
  expectTested(tested[kSky], static_cast<const Sky*>(nullptr));
  expectTested(tested[kAmbient], static_cast<const Ambient*>(nullptr));
  expectTested(tested[kFog], static_cast<const Fog*>(nullptr));
}

}  // namespace
}  // namespace whit
