// The subcommands, one file each. They take the words after their name and return the exit status.
// And their results as JSON, for other programs: the keys are a contract, to which adding is fine
// and renaming is not. Units are in the names; megabytes are 10^6 bytes.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/app/frame_summary.h"

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
int serveCommand(const Words& words);
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
    {"serve", "the viewer in a browser", serveCommand},
    {"explain", "tree of the rays of one pixel", explainCommand},
    {"effects", "cost of each effect of a scene", effectsCommand},
    {"accuracy", "report on accuracy against time", accuracyCommand},
    {"merge", "one image from its crops", mergeCommand},
};

using Json = nlohmann::ordered_json;

// The machine and the build.
Json machineJson(const Machine& machine);
// `writing_ms`, where images were written, has the medians of what writing one took and of what the
// tracing waited for it; `written_per_s` is the rate of both together. `stages_ms`, `embree_ms`,
// `rays` and what follows are those of the median frame; a run of no frames, whose images were all
// there, has none of what is measured on frames.
Json runJson(const RunSummary& run);
// "-" is standard output. Throws Error(io).
void writeJson(const std::string& path, const Json& json);

}  // namespace whit::cli
