#include "command_line/help_text.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <regex>

#include "command_line/parse_options.h"
#include "command_line/program.h"
#include "core/index.h"
#include "core/option_table.h"
#include "core/text.h"
#include "io/files.h"

namespace whit::cli {

namespace {

constexpr int kLeastWidth = 40, kUsualWidth = 80, kLargestWidth = 120;
constexpr std::size_t kNamesWidth = 28, kNarrowNamesWidth = 8;

// Returns names on the left with their meaning beside them, or below if there is no room.
std::string row(const std::string& names, const std::string& meaning, std::size_t width) {
  const std::size_t column = width < kUsualWidth ? kNarrowNamesWidth : kNamesWidth;
  std::string text = "  " + names;
  if (meaning.empty()) return text + "\n";
  // Names that are too long for their column have the meaning on the next line.
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

Terms presetTerms() {
  Terms terms;
  for (const QualityPreset& preset : qualityPresets()) {
    terms.emplace_back(preset.name, preset.options.empty() ? "the defaults" : preset.options);
  }
  return terms;
}

// The options that `isWanted` chooses, by their groups.
template <typename IsWanted>
std::vector<std::pair<std::string, Terms>> groupsOf(const OptionList& list, IsWanted&& isWanted) {
  std::vector<std::pair<std::string, Terms>> groups;
  for (const OptionList::Entry& entry : list.entries) {
    if (!isWanted(entry)) continue;
    if (groups.empty() || groups.back().first != entry.group) groups.push_back({entry.group, {}});
    groups.back().second.emplace_back(namesOf(entry), entry.help);
  }
  return groups;
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

// The values of an option that begin with `word`.
std::string valueLines(const std::string& word, const OptionList::Entry& entry) {
  std::string lines;
  const std::string done = word.substr(0, word.rfind(',') + 1);  // earlier items of a list

  for (const std::string& name : entry.names) lines += completionLine(word, done + name);
  for (const std::string& choice : choicesOf({.words = entry.placeholder})) {
    // A placeholder in capitals, such as FILE, stands for a value and is no choice.
    const bool stands =
        std::ranges::any_of(choice, [](unsigned char c) { return std::isupper(c) != 0; });
    if (!stands) lines += completionLine(word, choice);
  }
  return lines;
}

// Returns one line that troff prints as it is. Without escapes it would turn some characters into
// typographical ones.
std::string roff(const std::string& text) {
  static const std::map<char, std::string> kWritten{{'\\', "\\e"},  {'-', "\\-"},   {'\'', "\\(aq"},
                                                    {'"', "\\(dq"}, {'`', "\\(ga"}, {'^', "\\(ha"},
                                                    {'~', "\\(ti"}, {'\n', " "}};

  // A dot at the start of a line begins a request in troff; \& is a character without width.
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

std::string termsText(const Terms& terms) {
  std::string text;
  for (const auto& [term, meaning] : terms) {
    text += ".TP\n\\fB" + roff(term) + "\\fR\n" + roff(meaning) +
            (meaning.ends_with('.') ? "\n" : ".\n");
  }
  return text;
}

}  // namespace

std::string helpText(const std::string& usage, const std::string& summary, const OptionList& list,
                     HelpTier tier, int width) {
  const std::size_t columns = width;
  std::string text = wrapped(summary, 0, 0, columns) + "\nUsage: " + usage + "\n";

  if (list.operand.most > 0) {
    text +=
        "\n" + wrapped(list.operand.placeholder + ": " + list.operand.help + ".", 0, 2, columns);
  }

  const auto isListed = [&](const OptionList::Entry& e) {
    return tier == HelpTier::all || e.everyday;
  };
  auto groups = groupsOf(list, isListed);
  const std::size_t others = list.entries.size() - std::ranges::count_if(list.entries, isListed);

  groups.push_back({"Help",
                    {{"-h,--help", "the options of every day"},
                     {"--help-all", others > 0 ? formatted("all options, %zu more", others)
                                               : std::string("all options")}}});
  if (contains(list.entries, "quality", &OptionList::Entry::name)) {
    groups.push_back({"What --quality stands for, where an option is not given", presetTerms()});
  }

  for (const auto& [title, terms] : groups) {
    text += "\n" + wrapped(title + ":", 0, 0, columns);
    for (const auto& [names, meaning] : terms) text += row(names, meaning, columns);
  }
  return text;
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
  std::string function = program;
  std::ranges::replace(function, '-', '_');
  const std::string script =
      std::regex_replace(kScripts[parseChoice(spec, shell)], std::regex("FUNCTION"), function);
  return std::regex_replace(script, std::regex("NAME"), program);
}

std::string completions(const std::vector<std::string>& words, const OptionList& list) {
  const std::string word = words.empty() ? "" : words.back();
  const std::string before = words.size() < 2 ? "" : words[words.size() - 2];

  // After an option with a value, the word is completed to one of its values.
  for (const OptionList::Entry& entry : list.entries) {
    const bool byLetter = !entry.shortName.empty() && before == "-" + entry.shortName;
    const bool named = byLetter || before == "--" + entry.name;
    if (named && !entry.placeholder.empty()) return valueLines(word, entry);
  }

  // A word that begins with a dash is completed to an option, any other one to a scene.
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
  return heading(title) + termsText(terms);
}

std::string manOptions(const std::string& usage, const std::string& summary,
                       const OptionList& list) {
  std::string text = ".B " + roff(usage) + "\n.PP\n" + roff(summary) + "\n";
  if (list.operand.most > 0) {
    text +=
        ".PP\n\\fI" + roff(list.operand.placeholder) + "\\fR: " + roff(list.operand.help) + ".\n";
  }

  const auto isShared = [](const OptionList::Entry& entry) { return entry.common; };
  for (const auto& [title, terms] : groupsOf(list, std::not_fn(isShared))) text += termsText(terms);

  // Shared options are described once, after all commands, so a command only refers to them.
  std::vector<std::string> titles;
  for (const auto& [title, terms] : groupsOf(list, isShared)) titles.push_back(title);
  const std::string shared = joined(titles);
  return shared.empty() ? text : text + ".PP\nAlso the options described below: " + shared + ".\n";
}

void printManual(const ManPage& page, const std::function<void()>& body) {
  std::string text = ".TH " + roff(page.name) +
                     " 1 \"\" \"whit " WHIT_VERSION "\" \"User Commands\"\n" + heading("name") +
                     roff(page.name) + " \\- " + roff(page.summary) + "\n" + heading("synopsis") +
                     ".B " + roff(page.synopsis) + "\n" + heading("description") +
                     roff(page.description) + "\n";
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
  text.clear();
  for (const auto& [title, terms] : groupsOf(shared, [](const auto&) { return true; })) {
    text += manSection(title, terms);
  }

  Terms statuses;
  for (const ExitMeaning& e : kExitMeanings) {
    statuses.emplace_back(std::to_string(e.status), e.meaning);
  }

  text += manSection("values of --quality", presetTerms()) + manSection("exit status", statuses) +
          manSection("environment",
                     {{"WHIT_SCENES", "folder that is searched first for shipped scenes"},
                      {"WHIT_DATA", "folder of models that scenes may name as $WHIT_DATA/..."}}) +
          manSection("examples", page.examples) + heading("see also") + ".BR " +
          roff(page.seeAlso) + " (1)\n";
  std::fputs(text.c_str(), stdout);
}

}  // namespace whit::cli
