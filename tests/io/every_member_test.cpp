// Every member of a scene file's cameras, materials, lights, sky and ambient light changes the
// picture: from the file to the pixels, on both paths. A member that is not in a table fails.
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "inspect/reference_frame.h"
#include "render/renderer.h"
#include "scene/members.h"
#include "scene_files.h"

namespace whit {
namespace {

using PlainJson = nlohmann::json;
using Names = std::set<std::string>;

// A member in a scene file: the name and a value, and as JSON objects members that have to be there
// as well, and those that come with the value.
struct Row {
  const char *name, *value;
  const char* beside = "{}";
  const char* with = "{}";
};

const char kCamera[] = "/cameras/main", kMaterial[] = "/materials/a", kPoint[] = "/lights/0",
           kSpot[] = "/lights/1", kSun[] = "/lights/2", kSky[] = "/sky", kAmbient[] = "/ambient",
           kFog[] = "/fog";

constexpr const char* kGlossy = "{'diffuse': 0.2, 'specular': 0.5, 'roughness': 0.4}";
constexpr const char* kMirror = "{'diffuse': 0.2, 'mirror': 0.6}";
constexpr const char* kGlass = "{'diffuse': 0.1, 'transmission': 0.8}";
constexpr const char* kMatrix = "{'k': [30, 30, 18, 12], 'kSize': [36, 24]}";
constexpr const char* kCircle = "{'projection': 'equidistant'}";
constexpr const char* kTable =
    "{'projection': 'directions', 'azimuths': [-20, 0, 20], 'elevations': [-30, 0]}";

const std::pair<const char*, std::vector<Row>> kRows[] = {
    {kCamera,
     {
         {"eye", "[1, 2, 5]"},
         {"at", "[0, 0, 0]"},
         {"up", "[1, 1, 0]"},
         {"projection", "'panorama'"},
         {"fov", "30"},
         {"orthographicHeight", "3"},
         {"aspect", "2"},
         {"aperture", "0.5"},
         {"focus", "1", "{'aperture': 0.5}"},
         {"k", "[60, 60, 18, 12]", kMatrix},
         {"kSize", "[72, 48]", kMatrix},
         {"distortion", "[0.2, 0.1, 0, 0]", kMatrix},
         {"angle", "90", kCircle},
         {"azimuths", "[-10, 0, 40]", kTable},
         {"elevations", "[-10, 0]", kTable},
         {"stereo", "'leftRight'"},
         {"eyeDistance", "0.5", "{'stereo': 'leftRight'}"},
     }},
    {kMaterial,
     {
         {"diffuse", "[0.8, 0.1, 0.1]"},
         {"diffuseMap", "'checker'"},
         {"specular", "0.4"},
         {"specularMap", "'checker'", kGlossy},
         {"roughness", "0.2", kGlossy},
         {"roughnessMap", "'data'", kGlossy},
         {"emission", "[0, 0.5, 0]"},
         {"emissionMap", "'checker'", "{'emission': 1}"},
         {"normalMap", "'dents'"},
         {"occlusionMap", "'data'"},
         {"alphaMap", "'mask'"},
         {"alphaCutoff", "0.95", "{'alphaMap': 'mask'}"},
         {"coverage", "0.4"},
         {"coverageMap", "'mask'"},
         {"mirror", "0.5"},
         {"mirrorMap", "'checker'", kMirror},
         {"mirrorGrazing", "0.1", kMirror},
         {"transmission", "[0.9, 0.5, 0.2]"},
         {"transmissionMap", "'checker'", kGlass},
         {"thin", "true", kGlass},
         {"frosted", "true",
          "{'diffuse': 0.1, 'transmission': 0.8, 'specular': 0.04, 'roughness': 0.4}"},
         {"ior", "1.2", kGlass},
         {"absorption", "[2, 1, 0]", kGlass},
         {"priority", "5", kGlass},
         {"diffuseReflection", "false"},
         {"glossyReflection", "false", kGlossy},
         {"castsShadow", "false"},
         {"coat", "true", kMirror},
         {"doubleSided", "false"},
     }},
    {kPoint,
     {
         {"type", "'spot'", "{}", "{'direction': [0, -1, 0]}"},
         {"position", "[-2, 3, 1]"},
         {"intensity", "[9, 20, 30]"},
         {"radius", "0.8"},
     }},
    {kSpot,
     {
         {"direction", "[0.3, -1, 0]"},
         {"innerConeAngle", "5"},
         {"outerConeAngle", "40"},
     }},
    {kSun,
     {
         {"irradiance", "[0.5, 0, 0]"},
     }},
    {kSky,
     {
         {"zenith", "[1, 0, 0]"},
         {"horizon", "[0, 1, 0]"},
         {"ground", "[0, 0, 1]"},
         {"scale", "2"},
         {"rotation", "90", "{'image': 'sky.hdr'}"},
     }},
    {kAmbient,
     {
         {"up", "[0, 0.5, 0]"},
         {"down", "[0.5, 0, 0]"},
         {"occlusion", "0.3"},
         {"reflection", "0.2"},
     }},
    {kFog,
     {
         {"density", "[0.1, 0, 0]"},
         {"color", "0.4", "{'density': 0.1}"},
     }},
};

PlainJson parse(const char* text) { return PlainJson::parse(asJson(text)); }

PlainJson yard() {
  return parse(
      "{'whit': 1, 'size': [36, 24],"
      "'cameras': {'main': {'eye': [0, 1.6, 4], 'at': [0, 0.7, 0], 'fov': 50}},"
      "'lights': [{'type': 'point', 'position': [2, 3, 2], 'intensity': 20, 'radius': 0.3},"
      "{'type': 'spot', 'position': [-1.5, 4, 1], 'direction': [0, -1, 0],"
      "'intensity': [40, 30, 20], 'innerConeAngle': 15, 'outerConeAngle': 25},"
      "{'type': 'directional', 'direction': [-1, -2, -1], 'irradiance': 0.3}],"
      "'sky': {'zenith': [0.2, 0.4, 0.9], 'horizon': [1, 0.9, 0.8], 'ground': [0.3, 0.2, 0.1]},"
      "'ambient': {'up': 0.2, 'down': 0.1, 'occlusion': 1.5, 'reflection': 1},"
      "'textures': {'checker': {'pattern': 'checker', 'size': 32, 'columns': 6, 'rows': 6},"
      "'data': {'image': 'data.tga', 'as': 'data'},"
      "'dents': {'pattern': 'bricksNormals', 'size': 32, 'depth': 0.05},"
      "'mask': {'pattern': 'leafMask', 'size': 32}},"
      "'materials': {'floor': {'diffuse': 0.5}, 'a': {'diffuse': 0.6, 'doubleSided': true},"
      "'glossy': {'diffuse': 0.1, 'specular': 0.6, 'roughness': 0.5},"
      "'glass': {'diffuse': 0, 'transmission': 0.9, 'ior': 1.5, 'priority': 1}},"
      "'scene': [{'shape': 'quad', 'width': 9, 'depth': 9, 'material': 'floor'},"
      "{'shape': 'icosphere', 'radius': 0.7, 'level': 2, 'material': 'glossy',"
      "'transform': {'translate': [1.3, 0.7, 0]}},"
      "{'shape': 'icosphere', 'radius': 0.35, 'level': 2, 'material': 'glass',"
      "'transform': {'translate': [0.2, 0.7, 0.5]}},"
      "{'shape': 'icosphere', 'radius': 0.6, 'level': 2, 'material': 'a',"
      "'transform': {'translate': [-0.2, 0.7, 0]}},"
      "{'shape': 'quad', 'width': 1.2, 'depth': 1.2, 'material': 'a',"
      "'transform': {'rotate': [1, 0, 0, -80], 'translate': [-1.4, 0.8, 0.4]}}]}");
}

// Expects every member that files may have to be among these.
template <typename Noun>
void expectTested(const Names& names) {
  forEachMember<Noun>([&](const auto& member) {
    if (!member.rules.inFiles) return;
    EXPECT_TRUE(names.contains(member.name)) << member.name << " is in no row";
  });
}

class EveryMember : public SceneFileTest {
 protected:
  EveryMember() {
    // A sky of two halves; texels are red, green, blue and a common exponent.
    std::string sky = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n";
    for (int i = 0; i < 8; ++i) sky += i % 4 < 2 ? "\x80\x20\x10\x81" : "\x10\x20\x80\x80";
    save("sky.hdr", sky);
    saveImage("data.tga", {"ffffff", "282828", "5a5a5a", "c8c8c8"}, 2);
  }

