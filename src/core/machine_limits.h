// Functions that return how many processors and how much memory this process may use, which its
// control groups may bound below what the machine has.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace whit {

// The number of threads that the affinity mask and the CPU quota of the control groups allow.
int usableThreads();
// The affinity mask alone; at least 1.
int affinityThreads();

// The limit of memory for a scene where the user sets none: what memoryLeft() finds for this
// process, at most 16 * 10^9 bytes, and at most what Slurm gives the job; clusters may not enforce
// that by control groups.
std::uint64_t defaultMaxMemory();

// The number of tasks on the machine, besides the calling thread, that want a processor right now;
// 0 if it is unknown.
int otherRunnableTasks(const std::filesystem::path& loadavg = "/proc/loadavg");

// The functions below read what the kernel says from their arguments. `membership` is the text of
// /proc/PID/cgroup, and `root` the folder where control groups are mounted (/sys/fs/cgroup):
// version 2 at the folder itself, each controller of version 1 in a folder of its own (Linux
// kernel, admin-guide/cgroup-v2.rst and cgroup-v1). A limit of a group holds for all groups in it,
// so the smallest one counts. In a container the groups may be mounted under other names than the
// membership says; the limits of the mounted folder always count.

// The processor time that the control groups grant, in processors; infinite without a limit.
double cgroupQuota(const std::string& membership, const std::filesystem::path& root);

// The number of whole threads that a quota pays for, from 1 to `threads`.
int threadsWithin(double quota, int threads);

// Bytes of memory that the machine, by the text of /proc/meminfo, and each control group have left;
// the cache of files counts as free, because the kernel gives it back. Infinite without a limit.
double memoryLeft(const std::string& meminfo, const std::string& membership,
                  const std::filesystem::path& root);

}  // namespace whit
