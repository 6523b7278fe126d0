// How many threads this process may use at once.
#pragma once

#include <filesystem>
#include <string>

namespace whit {

// Its affinity mask, bounded by the CPU quota of its control groups.
int usableThreads();
// The affinity mask alone; at least 1.
int affinityThreads();

// The processor time that the control groups of a process grant it, in processors: the least that
// any group above grants as well; 0 where none sets a limit. `membership` is the text of
// /proc/PID/cgroup, `root` where the hierarchy of version 2 is mounted (/sys/fs/cgroup; Linux
// kernel, admin-guide/cgroup-v2.rst). In a container the groups may be mounted under other names
// than the membership says; the root's own limit counts always.
double cgroupQuota(const std::string& membership, const std::filesystem::path& root);

}  // namespace whit
