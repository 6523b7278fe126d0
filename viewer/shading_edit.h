// The edits of a scene's materials, lights, sky and ambient light, and the settings (--set) that
// amount to them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/app/open_scene.h"
#include "io/json_reader.h"

namespace whit::view {

// The sky that is shown, and its settings.
struct SkyChoice {
  std::string source;  // for namedSky(), with the whole path of files; empty: the scene's own
  Sky::Kind kind = Sky::Kind::none;
  float scale = 1, rotation = 0;

  friend bool operator==(const SkyChoice&, const SkyChoice&) = default;
};
// Returns the sky of a scene as it was read.
SkyChoice skyOf(const cli::OpenScene& scene);
// Returns the choice of another sky with its default settings.
SkyChoice chooseSky(const std::string& source);
// Describes a sky whose source is not empty as scene files do.
Json describeSky(const SkyChoice& sky);

// Returns whether both give the same light under the same sky.
inline bool sameAmbient(const Ambient& a, Ambient b) {
  if (a.ofSky > 0 || b.ofSky > 0) b.up = a.up, b.down = a.down;  // the sky decides
  return a == b;
}

// The edited materials, lights, sky and ambient light of a scene; see bake/edit_shading.h.
struct ShadingEdit {
  std::shared_ptr<const cli::OpenScene> scene;
  std::vector<Material> materials;
  std::vector<Light> lights;
  SkyChoice sky;
  Ambient ambient;                    // its colors do not count where the sky makes them
  std::vector<std::string> settings;  // editSettings() of this edit
};
// Returns the state of a scene as it was read.
ShadingEdit withoutEdits(const std::shared_ptr<const cli::OpenScene>& scene);

// Returns the edits as values of --set. A scene that is read with these as well has the edited
// materials, lights, sky and ambient light, bit for bit. Settings of the sky hold for a scene that
// is read without --sky.
std::vector<std::string> editSettings(const ShadingEdit& read, const ShadingEdit& edited);

}  // namespace whit::view
