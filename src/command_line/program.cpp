#include "command_line/program.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstring>
#include <exception>

#include "core/error.h"
#include "core/text.h"

namespace whit::cli {

namespace {

std::atomic<int> writers{0};
std::atomic<bool> interrupted{false};
std::atomic<int> child{0};  // 0: none
std::atomic<bool> hasFile{false};
char childsFile[4096];
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free,
              "they are used by a signal handler");

// Ends the program. The main thread opens WriteScopes and is also the one that the kernel prefers
// for signals to the process, so no scope can be opened between the test and the exit. Outside a
// scope no temporary file exists, and a long render is not waited for. Other threads may close a
// scope: either they see that there was an interruption, or the handler sees that the scope is
// closed.
[[noreturn]] void end() {
  if (child != 0) kill(child, SIGKILL);
  if (hasFile) unlink(childsFile);
  _exit(kInterruptedStatus);
}

extern "C" void onInterrupt(int) {
  interrupted = true;
  if (writers == 0) end();
}

// Opens the standard streams that are closed. Otherwise a file or a pipe would take their numbers,
// and ffmpeg would be given it in their place.
void openStandardStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // The null device is opened for reading alone, so that it refuses results as a closed stream
    // does.
    if (fcntl(stream, F_GETFD) < 0) open("/dev/null", O_RDONLY);
  }
}

int fail(const std::string& name, ExitStatus status, const std::string& what) {
  std::fprintf(stderr, "%s: %s\n", name.c_str(), printable(what).c_str());
  return static_cast<int>(status);
}

}  // namespace

void installInterruptHandlers() {
  struct sigaction action {};
  action.sa_handler = onInterrupt;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);

  // A program that nohup has started goes on when its terminal ends.
  struct sigaction inherited {};
  sigaction(SIGHUP, nullptr, &inherited);
  if (inherited.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

int runProgram(const std::string& name, const std::function<int()>& body) {
  openStandardStreams();
  installInterruptHandlers();
  signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit is then an error of the write

  try {
    const int status = body();
    // ferror() tells of earlier writes that failed, when the buffer was full.
    const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    if (lost) return fail(name, ExitStatus::io, "cannot write the result to standard output");
    return status;
  } catch (const std::exception& error) {
    const Failure failure = failureOf(error);
    return fail(name, failure.status, failure.what);
  }
}

std::vector<std::string> wordsOf(int argc, char** argv) {
  return argc > 1 ? std::vector<std::string>(argv + 1, argv + argc) : std::vector<std::string>();
}

WriteScope::WriteScope() { ++writers; }

WriteScope::~WriteScope() {
  if (--writers == 0 && interrupted) end();
}

ChildScope::ChildScope(const std::string& file) {
  if (file.size() >= sizeof childsFile)
    throwIo("cannot write '" + file + "': its name is too long");

  std::memcpy(childsFile, file.c_str(), file.size() + 1);
  hasFile = true;
}

ChildScope::~ChildScope() { hasFile = false; }

void ChildScope::begun(int process) { child = process; }
void ChildScope::ended() { child = 0; }

}  // namespace whit::cli
