// Texts that are made from the table of options: --help, completion in shells, and manual pages.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/option_list.h"

namespace whit::cli {

enum class HelpTier { everyday, all };

// Usage, summary and options, lines of `width` columns at most where a word is not longer. The
// everyday tier has the command's own options, and of those that all commands share the ones that
// are wanted every day; it says how many are left out. Ends with what the presets stand for.
std::string helpText(const std::string& usage, const std::string& summary, const OptionList& list,
                     HelpTier tier, int width);

// The columns of the terminal that standard output is, else $COLUMNS, else 80; from 40 to 120.
int helpWidth();

// The shells' scripts ask the program itself, so that completion and --help cannot disagree.
// The script that makes bash, zsh or fish call `program --complete WORD...`. Throws Error(usage)
// for another shell.
std::string completionScript(const std::string& shell, const std::string& program);

// The completions of the last word, which may be empty: a line for each, with its meaning after a
// tab. There are none where a file is expected.
std::string completions(const std::vector<std::string>& words, const OptionList& list);

// A name and its meaning as such a line, if the name begins with `word`; otherwise nothing.
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
