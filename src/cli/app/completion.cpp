#include "cli/app/completion.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "core/option_values.h"

namespace whit::cli {

namespace {

// The words that an option takes, without those that stand for others as FILE does.
std::vector<std::string> wordsOf(const OptionList::Entry& entry) {
  std::vector<std::string> words;
  if (entry.placeholder.find('|') == std::string::npos) return words;
  std::istringstream parts(entry.placeholder);
  for (std::string word; std::getline(parts, word, '|');) {
    const bool literal = std::none_of(word.begin(), word.end(), [](char c) {
      return std::isupper(static_cast<unsigned char>(c)) != 0;
    });
    if (literal) words.push_back(word);
  }
  return words;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

bool takesFile(const OptionList::Entry& entry) {
  return entry.placeholder.find("FILE") != std::string::npos || entry.placeholder == "DIR" ||
         entry.placeholder == "CSV";
}

bool takesScene(const OptionList& list) {
  return list.operand.most > 0 && list.operand.placeholder.find("SCENE") != std::string::npos;
}

// Function names have no dashes.
std::string functionName(const std::string& program, const std::string& command) {
  std::string name = "_" + program + (command.empty() ? "" : "_" + command);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

// Within single quotes; zsh gives colons and brackets a meaning of its own.
std::string quoted(const std::string& text, Shell shell) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += shell == Shell::fish ? "\\'" : "'\\''";
    } else if (shell == Shell::zsh && (c == ':' || c == '[' || c == ']' || c == '\\')) {
      out += std::string("\\") + c;
    } else if (shell == Shell::fish && c == '\\') {
      out += "\\\\";
    } else {
      out += c;
    }
  }
  return out;
}

std::string bashOptions(const std::string& command, const OptionList& list) {
  std::string all = "--help --help-all", values,
              text = "    " + (command.empty() ? "*" : command) + ")\n";
  text += "      case $before in\n";
  for (const OptionList::Entry& entry : list.entries) {
    const std::string option = "--" + entry.name;
    const std::string either = entry.shortName.empty() ? option : option + " | -" + entry.shortName;
    all += " " + option;
    const std::vector<std::string> words = wordsOf(entry);
    if (!entry.names.empty()) {
      text += "        " + either + ") words='" + joined(entry.names) + "' list=yes ;;\n";
    } else if (!words.empty()) {
      text += "        " + either + ") words='" + joined(words) + "' ;;\n";
    } else if (!entry.placeholder.empty()) {
      values += (values.empty() ? "" : " | ") + either;
    }
  }
  if (!values.empty()) text += "        " + values + ") ;;\n";
  text += "        *)\n          if [[ $current == -* ]]; then\n            words='" + all + "'\n";
  if (takesScene(list))
    text += "          else\n            words=$(whit scenes 2>/dev/null | cut -d' ' -f1)\n";
  return text + "          fi ;;\n      esac ;;\n";
}

std::string zshOptions(const std::string& program, const std::string& command,
                       const OptionList& list) {
  std::string text = functionName(program, command) +
                     "() {\n  _arguments \\\n"
                     "    '--help[the options of every day]' '--help-all[all options]'";
  for (const OptionList::Entry& entry : list.entries) {
    std::string spec = "[" + quoted(entry.help, Shell::zsh) + "]";
    if (!entry.placeholder.empty()) {
      spec += ":" + quoted(entry.placeholder, Shell::zsh) + ":";
      const std::vector<std::string> words = wordsOf(entry);
      if (!entry.names.empty())
        spec += "_values -s , " + entry.name + " " + joined(entry.names);
      else if (!words.empty())
        spec += "(" + joined(words) + ")";
      else if (takesFile(entry))
        spec += "_files";
    }
    const std::string repeats = entry.repeats ? "*" : "";
    text += " \\\n    '" + repeats + "--" + entry.name + spec + "'";
    if (!entry.shortName.empty())
      text += " \\\n    '" + repeats + "-" + entry.shortName + spec + "'";
  }
  text += std::string(" \\\n    '*:file:") + (takesScene(list) ? "_scenes_of_whit" : "_files") +
          "'\n}\n";
  return text;
}

std::string fishOptions(const std::string& program, const std::string& command,
                        const OptionList& list) {
  std::string begin = "complete -c " + program;
  if (!command.empty()) begin += " -n '__fish_seen_subcommand_from " + command + "'";
  std::string text = begin + " -l help -d 'the options of every day'\n" + begin +
                     " -l help-all -d 'all options'\n";
  for (const OptionList::Entry& entry : list.entries) {
    text += begin + (entry.shortName.empty() ? "" : " -s " + entry.shortName) + " -l " + entry.name;
    const std::vector<std::string> words = wordsOf(entry);
    if (!entry.placeholder.empty()) text += takesFile(entry) ? " -r" : " -x";
    if (!entry.names.empty()) text += " -a '(__fish_append , " + joined(entry.names) + ")'";
    if (!words.empty()) text += " -a '" + joined(words) + "'";
    text += " -d '" + quoted(entry.help, Shell::fish) + "'\n";
  }
  if (takesScene(list))
    text += begin + " -a '(whit scenes 2>/dev/null | string split -f1 \" \")'\n";
  return text;
}

}  // namespace

