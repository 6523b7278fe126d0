// Every main() runs its work through this file: errors become exit statuses, and an interruption
// (Control-C, SIGTERM) ends the program at once with status 130 and leaves no half-written file.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace whit::cli {

// Call from the main thread before any other thread is started.
void installInterruptHandlers();

// Opens standard streams that are closed, installs the interrupt handlers and runs `body`. An Error
// gives its status, exhausted memory 5, anything else 1, each with one line "NAME: what" on
// standard error.
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

inline constexpr int kInterruptedStatus = 130;

// While a WriteScope is alive, files are being written and an interruption waits; the destructor of
// the last one carries it out. Create it on the main thread; any thread may destroy it.
class WriteScope {
 public:
  WriteScope();
  ~WriteScope();
  WriteScope(const WriteScope&) = delete;
  WriteScope& operator=(const WriteScope&) = delete;
};

// While a ChildScope is alive, an interruption also removes the file and kills the process that
// writes it. There is at most one at a time.
class ChildScope {
 public:
  explicit ChildScope(const std::string& file);
  ~ChildScope();
  static void begun(int process);
  static void ended();
  ChildScope(const ChildScope&) = delete;
  ChildScope& operator=(const ChildScope&) = delete;
};

}  // namespace whit::cli
