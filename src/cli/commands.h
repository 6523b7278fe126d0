// The subcommands, one file each. They take the words after their name and return the exit status.
#pragma once

#include <string>
#include <vector>

namespace whit::cli {

using Words = std::vector<std::string>;

int renderCommand(const Words& words);
int benchCommand(const Words& words);
int compareCommand(const Words& words);
int infoCommand(const Words& words);
int mergeCommand(const Words& words);
int effectsCommand(const Words& words);
int explainCommand(const Words& words);
int accuracyCommand(const Words& words);
int scenesCommand(const Words& words);
int turntableCommand(const Words& words);

}  // namespace whit::cli
