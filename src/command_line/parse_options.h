// Parses the words of a command line into options.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bake/scene.h"
#include "command_line/option_list.h"
#include "core/options.h"
#include "io/load_scene.h"

namespace whit::cli {

// The options of all commands that render.
struct CommonOptions {
  RenderOptions render;
  std::set<std::string> given;  // names of the render options on the command line
  LoadOptions load;
  std::string cameraFile;               // file that --camera names; empty: none
  std::optional<double> azimuth, zoom;  // view of a model's camera
  bool ground = false;                  // a shadow below a model
  std::optional<double> maxMemoryGb;    // none: defaultMaxMemory()
  bool quiet = false;
  bool warns = true;  // false: whoever opens a scene reports its warnings
  std::string progress = "auto";
};

// Lists forEachOption's options, and those about loading and reporting.
void listCommonOptions(OptionList& list, CommonOptions& common);
void listReportOptions(OptionList& list, CommonOptions& common);

// Returns the options of a picture of the scene: those that were given, else those that the scene
// states. An automatic exposure is still to be measured (inspect/auto_exposure.h).
RenderOptions optionsFor(const Scene& scene, const CommonOptions& common);
// Returns the options of frames whose cost or accuracy is measured. Those of a scene file are left
// out, so that figures of different scenes, and of one option alone, can be compared.
RenderOptions optionsToMeasure(const Scene& scene, const CommonOptions& common);

// Throws Error(usage) if a file that is to be written is also read, or is written twice, as
// standard output ("-"). Devices and empty names are left out. A command reads `scenes`, the files
// that the options name, and `pictures`.
void requireSeparateFiles(const std::vector<std::string>& written, const CommonOptions& common,
                          const std::vector<std::string>& scenes,
                          const std::vector<std::string>& pictures = {});

// Parses `words` (without the names of program and command). --help and --help-all print the help
// text, which begins with `usage` and `summary`; a first word --man prints the command's part of
// the manual page, and --complete what a shell may complete the words after it to. Returns false
// then. Throws Error(usage).
bool parseOptions(const std::string& usage, const std::string& summary, const OptionList& list,
                  const std::vector<std::string>& words);

}  // namespace whit::cli
