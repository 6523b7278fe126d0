// Text for people: printf into a string, lines of a width, text from files on a terminal, lists of
// names, and suggestions for misspelt ones.
#pragma once

#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace whit {

__attribute__((format(printf, 1, 2))) inline std::string formatted(const char* format, ...) {
  std::va_list values, again;
  va_start(values, format);
  va_copy(again, values);

  // A first call without memory returns the length.
  const int size = std::vsnprintf(nullptr, 0, format, values);
  va_end(values);

  // vsnprintf() also writes a terminating zero, which the string does not keep.
  std::string text(static_cast<std::size_t>(size > 0 ? size : 0) + 1, '\0');
  std::vsnprintf(text.data(), text.size(), format, again);
  va_end(again);
  text.pop_back();
  return text;
}

inline void append(std::string& text, std::string_view part) { text += part; }
template <typename Number>
requires std::is_arithmetic_v<Number>
void append(std::string& text, Number number) { text += std::to_string(number); }

// The parts, texts and numbers, one after the other.
template <typename... Parts>
std::string concat(const Parts&... parts) {
  std::string text;
  (append(text, parts), ...);
  return text;
}

// The words of the text in lines of at most `width` letters, if no word is longer. The first line
// starts at column `at`, the others are indented.
inline std::string wrapped(const std::string& text, std::size_t at, std::size_t indent,
                           std::size_t width) {
  std::string lines;
  std::istringstream words(text);

  for (std::string word; words >> word;) {
    if (!lines.empty() && at + 1 + word.size() > width) {
      lines += "\n" + std::string(indent, ' ');
      at = indent;
    } else if (!lines.empty()) {
      lines += ' ';
      ++at;
    }

    lines += word;
    at += word.size();
  }

  return lines + "\n";
}

// The word, in quotation marks for a POSIX shell where they are needed.
std::string quoted(const std::string& word);

// The text as it may be put on a terminal. Control characters, which move the cursor, color or
// rename things, are written as "\x1b", and so are bytes that are no UTF-8.
std::string printable(const std::string& text);

// The name that other programs, or former versions, call `word`; else the name at the smallest edit
// distance from it, if that is about a third of the word at most; otherwise empty.
std::string nearestName(const std::string& word, const std::vector<std::string>& names);

// "; did you mean 'NAME'?" for the end of a message. If no name is near, all names where `kind`
// says what they are, else nothing.
std::string didYouMean(const std::string& word, const std::vector<std::string>& names,
                       const std::string& kind = "");

// The names, one after the other.
std::string joined(const std::vector<std::string>& names, const std::string& separator = ", ");

// "1 ray", "2 rays".
std::string counted(std::uint64_t count, const std::string& noun);

// The indices in `names` of the names in the text, which are separated by commas. Throws
// Error(usage) for an unknown one: "no KIND is called ...", with all there are.
std::vector<std::size_t> indicesOf(const std::string& commaSeparated,
                                   const std::vector<std::string>& names, const std::string& kind);

// The names, with a number after those that are taken: "lamp", "lamp#2".
std::vector<std::string> distinctNames(const std::vector<std::string>& names);

// The keys of a map.
template <typename Map>
std::vector<std::string> keysOf(const Map& map) {
  std::vector<std::string> keys;
  keys.reserve(map.size());
  for (const auto& [key, value] : map) keys.push_back(key);
  return keys;
}

// The names of a table whose rows have a member `name`.
template <typename Table>
std::vector<std::string> namesIn(const Table& table) {
  std::vector<std::string> names;
  names.reserve(std::size(table));
  for (const auto& row : table) names.emplace_back(row.name);
  return names;
}

}  // namespace whit