Shell shellNamed(const std::string& name) {
  Shell shell = Shell::bash;
  parseValue({.name = "completion", .words = "bash|zsh|fish"}, name, shell);
  return shell;
}

std::string completionOpening(Shell shell, const std::string& program,
                              const std::vector<CommandSummary>& commands) {
  const std::string written = program + " --completion";
  std::string names, text;
  for (const CommandSummary& c : commands) names += (names.empty() ? "" : " ") + c.name;
  switch (shell) {
    case Shell::bash:
      text = "# Written by " + written + " bash.\n" + functionName(program, "") +
             "() {\n  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} "
             "words= list=\n";
      if (!commands.empty()) {
        text += "  if ((COMP_CWORD == 1)); then\n    COMPREPLY=($(compgen -W '" + names +
                " --help --version --man --completion' -- \"$current\"))\n    return\n  fi\n";
      }
      return text + "  case ${COMP_WORDS[1]} in\n";
    case Shell::zsh:
      text = "#compdef " + program + "\n# Written by " + written +
             " zsh.\n"
             "_scenes_of_whit() {\n  compadd -- ${(f)\"$(whit scenes 2>/dev/null | cut -d' ' "
             "-f1)\"}\n  _files\n}\n";
      if (!commands.empty()) {
        const std::string function = functionName(program, "");
        text +=
            function + "() {\n  if ((CURRENT == 2)); then\n    compadd -- " + names +
            " --help --version --man --completion\n    return\n  fi\n  local command=$words[2]\n"
            "  shift words\n  ((CURRENT--))\n  if (($+functions[" +
            function + "_$command])); then " + function + "_$command; fi\n}\n";
      }
      return text;
    default:
      text = "# Written by " + written + " fish.\n";
      for (const CommandSummary& c : commands) {
        text += "complete -c " + program + " -n __fish_use_subcommand -f -a " + c.name + " -d '" +
                quoted(c.summary, Shell::fish) + "'\n";
      }
      return text;
  }
}

std::string completionOptions(Shell shell, const std::string& program, const std::string& command,
                              const OptionList& list) {
  switch (shell) {
    case Shell::bash:
      return bashOptions(command, list);
    case Shell::zsh:
      return zshOptions(program, command, list);
    default:
      return fishOptions(program, command, list);
  }
}

std::string completionClosing(Shell shell, const std::string& program) {
  const std::string function = functionName(program, "");
  switch (shell) {
    case Shell::bash:
      return "  esac\n  local done=${list:+${current%\"${current##*,}\"}}\n  COMPREPLY=($(compgen "
             "-P "
             "\"$done\" -W \"$words\" -- \"${current#\"$done\"}\"))\n}\ncomplete -o default -F " +
             function + " " + program + "\n";
    case Shell::zsh:
      return function + " \"$@\"\n";
    default:
      return "";
  }
}

}  // namespace whit::cli
