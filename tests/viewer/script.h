// A scripted user: lines of a text file, one command each, '#' begins a comment.
//
//   key NAME [SECONDS]            held for so long; without SECONDS for one frame
//   key Ctrl+NAME
//   mouse left|right|middle DX DY    dragged by so many pixels
//   wheel NOTCHES
//   wait N frames | wait sharp    sharp: until the picture gets no finer
//   screenshot FILE.png           what the window shows
//   click X Y [X2 Y2]             on the panel, in the window's pixels; from there dragged to X2 Y2
//   point X Y                     the pointer rests there from now on
//   panel NAME                    turns to that tab of the panel
//   drop FILE                     a file dropped on the window; "wait sharp" waits for its picture
//   resize W H | minimize | restore
//   bare                          the picture alone, without panel, words and messages
//   asked                         at rest no more samples than asked for
//   errors show                   errors are shown as to a user; by default they end the script
//
// Time is that of the frames: 1/60 s each, however long they take.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "viewer/app.h"

namespace whit::view {

// What a script does in one frame, apart from its input.
struct ScriptStep {
  std::string screenshot;  // taken of this frame after drawing; empty: none
  bool quit = false;       // the script is at its end
  std::optional<ImageSize> resize;
  bool minimize = false, restore = false, bare = false;
  bool askedSamples = false;           // at rest no more samples than asked for
  std::string tab;                     // tab of the panel to turn to; empty: it stays
  std::optional<Input::Pointer> rest;  // where the pointer rests from now on
  bool showErrors = false;             // from now on
};

struct ScriptCommand {
  // Called in each of its frames, numbered from 0; null: nothing happens in them.
  std::function<void(int frame, Input& input, ScriptStep& step)> act;
  int frames = 1;
  bool waitsUntilSharp = false;
};

// Throws Error(badScene) with "file:line" and what was expected.
std::vector<ScriptCommand> parseScript(const std::string& text, const std::string& file);

class ScriptPlayer {
 public:
  explicit ScriptPlayer(std::vector<ScriptCommand> commands) : commands_(std::move(commands)) {}

  // The next frame's input. `sharp`: nothing moves and the picture gets no finer.
  ScriptStep next(bool sharp, Input& input);

 private:
  std::vector<ScriptCommand> commands_;
  std::size_t at_ = 0;
  int frame_ = 0;  // number of the frame within the current command
  std::optional<Input::Pointer> rest_;
};

}  // namespace whit::view
