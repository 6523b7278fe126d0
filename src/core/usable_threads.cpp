#include "core/usable_threads.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>

namespace whit {

namespace fs = std::filesystem;

namespace {

// The quota of one group in processors; 0 for no limit.
double quotaOfGroup(const fs::path& group) {
  double period = 0;
  std::string quota;
  std::ifstream in(group / "cpu.max");
  if (!(in >> quota >> period)) return 0;
  const double granted = std::strtod(quota.c_str(), nullptr);  // 0 for "max"
  return granted > 0 && period > 0 ? granted / period : 0;
}

}  // namespace

double cgroupQuota(const std::string& membership, const fs::path& root) {
  constexpr std::string_view kVersionTwo = "0::";
  std::istringstream lines(membership);
  fs::path group;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(kVersionTwo)) group = line.substr(kVersionTwo.size());
  }
  double least = quotaOfGroup(root);
  fs::path at = root;
  for (const fs::path& part : group.relative_path()) {
    at /= part;
    const double quota = quotaOfGroup(at);
    if (quota > 0 && (least == 0 || quota < least)) least = quota;
  }
  return least;
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
  std::ifstream in("/proc/self/cgroup");
  const std::string membership{std::istreambuf_iterator<char>(in), {}};
  const double quota = cgroupQuota(membership, "/sys/fs/cgroup");
  if (quota <= 0) return threads;
  return std::clamp(static_cast<int>(std::floor(quota + 0.001)), 1, threads);
}

}  // namespace whit
