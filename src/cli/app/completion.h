// Completion of command lines by bash, zsh and fish, made of what --help is made of, so that the
// two cannot disagree. A script is its opening, the options of each command, and its closing.
#pragma once

#include <string>
#include <vector>

#include "cli/app/option_list.h"

namespace whit::cli {

enum class Shell { bash, zsh, fish };

// Throws Error(usage) naming the nearest one.
Shell shellNamed(const std::string& name);

struct CommandSummary {
  std::string name, summary;
};

// A program without commands has none here, and one part for the command "".
std::string completionOpening(Shell shell, const std::string& program,
                              const std::vector<CommandSummary>& commands);
// What parseOptions prints for the words --completion SHELL PROGRAM COMMAND.
std::string completionOptions(Shell shell, const std::string& program, const std::string& command,
                              const OptionList& list);
std::string completionClosing(Shell shell, const std::string& program);

}  // namespace whit::cli
