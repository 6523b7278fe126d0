// The options of a command: names, help, and where the values go.
#pragma once

#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/option_table.h"
#include "core/text.h"

namespace whit::cli {

class OptionList {
 public:
  struct Entry {
    std::string group, name, shortName, placeholder, help;  // a flag has no placeholder
    std::vector<std::string> names = {};  // its value is a list of these, separated by commas
    bool everyday = true;                 // listed in --help; the others only in --help-all
    bool common = false;                  // an option of all commands that render
    std::function<void(const std::string&)> set;
  };
  struct Operand {
    std::string placeholder, help;
    std::size_t least = 0, most = 0;
    std::vector<std::string>* values = nullptr;
  };

  // The entries that follow stand under this heading of --help.
  void group(const std::string& heading) { group_ = heading; }

  template <typename T>
  Entry& value(const OptionSpec& spec, const std::string& help, T& field) {
    // The default value is part of the help, unless the text explains the value in parentheses
    // itself.
    const std::string known = formatValue(spec, field);
    const bool tell = !spec.words.empty() && !known.empty() && help.find('(') == std::string::npos;
    Entry& entry = push(spec, tell ? help + " (default: " + known + ")" : help,
                        [spec, &field](const std::string& text) { parseValue(spec, text, field); });

    // Shells complete the items of a list.
    if constexpr (std::is_same_v<T, EffectSet>) entry.names = namesIn(kEffectNames);
    if constexpr (std::is_same_v<T, ChannelSet>) entry.names = namesIn(kChannels);
    return entry;
  }

  Entry& flag(std::string_view name, const std::string& help, bool& field) {
    return value({.name = name}, help, field);
  }

  // May be given more than once; all values are kept.
  Entry& many(const OptionSpec& spec, const std::string& help, std::vector<std::string>& field) {
    return push(spec, help, [&field](const std::string& text) { field.push_back(text); });
  }

  // Words that are not options, from `least` to `most` of them.
  static constexpr std::size_t kAnyNumber = std::numeric_limits<std::size_t>::max();
  void operands(const std::string& placeholder, const std::string& help, std::size_t least,
                std::size_t most, std::vector<std::string>& values) {
    operand = {placeholder, help, least, most, &values};
  }

  std::vector<Entry> entries;
  Operand operand;
  std::function<void()> whenParsed;  // called when all values are set

 private:
  Entry& push(const OptionSpec& spec, const std::string& help,
              std::function<void(const std::string&)> set) {
    entries.push_back({.group = group_,
                       .name = std::string(spec.name),
                       .shortName = "",
                       .placeholder = std::string(spec.words),
                       .help = help,
                       .set = std::move(set)});
    return entries.back();
  }

  std::string group_ = "Options";
};

}  // namespace whit::cli
