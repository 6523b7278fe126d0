// Counters of the kernel's events, by events that every machine counts.
#include "core/event_counters.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <thread>

#include "core/index.h"

namespace whit {
namespace {

using Counts = std::vector<std::uint64_t>;

constexpr PerfEvent kPageFaults{"faults", PERF_TYPE_SOFTWARE, PERF_COUNT_SW_PAGE_FAULTS};
constexpr std::size_t kPage = 4096;

// Each page of fresh memory faults when it is written for the first time.
void touchPages(std::size_t pages) {
  void* const memory =
      mmap(nullptr, pages * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  madvise(memory, pages * kPage, MADV_NOHUGEPAGE);
  for (const auto i : indices(pages)) static_cast<volatile char*>(memory)[i * kPage] = 1;
  munmap(memory, pages * kPage);
}

TEST(EventCounters, CountWhatLaterThreadsDo) {
  const std::vector<int> counters = openCounters(std::span(&kPageFaults, 1));
  const std::vector<double> before = readCounters(counters);
  if (before.empty()) GTEST_SKIP() << "this kernel lets nobody count";

  constexpr std::size_t kPages = 1000, kOthers = 500;  // of the thread, and of starting it
  std::thread(touchPages, kPages).join();

  const std::vector<double> after = readCounters(counters);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_GE(after[0] - before[0], kPages);
  EXPECT_LE(after[0] - before[0], kPages + kOthers);
}

TEST(EventCounters, AreEmptyWhereThereAreNone) {
  constexpr PerfEvent kUnknown{"unknown", PERF_TYPE_SOFTWARE, 1u << 20};
  const std::array events{kPageFaults, kUnknown};
  const std::vector<int> files = openCounters(events);
  EXPECT_TRUE(readCounters(files).empty());

  ASSERT_LT(files[1], 0);
  EXPECT_NE(reasonOfNoCounts(files), reasonOfNoCounts({})) << "the kernel's error is kept";
}

TEST(EventCounters, SayWhyTheyDoNotCount) {
  EXPECT_EQ(reasonOfNoCounts({5, -EACCES}),
            "the kernel forbids it (/proc/sys/kernel/perf_event_paranoid)");
  EXPECT_EQ(reasonOfNoCounts({5, -EPERM}), reasonOfNoCounts({-EACCES}));
  EXPECT_EQ(reasonOfNoCounts({-ENODEV}), "the machine has no such counters: No such device");
  EXPECT_EQ(reasonOfNoCounts({5, 6}), "other programs use the counters");
}

// A pipe that holds these numbers in place of a counter, and ends after them.
int counterOf(const Counts& numbers) {
  int ends[2] = {-1, -1};
  EXPECT_EQ(pipe(ends), 0);
  const std::size_t size = numbers.size() * sizeof(std::uint64_t);
  EXPECT_EQ(write(ends[1], numbers.data(), size), static_cast<ssize_t>(size));
  close(ends[1]);
  return ends[0];
}

// Reads a counter that has counted 7 events all the time, and another one.
std::vector<double> readBesideSeven(const Counts& other) {
  const std::vector<int> files{counterOf({7, 1000, 1000}), counterOf(other)};
  const std::vector<double> read = readCounters(files);
  for (const int file : files) close(file);
  return read;
}

// perf_event_open(2): the count, then the time enabled, then the time running.
TEST(EventCounters, ReadWhatTheKernelWrites) {
  EXPECT_EQ(readBesideSeven({1u << 20, 5, 5}), (std::vector<double>{7, 1 << 20}));
}

// An event that shared the processor's counters with others was not counted all the time, and a
// counter in error state is at its end.
TEST(EventCounters, AreEmptyWhereOneDidNotCount) {
  for (const Counts& second : {Counts{7, 1000, 999}, {7, 1000}, {}}) {
    EXPECT_TRUE(readBesideSeven(second).empty()) << second.size();
  }
}

}  // namespace
}  // namespace whit
