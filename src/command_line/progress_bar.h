// Writes warnings and the progress of long work to standard error.
#pragma once

#include <memory>
#include <string>

#include "command_line/parse_options.h"
#include "core/progress.h"
#include "core/warnings.h"

namespace whit::cli {

// Prints the warnings, one line each.
void printWarnings(const Warnings& warnings);

// Returns null if the bar is not wanted or standard error is no terminal. The bar removes itself
// when it is destroyed.
std::unique_ptr<Progress> makeProgressBar(const CommonOptions& common);

// Returns the text of the bar, at most 60 columns, without timeLeft():
// "[#####---------------]  25 % decoding textures".
std::string progressText(const std::string& phase, double fraction);
// Returns ", 1:05 left", the time for the rest of the work if this fraction of it took `ms`. The
// text is empty in the first second, in which nobody waits, and while nothing is done.
std::string timeLeft(double ms, double fraction);

}  // namespace whit::cli
