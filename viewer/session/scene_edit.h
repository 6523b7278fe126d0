// Edits of a scene's materials, lights, sky and ambient light. They are settings (--set): the
// engine applies them, the printed command states them, and the saved scene holds them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/open_scene.h"

namespace whit::view {

// A scene as it is after its edits: the settings with which a reader makes it, and the members that
// the panel shows.
struct EditedScene {
  std::vector<std::string> settings;
  std::string givenSky;  // replaces the scene's own (--sky); empty: none does
  bool isModel = false;
  Vec3d origin;  // origin of the scene's coordinates, in those of the file
  std::vector<Material> materials;
  std::vector<Light> lights;  // lights that move are where they start
  Sky sky;                    // without its image
  Ambient ambient;
};
EditedScene editedScene(const OpenScene& open);

// Adds settings to those of the edited scene; its members stay as they are.
void addEdit(const std::vector<std::string>& added, EditedScene& scene);

// All settings that a scene is to have, and the sky that replaces its own.
struct SceneEdit {
  std::shared_ptr<const OpenScene> scene;
  std::vector<std::string> settings;
  std::string givenSky = {};
};
// Returns what the edited scene is read with.
LoadOptions editedLoad(const SceneEdit& edit);

// These add settings that make the members of a scene what they are now: those of a material or
// light that have changed, the sky, or the ambient light.
void addMemberSettings(const Material& before, const Material& after, const Vec3d& origin,
                       std::vector<std::string>& settings);
void addMemberSettings(const Light& before, const Light& after, const Vec3d& origin,
                       std::vector<std::string>& settings);
void addSkySetting(const EditedScene& scene, std::vector<std::string>& settings);
void addAmbientSetting(const EditedScene& scene, std::vector<std::string>& settings);

// Returns the sky kNoSky, kStudio or that of an image file, without its image.
Sky skyFrom(const std::string& source);
// Returns whether there is no sky, or the black one that settings have in its place.
bool isNoSky(const Sky& sky);
// Returns whether both skies differ at most in brightness and rotation.
bool isSameSky(const Sky& a, const Sky& b);

}  // namespace whit::view
