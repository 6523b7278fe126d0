#include "script.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "viewer/panel.h"

namespace whit::view {

namespace {

using Words = std::vector<std::string>;

// Words that do not hold this are refused by parseScript(), which names the syntax.
void require(bool holds) {
  if (!holds) throw std::invalid_argument("words");
}

double number(const std::string& text) {
  constexpr double kLargest = 1e6;
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  require(error == std::errc() && stop == end && std::abs(value) <= kLargest);
  return value;
}

int framesOf(double seconds) {
  return std::max(1, static_cast<int>(std::lround(seconds / ScriptedUser::kSecondsPerFrame)));
}

template <typename Member, typename Value>
ScriptCommand setting(Member ScriptStep::*member, const Value& value) {
  return {[=](int, Input&, ScriptStep& step) { step.*member = value; }};
}

ScriptCommand keyCommand(const Words& words) {
  // A key with Ctrl is a command, and is not held.
  constexpr std::string_view kControl = "Ctrl+";
  const std::string& name = words[1];
  const bool isHeld = !name.starts_with(kControl);
  require(contains(keyNames(), isHeld ? name : name.substr(kControl.size())));

  const auto press = [=](int frame, Input& input, ScriptStep&) {
    if (frame == 0) input.pressed.push_back(name);
    if (isHeld) input.held.insert(name);
  };
  return {press, words.size() > 2 ? framesOf(number(words[2])) : 1};
}

ScriptCommand mouseCommand(const Words& words) {
  const std::map<std::string, Drag Drags::*> buttons{
      {"left", &Input::left}, {"right", &Input::right}, {"middle", &Input::middle}};
  const Drag by{number(words[2]), number(words[3])};
  return {[button = buttons.at(words[1]), by](int, Input& input, ScriptStep&) {
    (input.*button).x += by.x;
    (input.*button).y += by.y;
  }};
}

ScriptCommand wheelCommand(const Words& words) {
  return {[notches = number(words[1])](int, Input& input, ScriptStep&) { input.wheel += notches; }};
}

ScriptCommand sharpCommand(const Words& words) {
  require(words[1] == "sharp");
  return {nullptr, 1, true};
}

ScriptCommand waitCommand(const Words& words) {
  require(words[2] == "frames");
  return {nullptr, std::max(1, static_cast<int>(number(words[1])))};
}

ScriptCommand screenshotCommand(const Words& words) {
  require(words[1].ends_with(".png"));
  return setting(&ScriptStep::screenshot, words[1]);
}

ScriptCommand clickCommand(const Words& words) {
  constexpr int kFrames = 4;  // the pointer goes to the place, presses, moves along and is released
  const std::array from{number(words[1]), number(words[2])};
  std::array to = from;
  if (words.size() > 3) to = {number(words[3]), number(words[4])};

  const auto point = [=](int frame, Input& input, ScriptStep&) {
    const auto& [x, y] = frame < 2 ? from : to;
    input.pointer = {x, y, frame == 1 || frame == 2};
  };
  return {point, kFrames};
}

ScriptCommand pointCommand(const Words& words) {
  return setting(&ScriptStep::rest, Input::Pointer{number(words[1]), number(words[2])});
}

ScriptCommand panelCommand(const Words& words) {
  require(contains(kPanelTabs, words[1]));
  return setting(&ScriptStep::tab, words[1]);
}

ScriptCommand dropCommand(const Words& words) {
  return {[file = words[1]](int, Input& input, ScriptStep&) { input.dropped.push_back(file); }};
}

ScriptCommand resizeCommand(const Words& words) {
  constexpr int kLargestSide = 16384;
  const ImageSize size{static_cast<int>(number(words[1])), static_cast<int>(number(words[2]))};
  for (const int side : {size.width, size.height}) require(side >= 1 && side <= kLargestSide);
  return setting(&ScriptStep::resize, size);
}

ScriptCommand errorsCommand(const Words& words) {
  require(words[1] == "show");
  return setting(&ScriptStep::showErrors, true);
}

template <bool ScriptStep::*kFlag>
ScriptCommand plainCommand(const Words&) {
  return setting(kFlag, true);
}

// Commands by their syntax: the first word is the name, and those in brackets may be left out.
constexpr std::pair<const char*, ScriptCommand (*)(const Words&)> kCommands[] = {
    {"key NAME [SECONDS]", keyCommand},
    {"mouse left|right|middle DX DY", mouseCommand},
    {"wheel NOTCHES", wheelCommand},
    {"wait sharp", sharpCommand},
    {"wait N frames", waitCommand},
    {"click X Y [X2 Y2]", clickCommand},
    {"point X Y", pointCommand},
    {"screenshot FILE.png", screenshotCommand},
    {"panel NAME", panelCommand},
    {"drop FILE", dropCommand},
    {"resize W H", resizeCommand},
    {"errors show", errorsCommand},
    {"minimize", plainCommand<&ScriptStep::minimize>},
    {"restore", plainCommand<&ScriptStep::restore>},
    {"bare", plainCommand<&ScriptStep::bare>},
    {"asked", plainCommand<&ScriptStep::askedSamples>},
};

Words wordsOf(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}

// True if there are as many words as the syntax has, with or without those in brackets.
bool fits(const Words& words, const Words& syntax) {
  const auto required = std::ranges::count_if(
      syntax, [](const std::string& word) { return word[0] != '[' && word.back() != ']'; });
  return words.size() == syntax.size() || words.size() == static_cast<std::size_t>(required);
}

ScriptCommand commandOf(const Words& words) {
  Words expected;
  for (const auto& [text, read] : kCommands) {
    const Words syntax = wordsOf(text);
    if (syntax[0] != words[0]) continue;
    expected.emplace_back(text);
    if (!fits(words, syntax)) continue;
    try {
      return read(words);
    } catch (const std::logic_error&) {
      continue;
    }
  }
  if (expected.empty()) throwUsage("there is no command '" + words[0] + "'");
  throwUsage("expected " + joined(expected, " or ") + ", got '" + joined(words, " ") + "'");
}

}  // namespace

std::vector<ScriptCommand> parseScript(const std::string& text, const std::string& file) {
  std::vector<ScriptCommand> commands;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const Words words = wordsOf(line.substr(0, line.find('#')));
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
