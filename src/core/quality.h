// Presets of the options that trade time for accuracy.
#pragma once

#include <set>
#include <string>

#include "core/options.h"

namespace whit {

// Sets what options.quality stands for, leaving alone the options named in `given` (as in
// forEachOption): what the user says counts for more than a preset.
void applyQuality(RenderOptions& options, const std::set<std::string>& given);

}  // namespace whit
