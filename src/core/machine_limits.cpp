#include "core/machine_limits.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <thread>
#include <vector>

namespace whit {

namespace fs = std::filesystem;

namespace {

constexpr double kMostMemory = 16e9;
constexpr double kNone = -1;  // what a file says that is missing, or that has another word
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr const char* kGroupsFolder = "/sys/fs/cgroup";

std::string textOf(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string membershipOfThisProcess() { return textOf("/proc/self/cgroup"); }

// Returns the folders of the groups that limit the process with this controller ("cpu").
std::vector<fs::path> groupsOf(const std::string& controller, const std::string& membership,
                               const fs::path& root) {
  std::vector<fs::path> folders{root};
  std::istringstream lines(membership);

  // A line is "NUMBER:CONTROLLERS:/PATH". Version 2 is a single hierarchy and names no controllers.
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const bool isVersionTwo = controllers == ",,";
    if (!isVersionTwo && controllers.find("," + controller + ",") == std::string::npos) continue;

    // Controllers that are mounted together ("cpu,cpuacct") have links with their single names.
    fs::path folder = isVersionTwo ? root : root / controller;
    folders.push_back(folder);
    for (const fs::path& part : fs::path(line.substr(second + 1)).relative_path()) {
      folders.push_back(folder /= part);
    }
  }

  return folders;
}

// Reads a file of one number; "max" and -1 stand for no limit there.
double numberIn(const fs::path& file) {
  double number = kNone;
  std::ifstream in(file);
  return in >> number ? number : kNone;
}

// Returns the number behind a word.
double numberBehind(const std::string& word, const std::string& text) {
  std::istringstream words(text);
  double number = 0;
  for (std::string name; words >> name;) {
    if (name == word && words >> number) return number;
  }
  return kNone;
}

// The quota of one group in processors.
double quotaOf(const fs::path& group) {
  // Version 2 has both numbers in one file, "max" for no limit.
  double quota = 0, period = 0;
  std::ifstream both(group / "cpu.max");
  if (!(both >> quota >> period)) {
    quota = numberIn(group / "cpu.cfs_quota_us");
    period = numberIn(group / "cpu.cfs_period_us");
  }
  return quota > 0 && period > 0 ? quota / period : kNoLimit;
}

// Bytes that a group has left if its files have these names.
double freeMemory(const fs::path& group, const char* limitFile, const char* usageFile,
                  const std::string& prefix) {
  const double limit = numberIn(group / limitFile);
  if (limit < 0) return kNoLimit;

  const std::string statistics = textOf(group / "memory.stat");
  double used = numberIn(group / usageFile);
  for (const char* kind : {"active_file", "inactive_file"}) {
    used -= std::max(numberBehind(prefix + kind, statistics), 0.0);
  }
  return std::max(limit - used, 0.0);
}

// A number in the environment, 0 without one.
double given(const char* name) {
  const char* const text = std::getenv(name);
  return text == nullptr ? 0 : std::atof(text);
}

// Bytes that Slurm gives its job on this machine.
double memoryOfSlurm() {
  // At most one of the two limits is set.
  const double megabytes =
      given("SLURM_MEM_PER_NODE") + given("SLURM_MEM_PER_CPU") * given("SLURM_CPUS_ON_NODE");
  return megabytes > 0 ? megabytes * (1 << 20) : kNoLimit;
}

}  // namespace

double cgroupQuota(const std::string& membership, const fs::path& root) {
  double least = kNoLimit;
  for (const fs::path& group : groupsOf("cpu", membership, root)) {
    least = std::min(least, quotaOf(group));
  }
  return least;
}

int threadsWithin(double quota, int threads) {
  // A thread beyond the quota would be stopped in the middle of a frame, and the others would wait
  // for it. A quota that rounding has left just below a whole number counts as that number.
  const double whole = std::floor(quota + 0.001);
  return static_cast<int>(std::clamp(whole, 1.0, static_cast<double>(threads)));
}

double memoryLeft(const std::string& meminfo, const std::string& membership, const fs::path& root) {
  const double kilobytes = numberBehind("MemAvailable:", meminfo);
  double least = kilobytes < 0 ? kNoLimit : 1024 * kilobytes;

  for (const fs::path& group : groupsOf("memory", membership, root)) {
    least =
        std::min({least, freeMemory(group, "memory.max", "memory.current", ""),
                  freeMemory(group, "memory.limit_in_bytes", "memory.usage_in_bytes", "total_")});
  }
  return least;
}

int otherRunnableTasks(const fs::path& loadavg) {
  // The text is "0.20 0.18 0.12 1/80 11206": three means, runnable tasks over all tasks, a process.
  int tasks = 0;
  std::sscanf(textOf(loadavg).c_str(), "%*f %*f %*f %d", &tasks);
  return std::max(tasks - 1, 0);
}

int affinityThreads() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof(set), &set) == 0) return std::max(1, CPU_COUNT(&set));

  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

int usableThreads() {
  return threadsWithin(cgroupQuota(membershipOfThisProcess(), kGroupsFolder), affinityThreads());
}

std::uint64_t defaultMaxMemory() {
  const double left = memoryLeft(textOf("/proc/meminfo"), membershipOfThisProcess(), kGroupsFolder);
  return static_cast<std::uint64_t>(std::min({kMostMemory, left, memoryOfSlurm()}));
}

}  // namespace whit
