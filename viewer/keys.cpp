#define GLFW_INCLUDE_NONE
#include "viewer/keys.h"

#include <GLFW/glfw3.h>

#include <cctype>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/nearest_name.h"

namespace whit::view {

namespace {

constexpr std::pair<const char*, int> kNamed[] = {
    {"Left", GLFW_KEY_LEFT},      {"Right", GLFW_KEY_RIGHT},    {"Up", GLFW_KEY_UP},
    {"Down", GLFW_KEY_DOWN},      {"Space", GLFW_KEY_SPACE},    {"Shift", GLFW_KEY_LEFT_SHIFT},
    {"Escape", GLFW_KEY_ESCAPE},  {"+", GLFW_KEY_KP_ADD},       {"-", GLFW_KEY_MINUS},
    {"[", GLFW_KEY_LEFT_BRACKET}, {"]", GLFW_KEY_RIGHT_BRACKET}};

constexpr KeyHelp kHelp[] = {{"W A S D, Q E", "fly; down and up"},
                             {"Shift", "four times as fast"},
                             {"wheel", "speed"},
                             {"left drag, arrows", "look around"},
                             {"right drag", "orbit"},
                             {"click; T", "the rays of that pixel; their lines, or not"},
                             {"I", "what the pixel under the pointer holds, or not"},
                             {"1 ... 9", "cameras of the scene"},
                             {"Space", "fly the camera path"},
                             {"P", "play or pause what moves"},
                             {"+ -", "finer, coarser pixels"},
                             {"[ ]", "exposure"},
                             {"F", "full screen"},
                             {"H", "this panel"},
                             {"V", "depth, normals and other views"},
                             {"N", "more samples at rest, or not"},
                             {"M", "measure what each knob and effect costs"},
                             {"X", "against the reference; drag the line"},
                             {"C", "print and copy the view as whit render makes it"},
                             {"F12", "save PNG, EXR, camera and command"},
                             {"F5 F9", "save, restore the camera"},
                             {"R", "reload the scene"},
                             {"Ctrl+S", "save what was edited as a scene file"},
                             {"drop a file", "open it; an HDR or EXR image as the sky"},
                             {"Esc", "quit"}};

}  // namespace

int keyNamed(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& [text, code] : kNamed) {
    if (name == text) return code;
    known.emplace_back(text);
  }
  // GLFW's codes of letters and digits are their ASCII codes.
  if (name.size() == 1 && std::isalnum(static_cast<unsigned char>(name[0]))) {
    return std::toupper(static_cast<unsigned char>(name[0]));
  }
  for (int i = 1; i <= 12; ++i) {
    if (name == "F" + std::to_string(i)) return GLFW_KEY_F1 + i - 1;
    known.push_back("F" + std::to_string(i));
  }
  throwUsage("there is no key '" + name + "'" + didYouMean(name, known));
}

std::span<const KeyHelp> keyHelp() { return kHelp; }

}  // namespace whit::view
