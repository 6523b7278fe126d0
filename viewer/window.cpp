#include "viewer/window.h"

#define GLFW_INCLUDE_NONE
#include <GL/gl.h>
#include <GL/glext.h>
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl2.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "core/error.h"

namespace whit::view {

namespace {

constexpr double kClickSlack = 3;  // largest motion of a click, in pixels

std::string glfwReason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? std::string(" (") + text + ")" : std::string();
}

Window& windowOf(GLFWwindow* window) {
  return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

constexpr std::pair<const char*, int> kNamedKeys[] = {{"Left", GLFW_KEY_LEFT},
                                                      {"Right", GLFW_KEY_RIGHT},
                                                      {"Up", GLFW_KEY_UP},
                                                      {"Down", GLFW_KEY_DOWN},
                                                      {"Space", GLFW_KEY_SPACE},
                                                      {"Shift", GLFW_KEY_LEFT_SHIFT},
                                                      {"Shift", GLFW_KEY_RIGHT_SHIFT},
                                                      {"Esc", GLFW_KEY_ESCAPE},
                                                      {"Home", GLFW_KEY_HOME},
                                                      {"[", GLFW_KEY_LEFT_BRACKET},
                                                      {"]", GLFW_KEY_RIGHT_BRACKET},
                                                      {"F11", GLFW_KEY_F11},
                                                      {"F12", GLFW_KEY_F12}};

// Returns the name of a key; empty if the viewer does not know it.
std::string nameOfKey(int key) {
  for (const auto& [name, code] : kNamedKeys) {
    if (code == key) return name;
  }
  // GLFW's codes of letters and digits are their ASCII codes.
  const bool isLetter = key >= GLFW_KEY_A && key <= GLFW_KEY_Z;
  const bool isDigit = key >= GLFW_KEY_0 && key <= GLFW_KEY_9;
  return isLetter || isDigit ? std::string(1, static_cast<char>(key)) : "";
}

// Returns what a key says in the user's layout; the name of its place where the viewer knows no key
// of that name, as of the Ü that has the place of [.
std::string labelOfKey(const std::string& place, int key, int scancode) {
  const char* const says = glfwGetKeyName(key, scancode);
  if (!says) return place;

  std::string label = says;
  if (label.size() == 1) label[0] = static_cast<char>(std::toupper(label[0]));
  const std::vector<std::string> known = keyNames();
  return std::ranges::find(known, label) != known.end() ? label : place;
}

// Fonts of Debian, Fedora, Arch and macOS; the first that exists is used.
constexpr std::array kFonts{"/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf",
                            "/usr/share/fonts/dejavu-sans-mono-fonts/DejaVuSansMono.ttf",
                            "/usr/share/fonts/TTF/DejaVuSansMono.ttf",
                            "/usr/share/fonts/truetype/liberation/LiberationMono-Regular.ttf",
                            "/System/Library/Fonts/Menlo.ttc"};

// Loads a font at the display's scale, or enlarges Dear ImGui's own where the system has none.
void setFont(float scale) {
  ImGuiIO& io = ImGui::GetIO();
  for (const char* file : kFonts) {
    std::error_code none;
    if (!std::filesystem::is_regular_file(file, none)) continue;

    if (io.Fonts->AddFontFromFileTTF(file, std::round(kFontHeight * scale))) return;
  }
  io.FontGlobalScale = scale;
}

void setStyle(float scale) {
  setFont(scale);
  ImGuiStyle& style = ImGui::GetStyle();

  style.WindowRounding = 6;
  style.FrameRounding = style.GrabRounding = style.PopupRounding = 3;
  style.WindowPadding = ImVec2(10, 8);
  style.FramePadding = ImVec2(6, 3);
  style.ItemSpacing = ImVec2(8, 5);
  style.WindowBorderSize = 0;

  style.Colors[ImGuiCol_WindowBg] = ImVec4(0.06f, 0.07f, 0.09f, 1);
  style.Colors[ImGuiCol_FrameBg] = ImVec4(0.24f, 0.28f, 0.35f, 1);
  style.Colors[ImGuiCol_TitleBg] = style.Colors[ImGuiCol_TitleBgActive] =
      ImVec4(0.11f, 0.15f, 0.22f, 1);
  style.Colors[ImGuiCol_Header] = ImVec4(0.16f, 0.24f, 0.36f, 1);
  style.Colors[ImGuiCol_PlotHistogram] = ImVec4(0.2f, 0.42f, 0.7f, 1);  // bars have text on them
  style.Colors[ImGuiCol_TextDisabled] = ImVec4(0.62f, 0.65f, 0.7f, 1);
  style.ScaleAllSizes(scale);
}

}  // namespace

std::array<double, 2> sharesFilled(const ImageSize& madeFor, const ImageSize& window) {
  const double across = static_cast<double>(window.width) / madeFor.width;
  const double down = static_cast<double>(window.height) / madeFor.height;
  return {std::min(1.0, down / across), std::min(1.0, across / down)};
}

std::vector<std::string> keyNames() {
  std::vector<std::string> names;
  for (int key = GLFW_KEY_SPACE; key <= GLFW_KEY_LAST; ++key) {
    if (std::string name = nameOfKey(key); !name.empty()) names.push_back(std::move(name));
  }
  return names;
}

Display::Display() {
  if (!glfwInit())
    throwUsage("there is no display to open a window on" + glfwReason() +
               "; whit serve SCENE shows it in a browser");
}

Display::~Display() { glfwTerminate(); }

ImageSize Display::room(const ImageSize& kept) {
  ImageSize screen{1280, 800};
  if (GLFWmonitor* const monitor = glfwGetPrimaryMonitor()) {
    int x = 0, y = 0;
    glfwGetMonitorWorkarea(monitor, &x, &y, &screen.width, &screen.height);
  }

  // Without a kept size the window takes two thirds of the work area; a kept size may come from a
  // larger screen.
  if (kept == ImageSize()) return {screen.width * 2 / 3, screen.height * 2 / 3};
  return {std::min(kept.width, screen.width), std::min(kept.height, screen.height)};
}

Window::Window(const std::string& title, const ImageSize& size) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 2);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 1);
  window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  if (!window_) throwUsage("no window with OpenGL 2.1 can be opened here" + glfwReason());
  glfwSetWindowUserPointer(window_, this);
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);

  glfwSetKeyCallback(window_, onKey);
  glfwSetMouseButtonCallback(window_, onButton);
  glfwSetCursorPosCallback(window_, onCursor);
  glfwSetScrollCallback(window_, onScroll);
  glfwSetWindowFocusCallback(window_, onFocus);
  glfwSetDropCallback(window_, onDrop);

  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // no file is left behind

  // Window sizes are in pixels on some systems and in points of several pixels on others. The
  // motion of the pointer has to be scaled only on the former.
  float across = 1, down = 1;
  glfwGetWindowContentScale(window_, &across, &down);
  setStyle(std::max(1.0f, down));
  const double pixelsPerPoint =
      static_cast<double>(pixels().height) / std::max(this->size().height, 1);
  scale_ = std::max(1.0, static_cast<double>(down) / pixelsPerPoint);

  ImGui_ImplGlfw_InitForOpenGL(window_, true);  // chains the callbacks above
  ImGui_ImplOpenGL2_Init();
  glGenTextures(1, &texture_);
}

