#include "cli/app/help_text.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <sstream>

#include "cli/app/parse_options.h"
#include "cli/app/program.h"
#include "core/option_table.h"
#include "core/option_values.h"
#include "core/version.h"
#include "io/paths.h"

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

// NAME stands for the program, FUNCTION for its name without dashes.
constexpr const char* kScripts[] = {
    R"(_FUNCTION() {
  local IFS=$'\n'
  COMPREPLY=($(NAME --complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null | cut -f1))
}
complete -o default -F _FUNCTION NAME
)",
    R"zsh(#compdef NAME
_FUNCTION() {
  local -a found
  found=(${(f)"$(NAME --complete "${(@)words[2,CURRENT]}" 2>/dev/null | tr '\t' ':')"})
  if (($#found)); then _describe NAME found; else _files; fi
}
if [[ $funcstack[1] == _FUNCTION ]]; then _FUNCTION "$@"; else compdef _FUNCTION NAME; fi
)zsh",
    R"(function __FUNCTION_complete
  set -l words (commandline -opc) (commandline -ct)
  set -e words[1]
  NAME --complete $words 2>/dev/null
end
complete -c NAME -f -n 'count (__FUNCTION_complete) >/dev/null' -a '(__FUNCTION_complete)'
)"};

std::string withName(const std::string& script, const std::string& program) {
  std::string function = program, text;
  std::replace(function.begin(), function.end(), '-', '_');
  for (std::size_t i = 0; i < script.size(); ++i) {
    if (script.compare(i, 4, "NAME") == 0) {
      text += program;
      i += 3;
    } else if (script.compare(i, 8, "FUNCTION") == 0) {
      text += function;
      i += 7;
    } else {
      text += script[i];
    }
  }
  return text;
}

// The values of an option that begin with `word`.
std::string valueLines(const std::string& word, const OptionList::Entry& entry) {
  std::string lines;
  const std::string done = word.substr(0, word.rfind(',') + 1);  // of a list
  for (const std::string& name : entry.names) lines += completionLine(word, done + name);
  for (const std::string& choice : choicesOf({.words = entry.placeholder})) {
    const bool stands = std::any_of(choice.begin(), choice.end(),  // for a value, as FILE does
                                    [](unsigned char c) { return std::isupper(c) != 0; });
    if (!stands) lines += completionLine(word, choice);
  }
  return lines;
}

// One line that troff takes as it is: it would turn some characters into typographical ones.
std::string roff(const std::string& text) {
  static const std::map<char, std::string> kWritten{{'\\', "\\e"},  {'-', "\\-"},   {'\'', "\\(aq"},
                                                    {'"', "\\(dq"}, {'`', "\\(ga"}, {'^', "\\(ha"},
                                                    {'~', "\\(ti"}, {'\n', " "}};
  std::string out = text.starts_with('.') ? "\\&" : "";
  for (const char c : text) {
    const auto found = kWritten.find(c);
    out += found == kWritten.end() ? std::string(1, c) : found->second;
  }
  return out;
}

std::string heading(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return ".SH \"" + roff(text) + "\"\n";
}

std::string termText(const std::string& term, const std::string& meaning) {
  return ".TP\n" + term + "\n" + roff(meaning) + (meaning.ends_with('.') ? "\n" : ".\n");
}

