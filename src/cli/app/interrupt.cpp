#include "cli/app/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstring>

#include "core/error.h"

namespace whit::cli {

namespace {

std::atomic<int> writers{0};
std::atomic<bool> interrupted{false};
std::atomic<int> child{0};  // 0: none
std::atomic<bool> hasFile{false};
char childsFile[4096];
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free,
              "they are used by a signal handler");

// The main thread opens WriteScopes and is also the one that the kernel prefers for signals to the
// process, so that nothing can slip in between the test and the exit. Outside a scope no temporary
// file exists, and a long render is not waited for. Other threads may close a scope: either they
// see that there was an interruption, or it sees that the scope is closed.
[[noreturn]] void end() {
  if (child != 0) kill(child, SIGKILL);
  if (hasFile) unlink(childsFile);
  _exit(kInterruptedStatus);
}

extern "C" void onInterrupt(int) {
  interrupted = true;
  if (writers == 0) end();
}

}  // namespace

void installInterruptHandlers() {
  struct sigaction action {};
  action.sa_handler = onInterrupt;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
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
