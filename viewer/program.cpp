// The command line of whit-view.
#include <cstdio>
#include <cstdlib>

#include "command_line/help_text.h"
#include "core/error.h"
#include "viewer/app.h"

namespace whit::view {

namespace {

constexpr const char* kUsage = "whit-view [SCENE] [options]";
constexpr const char* kSummary = "Shows a scene in a window, to fly through. H shows the keys.";

cli::OptionList listOptions(ViewOptions& options, std::vector<std::string>& scenes) {
  cli::OptionList list;
  list.group("Viewing");
  listViewOptions(list, options);
  list.operands(
      "SCENE",
      "a scene file, a model, or the name of a shipped scene (default: choose in the window)", 0, 1,
      scenes);
  return list;
}

const cli::ManPage kPage{"whit-view",
                         "flies through a scene that is ray traced as it is seen",
                         kUsage,
                         "Traces the scene anew for every picture, at the resolution that holds "
                         "the rate asked for while "
                         "something moves, and sharpens the picture at rest.",
                         "whit",
                         {{"whit-view helmet.glb", "shows a model; H shows the keys"},
                          {"whit-view atrium --rate 60", "walks through a shipped scene"}}};

void showManual(const cli::OptionList& list) {
  cli::printManual(kPage, [&] {
    std::puts(".PP");
    std::fputs(cli::manOptions(kUsage, kSummary, list).c_str(), stdout);
    cli::Terms keys;
    for (const Verb& verb : verbs()) {
      if (!verb.keys.empty()) keys.emplace_back(verb.keys, verb.help);
    }
    std::fputs(cli::manSection("keys", keys).c_str(), stdout);
  });
}

}  // namespace

int runViewer(const std::vector<std::string>& words, ScriptedUser* scripted) {
  ViewOptions options;
  std::vector<std::string> scenes;
  const cli::OptionList list = listOptions(options, scenes);

  // Requests for documentation need neither a scene nor a display.
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

  if (!cli::parseOptions(kUsage, kSummary, list, words)) return 0;
  settleViewOptions(options);

  if (!scenes.empty()) options.scene = scenes[0];

  App app(options, scripted);
  app.run();
  writeKeptSettings(app.kept());

  // The thread that reads a scene looks only now and then whether it was given up, which may take
  // it many seconds. Nothing that it holds has to be saved.
  if (app.waitsForReader()) {
    const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    std::quick_exit(lost ? static_cast<int>(ExitStatus::io) : 0);
  }
  return 0;
}

}  // namespace whit::view
