#include "core/usable_threads.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>

namespace whit {

namespace fs = std::filesystem;

namespace {

// The quota of one group in processors; 0 for no limit.
double quotaOfGroup(const fs::path& group) {
  double period = 0;
  std::string quota;
  std::ifstream v2(group / "cpu.max");
  if (!(v2 >> quota >> period)) {
    std::ifstream v1Quota(group / "cpu.cfs_quota_us"), v1Period(group / "cpu.cfs_period_us");
    if (!(v1Quota >> quota) || !(v1Period >> period)) return 0;
  }
  const double granted = std::strtod(quota.c_str(), nullptr);  // 0 for "max", -1 for none
  return granted > 0 && period > 0 ? granted / period : 0;
}

// The least of a group and all above it, up to the mount point.
double quotaUpTo(const fs::path& mount, const fs::path& group) {
  double least = quotaOfGroup(mount);
  fs::path at = mount;
  for (const fs::path& part : group.relative_path()) {
    at /= part;
    const double quota = quotaOfGroup(at);
    if (quota > 0 && (least == 0 || quota < least)) least = quota;
  }
  return least;
}

std::string readWhole(const char* file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

double cgroupQuota(const std::string& membership, const fs::path& root) {
  std::istringstream lines(membership);
  fs::path v2Group, v1Group;
  for (std::string line; std::getline(lines, line);) {  // "4:cpu,cpuacct:/group", "0::/group"
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (controllers.empty()) v2Group = line.substr(second + 1);
    const bool cpu = ("," + controllers + ",").find(",cpu,") != std::string::npos;
    if (cpu) v1Group = line.substr(second + 1);
  }
  const double v2 = quotaUpTo(root, v2Group);
  return v2 > 0 ? v2 : quotaUpTo(root / "cpu", v1Group);
}

int affinityThreads() {
  cpu_set_t set;
  CPU_ZERO(&set);
  const bool known = sched_getaffinity(0, sizeof(set), &set) == 0;
  return std::max(1,
                  known ? CPU_COUNT(&set) : static_cast<int>(std::thread::hardware_concurrency()));
}

int usableThreads() {
  const int threads = affinityThreads();
  const double quota = cgroupQuota(readWhole("/proc/self/cgroup"), "/sys/fs/cgroup");
  if (quota <= 0) return threads;
  return std::clamp(static_cast<int>(std::floor(quota + 0.001)), 1, threads);
}

}  // namespace whit
