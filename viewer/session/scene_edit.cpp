#include "viewer/session/scene_edit.h"

#include <filesystem>
#include <set>
#include <string_view>

#include "io/scene/scene_sections.h"
#include "io/scene/scene_settings.h"
#include "make/studio_sky.h"

namespace whit::view {

namespace {

// Adds a setting for each member that has changed, and for those whose default values depend on it.
// Settings have coordinates of the file, which `origin` was subtracted from.
template <typename Noun>
void addChanges(const Noun& before, const Noun& after, const Vec3d& origin,
                std::vector<std::string>& settings) {
  std::set<std::string_view> decided;
  forEachMemberInFiles(before, [&](const auto& member) {
    const auto& value = after.*member.field;
    const bool changed = !(before.*member.field == value);
    if (changed) decided.insert(member.rules.decides.begin(), member.rules.decides.end());

    if (!changed && !decided.contains(member.name)) return;
    Json noun{{member.name, describe(value)}};
    movePoints(noun, origin);
    settings.push_back(after.pointer + "/" + member.name + "=" + noun[member.name].dump());
  });
}

}  // namespace

EditedScene editedScene(const OpenScene& open) {
  const Scene& scene = open.scene;
  const Sky& sky = scene.sky;
  EditedScene edited{
      open.load.settings,
      open.load.sky,
      scene.isModel,
      scene.origin,
      scene.materials,
      scene.lights,
      {sky.name, sky.kind, sky.zenith, sky.horizon, sky.ground, {}, sky.scale, sky.rotation},
      scene.ambient};

  // Lights that move are shown where they start, except those of a model: its nodes carry them, and
  // settings do not change that.
  if (scene.isModel) return edited;
  for (const MovingLight& moving : scene.motion.given.lights) {
    edited.lights[moving.light].position = moving.position;
    edited.lights[moving.light].direction = moving.direction;
  }
  return edited;
}

void addEdit(const std::vector<std::string>& added, EditedScene& scene) {
  for (const std::string& setting : added) {
    addSceneSetting(setting, scene.settings);
    if (setting.starts_with("/sky=")) scene.givenSky.clear();
  }
}

LoadOptions editedLoad(const SceneEdit& edit) {
  LoadOptions load = edit.scene->load;
  load.allowOutside = true;  // the user chose the file of the sky
  load.settings = edit.settings;
  load.sky = edit.givenSky;
  return load;
}

void addMemberSettings(const Material& before, const Material& after, const Vec3d& origin,
                       std::vector<std::string>& settings) {
  addChanges(before, after, origin, settings);
}

void addMemberSettings(const Light& before, const Light& after, const Vec3d& origin,
                       std::vector<std::string>& settings) {
  addChanges(before, after, origin, settings);
}

void addSkySetting(const EditedScene& scene, std::vector<std::string>& settings) {
  settings.push_back("/sky=" + describe(scene.sky).dump());
  // The reader of a model would choose its ambient light by the sky.
  if (scene.isModel) settings.push_back("/ambient=" + describe(scene.ambient).dump());
}

void addAmbientSetting(const EditedScene& scene, std::vector<std::string>& settings) {
  // Only a sky in the file makes ambient light, not one that is given by --sky.
  if (scene.ambient.ofSky > 0 && !scene.givenSky.empty()) addSkySetting(scene, settings);
  settings.push_back("/ambient=" + describe(scene.ambient).dump());
}

Sky skyFrom(const std::string& source) {
  Sky sky;
  if (source == kNoSky) return sky;

  sky.kind = Sky::Kind::image;
  sky.name = source;
  if (source != kStudio) {
    sky.name = std::filesystem::absolute(source).lexically_normal().string();
  }
  return sky;
}

bool isNoSky(const Sky& sky) {
  return sky.kind == Sky::Kind::none || (sky.kind == Sky::Kind::color && isBlack(sky.zenith));
}

bool isSameSky(const Sky& a, const Sky& b) {
  if (isNoSky(a) && isNoSky(b)) return true;
  return a.kind == b.kind && a.name == b.name && a.zenith == b.zenith && a.horizon == b.horizon &&
         a.ground == b.ground;
}

}  // namespace whit::view
