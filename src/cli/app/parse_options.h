// From the words of a command line to options.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "cli/app/option_list.h"
#include "core/options.h"
#include "io/load_scene.h"

namespace whit::cli {

// What every command that renders understands.
struct CommonOptions {
  RenderOptions render;
  std::set<std::string> given;  // names of the render options on the command line
  LoadOptions load;
  double maxMemoryGb = 16;
  bool quiet = false;
  std::string progress = "auto";
};

// Lists forEachOption's options, and those about loading and reporting.
void listCommonOptions(OptionList& list, CommonOptions& common);
void listReportOptions(OptionList& list, CommonOptions& common);
// After parsing: presets, and what follows from one option for another.
void settleOptions(CommonOptions& common);

enum class Parsed { run, helpShown };

// Parses `words` (without the program's name). `usage` is the first line of --help, which goes to
// standard output, with all options for --help-all; so does the command's part of the manual page
// for the one word --man, and its part of the completion for --completion SHELL PROGRAM COMMAND.
// Throws Error(usage): unknown options name the nearest one.
Parsed parseOptions(const std::string& usage, const std::string& summary, const OptionList& list,
                    const std::vector<std::string>& words);

}  // namespace whit::cli
