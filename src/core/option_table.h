// Questions to the table of options in core/options.h, and presets of what it holds.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/options.h"

namespace whit {

// The option of this name, set to what the text says or as text. Throws Error(usage): for a name
// that there is not it names the nearest one.
void setOption(RenderOptions& options, const std::string& name, const std::string& text);
std::string optionText(const RenderOptions& options, const std::string& name);

// Name and value of every option that can change the picture and says anything, in the order of the
// table.
std::vector<std::pair<std::string, std::string>> pictureOptions(const RenderOptions& options);

// What a renderer with options `a` has to make anew for frames with options `b`.
Rebuild rebuildNeeded(const RenderOptions& a, const RenderOptions& b);
// The options that need no more than `most` made anew.
void takeOver(const RenderOptions& from, Rebuild most, RenderOptions& to);

// Sets what options.quality stands for, leaving alone the options named in `given` (as in
// forEachOption): what the user says counts for more than a preset.
void applyQuality(RenderOptions& options, const std::set<std::string>& given);
// What a preset changes of the defaults, as on the command line; empty for those themselves.
struct QualityPreset {
  std::string name, options;
};
std::vector<QualityPreset> qualityPresets();
// Likewise what is better for a model without a scene file: nobody has looked at its picture.
void applyModelDefaults(RenderOptions& options, const std::set<std::string>& given);

}  // namespace whit
