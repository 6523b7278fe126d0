// Files that are written beside other work: they are written in order and one at a time, errors
// reach the caller, and an interruption waits for the current file.
#include "output/background_writer.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "command_line/program.h"

namespace whit::cli {
namespace {

TEST(BackgroundWriter, WritesOneAfterTheOther) {
  std::string done;
  // The jobs count how many of them run at the same time.
  std::atomic<int> atOnce{0}, most{0};
  BackgroundWriter writer;
  for (const char* name : {"a", "b", "c", "d"}) {
    writer.start([&, name] {
      most = std::max(most.load(), ++atOnce);
      usleep(2000);
      done += name;
      --atOnce;
    });
  }

  writer.finish();
  EXPECT_EQ(done, "abcd");
  EXPECT_EQ(most, 1);
  ASSERT_EQ(writer.times().size(), 4u);
  for (const BackgroundWriter::Times& times : writer.times()) EXPECT_GE(times.spentMs, 2);
}

TEST(BackgroundWriter, ReturnsWhileItWrites) {
  std::atomic<bool> goOn{false}, written{false};
  BackgroundWriter writer;
  writer.start([&] {
    goOn.wait(false);
    written = true;
  });

  // The job has not ended, so start() did not wait for it.
  EXPECT_FALSE(written);
  goOn = true;
  goOn.notify_one();
  writer.finish();
  EXPECT_TRUE(written);
}

TEST(BackgroundWriter, WhatAJobThrowsReachesTheNextStartWhichStartsNothing) {
  BackgroundWriter writer;
  bool next = false;
  writer.start([] { throw std::runtime_error("no space"); });
  EXPECT_THROW(writer.start([&] { next = true; }), std::runtime_error);
  writer.finish();
  EXPECT_FALSE(next);

  writer.start([] { throw std::runtime_error("no space"); });
  EXPECT_THROW(writer.finish(), std::runtime_error);
}

void interruptedBesideTheJob() {
  installInterruptHandlers();
  BackgroundWriter writer;
  std::atomic<bool> goOn{false};
  writer.start([&] {
    goOn.wait(false);
    std::fputs("finished the file", stderr);
  });

  raise(SIGINT);
  goOn = true;
  goOn.notify_one();
  // The interruption ends the program here, before another file is begun.
  writer.start([] { std::fputs("began another", stderr); });
  std::fputs("went on", stderr);
}

TEST(BackgroundWriterDeathTest, AnInterruptionWaitsForTheFileAndForNoOther) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(interruptedBesideTheJob(), testing::ExitedWithCode(kInterruptedStatus),
              "^finished the file$");
}

}  // namespace
}  // namespace whit::cli
