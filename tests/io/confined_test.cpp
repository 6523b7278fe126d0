// What a confined child process can do, and what ends it.
#include "io/confined.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/error.h"
#include "sanitized.h"

namespace whit {
namespace {

constexpr std::uint64_t kMemory = 64u << 20;

using Work = std::function<void(const ConfinedWriter&)>;

ConfinedAnswer answerOf(const Work& work) { return runConfined("a.glb", work, kMemory, 20); }

std::string failureOf(const Work& work) { return answerOf(work).failure; }

// Expects what a child process, whose address space is limited to so many bytes, says of itself.
void expectOfChild(rlim_t bytes, const std::function<bool()>& isRight) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const rlimit limits{bytes, bytes};
    setrlimit(RLIMIT_AS, &limits);
    _exit(isRight() ? 0 : 1);
  }

  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST(Confined, AnswersWithWhatItComputes) {
  int seen = 7;
  const std::string text = "what the parent knows";
  const ConfinedAnswer answer = answerOf([&](const ConfinedWriter& write) {
    seen = 8;
    const std::vector<char> much(1 << 20, 'x');  // more than a pipe holds
    write(text.data(), text.size());
    write(much.data(), much.size());
  });

  EXPECT_EQ(answer.failure, "");
  EXPECT_EQ(answer.bytes, text + std::string(1 << 20, 'x'));
  EXPECT_EQ(seen, 7) << "the child changed the parent";
}

// The address space is limited to 1 GB more than the process uses. A child that is allowed 64 GB
// must start all the same.
TEST(Confined, LimitsOfAddressSpaceAreKept) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take address space of their own";
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t used = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
  expectOfChild(used + (rlim_t{1} << 30), [] {
    const ConfinedAnswer answer = runConfined(
        "a.glb", [](const ConfinedWriter& write) { write("yes", 3); }, std::uint64_t{64} << 30, 20);
    return answer.bytes == "yes" && answer.failure.empty();
  });
}

// A process that may take no more addresses than it has cannot share memory with a child.
TEST(Confined, ErrorsNameWhatTheChildWasFor) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take address space of their own";
  expectOfChild(1, [] {
    try {
      answerOf([](const ConfinedWriter&) {});
    } catch (const Error& error) {
      return error.status() == ExitStatus::limit &&
             std::string(error.what()).starts_with("a.glb: cannot share memory");
    }
    return false;
  });
}

TEST(Confined, CrashesAreReportedAndBytesBeforeThemArrive) {
  const ConfinedAnswer answer = answerOf([](const ConfinedWriter& write) {
    write("half", 4);
    throw std::runtime_error("no");
  });
  EXPECT_EQ(answer.bytes, "half");
  EXPECT_EQ(answer.failure, "it gave up");
  if (kSanitized) GTEST_SKIP() << "sanitizers report crashes, which calls the system";
  EXPECT_EQ(failureOf([](const ConfinedWriter&) { *static_cast<volatile int*>(nullptr) = 1; }),
            "it crashed (signal 11)");
}

TEST(Confined, TimeIsLimited) {
  const auto forever = [](const ConfinedWriter&) {
    const volatile bool goesOn = true;
    while (goesOn) continue;
  };
  EXPECT_EQ(runConfined("a.glb", forever, kMemory, 1).failure, "it took too long");
}

TEST(Confined, MemoryIsLimited) {
  if (kSanitized) GTEST_SKIP() << "sanitizers end a process without memory in their own way";
  EXPECT_EQ(failureOf([](const ConfinedWriter&) {
              const std::vector<char> all(2 * kMemory, 'x');
              if (all[1] != 'x') std::abort();
            }),
            "it needs more memory");
}

TEST(Confined, AnswersAreLimited) {
  EXPECT_EQ(failureOf([](const ConfinedWriter& write) {
              const std::vector<char> some(1 << 20);
              for (;;) write(some.data(), some.size());
            }),
            "its answer is too long");
}

// Threads that allocate hold locks of malloc() at any time.
TEST(Confined, StartsFromAProgramWithThreads) {
  if (kSanitized) GTEST_SKIP() << "sanitizers allocate with locks that a fork does not free";
  std::atomic<bool> goesOn{true};
  std::vector<std::thread> others;
  for (int i = 0; i < 3; ++i) {
    others.emplace_back([&] {
      while (goesOn) std::vector<std::string>(200, std::string(100, 'x')).clear();
    });
  }

  for (int i = 0; i < 40; ++i) {
    const ConfinedAnswer answer = answerOf([](const ConfinedWriter& write) {
      const std::vector<std::string> many(1000, std::string(1000, 'y'));
      write(many[999].data(), 1000);
    });
    EXPECT_EQ(answer.failure, "");
    EXPECT_EQ(answer.bytes, std::string(1000, 'y'));
  }

  goesOn = false;
  for (std::thread& other : others) other.join();
  EXPECT_TRUE(waitpid(-1, nullptr, WNOHANG) < 0 && errno == ECHILD) << "a child is left";
}

TEST(Confined, TheSystemIsOutOfReach) {
  // The address of the filter is null, which a kernel with seccomp filters reports as a bad address
  // and others as an invalid option.
  const bool filters = prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, nullptr) != 0 && errno == EFAULT;
  if (!filters) GTEST_SKIP() << "no seccomp here";

  const auto open = [](const ConfinedWriter&) {
    if (::open("/dev/null", O_RDONLY) >= 0) _exit(0);
    throw std::runtime_error("the file cannot be opened");
  };

  EXPECT_EQ(failureOf(open), "it called the system");
  EXPECT_EQ(failureOf([](const ConfinedWriter&) { kill(getppid(), SIGTERM); }),
            "it called the system");
  EXPECT_EQ(failureOf([](const ConfinedWriter&) {
              if (::write(STDERR_FILENO, "x", 1) == 1) _exit(0);
            }),
            "it called the system");
}

}  // namespace
}  // namespace whit
