// The command line of whit-view.
#include <cstdio>

#include "cli/app/help_text.h"
#include "cli/app/open_scene.h"
#include "cli/app/progress_bar.h"
#include "core/error.h"
#include "viewer/app.h"

namespace whit::view {

namespace {

constexpr const char* kUsage = "whit-view SCENE [options]";
constexpr const char* kSummary = "Shows a scene in a window, to fly through. H shows the keys.";

cli::OptionList listOptions(ViewOptions& options, std::vector<std::string>& scenes) {
  cli::OptionList list;
  list.group("Viewing");
  list.value({"rate", "N", kLeastRate, kLargestRate},
             "frames a second to hold while something moves (default: 60, on up to four cores 30)",
             options.rate);
  list.value({"view", "none|depth|normals|albedo|rays|cost|effects|occupancy"},
             "what to show instead of the picture", options.view);
  cli::listCommonOptions(list, options.common);
  list.operands("SCENE", "a scene file, a model, or the name of a shipped scene", 1, 1, scenes);
  return list;
}

void check(const ViewOptions& options) {
  if (options.common.given.contains("crop")) {
    throwUsage("--crop: the viewer shows whole images; use whit render");
  }
  if (options.common.render.mode == Mode::reference) {
    throwUsage("--mode reference is too slow to look around with; use whit render");
  }
}

const cli::ManPage kPage{"whit-view", "flies through a scene that is ray traced as it is seen",
                         kUsage,
                         "Traces the scene anew for every picture, at the resolution that holds "
                         "the rate asked for while "
                         "something moves, and sharpens the picture at rest.",
                         "whit"};

void showManual(const cli::OptionList& list) {
  cli::printManual(kPage, [&] {
    std::puts(".PP");
    std::fputs(cli::manOptions(kUsage, kSummary, list).c_str(), stdout);
    cli::Terms keys;
    for (const KeyHelp& key : keyHelp()) keys.emplace_back(key.keys, key.text);
    std::fputs(cli::manSection("keys", keys).c_str(), stdout);
  });
}

}  // namespace

int runViewer(const std::vector<std::string>& words, ScriptedUser* scripted) {
  ViewOptions options;
  std::vector<std::string> scenes;
  const cli::OptionList list = listOptions(options, scenes);
  if (words == std::vector<std::string>{"--man"}) {
    showManual(list);
    return 0;
  }
  if (words == std::vector<std::string>{"--version"}) {
    std::printf("whit-view %s\n", WHIT_VERSION);
    return 0;
  }
  if (words.size() == 2 && words[0] == "--completion") {
    std::fputs(cli::completionScript(words[1], kPage.name).c_str(), stdout);
    return 0;
  }
  if (cli::parseOptions(kUsage, kSummary, list, words) == cli::Parsed::helpShown) return 0;
  options.scene = scenes[0];
  cli::settleOptions(options.common);
  check(options);
  options.common.load.instant.plays = true;
  const Display display;  // fails before a scene is loaded in vain
  const cli::CommonOptions& common = options.common;
  auto progress = cli::makeProgressBar(common);
  const std::shared_ptr<cli::OpenScene> scene =
      cli::openScene(options.scene, common, progress.get());
  progress.reset();
  options.common.render = cli::optionsFor(scene->scene, common);
  const ImageSize own{scene->scene.width, scene->scene.height};
  Window window("whit: " + scene->scene.name, common.render.size.value_or(own));
  App(options, scene, window, scripted).run();
  return 0;
}

}  // namespace whit::view
