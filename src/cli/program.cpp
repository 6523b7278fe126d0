#include "cli/program.h"

#include <cstdio>
#include <exception>
#include <new>

#include "cli/interrupt.h"
#include "core/error.h"

namespace whit::cli {

namespace {

int fail(const std::string& name, ExitStatus status, const char* what) {
  std::fprintf(stderr, "%s: %s\n", name.c_str(), what);
  return static_cast<int>(status);
}

}  // namespace

int runProgram(const std::string& name, const std::function<int()>& body) {
  installInterruptHandlers();
  try {
    const int status = body();
    if (std::fflush(stdout) != 0) return fail(name, ExitStatus::io, "cannot write the result");
    return status;
  } catch (const Error& error) {
    return fail(name, error.status(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(name, ExitStatus::limit, "out of memory");
  } catch (const std::exception& error) {
    return fail(name, ExitStatus::checkFailed, error.what());
  }
}

std::vector<std::string> wordsOf(int argc, char** argv) {
  return argc > 1 ? std::vector<std::string>(argv + 1, argv + argc) : std::vector<std::string>();
}

}  // namespace whit::cli
