// The input of a frame: what keys and mouse did since the last one. Filled by the window or by a
// script.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace whit::view {

struct Input {
  std::set<int> held;                // keys that are down, by their GLFW codes
  std::vector<int> pressed;          // keys that went down since the last frame
  std::vector<int> commands;         // those of them that went down with Ctrl, which are not above
  double lookX = 0, lookY = 0;       // pixels dragged with the left button; y grows downwards
  double orbitX = 0, orbitY = 0;     // with the right button
  double wheel = 0;                  // notches
  bool happened = false;             // anything, on the panel or beside it
  std::vector<std::string> dropped;  // files
  // A script's pointer on the panel, in pixels of the window; a user's goes to the panel by itself.
  struct Pointer {
    double x = 0, y = 0;
    bool down = false;
  };
  std::optional<Pointer> pointer;

  // Where the left button went down and up again on the picture, in pixels of the window.
  struct Click {
    double x = 0, y = 0;
  };

  bool isHeld(int key) const { return held.count(key) != 0; }
  // Forgets what happened, keeps what is held.
  void endFrame() {
    pressed.clear();
    commands.clear();
    dropped.clear();
    lookX = lookY = orbitX = orbitY = wheel = 0;
    happened = false;
  }
};

}  // namespace whit::view
