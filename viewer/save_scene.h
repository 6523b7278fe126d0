// Saves an edited scene as a scene file.
#pragma once

#include <string>

#include "viewer/traced_frame.h"

namespace whit::view {

struct SavedScene {
  std::string file;
  bool leavesFolder = false;  // it names files elsewhere, so reading it needs --allow-outside
};

// Writes NAME-edited.json, with the first number that is free, into the current folder. It is the
// file of the scene called `name` with its settings and edits, or a scene that holds the model
// called `name`; its first camera is `camera`. `load` holds the options that the scene was read
// with. Throws Error(io), and writes nothing then.
SavedScene saveScene(const LoadOptions& load, const std::string& name, const cli::OpenScene& scene,
                     const ShadingEdit& edit, const Camera& camera);

}  // namespace whit::view
