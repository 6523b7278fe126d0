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

struct Command {
  const char *name, *summary;
  int (*run)(const Words& words);
};

inline constexpr Command kCommands[] = {
    {"render", "one image, or the frames of a film", renderCommand},
    {"turntable", "a film of a model on a turntable", turntableCommand},
    {"bench", "time of a frame by stage and by kind of ray", benchCommand},
    {"compare", "packets against the scalar reference, or two images", compareCommand},
    {"info", "contents of a scene, its effects and the kernels that run", infoCommand},
    {"scenes", "list of the shipped scenes", scenesCommand},
    {"explain", "tree of the rays of one pixel", explainCommand},
    {"effects", "cost of each effect of a scene", effectsCommand},
    {"accuracy", "report on accuracy against time", accuracyCommand},
    {"merge", "one image from its crops", mergeCommand},
};

}  // namespace whit::cli
