#include "viewer/session/verbs.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/option_table.h"
#include "core/text.h"
#include "viewer/session/session.h"

namespace whit::view {

namespace {

constexpr double kLongestDrag = 1e5, kMostNotches = 1e3, kLargestSide = 65536;

// Makes an action of a member function without arguments.
template <auto kMember>
void call(Session& session, const Message& /*message*/) {
  (session.*kMember)();
}

// The window and the page each do this in their own way.
Verb byFaces(std::string_view name, std::string_view keys, std::string_view help) {
  return {.name = name, .keys = keys, .help = help, .onPage = true};
}

}  // namespace

std::span<const Verb> verbs() { return Session::verbs(); }

std::span<const Verb> Session::verbs() {
  using S = Session&;
  using M = const Message&;
  constexpr Numbers kDrag{2, -kLongestDrag, kLongestDrag};

  static const Verb kVerbs[] = {
      // Drags and clicks are in the list of keys, too.
      {"left", "left drag", "orbit what is seen from outside, look around in a room",
       [](S s, M m) { s.drag(s.drags_.left, m); }, kDrag},
      {"middle", "middle drag, Shift drag", "pan", [](S s, M m) { s.drag(s.drags_.middle, m); },
       kDrag},
      {"wheel",
       "wheel, right drag",
       "go forward and back: closer to a model, through a room",
       [](S s, M m) { s.drags_.wheel += m.numbers[0]; },
       {1, -kMostNotches, kMostNotches}},
      {"right", "", "", [](S s, M m) { s.drag(s.drags_.right, m); }, kDrag},
      // The numbers are: forward, right, up, turn right, turn up, fast.
      {"hold",
       "W A S D, Q E, arrows",
       "walk, down and up, look around; with Shift faster",
       [](S s, M m) { s.hold(m); },
       {6, -1, 1}},
      {"fit", "F", "fit what is looked at; in a room go to the first camera",
       call<&Session::fitView>},
      {"home", "Home", "go to the first camera", [](S s, M) { s.jumpToNumber(0); }},
      {"camera",
       "1 2 3 4 5 6 7 8 9",
       "go to that camera of the scene",
       [](S s, M m) { s.jumpToNumber(static_cast<std::size_t>(m.numbers[0])); },
       {1, 0, 1e6, 0, 1}},
      byFaces("cameras", "L", "list the cameras with their names"),
      {"play", "Space", "play or pause what moves, or fly along the camera path",
       call<&Session::playOrPause>},
      {"expose",
       "[ ]",
       "darker, brighter",
       [](S s, M m) { s.expose(static_cast<float>(m.numbers[0])); },
       {1, -64, 64, -0.25, 0.5}},
      {"click",
       "click",
       "show the rays of that pixel",
       [](S s, M m) { s.pick(m.numbers[0], m.numbers[1]); },
       {2, 0, kLargestSide}},
      byFaces("lines", "T", "draw the rays into the scene, or hide them"),
      {"next-view", "V",
       "show depth, normals, albedo, rays, cost, packet occupancy, the scalar reference and the "
       "difference from it in turn, with the value of the pixel under the pointer",
       call<&Session::showNextView>},
      {"undo", "Ctrl+Z", "undo the last edit, or the last change of an option",
       call<&Session::undo>},
      {"save-scene", "Ctrl+S",
       "save the scene with all edits, options and this view as NAME-edited.json, never over "
       "another file"},
      byFaces("copy", "C",
              "copy and print the whit render command that makes the same picture, bit for bit"),
      {"save-picture", "F12",
       "save PNG and EXR as soon as the picture has full resolution and all samples; Esc ends the "
       "wait"},
      {"reload", "R", "read the scene again, as a change of its file does; edits stay",
       call<&Session::reload>},
      {.name = "open",
       .keys = "drop of a file",
       .help = "open the scene or model, or show the HDR or EXR image as the sky",
       .text = true},
      byFaces("panel", "P", "show the panel"),
      byFaces("keys", "H", "show the keys"),
      {"full-screen", "F11", "full screen"},
      {"close", "Esc",
       "give up what is read or awaited, close what is open; a window then quits, but asks before "
       "edits are lost",
       [](S s, M) {
         if (!s.close()) s.forgetRays();
       }},

      // These have controls instead of keys.
      {.name = "scene", .act = [](S s, M m) { s.openShipped(m.text); }, .text = true},
      {"time", "", "", [](S s, M m) { s.setTime(m.numbers[0]); }, {1, 0, 1e9}},
      {.name = "animation", .act = [](S s, M m) { s.chooseAnimation(m.text); }, .text = true},
      {.name = "view", .act = [](S s, M m) { s.chooseView(m.text); }, .text = true},
      {.name = "set",
       .act = [](S s, M m) { s.chooseOption(m.name, m.text); },
       .named = true,
       .text = true},
      {.name = "effect",
       .act = [](S s, M m) { s.chooseEffect(m.name, m.numbers[0] > 0); },
       .numbers = {1, 0, 1},
       .named = true},
      {.name = "preset", .act = [](S s, M m) { s.choosePreset(m.text); }, .text = true},
      {"measure", "", "", call<&Session::measure>},
      {"aside", "", "", call<&Session::lookFromAside>},
      {"forget", "", "", call<&Session::forgetRays>},
      {"dismiss", "", "", [](S s, M) { s.state_.error.clear(); }},

      // The server carries out the last two. "ack" has the numbers of a page and of the message
      // that it has drawn; "size" has the width and height of its picture, and pixels per CSS
      // pixel.
      {"ack", "", "", nullptr, {2, 0, 4e9}},
      {"size", "", "", nullptr, {3, 0.1, 8192}}};
  return kVerbs;
}

namespace {

[[noreturn]] void fail(std::size_t line, const std::string& expected) {
  throwUsage("line " + std::to_string(line) + " of the input: expected " + expected);
}

// Removes the first word of the line and the blank behind it.
std::string takeWord(std::string_view& line) {
  const std::size_t end = std::min(line.find(' '), line.size());
  std::string word(line.substr(0, end));
  line.remove_prefix(std::min(end + 1, line.size()));
  return word;
}

Message readMessage(std::string_view line, std::size_t number) {
  const bool plain =
      std::ranges::none_of(line, [](char c) { return c >= 0 && (c < ' ' || c > '~'); });
  if (!plain || line.size() > kMessageBytes) fail(number, "no control characters");

  const std::string word = takeWord(line);
  const auto verb = std::ranges::find(verbs(), std::string_view(word), &Verb::name);
  const bool known = verb != verbs().end() && (verb->act || verb->keys.empty());
  if (!known) fail(number, "a verb, as 'left 3 -4'");

  Message message{.verb = &*verb};
  if (verb->named) message.name = takeWord(line);
  const Numbers& numbers = verb->numbers;
  for (std::size_t i = 0; i < numbers.count; ++i) {
    double& value = message.numbers[i];
    const bool read =
        readNumber(takeWord(line), value) && value >= numbers.low && value <= numbers.high;

    if (!read) {
      fail(number, formatted("%zu numbers from %g to %g after '%s'", numbers.count, numbers.low,
                             numbers.high, word.c_str()));
    }
  }

  if (verb->text) message.text = std::exchange(line, std::string_view());
  if (!line.empty()) fail(number, "nothing more after '" + word + "'");
  return message;
}

}  // namespace

std::vector<Message> readMessages(std::string_view body) {
  if (body.size() > kMessageBytes) throwUsage("the input is longer than it may be");

  std::vector<Message> messages;
  while (!body.empty()) {
    if (messages.size() == kMessageLines) throwUsage("the input has more lines than it may have");
    const std::size_t end = std::min(body.find('\n'), body.size());
    messages.push_back(readMessage(body.substr(0, end), messages.size() + 1));
    body.remove_prefix(std::min(end + 1, body.size()));
  }
  return messages;
}

std::string lineOfKey(std::string_view key) {
  for (const Verb& verb : verbs()) {
    const Numbers& numbers = verb.numbers;
    if (numbers.count > 1 || verb.text || verb.keys.empty())
      continue;  // these are drags, clicks and drops

    const std::vector<std::string> keys = split(std::string(verb.keys), ' ');
    const auto found = std::ranges::find(keys, key);
    if (found == keys.end()) continue;

    const auto place = static_cast<double>(found - keys.begin());
    const std::string number = shortest(numbers.first + place * numbers.step);
    return std::string(verb.name) + (numbers.count > 0 ? " " + number : "");
  }
  return "";
}

}  // namespace whit::view