Window::~Window() {
  ImGui_ImplOpenGL2_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glDeleteTextures(1, &texture_);
  glfwDestroyWindow(window_);
}

bool Window::closing() const { return glfwWindowShouldClose(window_) != 0; }

void Window::setClosing(bool closing) { glfwSetWindowShouldClose(window_, closing); }

ImageSize Window::pixels() const {
  ImageSize size;
  glfwGetFramebufferSize(window_, &size.width, &size.height);
  return size;
}

ImageSize Window::size() const {
  ImageSize size;
  glfwGetWindowSize(window_, &size.width, &size.height);
  return size;
}

void Window::resize(const ImageSize& size) { glfwSetWindowSize(window_, size.width, size.height); }

std::array<int, 2> Window::pixelAt(const Input::Click& place) const {
  const auto [width, height] = this->size();
  const ImageSize size = pixels();
  const auto pixel = [](double at, int points, int most) {
    return std::clamp(static_cast<int>(at * most / std::max(points, 1)), 0, std::max(most - 1, 0));
  };
  return {pixel(place.x, width, size.width), pixel(place.y, height, size.height)};
}

void Window::setTitle(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::setClipboard(const std::string& text) {
  glfwSetClipboardString(window_, text.c_str());
}

bool Window::isFullScreen() const { return glfwGetWindowMonitor(window_) != nullptr; }

void Window::toggleFullScreen() {
  if (isFullScreen()) {
    glfwSetWindowMonitor(window_, nullptr, windowedX_, windowedY_, windowed_.width,
                         windowed_.height, GLFW_DONT_CARE);
    return;
  }

  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (!monitor) return;

  // Place and size of the window are kept for the way back.
  const GLFWvidmode* mode = glfwGetVideoMode(monitor);
  glfwGetWindowPos(window_, &windowedX_, &windowedY_);
  windowed_ = size();
  glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

std::optional<Input::Click> Window::pointed() const {
  if (ImGui::GetIO().WantCaptureMouse || dragged_) return std::nullopt;
  if (input.pointer) return Input::Click{input.pointer->x, input.pointer->y};
  if (!glfwGetWindowAttrib(window_, GLFW_HOVERED)) return std::nullopt;
  return Input::Click{cursorX_, cursorY_};
}

void Window::poll(double waitSeconds) {
  if (waitSeconds > 0) {
    glfwWaitEventsTimeout(waitSeconds);
  } else {
    glfwPollEvents();
  }
}

void Window::wake() { glfwPostEmptyEvent(); }

void Window::upload(const DisplayImage& image, const ImageSize& madeFor) {
  glBindTexture(GL_TEXTURE_2D, texture_);
  madeFor_ = madeFor;

  // The texture is allocated anew only when its size changes.
  if (size_ != ImageSize{image.width, image.height}) {
    size_ = {image.width, image.height};
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.width, image.height, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }

  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE,
                  image.rgba.data());
}

void Window::drawImage() const {
  const ImageSize window = pixels();
  glViewport(0, 0, window.width, window.height);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  if (size_ == ImageSize{}) return;

  // Texels of the window's resolution are shown unchanged; coarser ones are blended.
  const GLint filter = size_ == window ? GL_NEAREST : GL_LINEAR;
  const auto shares = sharesFilled(madeFor_, window);
  const auto x = static_cast<float>(shares[0]), y = static_cast<float>(shares[1]);

  glEnable(GL_TEXTURE_2D);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);

  glBegin(GL_TRIANGLE_STRIP);  // the image's first row is at the top
  glTexCoord2f(0, 0);
  glVertex2f(-x, y);
  glTexCoord2f(0, 1);
  glVertex2f(-x, -y);
  glTexCoord2f(1, 0);
  glVertex2f(x, y);
  glTexCoord2f(1, 1);
  glVertex2f(x, -y);
  glEnd();
  glDisable(GL_TEXTURE_2D);
}

