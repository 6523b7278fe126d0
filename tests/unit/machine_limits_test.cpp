// Quotas and memory of control groups, read from folders that look like the kernel's.
#include "core/machine_limits.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <cmath>
#include <fstream>

#include "temporary_folder.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

constexpr double kNoLimit = INFINITY;

class ControlGroups : public testing::Test {
 protected:
  void put(const std::string& file, const std::string& text) {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text << '\n';
  }

  double quota(const char* membership = "0::/\n") const { return cgroupQuota(membership, root_); }
  double left(const char* membership, const char* machine = "") const {
    return memoryLeft(machine, membership, root_);
  }

  const TemporaryFolder folder_;
  const fs::path root_ = folder_.path();
};

using CgroupQuota = ControlGroups;
using MemoryLeft = ControlGroups;

TEST_F(CgroupQuota, VersionTwo) {
  EXPECT_EQ(quota(), kNoLimit);
  put("cpu.max", "max 100000");
  EXPECT_EQ(quota(), kNoLimit);
  put("cpu.max", "150000 100000");
  EXPECT_EQ(quota(), 1.5);
}

TEST_F(CgroupQuota, TheLeastOfAllAboveCounts) {
  put("a.slice/b.service/cpu.max", "400000 100000");
  put("a.slice/cpu.max", "200000 100000");
  put("cpu.max", "max 100000");
  EXPECT_EQ(quota("0::/a.slice/b.service\n"), 2);
  EXPECT_EQ(quota(), kNoLimit);

  put("a.slice/b.service/cpu.max", "50000 100000");
  EXPECT_EQ(quota("0::/a.slice/b.service\n"), 0.5);
}

// The membership names groups of the host, which a container does not see.
TEST_F(CgroupQuota, InAContainerTheRootCounts) {
  put("cpu.max", "250000 100000");
  EXPECT_EQ(quota("0::/docker/0123abcd\n"), 2.5);
}

TEST_F(CgroupQuota, NonsenseIsNoLimit) {
  put("cpu.max", "many things");
  for (const char* membership : {"", "::", "0:\n", "no colons", "0::/../../..\n"}) {
    EXPECT_EQ(cgroupQuota(membership, root_ / "deep/er/than/that"), kNoLimit) << membership;
  }

  EXPECT_EQ(quota(), kNoLimit);
  put("cpu.max", "100000 0");
  EXPECT_EQ(quota(), kNoLimit);
}

// The kernel names the controllers in the membership and in the names of the folders; -1 stands for
// no limit.
TEST_F(CgroupQuota, VersionOne) {
  const char* membership = "5:memory:/box\n3:cpuacct:/\n2:cpu:/box/inner\n1:name=systemd:/\n0::/\n";
  EXPECT_EQ(quota(membership), kNoLimit);
  put("cpu/box/cpu.cfs_quota_us", "150000");
  put("cpu/box/cpu.cfs_period_us", "100000");
  EXPECT_EQ(quota(membership), 1.5);

  put("cpu/box/inner/cpu.cfs_quota_us", "25000");
  put("cpu/box/inner/cpu.cfs_period_us", "50000");
  EXPECT_EQ(quota(membership), 0.5);
  put("cpu/box/inner/cpu.cfs_quota_us", "-1");
  EXPECT_EQ(quota(membership), 1.5);

  EXPECT_EQ(quota("2:cpuset:/box\n"), kNoLimit) << "the controller has another name";
}

TEST_F(CgroupQuota, VersionOneWithControllersThatAreMountedTogether) {
  fs::create_directory(root_ / "cpu,cpuacct");
  fs::create_directory_symlink("cpu,cpuacct", root_ / "cpu");
  put("cpu,cpuacct/docker/cpu.cfs_quota_us", "300000");
  put("cpu,cpuacct/docker/cpu.cfs_period_us", "100000");
  EXPECT_EQ(quota("4:cpu,cpuacct:/docker\n"), 3);
  EXPECT_EQ(quota("4:cpuacct,cpu:/docker\n"), 3);

  // A container sees its own group as the root of the mount.
  put("cpu/cpu.cfs_quota_us", "200000");
  put("cpu/cpu.cfs_period_us", "100000");
  EXPECT_EQ(quota("4:cpu,cpuacct:/docker/0123\n"), 2);
}

