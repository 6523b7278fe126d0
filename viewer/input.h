// What keys and mouse did since the last frame. Filled by the window or by a script.
#pragma once

#include <set>
#include <vector>

namespace whit::view {

struct Input {
  std::set<int> held;             // keys that are down, by their GLFW codes
  std::vector<int> pressed;       // keys that went down since the last frame
  double lookX = 0, lookY = 0;    // pixels dragged with the left button; y grows downwards
  double orbitX = 0, orbitY = 0;  // with the right button
  double wheel = 0;               // notches

  bool isHeld(int key) const { return held.count(key) != 0; }
  // Forgets what happened, keeps what is held.
  void endFrame() {
    pressed.clear();
    lookX = lookY = orbitX = orbitY = wheel = 0;
  }
};

}  // namespace whit::view
