#include "cli/app/program.h"

#include <signal.h>

#include <cstdio>
#include <exception>

#include "cli/app/interrupt.h"
#include "core/error.h"
#include "core/printable.h"

namespace whit::cli {

namespace {

int fail(const std::string& name, ExitStatus status, const std::string& what) {
  std::fprintf(stderr, "%s: %s\n", name.c_str(), printable(what).c_str());
  return static_cast<int>(status);
}

}  // namespace

int runProgram(const std::string& name, const std::function<int()>& body) {
  installInterruptHandlers();
  signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit is then an error of the write
  try {
    const int status = body();
    // The flag tells of earlier writes, which did not fit into the buffer.
    const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    if (lost) return fail(name, ExitStatus::io, "cannot write the result");
    return status;
  } catch (const std::exception& error) {
    const Failure failure = failureOf(error);
    return fail(name, failure.status, failure.what);
  }
}

std::vector<std::string> wordsOf(int argc, char** argv) {
  return argc > 1 ? std::vector<std::string>(argv + 1, argv + argc) : std::vector<std::string>();
}

}  // namespace whit::cli
