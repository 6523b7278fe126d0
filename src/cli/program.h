// What the programs have in common: errors become exit statuses.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace whit::cli {

// Installs the interrupt handlers and runs `body`. An Error gives its status, exhausted memory 5,
// anything else 1, each with one line "NAME: what" on standard error.
int runProgram(const std::string& name, const std::function<int()>& body);

std::vector<std::string> wordsOf(int argc, char** argv);  // without the program's name

}  // namespace whit::cli
