// The window: GLFW, OpenGL 2.1 and Dear ImGui. The only file that calls OpenGL.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/image.h"

struct GLFWwindow;

namespace whit::view {

// The input of a frame: what keys and mouse did since the last one. The window or a script fills
// it.
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

// The shares of a window's width and height that a picture fills which was made for a window of
// another size: it keeps its shape.
std::array<double, 2> sharesFilled(const ImageSize& madeFor, const ImageSize& window);

// Starts GLFW. Throws Error(usage) when there is no display.
class Display {
 public:
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;
};

class Window {
 public:
  // A Display must be alive. Throws Error(usage) when no window or OpenGL context can be had.
  Window(const std::string& title, const ImageSize& size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  Input input;  // of the user; the caller ends the frames

  bool closing() const;
  void close();
  ImageSize pixels() const;  // of the framebuffer; zero when minimized
  double contentScale() const;
  // The framebuffer's pixel at that place of the window.
  std::array<int, 2> pixelAt(const Input::Click& place) const;
  void setTitle(const std::string& title);
  void setClipboard(const std::string& text);
  void toggleFullScreen();

  // The last click on the picture since the last call, the user's or a script's pointer's.
  std::optional<Input::Click> takeClick() { return std::exchange(click_, std::nullopt); }

  // Where the pointer is over the picture, not over a panel, and no button is down. Of a script, if
  // it has one.
  std::optional<Input::Click> pointed() const;

  // Handles what happened, after waiting for it so long at most.
  void poll(double waitSeconds);
  // Makes poll() return; for other threads.
  static void wake();

  // The picture. It was made for a window of that size, and fills as much of another one as its
  // shape allows; zero: it is stretched to any.
  void upload(const DisplayImage& image, const ImageSize& madeFor = {});
  // What lies over it: transparent where there is nothing.
  void uploadOver(const DisplayImage& image, const ImageSize& madeFor);
  void dropOver() { over_.size = {}; }
  // Begins a frame: the picture and what lies over it, and a new ImGui frame over that.
  void begin();
  // Draws what ImGui was given.
  void end();
  void present();

 private:
  static void onKey(GLFWwindow* window, int key, int scancode, int action, int mods);
  static void onButton(GLFWwindow* window, int button, int action, int mods);
  static void onCursor(GLFWwindow* window, double x, double y);
  static void onScroll(GLFWwindow* window, double x, double y);
  static void onFocus(GLFWwindow* window, int focused);
  static void onDrop(GLFWwindow* window, int count, const char** files);
  void drawImage() const;
  void followPointer();

  GLFWwindow* window_ = nullptr;
  struct Layer {
    unsigned int texture = 0;
    ImageSize size, madeFor;  // of zero pixels: there is none
  };
  static void fill(Layer& layer, const DisplayImage& image, const ImageSize& madeFor);
  static void drawLayer(const Layer& layer, const ImageSize& window);

  Layer picture_, over_;
  double cursorX_ = 0, cursorY_ = 0;
  bool looking_ = false, orbiting_ = false;
  double pressedX_ = 0, pressedY_ = 0;  // where the left button went down
  std::optional<Input::Click> click_;
  std::optional<Input::Click> pointed_;  // a script's pointer is down on the picture
  int windowedX_ = 0, windowedY_ = 0;    // before full screen
  ImageSize windowed_;
};

}  // namespace whit::view
