// Results of runs as JSON, for other programs: the keys are a contract, to which adding is fine and
// renaming is not. Units are in the names; megabytes are 10^6 bytes.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "output/frame_summary.h"

namespace whit {

using Json = nlohmann::ordered_json;

Json jsonOf(const Vec3d& v);  // [x, y, z]

// The options that can change a picture: names and values as on the command line.
Json optionsJson(const RenderOptions& options);
// The machine and the build.
Json machineJson(const Machine& machine);
// `name` tells the runs of one scene apart ("effects all"); `other_tasks` is the median number of
// tasks of other programs that wanted a processor. `writing_ms`, where images were written, has the
// medians of the time that writing one took and of the time that tracing waited for it;
// `written_per_s` is the rate of both together. `stages_ms`, `embree_ms`, `rays` and the keys
// behind them are those of the median frame. A run without frames, whose images all existed, has no
// keys that are measured on frames.
Json runJson(const RunSummary& run);
// Writes an object, with the number of the format as its first member: "schema", which changes when
// a key is renamed or gets another meaning. "-" is standard output. Throws Error(io).
void writeJson(const std::string& path, const Json& json);
// Writes a text in the same way.
void writeReport(const std::string& path, const std::string& text);

}  // namespace whit
