#include "io/confined.h"

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>

#include "core/error.h"
#include "core/text.h"

namespace whit {
namespace {

// Exit codes of the child and what they mean.
enum Exit { kDone, kOutOfMemory, kTooLong, kThrew };
constexpr const char* kFailures[] = {"", "it needs more memory", "its answer is too long",
                                     "it gave up"};

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kArchitecture = 0;
#endif

// Returns the bytes of address space that this process has.
std::uint64_t addressSpace() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * sysconf(_SC_PAGESIZE);
}

// Returns the bytes of address space that this process may still take (ulimit -v).
std::uint64_t addressesLeft() {
  rlimit limits{};
  const bool isLimited = getrlimit(RLIMIT_AS, &limits) == 0 && limits.rlim_cur != RLIM_INFINITY;
  const std::uint64_t own = addressSpace();
  if (!isLimited) return ~std::uint64_t{0};
  return limits.rlim_cur > own ? limits.rlim_cur - own : 0;
}

void limit(__rlimit_resource resource, std::uint64_t most) {
  const rlimit both{most, most};
  setrlimit(resource, &both);
}

// Ends the process at any system call but those that follow. A kernel without seccomp refuses the
// filter; the other limits then stand alone.
void filterSystemCalls() {
  // Address sanitizer asks for the stack of signals before an exception or an end.
  constexpr std::uint32_t kAllowed[] = {__NR_brk,    __NR_mmap,       __NR_munmap,
                                        __NR_mremap, __NR_madvise,    __NR_mprotect,
                                        __NR_exit,   __NR_exit_group, __NR_sigaltstack};
  constexpr std::uint8_t kCount = std::size(kAllowed);
  constexpr std::uint16_t kLoad = BPF_LD | BPF_W | BPF_ABS;
  constexpr std::uint16_t kReturn = BPF_RET | BPF_K;
  constexpr std::uint16_t kSkipIfEqual = BPF_JMP | BPF_JEQ | BPF_K;

  // The BPF program ends the process unless the architecture and the number of the system call are
  // among the expected ones.
  std::array<sock_filter, kCount + 5> filter{{
      {kLoad, 0, 0, offsetof(seccomp_data, arch)},
      {kSkipIfEqual, 0, kCount + 1, kArchitecture},  // otherwise on to the end of the process
      {kLoad, 0, 0, offsetof(seccomp_data, nr)},
  }};
  for (std::uint8_t i = 0; i < kCount; ++i) {
    filter[3u + i] = {kSkipIfEqual, static_cast<std::uint8_t>(kCount - i), 0, kAllowed[i]};
  }
  filter[kCount + 3] = {kReturn, 0, 0, SECCOMP_RET_KILL_PROCESS};
  filter[kCount + 4] = {kReturn, 0, 0, SECCOMP_RET_ALLOW};

  // The kernel accepts filters of an ordinary process only if it can no longer gain privileges.
  const sock_fprog program{filter.size(), filter.data()};
  if (kArchitecture == 0 || prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return;
  prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

// Up to `work` this calls only what is safe after a fork() of a program with threads. `work` may
// allocate, because the C library frees the locks of malloc() in the child; no other lock is ever
// waited for, because that is a system call. Memory that runs out ends the child without an
// exception, whose way up may need a lock of the loader.
[[noreturn]] void beChild(const std::function<void(const ConfinedWriter&)>& work,
                          const ConfinedWriter& writer, std::uint64_t mostAddresses, int seconds) {
  // The child dies with its parent, has no open files, and handles signals as a new process does.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  syscall(__NR_close_range, 0u, ~0u, 0);
  for (int number = 1; number < NSIG; ++number) signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);

  // Memory and time are limited, and the child can neither write files nor start processes.
  limit(RLIMIT_AS, mostAddresses);
  limit(RLIMIT_CPU, seconds + 1);
  for (const auto resource : {RLIMIT_CORE, RLIMIT_FSIZE, RLIMIT_NPROC}) limit(resource, 0);
  alarm(static_cast<unsigned>(seconds));

  std::set_new_handler([] { _exit(kOutOfMemory); });
  filterSystemCalls();

  try {
    work(writer);
  } catch (...) {
    _exit(kThrew);
  }
  _exit(kDone);
}

std::string failureOfChild(int status) {
  if (WIFEXITED(status)) {
    const std::size_t code = WEXITSTATUS(status);
    return kFailures[std::min(code, std::size(kFailures) - 1)];
  }

  const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (number == SIGSYS) return "it called the system";
  if (number == SIGALRM) return "it took too long";
  return concat("it crashed (signal ", number, ")");
}

}  // namespace

ConfinedAnswer runConfined(const std::string& where,
                           const std::function<void(const ConfinedWriter&)>& work,
                           std::uint64_t mostBytes, int seconds) {
  mostBytes = std::min(mostBytes, addressesLeft() / 4);

  // The answer lies in memory that both processes share: its length, and behind it the bytes.
  const std::size_t size = sizeof(std::uint64_t) + mostBytes;
  void* const shared = mmap(nullptr, size, PROT_READ | PROT_WRITE,
                            MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (shared == MAP_FAILED) {
    throwLimit(where + ": cannot share memory with a process: " + std::strerror(errno));
  }

  const auto unmap = [size](void* memory) { munmap(memory, size); };
  const std::unique_ptr<void, decltype(unmap)> owner(shared, unmap);

  auto* const length = static_cast<std::uint64_t*>(shared);
  char* const answer = reinterpret_cast<char*>(length + 1);
  const ConfinedWriter writer = [=](const void* bytes, std::size_t count) {
    if (count > mostBytes - *length) _exit(kTooLong);
    std::copy_n(static_cast<const char*>(bytes), count, answer + *length);
    *length += count;
  };

  // The first exception of a process makes tables by a system call that the child may not make.
  try {
    throw 0;
  } catch (int) {
  }

  const std::uint64_t mostAddresses = addressSpace() + mostBytes;
  const pid_t child = fork();
  if (child == 0) beChild(work, writer, mostAddresses, seconds);
  if (child < 0) throwLimit(where + ": cannot start a process: " + std::strerror(errno));

  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return {std::string(answer, std::min(*length, mostBytes)), failureOfChild(status)};
}

}  // namespace whit