  // By packets and by the reference, of a scene that is loaded once.
  std::array<Image, 2> picturesOf(const PlainJson& scene) {
    const Scene loaded = bake(load(save("s.json", scene.dump())));
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
  for (const auto& [noun, rows] : kRows) {
    const PlainJson::json_pointer place(noun);
    for (const Row& row : rows) {
      tested[noun].insert(row.name);

      PlainJson before = yard();
      const PlainJson beside = parse(row.beside);
      if (beside.contains("image"))
        before[place] = PlainJson::object();  // the gradient of the sky goes
      before[place].update(beside);
      PlainJson after = before;
      after[place].update(parse(row.with));
      after[place][row.name] = parse(row.value);

      // Samples of the lobe see the material's own members, and the blurred sky the ambient
      // light's.
      const std::string name = row.name;
      withRays_ = name == "glossyReflection" || name == "frosted";
      indirect_ = name == "diffuseReflection" ? 1 : 0;
      SCOPED_TRACE(joined(noun, "/", name));

      // Most rows begin with the same scene.
      const std::string key = joined(before.dump(), indirect_, withRays_);
      if (!pictures.contains(key)) pictures[key] = picturesOf(before);
      const std::array<Image, 2> changed = picturesOf(after);
      EXPECT_TRUE(pictures[key][0].pixels != changed[0].pixels) << "by packets";
      EXPECT_TRUE(pictures[key][1].pixels != changed[1].pixels) << "by the reference";
    }
  }

  Names ofLights = tested[kPoint];
  ofLights.merge(tested[kSpot]);
  ofLights.merge(tested[kSun]);
  expectTested<Camera>(tested[kCamera]);
  expectTested<Material>(tested[kMaterial]);
  expectTested<Light>(ofLights);
  expectTested<Sky>(tested[kSky]);
  expectTested<Ambient>(tested[kAmbient]);
  expectTested<Fog>(tested[kFog]);
}

}  // namespace
}  // namespace whit
