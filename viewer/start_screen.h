// What the window shows until there is a scene: scenes to choose from, and the progress of reading.
#pragma once

#include <memory>
#include <string>

#include "viewer/app.h"

namespace whit::view {

// Reads options.scene and shows it. If no scene is named, or it cannot be read, the user chooses
// one that is shipped or was open lately, or drops a file. Returns null if the window is closed.
// Throws instead of showing an error to a scripted user who does not survive errors.
std::unique_ptr<App> start(ViewOptions& options, Window& window, const KeptSettings& kept,
                           ScriptedUser* scripted);

}  // namespace whit::view
