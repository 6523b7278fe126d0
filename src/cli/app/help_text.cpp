#include "cli/app/help_text.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "core/option_table.h"

namespace whit::cli {

namespace {

constexpr int kLeastWidth = 40, kUsualWidth = 80, kLargestWidth = 120;
constexpr std::size_t kNamesWidth = 28, kNarrowNamesWidth = 8;

// Words with blanks between, in lines behind `indent` blanks; the first goes on where the text
// stands, at column `at`.
std::string wrapped(const std::string& text, std::size_t at, std::size_t indent,
                    std::size_t width) {
  std::string lines;
  std::istringstream words(text);
  bool first = true;
  for (std::string word; words >> word;) {
    if (!first && at + 1 + word.size() > width) {
      lines += "\n" + std::string(indent, ' ');
      at = indent;
    } else if (!first) {
      lines += ' ';
      ++at;
    }
    lines += word;
    at += word.size();
    first = false;
  }
  return lines + "\n";
}

// Names on the left and their meaning beside them, or below where there is no room.
std::string row(const std::string& names, const std::string& meaning, std::size_t width) {
  const std::size_t column = width < kUsualWidth ? kNarrowNamesWidth : kNamesWidth;
  std::string text = "  " + names;
  if (meaning.empty()) return text + "\n";
  if (text.size() + 2 > column) {
    text += "\n" + std::string(column, ' ');
  } else {
    text.resize(column, ' ');
  }
  return text + wrapped(meaning, column, column, width);
}

std::string namesOf(const OptionList::Entry& entry) {
  std::string names = entry.shortName.empty() ? "" : "-" + entry.shortName + ",";
  names += "--" + entry.name;
  return entry.placeholder.empty() ? names : names + " " + entry.placeholder;
}

std::string presetRows(std::size_t width) {
  std::string text =
      "\n" + wrapped("What --quality stands for, where an option is not given:", 0, 0, width);
  for (const QualityPreset& preset : qualityPresets()) {
    text += row(preset.name, preset.options.empty() ? "the defaults" : preset.options, width);
  }
  return text;
}

}  // namespace

std::string helpText(const std::string& usage, const std::string& summary, const OptionList& list,
                     HelpTier tier, int width) {
  const auto columns = static_cast<std::size_t>(width);
  std::string text = wrapped(summary, 0, 0, columns) + "\nUsage: " + usage + "\n";
  if (list.operand.most > 0) {
    text +=
        "\n" + wrapped(list.operand.placeholder + ": " + list.operand.help + ".", 0, 2, columns);
  }
  std::string group;
  std::size_t left = 0;
  bool presets = false;
  for (const OptionList::Entry& entry : list.entries) {
    if (tier == HelpTier::everyday && !entry.everyday) {
      ++left;
      continue;
    }
    if (entry.group != group) text += "\n" + (group = entry.group) + ":\n";
    text += row(namesOf(entry), entry.help, columns);
    presets |= entry.name == "quality";
  }
  text += "\nHelp:\n" + row("-h,--help", "the options of every day", columns);
  text += row("--help-all",
              left > 0 ? "all options, " + std::to_string(left) + " more" : "all options", columns);
  return presets ? text + presetRows(columns) : text;
}

int helpWidth() {
  winsize size{};
  int width = kUsualWidth;
  const char* const columns = std::getenv("COLUMNS");
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
    width = size.ws_col;
  } else if (columns != nullptr && std::atoi(columns) > 0) {
    width = std::atoi(columns);
  }
  return std::clamp(width, kLeastWidth, kLargestWidth);
}

}  // namespace whit::cli
