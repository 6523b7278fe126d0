// The edits of a scene's materials, lights, sky and ambient light, and the settings (--set) that
// amount to them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/app/open_scene.h"
#include "io/scene/json_text.h"

namespace whit::view {

// The sky that is looked at: which one, and what can be changed about each.
struct SkyChoice {
  std::string
      source;  // as namedSky() takes it, files with their whole path; empty: the scene's own
  Sky::Kind kind = Sky::Kind::none;
  float scale = 1, rotation = 0;

  friend bool operator==(const SkyChoice&, const SkyChoice&) = default;
};
// As it has been read, before any edit.
SkyChoice skyOf(const cli::OpenScene& scene);
// Another one.
SkyChoice chooseSky(const std::string& source);
// As scene files have it, its source not being empty.
Json describeSky(const SkyChoice& sky);

// Whether both give the same light under the same sky.
inline bool sameAmbient(const Ambient& a, Ambient b) {
  if (a.ofSky > 0 || b.ofSky > 0) b.up = a.up, b.down = a.down;  // they follow from it
  return a == b;
}

// What a user makes of a scene's surfaces, lights and surroundings; see scene/edit_shading.h.
struct ShadingEdit {
  std::shared_ptr<const cli::OpenScene> scene;  // that was edited
  std::vector<Material> materials;
  std::vector<Light> lights;
  SkyChoice sky;
  Ambient ambient;                    // of one from the sky only the strength counts
  std::vector<std::string> settings;  // that amount to the same when the scene is read
};
// As it has been read, before any edit.
ShadingEdit withoutEdits(const std::shared_ptr<const cli::OpenScene>& scene);

// What differs between a scene as it was read and as it was edited, as values of --set: read again
// with these as well, it has the same materials, lights, sky and ambient light, bit for bit. Those
// of the sky are for a scene that is read without --sky.
std::vector<std::string> editSettings(const ShadingEdit& read, const ShadingEdit& edited);

}  // namespace whit::view
