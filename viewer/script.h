// A scripted user: lines of a text file, one command each, '#' begins a comment.
//
//   key NAME [SECONDS]            held for so long; without SECONDS for one frame
//   mouse left|right DX DY        dragged by so many pixels
//   wheel NOTCHES
//   wait N frames | wait N seconds | wait sharp     sharp: until the picture gets no finer
//   screenshot FILE.png           what the window shows
//   click X Y [X2 Y2]             on the panel, in the window's pixels; from there dragged to X2 Y2
//   panel NAME                    turns to that tab of the panel
//   drop FILE                     a file dropped on the window
//   resize W H | minimize | restore
//   errors show | errors end      errors are shown as to a user; by default they end the script
//   quit
//
// Time is that of the frames: 1/60 s each, however long they take.
#pragma once

#include <string>
#include <vector>

#include "viewer/input.h"

namespace whit::view {

inline constexpr double kScriptSecondsPerFrame = 1.0 / 60;

struct ScriptCommand {
  enum class Kind {
    key,
    look,
    orbit,
    wheel,
    wait,
    waitSharp,
    screenshot,
    click,
    panel,
    drop,
    resize,
    minimize,
    restore,
    showErrors,
    endErrors,
    quit
  };
  Kind kind = Kind::quit;
  int key = 0;     // GLFW code
  int frames = 1;  // that it takes: key, wait
  // look, orbit, click: pixels; wheel: notches in x; resize: pixels a side; to: where a click ends
  double x = 0, y = 0, toX = 0, toY = 0;
  std::string file{};  // or a tab of the panel
};

// Throws Error(badScene) with "file:line" and what was expected.
std::vector<ScriptCommand> parseScript(const std::string& text, const std::string& file);

class ScriptPlayer {
 public:
  explicit ScriptPlayer(std::vector<ScriptCommand> commands) : commands_(std::move(commands)) {}

  struct Step {
    std::string screenshot;                  // of this frame, after drawing; empty: none
    bool quit = false;                       // the end of the script quits too
    const ScriptCommand* command = nullptr;  // to the window or the viewer, in its first frame
  };
  // The next frame's input. `sharp`: nothing moves and the picture gets no finer.
  Step next(bool sharp, Input& input);

 private:
  std::vector<ScriptCommand> commands_;
  std::size_t at_ = 0;
  int frame_ = 0;  // of the current command
};

}  // namespace whit::view
