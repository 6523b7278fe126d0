// Tables of text about a run: where a frame's time went, and how its rays filled the packets.
#pragma once

#include <string>

#include "cli/app/frame_summary.h"

namespace whit::cli {

// One line about the run's settings, one about its frame times, the eight stages of the median
// frame and its rays, of the kinds that the scene calls for, what writing its image took if it was
// written, and the floor if it was measured.
std::string stageTable(const RunSummary& run);

// The second of two runs of one scene, whose frames took turns, over the first.
std::string ratioText(RunPairs pairs, const RunSummary& first, const RunSummary& second);

}  // namespace whit::cli
