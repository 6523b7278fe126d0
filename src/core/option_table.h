// Access to the table of options in core/options.h by name, and presets of its values.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/options.h"

namespace whit {

// Throws Error(usage) for a name, with or without "--", that no option has: with the present name
// of one that was renamed, or with a near one of `names`.
[[noreturn]] void throwNoOption(const std::string& name, const std::vector<std::string>& names);

// Set or format the option of this name. They throw Error(usage), which for an unknown name
// suggests a near one.
void setOption(RenderOptions& options, const std::string& name, const std::string& text);
std::string optionText(const RenderOptions& options, const std::string& name);

// Name and value of every option that can change the picture and says anything, in the order of the
// table.
std::vector<std::pair<std::string, std::string>> pictureOptions(const RenderOptions& options);

// The rebuild that a renderer with options `a` needs for frames with options `b`.
Rebuild rebuildNeeded(const RenderOptions& a, const RenderOptions& b);
// Copies the options that need no larger rebuild than `most`.
void takeOver(const RenderOptions& from, Rebuild most, RenderOptions& to);

// Applies the preset options.quality to all options but those named in `given`, which the user has
// set.
void applyQuality(RenderOptions& options, const std::set<std::string>& given);
// The options in which a preset differs from the defaults, as on the command line.
struct QualityPreset {
  std::string name, options;
};
std::vector<QualityPreset> qualityPresets();

// The options that a scene may state: they describe the picture, not how or where it is made.
std::vector<std::string> sceneOptionNames();
// Applies the options that a scene states, names and values as on the command line, except those in
// `given` and, if that has "quality", those of presets. A preset of the scene leaves `mode` alone.
void applySceneOptions(const std::map<std::string, std::string>& stated,
                       std::set<std::string> given, RenderOptions& options);

}  // namespace whit
