// Writes warnings and the progress of long work to standard error.
#pragma once

#include <memory>
#include <string>

#include "command_line/parse_options.h"
#include "core/progress.h"
#include "core/warnings.h"

namespace whit::cli {

// Prints what was repaired, one line each.
void printWarnings(const Warnings& warnings);

// Null when nobody would see it: not wanted, or standard error is no terminal. The bar removes
// itself when destroyed.
std::unique_ptr<Progress> makeProgressBar(const CommonOptions& common);

// The text of the bar, at most 60 columns and what timeLeft() says:
// "[#####---------------]  25 % decoding textures".
std::string progressText(const std::string& phase, double fraction);
// ", 1:05 left" after `ms` for this fraction of the work, if the rest takes as long for its part;
// nothing in the first second, in which nobody waits, and while nothing is done.
std::string timeLeft(double ms, double fraction);

}  // namespace whit::cli
