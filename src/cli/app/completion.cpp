#include "cli/app/completion.h"

#include <algorithm>
#include <cctype>

#include "core/option_values.h"
#include "io/paths.h"

namespace whit::cli {

namespace {

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

}  // namespace

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

}  // namespace whit::cli
