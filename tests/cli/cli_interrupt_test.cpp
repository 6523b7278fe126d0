// Interruptions within one process: what is being written is finished first.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

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

void interruptedOtherwise(int number) {
  signal(number, SIG_DFL);  // the tests may have been started by nohup
  installInterruptHandlers();
  { const WriteScope earlier; }
  raise(number);
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

TEST(InterruptDeathTest, WhatNohupStartsOutlivesItsTerminal) {
  const auto startedByNohup = [] {
    signal(SIGHUP, SIG_IGN);
    installInterruptHandlers();
    raise(SIGHUP);
    std::fputs("went on", stderr);
    _exit(0);
  };
  EXPECT_EXIT(startedByNohup(), testing::ExitedWithCode(0), "^went on$");
}

}  // namespace
}  // namespace whit::cli
