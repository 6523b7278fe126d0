// The window: GLFW, OpenGL 2.1 and Dear ImGui. The only file that calls OpenGL.
#pragma once

#include <string>

#include "core/image.h"
#include "viewer/input.h"

struct GLFWwindow;

namespace whit::view {

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
  void setTitle(const std::string& title);
  void setVsync(bool on);
  void toggleFullScreen();
  void resize(const ImageSize& size);
  void minimize();
  void restore();

  // Handles what happened, after waiting for it so long at most.
  void poll(double waitSeconds);
  // Makes poll() return; for other threads.
  static void wake();

  void upload(const DisplayImage& image);
  // Begins a frame: the image, scaled to the window, and a new ImGui frame over it.
  void begin();
  // Draws what ImGui was given.
  void end();
  void present();
  DisplayImage readPixels() const;  // after end(), before present()
  void finish() const;              // until everything is drawn

 private:
  static void onKey(GLFWwindow* window, int key, int scancode, int action, int mods);
  static void onButton(GLFWwindow* window, int button, int action, int mods);
  static void onCursor(GLFWwindow* window, double x, double y);
  static void onScroll(GLFWwindow* window, double x, double y);
  static void onFocus(GLFWwindow* window, int focused);
  static void onDrop(GLFWwindow* window, int count, const char** files);
  void drawImage() const;

  GLFWwindow* window_ = nullptr;
  unsigned int texture_ = 0;
  ImageSize textureSize_;
  double cursorX_ = 0, cursorY_ = 0;
  bool looking_ = false, orbiting_ = false;
  int windowedX_ = 0, windowedY_ = 0;  // before full screen
  ImageSize windowed_;
};

}  // namespace whit::view
