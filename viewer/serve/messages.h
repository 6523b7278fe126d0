// The page reports what its user does: a line for each act, with a verb and its values.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace whit::serve {

struct Verb {
  std::string_view name;
  std::size_t numbers = 0;   // values that are numbers
  double low = 0, high = 0;  // their range
  bool named = false;        // then comes the name of an option or of an effect
  bool text = false;         // then comes a text, which may hold blanks
};
inline constexpr double kLongestDrag = 1e5;  // pixels
inline constexpr std::array kVerbs{
    Verb{"ack", 2, 0, 4e9},      // number of the page, and of the message that it has drawn
    Verb{"size", 3, 0.1, 8192},  // width and height of the picture, and its pixels for each of CSS
    Verb{"left", 2, -kLongestDrag, kLongestDrag},
    Verb{"middle", 2, -kLongestDrag, kLongestDrag},
    Verb{"right", 2, -kLongestDrag, kLongestDrag},
    Verb{"wheel", 1, -100, 100},
    Verb{"hold", 6, -1, 1},  // forward, right, up, turn right, turn up, fast
    Verb{"click", 2, 0, 8192},
    Verb{"camera", 1, 0, 1e6},
    Verb{"fit"},
    Verb{"play"},
    Verb{"time", 1, 0, 1e9},
    Verb{"animation", 0, 0, 0, false, true},
    Verb{"expose", 1, -64, 64},
    Verb{"view", 0, 0, 0, false, true},
    Verb{"measure"},
    Verb{"set", 0, 0, 0, true, true},
    Verb{"effect", 1, 0, 1, true},
    Verb{"preset", 0, 0, 0, false, true},
    Verb{"aside"},
    Verb{"forget"},
    Verb{"reload"}};

struct Message {
  std::string_view verb;  // of kVerbs
  std::array<double, 6> numbers{};
  std::string name, text;
};

inline constexpr std::size_t kMessageBytes = 1 << 14, kMessageLines = 256;

// Reads the lines of a request. Throws Error(usage) that names the line and what was expected; then
// none of them counts.
std::vector<Message> readMessages(std::string_view body);

}  // namespace whit::serve
