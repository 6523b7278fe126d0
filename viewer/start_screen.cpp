#include "viewer/start_screen.h"

#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>

#include "core/text.h"
#include "output/open_and_warn.h"
#include "viewer/session/latest_progress.h"

namespace whit::view {

namespace {

constexpr double kSecondsBetweenTexts = 0.1;

// Draws a list under its title, and puts the entry that is clicked into `chosen`.
void drawNames(const char* title, const std::vector<std::string>& names, std::string& chosen) {
  if (names.empty()) return;
  ImGui::TextDisabled("%s", title);
  ImGui::PushID(title);  // both lists may have the same name
  for (const std::string& name : names) {
    if (ImGui::Selectable(name.c_str())) chosen = name;
  }
  ImGui::PopID();
}

// Puts the scene that is clicked in this frame into `chosen`.
void drawScenes(const std::vector<std::string>& recent, const std::vector<std::string>& shipped,
                std::string& chosen) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float margin = ImGui::GetFontSize(), room = std::max(window.y - 6 * margin, margin);
  ImGui::SetNextWindowPos(ImVec2(window.x / 2, margin), ImGuiCond_Always, ImVec2(0.5f, 0));
  ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(window.x, room));

  constexpr ImGuiWindowFlags kStill =
      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove;
  if (ImGui::Begin("scenes", nullptr, kStill)) {
    ImGui::TextUnformatted("Choose a scene, or drop a file on this window");
    drawNames("opened lately", recent, chosen);
    drawNames("shipped", shipped, chosen);
  }
  ImGui::End();
}

// Lets the user choose a scene. Returns an empty name if the window is closed.
std::string chooseScene(Window& window, const KeptSettings& kept, std::string error,
                        ScriptedUser* scripted) {
  const std::vector<std::string> shipped = shippedNames();
  WindowState none;
  std::string chosen;
  while (chosen.empty() && !window.closing()) {
    window.poll(scripted ? 0 : kSecondsBetweenTexts);
    if (scripted) {
      window.input = Input();
      if (!scripted->act(true, window.input, none)) return "";
    }
    if (!window.input.dropped.empty()) chosen = window.input.dropped.front();

    window.begin();
    drawScenes(kept.recent, shipped, chosen);
    std::vector<std::string> said;
    if (!error.empty()) drawError(error, static_cast<float>(window.size().height), said);
    if (!said.empty()) error.clear();  // dismissed
    window.end();
    if (scripted) scripted->drawn();
    window.present();
    window.input.endFrame();
  }
  return chosen;
}

// Reads the scene on another thread, while this one draws the window.
std::unique_ptr<App> readApp(ViewOptions& options, Window& window, const KeptSettings& kept,
                             ScriptedUser* scripted) {
  LatestProgress progress;
  auto loading = std::async(std::launch::async, [&] {
    const std::shared_ptr<OpenScene> scene = openAndWarn(options.scene, options.common, &progress);
    progress.report("building the acceleration structure", 0);
    auto app = std::make_unique<App>(options, scene, window, kept, scripted);
    Window::wake();
    return app;
  });

  while (loading.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    if (window.closing()) std::quick_exit(0);  // nothing has been written
    window.begin();
    drawMessage("reading " + options.scene + " " + progress.text(),
                static_cast<float>(window.size().height));
    window.end();
    window.present();
    window.poll(kSecondsBetweenTexts);
  }
  return loading.get();
}

}  // namespace

std::unique_ptr<App> start(ViewOptions& options, Window& window, const KeptSettings& kept,
                           ScriptedUser* scripted) {
  std::string error;
  for (;;) {
    if (options.scene.empty()) options.scene = chooseScene(window, kept, error, scripted);
    if (options.scene.empty()) return nullptr;
    window.setTitle("whit: " + options.scene);

    try {
      return readApp(options, window, kept, scripted);
    } catch (const std::exception& failure) {
      if (scripted && !scripted->survivesErrors()) throw;
      error = failure.what();
      std::fprintf(stderr, "whit-view: %s\n", printable(error).c_str());
      options.scene.clear();
    }
  }
}

}  // namespace whit::view