TEST(ThreadsWithin, AQuotaPaysForWholeThreads) {
  for (const auto& [quota, threads] :
       {std::pair{kNoLimit, 8}, {0.25, 1}, {1.5, 1}, {2, 2}, {2.9995, 3}, {100, 8}, {1e300, 8}}) {
    EXPECT_EQ(threadsWithin(quota, 8), threads) << quota;
  }
}

TEST_F(MemoryLeft, OfTheMachine) {
  EXPECT_EQ(left("", "MemTotal:  99 kB\nMemAvailable:   2000 kB\nMemFree: 5 kB\n"), 2000 * 1024);
  EXPECT_EQ(left("", "MemTotal:  99 kB\n"), kNoLimit) << "an old kernel";
  EXPECT_EQ(left("", "MemAvailable: lots\n"), kNoLimit);
}

TEST_F(MemoryLeft, OfVersionTwoWithTheCacheOfFiles) {
  const char* membership = "0::/box/inner\n";
  put("box/memory.max", "1000000");
  put("box/memory.current", "700000");
  EXPECT_EQ(left(membership), 300000);
  put("box/memory.stat", "anon 400000\ninactive_file 200000\nactive_file 50000\nslab 1");
  EXPECT_EQ(left(membership), 550000);

  // The smallest of all groups and of the machine counts.
  put("box/inner/memory.max", "max");
  put("box/inner/memory.current", "600000");
  EXPECT_EQ(left(membership), 550000);
  put("box/inner/memory.max", "610000");
  EXPECT_EQ(left(membership), 10000);
  EXPECT_EQ(left(membership, "MemAvailable: 9 kB\n"), 9 * 1024);

  put("box/inner/memory.max", "500000");
  EXPECT_EQ(left(membership), 0) << "more is in use than allowed";
}

// Without a limit the file has the largest number of pages. The statistics of a group have rows for
// the group alone and for all groups in it.
TEST_F(MemoryLeft, OfVersionOne) {
  const char* membership = "4:memory:/box\n0::/\n";
  put("memory/memory.limit_in_bytes", "9223372036854771712");
  put("memory/memory.usage_in_bytes", "1000");
  EXPECT_GT(left(membership), 4e18);

  put("memory/box/memory.limit_in_bytes", "5000000");
  put("memory/box/memory.usage_in_bytes", "4000000");
  put("memory/box/memory.stat", "inactive_file 7\ntotal_inactive_file 300000\ntotal_active_file 1");
  EXPECT_EQ(left(membership), 1300001);
}

TEST(DefaultMaxMemory, IsAtMost16Gigabytes) {
  EXPECT_GT(defaultMaxMemory(), 0u);
  EXPECT_LE(defaultMaxMemory(), 16'000'000'000u);
}

// Slurm gives its limits in megabytes (2^20 bytes), by the machine or by the processor.
TEST(DefaultMaxMemory, IsAtMostWhatSlurmGives) {
  setenv("SLURM_MEM_PER_NODE", "3", 1);
  EXPECT_EQ(defaultMaxMemory(), 3u << 20);
  unsetenv("SLURM_MEM_PER_NODE");

  setenv("SLURM_MEM_PER_CPU", "2", 1);
  setenv("SLURM_CPUS_ON_NODE", "4", 1);
  EXPECT_EQ(defaultMaxMemory(), 8u << 20);
  unsetenv("SLURM_MEM_PER_CPU");
  EXPECT_GT(defaultMaxMemory(), 8u << 20) << "no limit was given";
  unsetenv("SLURM_CPUS_ON_NODE");
}

using RunnableTasks = ControlGroups;

TEST_F(RunnableTasks, AreReadFromTheLoadWithoutThisOne) {
  put("loadavg", "20.35 21.12 17.76 21/198 19482");
  EXPECT_EQ(otherRunnableTasks(root_ / "loadavg"), 20);
  put("loadavg", "0.1 0.1 0.1 lots");
  EXPECT_EQ(otherRunnableTasks(root_ / "loadavg"), 0);
  EXPECT_EQ(otherRunnableTasks(root_ / "none"), 0);
}

// Limits.WorkersAreNoMoreThanTheProcessMayUse allows a process fewer processors.
TEST(UsableThreads, AreNoMoreThanTheAffinityAllows) {
  cpu_set_t allowed;
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  EXPECT_EQ(affinityThreads(), CPU_COUNT(&allowed));
  EXPECT_GE(usableThreads(), 1);
  EXPECT_LE(usableThreads(), CPU_COUNT(&allowed));
}

}  // namespace
}  // namespace whit
