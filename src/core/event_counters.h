// Counters of the kernel's performance events, summed over the threads of a program.
#pragma once

#include <linux/perf_event.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace whit {

// `type` and `config` are those of perf_event_open(2).
struct PerfEvent {
  std::string_view name;
  std::uint32_t type = 0;
  std::uint64_t config = 0;
};
inline constexpr std::array<PerfEvent, 3> kProcessorEvents{
    {{"instructions", PERF_TYPE_HARDWARE, PERF_COUNT_HW_INSTRUCTIONS},
     {"cycles", PERF_TYPE_HARDWARE, PERF_COUNT_HW_CPU_CYCLES},
     {"cache_misses", PERF_TYPE_HARDWARE, PERF_COUNT_HW_CACHE_MISSES}}};

// Returns the files of counters that count in user space, from now on and for as long as the
// program runs, for the calling thread and all threads that it starts later. A counter that the
// kernel refuses is the negative number of the error in place of a file.
std::vector<int> openCounters(std::span<const PerfEvent> events);
// Says why the counters have no counts.
std::string reasonOfNoCounts(const std::vector<int>& files);
// Returns the counts up to now, one for each file. Empty if the kernel or the machine does not
// count all of the events all the time.
std::vector<double> readCounters(const std::vector<int>& files);

// Counters of kProcessorEvents that begin with the first call.
inline const std::vector<int>& processorCounters() {
  static const std::vector<int> files = openCounters(kProcessorEvents);
  return files;
}

}  // namespace whit
