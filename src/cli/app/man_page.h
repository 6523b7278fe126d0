// Manual pages in man(7), made of what --help is made of, so that the two cannot disagree. A page
// is its opening, an options part for each command, and its closing.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/app/option_list.h"

namespace whit::cli {

struct ManPage {
  std::string name, summary, synopsis, description, seeAlso;
};

// Heading to description.
std::string manOpening(const ManPage& page);
// Usage, summary and options; of the options of listCommonOptions no more than the name of their
// section. What parseOptions prints for the word --man.
std::string manOptions(const std::string& usage, const std::string& summary,
                       const OptionList& list);
// A section of things and what they mean.
std::string manTerms(const std::string& heading,
                     const std::vector<std::pair<std::string, std::string>>& terms);
// The options of listCommonOptions, exit status, environment.
std::string manClosing(const ManPage& page);

}  // namespace whit::cli
