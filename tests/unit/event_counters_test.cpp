// Counters of the kernel's events, by events that every machine counts.
#include "core/event_counters.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <thread>

namespace whit {
namespace {

constexpr PerfEvent kPageFaults{"faults", PERF_TYPE_SOFTWARE, PERF_COUNT_SW_PAGE_FAULTS};
constexpr std::size_t kPage = 4096;

// Each page of fresh memory faults when it is written for the first time.
void touchPages(std::size_t pages) {
  void* const memory =
      mmap(nullptr, pages * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  madvise(memory, pages * kPage, MADV_NOHUGEPAGE);
  for (std::size_t i = 0; i < pages; ++i) static_cast<volatile char*>(memory)[i * kPage] = 1;
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
  EXPECT_TRUE(readCounters(openCounters(events)).empty());
}

}  // namespace
}  // namespace whit
