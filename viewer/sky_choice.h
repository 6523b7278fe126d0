// Which sky is looked at.
#pragma once

#include <string>

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

}  // namespace whit::view
