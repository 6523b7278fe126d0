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
  virtual bool act(bool sharp, Input& input, WindowState& shown) = 0;
  // Called when a frame was drawn, before it is presented.
  virtual void drawn() = 0;
  // Returns true if errors are shown as to a person, and false if they end the viewer.
  virtual bool survivesErrors() const = 0;
};

class App {
 public:
  // Opens the window, and begins to read options.scene; without one the user chooses a scene there.
  App(const ViewOptions& options, ScriptedUser* scripted);

  // Returns when the user quits. Errors are shown and survived; throws them where a scripted user
  // does not survive them.
  void run();
  // True if the destructor would wait for a scene that is being read.
  bool waitsForReader() const { return session_.waitsForReader(); }
  // Returns the settings as the user left them.
  KeptSettings kept() const;

 private:
  // The loop from frame to frame, in app.cpp.
  bool step();  // returns false when the scripted user ends
  double waitSeconds() const;
  bool worthDrawing(bool fresh, double seconds);
  double tick();
  // The first scene is being read: scripts begin when it is there.
  bool awaitsScene() const { return session_.choosesScene() && session_.isReading(); }
  ImageSize sizeFor(const Scene& scene) const;
  void followScene();
  void tellErrors();
  void showPicture();
  void draw();
  float drawBottom(std::vector<std::string>& said) const;
  void drawOver(float bottom, std::vector<std::string>& said);
  void inspectPointed() const;

  // These carry out what keys, mouse and panel ask for; they are in app_keys.cpp.
  void handleInput();
  void move(const Input& input);
  void act(const std::string& line);
  void toggle(Over over);
  void close();
  bool mayLoseEdits(const char* howToLose);
  void savePicture();
  void copyCommand();
  void click(const Input::Click& place);
  void saveScene();
  void open(const std::string& file);

  const ViewOptions& options_;
  ScriptedUser* scripted_;  // null: a person
  WindowState shown_;
  Display display_;
  ImageSize fitted_;  // size of the window until the user changes it
  Window window_;
  Session session_;
  Panel panel_;
  bool isHeld_ = false;        // some key was held in the last frame
  bool hints_ = false;         // the first scene's hint is shown
  bool savesPicture_ = false;  // the picture is to be saved as soon as it is complete
  // The unsaved edits that the user was last warned of.
  std::optional<std::vector<std::string>> warnedOf_;
  int errors_ = 0;  // number of errors that were reported
  std::string sceneName_;
  double undrawnSeconds_ = 0;
  int drawAgain_ = 0;  // frames to draw without waiting, see kFramesToAnswer
  Stopwatch sinceTick_;
};

// Reads the command line and shows the scene. Returns the exit status.
int runViewer(const std::vector<std::string>& words, ScriptedUser* scripted = nullptr);

}  // namespace whit::view
