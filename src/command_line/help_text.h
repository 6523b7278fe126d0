// Texts that are made from the table of options: --help, completion in shells, and manual pages.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/option_list.h"

namespace whit::cli {

enum class HelpTier { everyday, all };

// Returns usage, summary and options, in lines of at most `width` columns unless a word is longer.
// The everyday tier has the command's own options, and of the options that all commands share only
// those of every day; it says how many are left out. The text ends with what the presets stand for.
std::string helpText(const std::string& usage, const std::string& summary, const OptionList& list,
                     HelpTier tier, int width);

// Returns the columns of the terminal on standard output, else $COLUMNS, else 80; from 40 to 120.
int helpWidth();

// Returns the script that makes bash, zsh or fish call `program --complete WORD...`. The shells ask
// the program itself, so that completion and --help cannot disagree. Throws Error(usage) for
// another shell.
std::string completionScript(const std::string& shell, const std::string& program);

// Returns the completions of the last word, which may be empty: a line for each, with its meaning
// after a tab. There are none if a file is expected.
std::string completions(const std::vector<std::string>& words, const OptionList& list);

// Returns a name and its meaning as such a line, or an empty text unless the name begins with
// `word`.
std::string completionLine(const std::string& word, const std::string& name,
                           const std::string& meaning = "");

// Manual pages in man(7).
using Terms = std::vector<std::pair<std::string, std::string>>;

struct ManPage {
  std::string name, summary, synopsis, description, seeAlso;
  Terms examples;  // command lines, and what they do
};

// Prints a page to standard output: the sections up to the options of the program itself, what
// `body` prints, and the options that all commands share, exit status and environment.
void printManual(const ManPage& page, const std::function<void()>& body);

// The part of a command: usage, summary, its own options and a reference to the shared ones.
std::string manOptions(const std::string& usage, const std::string& summary,
                       const OptionList& list);
// A section of terms and their meaning.
std::string manSection(const std::string& heading, const Terms& terms);

}  // namespace whit::cli
