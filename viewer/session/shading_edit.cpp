#include <filesystem>
#include <set>

#include "io/load_scene.h"
#include "io/scene/scene_sections.h"
#include "make/model_view.h"
#include "viewer/session/frame_tracer.h"

namespace whit::view {

namespace {

// A member whose default value depends on a changed member has to be set as well. Settings have
// coordinates of the file, which `origin` was subtracted from.
template <typename Noun>
void addMembers(const Noun& read, const Noun& edited, const Vec3d& origin,
                std::vector<std::string>& settings) {
  std::set<std::string_view> decided;
  forEachMemberInFiles(read, [&](const auto& member) {
    const auto& value = edited.*member.field;
    const bool changed = !(read.*member.field == value);
    if (changed) decided.insert(member.rules.decides.begin(), member.rules.decides.end());

    if (!changed && !decided.contains(member.name)) return;
    Json noun{{member.name, describe(value)}};
    movePoints(noun, origin);
    settings.push_back(edited.pointer + "/" + member.name + "=" + noun[member.name].dump());
  });
}

void addMaterial(const Material& read, const Material& edited, std::vector<std::string>& settings) {
  addMembers(read, edited, {}, settings);
  // A model may have a specular map although the material is not glossy, which readers leave out.
  if (!read.hasGlossy() && edited.hasGlossy() && edited.specularMap == kNoTexture) {
    settings.push_back(edited.pointer + "/specularMap=null");
  }
}

// With `whole` a sky from another source is stated even if it has not changed.
void addSky(const SkyChoice& read, const SkyChoice& edited, bool whole,
            std::vector<std::string>& settings) {
  const auto say = [&](const char* pointer, const Json& value) {
    settings.push_back(pointer + ("=" + value.dump()));
  };

  if (edited == read && !whole) return;
  if (!edited.source.empty()) return say("/sky", describeSky(edited));
  if (edited.scale != read.scale) say("/sky/scale", describe(edited.scale));
  if (edited.rotation != read.rotation) say("/sky/rotation", describe(edited.rotation));
}

}  // namespace

SkyChoice skyOf(const OpenScene& scene) {
  const Sky& sky = scene.scene.sky;
  SkyChoice choice{"", sky.kind, sky.scale, sky.rotation};

  if (!scene.load.sky.empty()) {
    choice.source = chooseSky(scene.load.sky).source;
  } else if (sky.name == kStudio) {
    choice.source = kStudio;
  }
  return choice;
}

SkyChoice chooseSky(const std::string& source) {
  if (source == kNoSky) return {source};
  if (source == kStudio) return {source, Sky::Kind::image};
  return {std::filesystem::absolute(source).lexically_normal().string(), Sky::Kind::image};
}

Json describeSky(const SkyChoice& sky) {
  if (sky.kind == Sky::Kind::none) return {{"color", 0}};
  Json json{{"scale", describe(sky.scale)}, {"rotation", describe(sky.rotation)}};
  json[sky.source == kStudio ? "preset" : "image"] = sky.source;
  return json;
}

ShadingEdit withoutEdits(const std::shared_ptr<const OpenScene>& scene) {
  return {scene,         scene->scene.materials, scene->scene.lights,
          skyOf(*scene), scene->scene.ambient,   {}};
}

std::vector<std::string> editSettings(const ShadingEdit& read, const ShadingEdit& edited) {
  std::vector<std::string> settings;
  const Vec3d origin = read.scene ? read.scene->scene.origin : Vec3d();
  for (std::size_t i = 0; i < read.lights.size(); ++i) {
    addMembers(read.lights[i], edited.lights[i], origin, settings);
  }

  for (std::size_t i = 0; i < read.materials.size(); ++i) {
    addMaterial(read.materials[i], edited.materials[i], settings);
  }
  const bool ambientChanged = !sameAmbient(read.ambient, edited.ambient);
  // Only a sky in the file makes ambient light, not one that is given by --sky.
  addSky(read.sky, edited.sky, ambientChanged && edited.ambient.ofSky > 0, settings);

  // The default ambient light of a model follows its sky.
  const bool ambientFollows = read.scene && read.scene->scene.isModel && edited.sky != read.sky;
  if (ambientFollows || ambientChanged) {
    settings.push_back("/ambient=" + describe(edited.ambient).dump());
  }
  return settings;
}

}  // namespace whit::view
