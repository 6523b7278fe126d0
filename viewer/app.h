// The interactive viewer: its loop from one displayed frame to the next.
#pragma once

#include <filesystem>
#include <optional>

#include "core/stopwatch.h"
#include "core/worker_pool.h"
#include "viewer/camera_control.h"
#include "viewer/panel.h"
#include "viewer/render_thread.h"
#include "viewer/resolution_control.h"
#include "viewer/window.h"

namespace whit::view {

// The viewer's command line.
struct ViewOptions {
  cli::CommonOptions common;
  std::string scene;  // as on the command line
  DebugView view = DebugView::none;
  double rate = defaultRate(usableThreads());  // frames a second to hold in motion
};

// Takes the place of keys, mouse and clock: tests play scripts.
class ScriptedUser {
 public:
  static constexpr double kSecondsPerFrame = 1.0 / 60;  // however long frames take

  virtual ~ScriptedUser() = default;
  // Makes the input of the next frame. `sharp`: nothing moves and the picture gets no finer.
  // Returns false to end the viewer.
  virtual bool act(bool sharp, Input& input, PanelSettings& settings) = 0;
  // Called when a frame was drawn, before it is presented.
  virtual void drawn() = 0;
  // True: errors are shown as to a person; false: they end the viewer.
  virtual bool survivesErrors() const = 0;
};

class App {
 public:
  // The constructor may run on another thread than the window's, which may only draw the window
  // meanwhile.
  App(const ViewOptions& options, const std::shared_ptr<cli::OpenScene>& scene, Window& window,
      const KeptSettings& kept, ScriptedUser* scripted = nullptr);

  // Returns when the user quits. Errors are shown and survived; throws Error(checkFailed) where a
  // scripted user does not survive them.
  void run();
  // Returns the settings as the user left them, with the window's size as it was read.
  const KeptSettings& kept() const { return settings_; }

 private:
  // app.cpp:
  bool step();  // returns false when the scripted user ends
  double waitSeconds() const;
  bool worthDrawing(bool fresh, double seconds);
  double tick();
  bool moveCamera(double seconds);
  bool play(double seconds);
  void followCamera();
  void flyPath(double seconds);
  bool fetchFrame();  // returns whether there is something new to show
  void askForFrame();
  bool supersamples() const;
  FrameRequest movingRequest(const ImageSize& window);
  FrameRequest stillRequest(const ImageSize& window);
  FrameRequest requestFor(const Sharpness& sharpness, bool still) const;
  void showPicture();
  void followRays();
  void drawPanel();
  void passOnEdit();
  void inspectPointed() const;
  void draw();
  void say(const std::string& message);
  void fail(const std::string& error);
  const Scene& scene() const { return scene_->scene; }

  // app_keys.cpp:
  CameraMotion motionOf(const Input& input) const;
  void show(const Camera& camera);
  void fitView();
  void handleInput();
  void handleKey(int key);
  void savePicture();
  void printView();
  void expose(float step);
  void showNextView();
  void startOrStopPath();
  void pick(const Input::Click& place);
  void forgetRays();
  void jumpToNumber(std::size_t number);
  void jump(const Camera& camera);
  std::string command(const RenderOptions& options) const;
  RenderOptions viewOptions() const;
  void saveScene();
  void servePanel();
  void watchSceneFile();
  void watch(const std::string& scene);
  void load(const SceneChoice& choice, const std::string& message);
  void reload();
  void changeAnimation();
  void open(const std::string& name);
  void openFile(const std::string& file);
  void showSky(const std::string& file);
  void takeOptions();
  void takeScene();

  const ViewOptions& options_;
  std::shared_ptr<const cli::OpenScene> scene_;  // the scene of the frame shown
  std::string sceneName_;                        // as on the command line
  std::string opening_;                          // name of another scene while it is read
  ScriptedUser* scripted_;                       // null: a person
  Window& window_;
  RenderThread thread_;
  CameraControl control_;
  ResolutionControl resolution_;
  Panel panel_;
  PanelSettings settings_;
  TracedFrame shown_;
  std::optional<UnfinishedFrame> unfinished_;  // is shown in place of the frame
  std::optional<FrameRequest> stillFor_;       // the view that is being sharpened
  ImageSize windowSize_;
  Stopwatch sincePicture_;
  double pictureMs_ = 0;  // mean time between pictures in motion; 0: nothing moves
  std::optional<FrameRequest> asked_;
  std::optional<RayQuery> picked_, queried_;  // the user's pick, and the last query for it
  std::optional<Input::Click> clicked_;  // the last click, until it is too old for a double one
  double clickSeconds_ = 0;              // time since then
  bool shownBeforeClick_ = false;        // the panel was
  RayPick rays_;                         // the last answer
  RenderOptions own_;                    // without the user's changes
  // The scene's shading as it was read, as it is edited, and as it was last traced.
  ShadingEdit read_, edit_, traced_;
  int reloads_ = 0, edits_ = 0, tracedEdits_ = 0;
  double restSeconds_ = 0;  // time since something changed
  double undrawnSeconds_ = 0;
  int drawAgain_ = 0;     // frames to draw without waiting, see kFramesToAnswer
  bool sharp_ = false;    // the frame shown gets no finer
  bool selects_ = false;  // the next answer selects a material and a light
  std::optional<double> pathTime_;
  std::optional<std::size_t> followed_;  // the scene's camera whose view is shown
  std::string message_, error_;
  double messageSeconds_ = 0;  // time for which the message is still shown
  std::filesystem::path sceneFile_;
  std::filesystem::file_time_type sceneFileTime_;
  Stopwatch sinceTick_;
};

// Reads the command line and shows the scene. Returns the exit status.
int runViewer(const std::vector<std::string>& words, ScriptedUser* scripted = nullptr);

}  // namespace whit::view
