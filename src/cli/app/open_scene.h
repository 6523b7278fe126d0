// A scene as the commands need it, the frames made of it, and a line on standard error that says
// how far long work has come.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "bake/scene.h"
#include "cli/app/parse_options.h"
#include "core/progress.h"
#include "core/warnings.h"
#include "render/renderer.h"

namespace whit::cli {

struct OpenScene {
  explicit OpenScene(bool strict) : warnings(strict) {}
  Scene scene;
  Warnings warnings;
  // The options --set and --sky that it was read with.
  std::vector<std::string> settings;
  std::string sky;
  double loadMs = 0;    // reading and baking
  bool isMade = false;  // made or moved by a program: no command line opens it
  // Held while the scene is brought to another time, where other threads look at it.
  mutable std::mutex moving;
};

// Loads and bakes; tells people on standard error what was repaired, unless --quiet. `look`, if
// any, sees the scene before it is baked.
using LookAtScene = std::function<void(const SceneDescription&)>;
std::unique_ptr<OpenScene> openScene(const std::string& name, const CommonOptions& common,
                                     Progress* progress, const LookAtScene& look = {});

// The options of a picture of the scene: those that were given, else those that the scene states.
// An automatic exposure is still to be settled (render/renderer.h).
RenderOptions optionsFor(const Scene& scene, const CommonOptions& common);
// The options of frames whose cost or accuracy is measured: without those of a scene file, so that
// figures of different scenes, and of one option alone, can be compared.
RenderOptions optionsToMeasure(const Scene& scene, const CommonOptions& common);

// Prints what was repaired, one line each, to standard error.
void tellWarnings(const Warnings& warnings);

// Null when nobody would see it: not wanted, or standard error is no terminal. The bar removes
// itself when destroyed.
std::unique_ptr<Progress> makeProgressBar(const CommonOptions& common);

// The text of the bar, at most 60 columns and what timeLeft() says:
// "[#####---------------]  25 % decoding textures".
std::string progressText(const std::string& phase, double fraction);
// ", 1:05 left" after `ms` for this fraction of the work, if the rest takes as long for its part;
// nothing in the first second, in which nobody waits, and while nothing is done.
std::string timeLeft(double ms, double fraction);

}  // namespace whit::cli
