// --help and --help-all: what a command can be told, for a terminal.
#pragma once

#include <string>

#include "cli/app/option_list.h"

namespace whit::cli {

enum class HelpTier { everyday, all };

// Usage, summary and options, lines of `width` columns at most where a word is not longer. The
// everyday tier has the command's own options, and of those that all commands share the ones that
// are wanted every day; it says how many are left out. Ends with what the presets stand for.
std::string helpText(const std::string& usage, const std::string& summary, const OptionList& list,
                     HelpTier tier, int width);

// The columns of the terminal that standard output is, else $COLUMNS, else 80; from 40 to 120.
int helpWidth();

}  // namespace whit::cli
