#include "core/event_counters.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

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
    const auto file = static_cast<int>(
        syscall(SYS_perf_event_open, &attributes, 0, -1, -1, PERF_FLAG_FD_CLOEXEC));
    files.push_back(file < 0 ? -errno : file);
  }
  return files;
}

std::string reasonOfNoCounts(const std::vector<int>& files) {
  const auto refused = std::ranges::find_if(files, [](int file) { return file < 0; });
  if (refused == files.end()) return "other programs use the counters";

  // perf_event_open(2) documents both errors for a lack of rights.
  const bool isForbidden = *refused == -EACCES || *refused == -EPERM;
  if (isForbidden) return "the kernel forbids it (/proc/sys/kernel/perf_event_paranoid)";
  return std::string("the machine has no such counters: ") + std::strerror(-*refused);
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
