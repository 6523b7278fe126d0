// Opens a scene for a program, and prints warnings and the names of written files on standard
// error.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "command_line/parse_options.h"
#include "engine/open_scene.h"
#include "output/frame_summary.h"

namespace whit {

// Opens the scene. Warns of what was repaired, and if nothing in the scene gives light, unless the
// caller reports the warnings itself.
std::unique_ptr<OpenScene> openAndWarn(const std::string& name, const cli::CommonOptions& common,
                                       Progress* progress, const LookAtScene& look = {});

// Warns of what pictureWarnings() finds.
void printPictureWarnings(const RunSummary& run);

// Prints the names of the files that were written, unless --quiet is set. Empty names and standard
// output are left out.
void printWrittenFiles(const std::vector<std::string>& files, const cli::CommonOptions& common);

}  // namespace whit
