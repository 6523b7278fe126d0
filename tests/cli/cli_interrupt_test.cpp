// Interruptions within one process: what is being written is finished first.
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdio>

#include "command_line/program.h"

namespace whit::cli {
namespace {

void interruptedWhileWriting() {
  installInterruptHandlers();
  {
    const WriteScope outer;
    raise(SIGINT);
    { const WriteScope inner; }
    std::fputs("finished the file", stderr);
  }
  std::fputs("went on", stderr);
}

void interruptedOtherwise(int signal) {
  installInterruptHandlers();
  { const WriteScope earlier; }
  raise(signal);
  std::fputs("went on", stderr);
}

TEST(InterruptDeathTest, WaitsForTheFile) {
  EXPECT_EXIT(interruptedWhileWriting(), testing::ExitedWithCode(kInterruptedStatus),
              "^finished the file$");
}

TEST(InterruptDeathTest, EndsAtOnceOtherwise) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EXIT(interruptedOtherwise(signal), testing::ExitedWithCode(kInterruptedStatus), "^$");
  }
}

}  // namespace
}  // namespace whit::cli
