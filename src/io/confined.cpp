#include "io/confined.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <new>
#include <vector>

#include "core/error.h"

namespace whit {
namespace {

constexpr int kDone = 0, kOutOfMemory = 1, kThrew = 2;

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kArchitecture = 0;
#endif

// Bytes of address space that this process has.
std::uint64_t addressSpace() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void limit(__rlimit_resource resource, std::uint64_t soft, std::uint64_t hard) {
  const rlimit both{soft, hard};
  setrlimit(resource, &both);
}

// Ends the process at any system call but those that follow. A kernel without seccomp refuses the
// filter; the other limits then stand alone.
void filterSystemCalls() {
  constexpr std::uint32_t kAllowed[] = {__NR_brk,    __NR_mmap,    __NR_munmap,
                                        __NR_mremap, __NR_madvise, __NR_mprotect,
                                        __NR_futex,  __NR_exit,    __NR_exit_group};
  std::vector<sock_filter> filter;
  const auto load = [&](std::size_t offset) {
    filter.push_back({BPF_LD | BPF_W | BPF_ABS, 0, 0, static_cast<std::uint32_t>(offset)});
  };
  const auto end = [&](std::uint32_t how) { filter.push_back({BPF_RET | BPF_K, 0, 0, how}); };
  // Skips so many of the following instructions unless the loaded value is this one.
  const auto unless = [&](std::uint32_t value, std::uint8_t skipped) {
    filter.push_back({BPF_JMP | BPF_JEQ | BPF_K, 0, skipped, value});
  };
  constexpr std::uint8_t kRest = 2 * std::size(kAllowed) + 5;
  load(offsetof(seccomp_data, arch));
  unless(kArchitecture, kRest);
  load(offsetof(seccomp_data, nr));
  for (const std::uint32_t call : kAllowed) {
    unless(call, 1);
    end(SECCOMP_RET_ALLOW);
  }
  unless(__NR_write, 3);
  load(offsetof(seccomp_data, args));  // the low half of the first, which is all of a descriptor
  unless(STDOUT_FILENO, 1);
  end(SECCOMP_RET_ALLOW);
  end(SECCOMP_RET_KILL_PROCESS);
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  if (kArchitecture == 0 || prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return;
  prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

void writeAnswer(const void* bytes, std::size_t count) {
  const char* at = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = write(STDOUT_FILENO, at, count);
    if (written < 0 && errno != EINTR) _exit(kThrew);
    if (written <= 0) continue;
    at += written;
    count -= static_cast<std::size_t>(written);
  }
}

[[noreturn]] void beChild(const std::function<void(const ConfinedWriter&)>& work, int out,
                          std::uint64_t mostAddresses, int seconds) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  dup2(out, STDOUT_FILENO);
  syscall(__NR_close_range, STDERR_FILENO, ~0u, 0);
  close(STDIN_FILENO);
  for (const int fault : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT}) signal(fault, SIG_DFL);
  const auto time = static_cast<std::uint64_t>(seconds);
  limit(RLIMIT_AS, mostAddresses, mostAddresses);
  limit(RLIMIT_CPU, time, time + 1);
  for (const auto resource : {RLIMIT_CORE, RLIMIT_FSIZE, RLIMIT_NPROC}) limit(resource, 0, 0);
  try {
    const ConfinedWriter writer = writeAnswer;
    filterSystemCalls();
    work(writer);
  } catch (const std::bad_alloc&) {
    _exit(kOutOfMemory);
  } catch (...) {
    _exit(kThrew);
  }
  _exit(kDone);
}

std::string failureOfChild(int status) {
  if (WIFEXITED(status)) {
    const int code = WEXITSTATUS(status);
    return code == kDone ? "" : code == kOutOfMemory ? "it needs more memory" : "it gave up";
  }
  const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (number == SIGSYS) return "it called the system";
  if (number == SIGXCPU) return "it took too long";
  return "it crashed (signal " + std::to_string(number) + ")";
}

}  // namespace

ConfinedAnswer runConfined(const std::function<void(const ConfinedWriter&)>& work,
                           std::uint64_t mostBytes, int seconds) {
  using Clock = std::chrono::steady_clock;
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throwLimit(std::string("cannot make a pipe: ") + std::strerror(errno));
  }
  const std::uint64_t mostAddresses = addressSpace() + mostBytes;
  const pid_t child = fork();
  if (child == 0) beChild(work, ends[1], mostAddresses, seconds);
  close(ends[1]);
  if (child < 0) {
    close(ends[0]);
    throwLimit(std::string("cannot start a process: ") + std::strerror(errno));
  }
  ConfinedAnswer answer;
  const auto end = Clock::now() + std::chrono::seconds(seconds);
  std::vector<char> chunk(std::size_t{1} << 16);
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    pollfd ready{ends[0], POLLIN, 0};
    const int found = left.count() > 0 ? poll(&ready, 1, static_cast<int>(left.count())) : 0;
    if (found < 0 && errno == EINTR) continue;
    if (found <= 0) {
      answer.failure = "it took too long";
      break;
    }
    const ssize_t count = read(ends[0], chunk.data(), chunk.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    if (static_cast<std::size_t>(count) > mostBytes - answer.bytes.size()) {
      answer.failure = "its answer is too long";
      break;
    }
    answer.bytes.append(chunk.data(), static_cast<std::size_t>(count));
  }
  close(ends[0]);
  if (!answer.failure.empty()) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (answer.failure.empty()) answer.failure = failureOfChild(status);
  return answer;
}

}  // namespace whit
