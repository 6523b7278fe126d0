#include "script.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

#include "core/error.h"
#include "core/text.h"
#include "viewer/panel.h"

namespace whit::view {

namespace {

using Words = std::vector<std::string>;

constexpr double kLargestNumber = 1e6;

[[noreturn]] void expected(const std::string& what) { throwUsage("expected " + what); }

std::string keyNamed(const std::string& name) {
  const std::vector<std::string> known = keyNames();
  if (std::ranges::find(known, name) != known.end()) return name;
  throwUsage("there is no key '" + name + "'" + didYouMean(name, known));
}

double number(const std::string& text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !(std::abs(value) <= kLargestNumber)) {
    expected("a number of at most 1e6, got '" + text + "'");
  }
  return value;
}

int framesOf(double seconds) {
  return std::max(1, static_cast<int>(std::lround(seconds / ScriptedUser::kSecondsPerFrame)));
}

ScriptCommand keyCommand(const Words& words) {
  if (words.size() != 2 && words.size() != 3) expected("key NAME [SECONDS]");

  constexpr std::string_view kControl = "Ctrl+";
  // A key with Ctrl is a command, and is not held.
  if (words.size() == 2 && words[1].starts_with(kControl)) {
    keyNamed(words[1].substr(kControl.size()));
    return {[key = words[1]](int, Input& input, ScriptStep&) { input.pressed.push_back(key); }};
  }

  const auto hold = [key = keyNamed(words[1])](int frame, Input& input, ScriptStep&) {
    if (frame == 0) input.pressed.push_back(key);
    input.held.insert(key);
  };
  return {hold, words.size() == 3 ? framesOf(number(words[2])) : 1};
}

ScriptCommand mouseCommand(const Words& words) {
  constexpr std::pair<const char*, Drag Drags::*> kButtons[] = {
      {"left", &Input::left}, {"right", &Input::right}, {"middle", &Input::middle}};
  for (const auto& [name, button] : kButtons) {
    if (words.size() != 4 || words[1] != name) continue;
    return {[button = button, x = number(words[2]), y = number(words[3])](int, Input& input,
                                                                          ScriptStep&) {
      (input.*button).x += x;
      (input.*button).y += y;
    }};
  }
  expected("mouse left|right|middle DX DY");
}

ScriptCommand wheelCommand(const Words& words) {
  if (words.size() != 2) expected("wheel NOTCHES");
  return {[notches = number(words[1])](int, Input& input, ScriptStep&) { input.wheel += notches; }};
}

ScriptCommand waitCommand(const Words& words) {
  if (words.size() == 2 && words[1] == "sharp") return {nullptr, 1, true};
  if (words.size() != 3 || (words[2] != "frames" && words[2] != "seconds")) {
    expected("wait N frames, wait N seconds or wait sharp");
  }

  const double amount = number(words[1]);
  return {nullptr,
          words[2] == "seconds" ? framesOf(amount) : std::max(1, static_cast<int>(amount))};
}

ScriptCommand screenshotCommand(const Words& words) {
  if (words.size() != 2 || !words[1].ends_with(".png")) expected("screenshot FILE.png");
  return {[file = words[1]](int, Input&, ScriptStep& step) { step.screenshot = file; }};
}

ScriptCommand clickCommand(const Words& words) {
  constexpr int kFrames = 4;  // the pointer goes to the place, presses, moves along and is released
  if (words.size() != 3 && words.size() != 5) expected("click X Y [X2 Y2]");

  const std::array from{number(words[1]), number(words[2])};
  std::array to = from;
  if (words.size() == 5) to = {number(words[3]), number(words[4])};

  const auto point = [=](int frame, Input& input, ScriptStep&) {
    const auto& [x, y] = frame < 2 ? from : to;
    input.pointer = {x, y, frame == 1 || frame == 2};
  };
  return {point, kFrames};
}

ScriptCommand pointCommand(const Words& words) {
  if (words.size() != 3) expected("point X Y");
  const Input::Pointer rest{number(words[1]), number(words[2])};
  return {[rest](int, Input&, ScriptStep& step) { step.rest = rest; }};
}

ScriptCommand panelCommand(const Words& words) {
  if (words.size() != 2) expected("panel NAME");
  const std::vector<std::string> tabs(kPanelTabs.begin(), kPanelTabs.end());
  if (std::find(tabs.begin(), tabs.end(), words[1]) == tabs.end()) {
    throwUsage("the panel has no tab '" + words[1] + "'" + didYouMean(words[1], tabs));
  }
  return {[tab = words[1]](int, Input&, ScriptStep& step) { step.tab = tab; }};
}

ScriptCommand dropCommand(const Words& words) {
  if (words.size() != 2) expected("drop FILE");
  return {[file = words[1]](int, Input& input, ScriptStep&) { input.dropped.push_back(file); }};
}

ScriptCommand resizeCommand(const Words& words) {
  constexpr double kLargestSide = 16384;
  const auto side = [&](std::size_t i) { return words.size() == 3 ? number(words[i]) : 0; };
  const double width = side(1), height = side(2);
  const auto fits = [](double side) { return side >= 1 && side <= kLargestSide; };
  if (!fits(width) || !fits(height)) expected("resize W H, from 1 to 16384");

  const ImageSize size{static_cast<int>(width), static_cast<int>(height)};
  return {[size](int, Input&, ScriptStep& step) { step.resize = size; }};
}

ScriptCommand errorsCommand(const Words& words) {
  if (words.size() != 2 || (words[1] != "show" && words[1] != "end")) {
    expected("errors show or errors end");
  }
  return {[show = words[1] == "show"](int, Input&, ScriptStep& step) { step.showErrors = show; }};
}

constexpr std::pair<const char*, ScriptCommand (*)(const Words&)> kCommands[] = {
    {"key", keyCommand},
    {"mouse", mouseCommand},
    {"wheel", wheelCommand},
    {"wait", waitCommand},
    {"click", clickCommand},
    {"point", pointCommand},
    {"screenshot", screenshotCommand},
    {"panel", panelCommand},
    {"drop", dropCommand},
    {"resize", resizeCommand},
    {"errors", errorsCommand},
};
constexpr std::pair<const char*, bool ScriptStep::*> kPlainCommands[] = {
    {"minimize", &ScriptStep::minimize},
    {"restore", &ScriptStep::restore},
    {"bare", &ScriptStep::bare},
    {"asked", &ScriptStep::askedSamples},
    {"quit", &ScriptStep::quit}};

ScriptCommand commandOf(const Words& words) {
  for (const auto& [name, read] : kCommands) {
    if (words[0] == name) return read(words);
  }
  for (const auto& [name, flag] : kPlainCommands) {
    if (words[0] != name || words.size() != 1) continue;
    return {[flag = flag](int, Input&, ScriptStep& step) { step.*flag = true; }};
  }
  expected(
      "key, mouse, wheel, wait, screenshot, click, point, panel, drop, resize, minimize, restore, "
      "bare, asked, errors or quit, got '" +
      words[0] + "'");
}

}  // namespace

std::vector<ScriptCommand> parseScript(const std::string& text, const std::string& file) {
  std::vector<ScriptCommand> commands;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream in(line.substr(0, line.find('#')));
    Words words;
    for (std::string word; in >> word;) words.push_back(word);

    if (words.empty()) continue;
    try {
      commands.push_back(commandOf(words));
    } catch (const Error& error) {
      throwBadScene(file + ":" + std::to_string(number), error.what());
    }
  }
  return commands;
}

ScriptStep ScriptPlayer::next(bool sharp, Input& input) {
  ScriptStep step;
  step.quit = at_ >= commands_.size();
  if (step.quit) return step;

  const ScriptCommand& command = commands_[at_];
  // A command that waits until the picture is sharp is repeated until then.
  if (!command.waitsUntilSharp || sharp) {
    if (command.act) command.act(frame_, input, step);
    if (++frame_ >= command.frames) {
      frame_ = 0;
      ++at_;
    }
  }

  if (step.rest) rest_ = step.rest;
  if (!input.pointer) input.pointer = rest_;
  return step;
}

}  // namespace whit::view
