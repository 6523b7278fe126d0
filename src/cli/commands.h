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
    {"render", "one image, or the frames of a scene's camera path", renderCommand},
    {"turntable", "a film of a model that turns", turntableCommand},
    {"bench", "how long a frame takes, by stage and by kind of ray", benchCommand},
    {"compare", "packets against the scalar reference, or two images", compareCommand},
    {"info", "what a scene holds, which effects it calls for, which kernels run", infoCommand},
    {"scenes", "the shipped scenes, a line each", scenesCommand},
    {"explain", "the tree of rays of one pixel", explainCommand},
    {"effects", "what each effect adds to a frame, one after the other", effectsCommand},
    {"accuracy", "what each step of accuracy costs in time", accuracyCommand},
    {"merge", "crops of one image, put together", mergeCommand},
};

}  // namespace whit::cli