void Window::begin() {
  drawImage();
  ImGui_ImplOpenGL2_NewFrame();
  ImGui_ImplGlfw_NewFrame();

  // A script's pointer takes the place of the one that GLFW reports.
  if (input.pointer) {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos =
        ImVec2(static_cast<float>(input.pointer->x), static_cast<float>(input.pointer->y));
    io.MouseDown[0] = input.pointer->down;
  }

  ImGui::NewFrame();
  followPointer();
}

void Window::followPointer() {
  if (!input.pointer) return;
  const Input::Click at{input.pointer->x, input.pointer->y};
  if (input.pointer->down) {
    if (!scriptPressed_ && !ImGui::GetIO().WantCaptureMouse) scriptPressed_ = at;
    return;
  }

  // A script clicks where its pointer goes down and up in the same place.
  if (scriptPressed_ && scriptPressed_->x == at.x && scriptPressed_->y == at.y) click_ = at;
  scriptPressed_.reset();
}

void Window::end() {
  ImGui::Render();
  ImGui_ImplOpenGL2_RenderDrawData(ImGui::GetDrawData());
}

void Window::present() { glfwSwapBuffers(window_); }

void Window::onKey(GLFWwindow* window, int key, int scancode, int action, int mods) {
  Input& input = windowOf(window).input;
  input.happened = true;
  const std::string name = nameOfKey(key);
  if (action == GLFW_RELEASE) {
    input.held.erase(name);
  } else if (action == GLFW_PRESS && !ImGui::GetIO().WantTextInput) {
    // A key with Ctrl is a command, and is not held.
    const bool commands = (mods & GLFW_MOD_CONTROL) != 0;
    const bool moves =
        !commands && !name.empty() && std::string_view("WASDQE").find(name) != std::string::npos;
    const std::string label = moves ? name : labelOfKey(name, key, scancode);
    input.pressed.push_back(commands ? "Ctrl+" + label : label);
    if (!commands) input.held.insert(name);
  }
}

void Window::onButton(GLFWwindow* window, int button, int action, int mods) {
  Window& self = windowOf(window);
  self.input.happened = true;

  // A button that comes up close to where it went down is a click, not a drag.
  if (action == GLFW_RELEASE) {
    const double moved =
        std::abs(self.cursorX_ - self.pressedX_) + std::abs(self.cursorY_ - self.pressedY_);

    const bool clicks = button == GLFW_MOUSE_BUTTON_LEFT && self.dragged_ == &Input::left;
    if (clicks && moved <= kClickSlack * self.scale_) self.click_ = {self.cursorX_, self.cursorY_};
    self.dragged_ = nullptr;
  } else if (!ImGui::GetIO().WantCaptureMouse && button <= GLFW_MOUSE_BUTTON_MIDDLE) {
    const bool left = button == GLFW_MOUSE_BUTTON_LEFT && (mods & GLFW_MOD_SHIFT) == 0;
    self.dragged_ = left ? &Input::left : &Input::middle;
    if (button == GLFW_MOUSE_BUTTON_RIGHT) self.dragged_ = &Input::right;
    self.pressedX_ = self.cursorX_;
    self.pressedY_ = self.cursorY_;
  }
}

void Window::onCursor(GLFWwindow* window, double x, double y) {
  Window& self = windowOf(window);
  self.input.happened = true;

  if (self.dragged_) {
    Drag& drag = self.input.*self.dragged_;
    drag.x += x - self.cursorX_;
    drag.y += y - self.cursorY_;
  }

  self.cursorX_ = x;
  self.cursorY_ = y;
}

void Window::onScroll(GLFWwindow* window, double, double y) {
  windowOf(window).input.happened = true;
  if (!ImGui::GetIO().WantCaptureMouse) windowOf(window).input.wheel += y;
}

void Window::onDrop(GLFWwindow* window, int count, const char** files) {
  for (int i = 0; i < count; ++i) windowOf(window).input.dropped.emplace_back(files[i]);
}

void Window::onFocus(GLFWwindow* window, int focused) {
  if (!focused) windowOf(window).input.held.clear();  // their release would not be seen
}

}  // namespace whit::view
