// The interactive viewer: what happens from one displayed frame to the next.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "viewer/camera_control.h"
#include "viewer/panel.h"
#include "viewer/render_thread.h"
#include "viewer/resolution_control.h"
#include "viewer/script.h"
#include "viewer/view_options.h"
#include "viewer/window.h"

namespace whit::view {

class App {
 public:
  App(const ViewOptions& options, std::shared_ptr<const cli::OpenScene> scene,
      std::optional<ScriptPlayer> script, Window& window);

  // Until the user or the script quits. Errors are shown and survived; with a script they end it:
  // throws Error(checkFailed).
  void run();

 private:
  double waitSeconds() const;
  double tick();
  void handleKeys();
  void handleKey(int key);
  void handleViewKey(int key);
  void attempt(const std::function<void()>& action);
  bool moveCamera(double seconds);
  void flyPath(double seconds);
  void watchSceneFile(double seconds);
  void reload();
  void fetchFrame();
  void askForFrame();
  FrameRequest requestFor(const Sharpness& sharpness, bool still) const;
  void draw(const std::string& screenshot);
  void say(const std::string& message);
  void fail(const std::string& error);
  const Scene& scene() const { return scene_->scene; }

  const ViewOptions& options_;
  std::shared_ptr<const cli::OpenScene> scene_;  // of the frame shown
  std::optional<ScriptPlayer> script_;
  Window& window_;
  RenderThread thread_;
  CameraControl control_;
  ResolutionControl resolution_;
  Panel panel_;
  PanelSettings settings_;
  TracedFrame shown_;
  std::optional<FrameRequest> asked_;
  int reloads_ = 0;
  double restSeconds_ = 0;  // since something changed
  bool sharp_ = false;      // the frame shown gets no finer
  std::optional<double> pathTime_;
  std::string message_, error_;
  double messageSeconds_ = 0;  // that it is still to be seen
  std::filesystem::path sceneFile_;
  std::filesystem::file_time_type sceneFileTime_;
  double watchSeconds_ = 0;
  std::chrono::steady_clock::time_point lastTick_;
};

}  // namespace whit::view
