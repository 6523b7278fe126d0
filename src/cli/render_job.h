// The options of whit render and whit turntable, and the requests that they refuse.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/terminal_picture.h"
#include "command_line/option_list.h"
#include "command_line/parse_options.h"
#include "engine/engine.h"
#include "inspect/budget.h"
#include "make/turntable.h"
#include "output/image_output.h"

namespace whit::cli {

// True for the name of a film, .mp4.
bool isFilm(const std::string& output);

struct RenderJob {
  CommonOptions common;
  std::vector<std::string> scenes, outputs;
  std::string frames, json, time, target, words;
  Budget budget;
  double fps = 24;
  bool resume = false, stats = false;
  ExrStorage exr = ExrStorage::zip;
  bool onTurntable = false;
  double turns = 1;
  TerminalGraphics graphics = TerminalGraphics::none;  // shows the picture on standard output
  std::optional<Turntable> turntable;                  // once the scene is open
  int turntableFrames = 96;                            // number of frames of all turns together

  bool toStandardOutput() const { return contains(outputs, kStandardOutput); }
  bool makesFilm() const;
};

OptionList listOptions(RenderJob& job);

// Chooses the outputs that are not given. Throws if the requests contradict each other or cannot be
// met, before anything is loaded.
void checkJob(RenderJob& job);

// Throws if the open scene cannot be rendered as asked for. Warns of what the options leave out.
void checkScene(const RenderJob& job, const Scene& scene);

}  // namespace whit::cli
