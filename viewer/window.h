// The window: GLFW, OpenGL 2.1 and Dear ImGui. No other file of the viewer calls OpenGL.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/image.h"
#include "viewer/session/session.h"

struct GLFWwindow;

namespace whit::view {

// The input by keys and mouse since the last frame. The window or a script fills it.
struct Input : Drags {
  std::set<std::string> held;        // names of keys that are down
  std::vector<std::string> pressed;  // keys that went down since the last frame: "W", "Ctrl+S"
  bool happened = false;             // there was an event, on the panel or beside it
  std::vector<std::string> dropped;  // files
  // A script's pointer in pixels of the window; ImGui sees a person's pointer by itself.
  struct Pointer {
    double x = 0, y = 0;
    bool down = false;
  };
  std::optional<Pointer> pointer;

  // A place on the picture where the left button went down and up, in pixels of the window.
  struct Click {
    double x = 0, y = 0;
  };

  bool isHeld(const std::string& key) const { return held.contains(key); }
  // Forgets all events, but not the keys that are held.
  void endFrame() {
    pressed.clear();
    dropped.clear();
    static_cast<Drags&>(*this) = Drags();
    happened = false;
  }
};

inline constexpr float kFontHeight = 13;  // pixels on a screen of the usual density

// Returns the shares of a window's width and height that are filled by a picture that was made for
// a window of another size and keeps its shape.
std::array<double, 2> sharesFilled(const ImageSize& madeFor, const ImageSize& window);

// The names of all keys that the viewer knows.
std::vector<std::string> keyNames();

// Starts GLFW. Throws Error(usage) when there is no display.
class Display {
 public:
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  // Returns the size that was kept, limited to the screen's work area, or if there is none two
  // thirds of that area, in the units of windows.
  static ImageSize room(const ImageSize& kept);
};

class Window {
 public:
  // A Display must be alive. Throws Error(usage) when no window or OpenGL context can be had.
  Window(const std::string& title, const ImageSize& size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  Input input;  // the caller ends its frames

  bool closing() const;
  void setClosing(bool closing);
  ImageSize pixels() const;  // size of the framebuffer; zero when minimized
  // Returns the framebuffer's pixel at that place of the window.
  std::array<int, 2> pixelAt(const Input::Click& place) const;
  void setTitle(const std::string& title);
  void setClipboard(const std::string& text);
  void toggleFullScreen();
  bool isFullScreen() const;
  void resize(const ImageSize& size);
  ImageSize size() const;  // in the units of the pointer's places
  // Returns how many pixels of pointer motion make one pixel on a screen of the usual density.
  double scale() const { return scale_; }

  // Returns the last click on the picture since the last call.
  std::optional<Input::Click> takeClick() { return std::exchange(click_, std::nullopt); }

  // Returns the place of the pointer if it is on the picture, not on a panel, and no button is
  // down.
  std::optional<Input::Click> pointed() const;

  // Waits for events, at most that long, and handles them.
  void poll(double waitSeconds);
  // Makes poll() return. Other threads may call it.
  static void wake();

  // Sets the picture. It was made for a window of that size and keeps its shape in another one.
  void upload(const DisplayImage& image, const ImageSize& madeFor);
  // Draws the picture and begins a new ImGui frame over it.
  void begin();
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
  unsigned int texture_ = 0;
  ImageSize size_;     // size of the picture; zero: there is none
  ImageSize madeFor_;  // size of the window that the picture was made for
  double cursorX_ = 0, cursorY_ = 0;
  double scale_ = 1;
  Drag Drags::*dragged_ = nullptr;      // null: no button is down on the picture
  double pressedX_ = 0, pressedY_ = 0;  // where it went down
  std::optional<Input::Click> click_;
  std::optional<Input::Click> scriptPressed_;  // where a script pressed the button on the picture
  int windowedX_ = 0, windowedY_ = 0;          // place and size before full screen
  ImageSize windowed_;
};

}  // namespace whit::view
