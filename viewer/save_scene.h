// What was edited in the viewer as a scene file.
#pragma once

#include <string>

#include "viewer/traced_frame.h"

namespace whit::view {

struct SavedScene {
  std::string file;
  bool leavesFolder = false;  // it names files elsewhere: --allow-outside is needed to read it
};

// Writes NAME-edited.json into the current folder, or with the first number that is free: the file
// of the scene called `name` with its settings and edits, all else as it was, or for a model a
// scene that holds it; seen by `camera` first. `load` is as the scene was read with. Throws
// Error(io), and nothing is written then.
SavedScene saveScene(const LoadOptions& load, const std::string& name, const cli::OpenScene& scene,
                     const ShadingEdit& edit, const Camera& camera);

}  // namespace whit::view
