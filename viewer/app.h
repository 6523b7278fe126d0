// The interactive viewer: its loop from one displayed frame to the next.
#pragma once

#include <optional>

#include "core/stopwatch.h"
#include "viewer/panel.h"
#include "viewer/window.h"

namespace whit::view {

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

class App : public Session {
 public:
  // The constructor may run on another thread than the window's, which may only draw the window
  // meanwhile.
  App(const ViewOptions& options, const std::shared_ptr<OpenScene>& scene, Window& window,
      const KeptSettings& kept, ScriptedUser* scripted = nullptr);

  // Returns when the user quits. Errors are shown and survived; throws Error(checkFailed) where a
  // scripted user does not survive them.
  void run();
  ImageSize pictureSize() const { return {scene().width, scene().height}; }  // that the scene has
  // Returns the settings as the user left them, with the window's size as it was read.
  const KeptSettings& kept() const { return settings_; }

 private:
  // app.cpp:
  bool step();  // returns false when the scripted user ends
  double waitSeconds() const;
  bool worthDrawing(bool fresh, double seconds);
  double tick();
  void showPicture();
  void drawPanel();
  void inspectPointed() const;
  void draw();
  void fail(const std::string& error) override;
  ImageSize windowPixels() const override { return window_.pixels(); }
  void opened() override { window_.setTitle("whit: " + scene().name); }

  // app_keys.cpp:
  CameraMotion keysAndDrags() const;
  template <typename Action>
  void attempt(const Action& action);
  void handleInput();
  void handleKey(int key);
  void closeOrQuit();
  bool mayQuit();
  void savePicture();
  void printView();
  void click(const Input::Click& place);
  void saveScene();
  void servePanel();
  void openFile(const std::string& file);
  void showSky(const std::string& file);

  ScriptedUser* scripted_;  // null: a person
  Window& window_;
  Panel panel_;
  bool listsCameras_ = false;
  bool savesPicture_ = false;  // as soon as it is complete
  // The edits of which the user was asked whether they may be lost.
  std::optional<std::vector<std::string>> askedAbout_;
  double undrawnSeconds_ = 0;
  int drawAgain_ = 0;  // frames to draw without waiting, see kFramesToAnswer
  Stopwatch sinceTick_;
};

// Reads the command line and shows the scene. Returns the exit status.
int runViewer(const std::vector<std::string>& words, ScriptedUser* scripted = nullptr);

}  // namespace whit::view
