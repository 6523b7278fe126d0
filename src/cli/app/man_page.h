// Manual pages in man(7), written from what --help is written from.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "cli/app/option_list.h"

namespace whit::cli {

using Terms = std::vector<std::pair<std::string, std::string>>;

struct ManPage {
  std::string name, summary, synopsis, description, seeAlso;
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
