// Every member of a scene file's cameras, materials, lights, sky and ambient light changes the
// picture: from the file to the pixels, on both paths. A member that is not in a table fails.
#include <array>
#include <map>
#include <set>
#include <tuple>

#include "inspect/reference_frame.h"
#include "member_rows.h"
#include "render/renderer.h"
#include "scene/members.h"

namespace whit {
namespace {

const MemberRows kSkyRows{
    {"zenith", "[1, 0, 0]"},
    {"horizon", "[0, 1, 0]"},
    {"ground", "[0, 0, 1]"},
    {"scale", "2"},
    // The gradient goes.
    {"rotation", "90", "{'image': 'sky.hdr', 'zenith': null, 'horizon': null, 'ground': null}"},
};

const MemberRows kAmbientRows{
    {"up", "[0, 0.5, 0]"},
    {"down", "[0.5, 0, 0]"},
    {"occlusion", "0.3"},
    {"reflection", "0.2"},
};

const MemberRows kFogRows{
    {"density", "[0.1, 0, 0]"},
    {"color", "0.4", "{'density': 0.1}"},
};

// Where each noun is in the scene file.
const std::pair<const char*, MemberRows> kRows[] = {
    {"/cameras/main", kCameraRows}, {"/materials/a", kMaterialRows},
    {"/lights/0", kPointRows},      {"/lights/1", kSpotRows},
    {"/lights/2", kSunRows},        {"/sky", kSkyRows},
    {"/ambient", kAmbientRows},     {"/fog", kFogRows},
};

// Expects every member that files may have to be in one of these tables.
template <typename Noun>
void expectRowsOfAll(const std::vector<MemberRows>& tables) {
  std::set<std::string> names;
  for (const MemberRows& rows : tables) {
    for (const MemberRow& row : rows) names.insert(row.name);
  }
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
  std::map<std::string, std::array<Image, 2>> pictures;
  for (const auto& [noun, rows] : kRows) {
    const PlainJson::json_pointer place(noun);
    for (const MemberRow& row : rows) {
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
}

TEST_F(EveryMember, IsInARow) {
  expectRowsOfAll<Camera>({kCameraRows});
  expectRowsOfAll<Material>({kMaterialRows});
  expectRowsOfAll<Light>({kPointRows, kSpotRows, kSunRows});
  expectRowsOfAll<Sky>({kSkyRows});
  expectRowsOfAll<Ambient>({kAmbientRows});
  expectRowsOfAll<Fog>({kFogRows});
}

}  // namespace
}  // namespace whit
