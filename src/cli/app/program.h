// The frame of main(): errors become exit statuses.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace whit::cli {

// Installs the interrupt handlers and runs `body`. An Error gives its status, exhausted memory 5,
// anything else 1, each with one line "NAME: what" on standard error.
int runProgram(const std::string& name, const std::function<int()>& body);

// The exit statuses of the programs.
struct ExitMeaning {
  int status;
  const char* meaning;
};
inline constexpr ExitMeaning kExitMeanings[] = {
    {0, "done"},
    {1, "a comparison or check failed"},
    {2, "wrong usage"},
    {3, "a bad scene or image"},
    {4, "cannot read or write"},
    {5, "a limit or memory ran out"},
    {130, "interrupted"},
};

std::vector<std::string> wordsOf(int argc, char** argv);  // without the program's name

}  // namespace whit::cli