std::string entryText(const OptionList::Entry& entry) {
  const std::string letter = entry.shortName.empty() ? "" : "-" + entry.shortName + ", ";
  std::string term = "\\fB" + roff(letter + "--" + entry.name) + "\\fR";
  if (!entry.placeholder.empty()) term += " \\fI" + roff(entry.placeholder) + "\\fR";
  return termText(term, entry.help);
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

std::string completionLine(const std::string& word, const std::string& name,
                           const std::string& meaning) {
  if (!name.starts_with(word)) return "";
  return name + (meaning.empty() ? "" : "\t" + meaning) + "\n";
}

std::string completionScript(const std::string& shell, const std::string& program) {
  const OptionSpec spec{.name = "completion", .words = "bash|zsh|fish"};
  return withName(kScripts[parseChoice(spec, shell)], program);
}

std::string completions(const std::vector<std::string>& words, const OptionList& list) {
  const std::string word = words.empty() ? "" : words.back();
  const std::string before = words.size() < 2 ? "" : words[words.size() - 2];
  for (const OptionList::Entry& entry : list.entries) {
    const bool byLetter = !entry.shortName.empty() && before == "-" + entry.shortName;
    const bool named = byLetter || before == "--" + entry.name;
    if (named && !entry.placeholder.empty()) return valueLines(word, entry);
  }
  std::string lines;
  if (word.starts_with('-')) {
    for (const OptionList::Entry& entry : list.entries) {
      lines += completionLine(word, "--" + entry.name, entry.help);
    }
    return lines + completionLine(word, "--help", "the options of every day") +
           completionLine(word, "--help-all", "all options");
  }
  if (list.operand.placeholder.find("SCENE") == std::string::npos) return lines;
  for (const auto& scene : shippedScenes()) lines += completionLine(word, scene.stem().string());
  return lines;
}

std::string manSection(const std::string& title, const Terms& terms) {
  std::string text = heading(title);
  for (const auto& [term, meaning] : terms) text += termText("\\fB" + roff(term) + "\\fR", meaning);
  return text;
}

std::string manOptions(const std::string& usage, const std::string& summary,
                       const OptionList& list) {
  std::string text = ".B " + roff(usage) + "\n.PP\n" + roff(summary) + "\n";
  if (list.operand.most > 0) {
    text +=
        ".PP\n\\fI" + roff(list.operand.placeholder) + "\\fR: " + roff(list.operand.help) + ".\n";
  }
  std::string group, shared;
  for (const OptionList::Entry& entry : list.entries) {
    if (!entry.common) text += entryText(entry);
    if (entry.common && entry.group != group) shared += (shared.empty() ? "" : ", ") + entry.group;
    if (entry.common) group = entry.group;
  }
  return shared.empty() ? text : text + ".PP\nAlso the options described below: " + shared + ".\n";
}

void printManual(const ManPage& page, const std::function<void()>& body) {
  std::string text = ".TH " + roff(page.name) + " 1 \"\" \"whit " + versionText() +
                     "\" \"User Commands\"\n" + heading("name") + roff(page.name) + " \\- " +
                     roff(page.summary) + "\n" + heading("synopsis") + ".B " + roff(page.synopsis) +
                     "\n" + heading("description") + roff(page.description) + "\n";
  text += manSection("options",
                     {{"--help", "commands, or the options of a command that are used every day"},
                      {"--help-all", "all options of a command"},
                      {"--version", "the version"},
                      {"--man", "this page, for man -l"},
                      {"--completion SHELL", "a script for completion in bash, zsh or fish"}});
  std::fputs(text.c_str(), stdout);
  body();
  CommonOptions common;
  OptionList shared;
  listCommonOptions(shared, common);
  std::string group;
  text.clear();
  for (const OptionList::Entry& entry : shared.entries) {
    if (entry.group != group) text += heading(group = entry.group);
    text += entryText(entry);
  }
  Terms statuses, presets;
  for (const ExitMeaning& e : kExitMeanings) {
    statuses.emplace_back(std::to_string(e.status), e.meaning);
  }
  for (const QualityPreset& preset : qualityPresets()) {
    presets.emplace_back("--quality " + preset.name,
                         preset.options.empty() ? "the defaults" : preset.options);
  }
  text += manSection("presets", presets) + manSection("exit status", statuses) +
          manSection("environment",
                     {{"WHIT_SCENES", "folder that is searched first for shipped scenes"},
                      {"WHIT_DATA", "folder of models that scenes may name as $WHIT_DATA/..."}}) +
          heading("see also") + ".BR " + roff(page.seeAlso) + " (1)\n";
  std::fputs(text.c_str(), stdout);
}

}  // namespace whit::cli
