// Completion of command lines: the shells' scripts ask the program itself, so that completion and
// --help cannot disagree.
#pragma once

#include <string>
#include <vector>

#include "cli/app/option_list.h"

namespace whit::cli {

// The script that makes bash, zsh or fish call `program --complete WORD...`. Throws Error(usage)
// for another shell.
std::string completionScript(const std::string& shell, const std::string& program);

// The completions of the last word, which may be empty: a line for each, with its meaning after a
// tab. There are none where a file is expected.
std::string completions(const std::vector<std::string>& words, const OptionList& list);

// A name and its meaning as such a line, if the name begins with `word`; otherwise nothing.
std::string completionLine(const std::string& word, const std::string& name,
                           const std::string& meaning = "");

}  // namespace whit::cli
