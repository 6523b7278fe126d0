// The command line of whit-view.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <mutex>

#include "command_line/help_text.h"
#include "core/error.h"
#include "core/text.h"
#include "output/open_and_warn.h"
#include "viewer/app.h"

namespace whit::view {

namespace {

constexpr const char* kUsage = "whit-view [SCENE] [options]";
constexpr const char* kSummary = "Shows a scene in a window, to fly through. H shows the keys.";

cli::OptionList listOptions(ViewOptions& options, std::vector<std::string>& scenes) {
  cli::OptionList list;
  list.group("Viewing");
  listViewOptions(list, options);
  list.operands("SCENE",
                "a scene file, a model, or the name of a shipped scene (default: the last one)", 0,
                1, scenes);
  return list;
}

// Returns the largest size with the picture's aspect that fits into `room`.
ImageSize fitted(const ImageSize& picture, const ImageSize& room) {
  const double scale = std::min(static_cast<double>(room.width) / picture.width,
                                static_cast<double>(room.height) / picture.height);
  const auto scaled = [&](int side) { return std::max(static_cast<int>(side * scale), 1); };
  return {scaled(picture.width), scaled(picture.height)};
}

// Keeps the latest progress for the thread that draws the window.
class LoadingProgress : public Progress {
 public:
  void report(const std::string& phase, double fraction) override {
    const std::lock_guard lock(mutex_);
    text_ = formatted(": %s, %.0f %%", phase.c_str(), 100 * fraction);
  }
  std::string text() {
    const std::lock_guard lock(mutex_);
    return text_;
  }

 private:
  std::mutex mutex_;
  std::string text_;
};

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

  // Without a scene on the command line the last one is opened again.
  const KeptSettings kept = readKeptSettings();
  if (scenes.empty()) scenes = kept.recent;
  if (scenes.empty()) throwUsage("expected SCENE: " + list.operand.help);
  options.scene = scenes[0];

  // The picture's size is known only when the scene has been read; until then the window has a
  // default size.
  const Display display;
  const ImageSize room = Display::room(kept.window);
  const auto sizeFor = [&](const ImageSize& picture) {
    return options.common.render.size.value_or(fitted(picture, room));
  };
  ImageSize opened = sizeFor({Scene().width, Scene().height});
  Window window("whit: " + options.scene, opened);
  LoadingProgress progress;

  // This thread draws the window until the other one has read the scene.
  auto loading = std::async(std::launch::async, [&] {
    const std::shared_ptr<OpenScene> scene = openAndWarn(options.scene, options.common, &progress);
    opened = sizeFor({scene->scene.width, scene->scene.height});
    progress.report("building the acceleration structure", 0);
    auto app = std::make_unique<App>(options, scene, window, kept, scripted);
    Window::wake();
    return app;
  });

  while (loading.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    if (window.closing()) std::quick_exit(0);  // nothing has been written
    window.begin();
    drawMessage("reading " + options.scene + progress.text(),
                static_cast<float>(window.size().height));
    window.end();
    window.present();

    constexpr double kSecondsBetweenTexts = 0.1;
    window.poll(kSecondsBetweenTexts);
  }

  const std::unique_ptr<App> app = loading.get();
  if (opened != window.size()) window.resize(opened);
  app->run();

  // A size that the user has not chosen is not kept, so that the next scene is fitted anew.
  KeptSettings left = app->kept();
  if (!window.isFullScreen() && window.size() != opened) left.window = window.size();
  writeKeptSettings(left);
  return 0;
}

}  // namespace whit::view
