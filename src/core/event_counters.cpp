#include "core/event_counters.h"

#include <sys/syscall.h>
#include <unistd.h>

namespace whit {

std::vector<int> openCounters(std::span<const PerfEvent> events) {
  std::vector<int> files;
  for (const PerfEvent& event : events) {
    perf_event_attr attributes{};
    attributes.size = sizeof attributes;
    attributes.type = event.type;
    attributes.config = event.config;
    attributes.inherit = 1;
    attributes.exclude_kernel = 1;  // what the kernel does needs privileges
    attributes.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
    files.push_back(static_cast<int>(
        syscall(SYS_perf_event_open, &attributes, 0, -1, -1, PERF_FLAG_FD_CLOEXEC)));
  }
  return files;
}

std::vector<double> readCounters(const std::vector<int>& files) {
  std::vector<double> counts;
  for (const int file : files) {
    struct {
      std::uint64_t count, enabledTime, runningTime;
    } value{};
    const bool isWhole = read(file, &value, sizeof value) == ssize_t{sizeof value};
    if (!isWhole || value.runningTime < value.enabledTime) return {};
    counts.push_back(static_cast<double>(value.count));
  }
  return counts;
}

}  // namespace whit
