// What a user can ask the viewer for. One table of verbs holds names, keys, help and actions.
// The keys of the window, the lines that the page sends, the overlay of H and the list of keys in
// viewer/README.md follow from it.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace whit::view {

class Session;
struct Message;

// The values of a verb that are numbers.
struct Numbers {
  std::size_t count = 0;
  double low = 0, high = 0;    // their range
  double first = 0, step = 0;  // the number of the verb's first key, and what each further one adds
};

struct Verb {
  std::string_view name;
  std::string_view keys = {}, help = {};  // its row in the list of keys; empty: it has none
  // Carries out the verb. Null leaves it to the window, and to the page if `onPage` is set.
  void (*act)(Session& session, const Message& message) = nullptr;
  Numbers numbers = {};
  bool named = false;  // the name of an option or an effect comes before the numbers
  bool text = false;   // a text follows, which may hold blanks
  bool onPage = false;
};

// The table, in the order of the list of keys.
std::span<const Verb> verbs();

// A verb and its values. It is written as a line: "left 3 -4", "set depth 2".
struct Message {
  const Verb* verb = nullptr;
  std::array<double, 6> numbers{};
  std::string name = {}, text = {};
};

inline constexpr std::size_t kMessageBytes = 1 << 14, kMessageLines = 256;

// Reads lines. Throws Error(usage), which names the line and what was expected, and then returns
// none of them.
std::vector<Message> readMessages(std::string_view body);

// Returns the line that a key stands for: "camera 2" for "3". Empty if there is none.
std::string lineOfKey(std::string_view key);

}  // namespace whit::view
