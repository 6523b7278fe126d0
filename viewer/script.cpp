#include "viewer/script.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "core/error.h"
#include "core/nearest_name.h"
#include "viewer/keys.h"
#include "viewer/panel.h"

namespace whit::view {

namespace {

using Kind = ScriptCommand::Kind;
using Words = std::vector<std::string>;

constexpr double kLargestNumber = 1e6;

[[noreturn]] void expected(const std::string& what) { throwUsage("expected " + what); }

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
  return std::max(1, static_cast<int>(std::lround(seconds / kScriptSecondsPerFrame)));
}

ScriptCommand keyCommand(const Words& words) {
  if (words.size() != 2 && words.size() != 3) expected("key NAME [SECONDS]");
  ScriptCommand command{Kind::key};
  command.key = keyNamed(words[1]);
  if (words.size() == 3) command.frames = framesOf(number(words[2]));
  return command;
}

ScriptCommand mouseCommand(const Words& words) {
  if (words.size() != 4 || (words[1] != "left" && words[1] != "right")) {
    expected("mouse left|right DX DY");
  }
  ScriptCommand command{words[1] == "left" ? Kind::look : Kind::orbit};
  command.x = number(words[2]);
  command.y = number(words[3]);
  return command;
}

ScriptCommand waitCommand(const Words& words) {
  if (words.size() == 2 && words[1] == "sharp") return {Kind::waitSharp};
  if (words.size() != 3 || (words[2] != "frames" && words[2] != "seconds")) {
    expected("wait N frames, wait N seconds or wait sharp");
  }
  ScriptCommand command{Kind::wait};
  const double amount = number(words[1]);
  command.frames = words[2] == "seconds" ? framesOf(amount) : std::max(1, static_cast<int>(amount));
  return command;
}

constexpr int kClickFrames = 4;  // to the place, down, along, up

ScriptCommand clickCommand(const Words& words) {
  if (words.size() != 3 && words.size() != 5) expected("click X Y [X2 Y2]");
  ScriptCommand command{Kind::click};
  command.frames = kClickFrames;
  command.x = command.toX = number(words[1]);
  command.y = command.toY = number(words[2]);
  if (words.size() == 5) command.toX = number(words[3]), command.toY = number(words[4]);
  return command;
}

ScriptCommand resizeCommand(const Words& words) {
  constexpr double kLargestSide = 16384;
  ScriptCommand command{Kind::resize};
  const bool three = words.size() == 3;
  if (three) command.x = number(words[1]), command.y = number(words[2]);
  const auto fits = [](double side) { return side >= 1 && side <= kLargestSide; };
  if (!three || !fits(command.x) || !fits(command.y)) expected("resize W H, from 1 to 16384");
  return command;
}

ScriptCommand errorsCommand(const Words& words) {
  if (words.size() != 2 || (words[1] != "show" && words[1] != "end")) {
    expected("errors show or errors end");
  }
  return {words[1] == "show" ? Kind::showErrors : Kind::endErrors};
}

ScriptCommand panelCommand(const Words& words) {
  if (words.size() != 2) expected("panel NAME");
  const std::vector<std::string> tabs(kPanelTabs.begin(), kPanelTabs.end());
  if (std::find(tabs.begin(), tabs.end(), words[1]) == tabs.end()) {
    throwUsage("the panel has no tab '" + words[1] + "'; nearest: '" + nearestName(words[1], tabs) +
               "'");
  }
  ScriptCommand command{Kind::panel};
  command.file = words[1];
  return command;
}

constexpr std::pair<const char*, Kind> kPlainCommands[] = {
    {"minimize", Kind::minimize}, {"restore", Kind::restore}, {"quit", Kind::quit}};

ScriptCommand commandOf(const Words& words) {
  if (words[0] == "key") return keyCommand(words);
  if (words[0] == "mouse") return mouseCommand(words);
  if (words[0] == "wait") return waitCommand(words);
  if (words[0] == "wheel") {
    if (words.size() != 2) expected("wheel NOTCHES");
    ScriptCommand command{Kind::wheel};
    command.x = number(words[1]);
    return command;
  }
  if (words[0] == "screenshot") {
    if (words.size() != 2 || !words[1].ends_with(".png")) expected("screenshot FILE.png");
    ScriptCommand command{Kind::screenshot};
    command.file = words[1];
    return command;
  }
  if (words[0] == "click") return clickCommand(words);
  if (words[0] == "panel") return panelCommand(words);
  if (words[0] == "drop") {
    if (words.size() != 2) expected("drop FILE");
    ScriptCommand command{Kind::drop};
    command.file = words[1];
    return command;
  }
  if (words[0] == "resize") return resizeCommand(words);
  if (words[0] == "errors") return errorsCommand(words);
  for (const auto& [name, kind] : kPlainCommands) {
    if (words[0] == name && words.size() == 1) return {kind};
  }
  expected(
      "key, mouse, wheel, wait, screenshot, click, panel, drop, resize, minimize, restore, errors "
      "or quit, got '" +
      words[0] + "'");
}

Input::Pointer pointerOf(const ScriptCommand& click, int frame) {
  const bool begins = frame < 2;
  return {begins ? click.x : click.toX, begins ? click.y : click.toY, frame == 1 || frame == 2};
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

ScriptPlayer::Step ScriptPlayer::next(bool sharp, Input& input) {
  Step step;
  if (at_ >= commands_.size()) {
    step.quit = true;
    return step;
  }
  const ScriptCommand& c = commands_[at_];
  if (c.kind == Kind::waitSharp && !sharp) return step;
  switch (c.kind) {
    case Kind::key:
      if (frame_ == 0) input.pressed.push_back(c.key);
      input.held.insert(c.key);
      break;
    case Kind::look:
      input.lookX += c.x, input.lookY += c.y;
      break;
    case Kind::orbit:
      input.orbitX += c.x, input.orbitY += c.y;
      break;
    case Kind::wheel:
      input.wheel += c.x;
      break;
    case Kind::screenshot:
      step.screenshot = c.file;
      break;
    case Kind::click:
      input.pointer = pointerOf(c, frame_);
      break;
    case Kind::drop:
      input.dropped.push_back(c.file);
      break;
    case Kind::panel:
    case Kind::resize:
    case Kind::minimize:
    case Kind::restore:
    case Kind::showErrors:
    case Kind::endErrors:
      step.command = &c;
      break;
    case Kind::quit:
      step.quit = true;
      break;
    case Kind::wait:
    case Kind::waitSharp:
      break;
  }
  if (++frame_ >= c.frames) {
    frame_ = 0;
    ++at_;
  }
  return step;
}

}  // namespace whit::view
