// Every member of a scene file's cameras, materials, lights, sky and ambient light changes the
// picture: from the file to the pixels, on both paths. A member that is not in a table fails.
#include <array>
#include <map>
#include <set>

#include "inspect/reference_frame.h"
#include "member_rows.h"
#include "render/renderer.h"
#include "scene/members.h"

namespace whit {
namespace {

using Names = std::set<std::string>;

const char kCamera[] = "/cameras/main", kMaterial[] = "/materials/a", kPoint[] = "/lights/0",
           kSpot[] = "/lights/1", kSun[] = "/lights/2", kSky[] = "/sky", kAmbient[] = "/ambient",
           kFog[] = "/fog";

const std::pair<const char*, MemberRows> kRows[] = {
    {kCamera, kCameraRows},
    {kMaterial, kMaterialRows},
    {kPoint, kPointRows},
    {kSpot, kSpotRows},
    {kSun, kSunRows},
    {kSky,
     {
         {"zenith", "[1, 0, 0]"},
         {"horizon", "[0, 1, 0]"},
         {"ground", "[0, 0, 1]"},
         {"scale", "2"},
         // The gradient goes.
         {"rotation", "90",
          "{'image': 'sky.hdr', 'zenith': null, 'horizon': null, 'ground': null}"},
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
    for (const MemberRow& row : rows) {
      tested[noun].insert(row.name);

      PlainJson before = yard();
      PlainJson after = before;
      std::tie(before[place], after[place]) = withoutAndWith(row, before[place]);

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
