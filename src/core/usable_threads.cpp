#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "core/cgroup_quota.h"
#include "core/worker_pool.h"

namespace whit {

namespace {

int affinityThreads() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof(set), &set) == 0) return CPU_COUNT(&set);
  return static_cast<int>(std::thread::hardware_concurrency());
}

std::string readWhole(const char* file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

int usableThreads() {
  const int threads = std::max(1, affinityThreads());
  const double quota = cgroupQuota(readWhole("/proc/self/cgroup"), "/sys/fs/cgroup");
  if (quota <= 0) return threads;
  return std::clamp(static_cast<int>(std::floor(quota + 0.001)), 1, threads);
}

}  // namespace whit
