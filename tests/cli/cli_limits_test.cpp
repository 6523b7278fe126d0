// When something runs out: disk, memory, processors.
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "has_text.h"
#include "run_command.h"
#include "sanitized.h"

namespace whit::cli {
namespace {

namespace fs = std::filesystem;

void limit(int resource, rlim_t most) {
  const rlimit both{most, most};
  setrlimit(static_cast<__rlimit_resource_t>(resource), &both);
}

class Limits : public TinySceneTest {
 protected:
  const TemporaryFolder results_;
};

TEST_F(Limits, AFullDeviceIsAnErrorOfWriting) {
  for (const char* name : {"full.exr", "full.png", "full.json"}) {
    fs::create_symlink("/dev/full", results_ / name);
  }

  for (const char* name : {"full.exr", "full.png"}) {
    // "No space left on device", or "no space left, or the device failed" where the library that
    // writes keeps the reason to itself.
    expectFailed(runWhit({"render", tiny_, "-o", results_ / name, "--quiet"}), 4, "o space left");
  }

  expectFailed(runWhit({"info", tiny_, "--json", results_ / "full.json", "--quiet"}), 4,
               "full.json");

  // Standard output on a full device is an error as well.
  const auto toFull = [] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); };
  expectFailed(runWhit({"info", tiny_, "--quiet"}, toFull), 4, "cannot write");
  expectFailed(runWhit({"render", "--help"}, toFull), 4, "cannot write");
}

TEST_F(Limits, AFileThatMayNotGrowIsLeftOutWhole) {
  for (const std::string type : {".exr", ".png"}) {
    const std::string old = results_ / ("old" + type);
    succeed({"render", tiny_, "-o", old, "--size", "8x8", "--quiet"});
    const std::string before = readFile(old);

    ASSERT_LT(before.size(), 4096u);
    for (const std::string& path : {old, results_ / ("new" + type)}) {
      const Outcome outcome = runWhit({"render", tiny_, "-o", path, "--size", "200x200", "--quiet"},
                                      [] { limit(RLIMIT_FSIZE, 4096); });
      expectFailed(outcome, 4, "File too large");
    }

    // The old file is kept, and no part of the new one is left.
    EXPECT_TRUE(readFile(old) == before) << "what was there is gone";
    EXPECT_FALSE(fs::exists(results_ / ("new" + type)));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(results_.path()), {}), 2)
      << "temporary files left";
}

// With too little memory the program ends with a message and status 5. The limit grows until there
// is enough; below 64 MB not even the shared libraries find room, and no line of ours runs.
TEST_F(Limits, TooLittleMemoryIsALimit) {
  if (kSanitized) GTEST_SKIP() << "sanitizers need terabytes of addresses";
  int failures = 0, successes = 0;
  for (rlim_t megabytes = 64; successes < 2 && megabytes < 65536; megabytes += megabytes / 4) {
    const Outcome outcome = runWhit({"render", tiny_, "-o", results_ / "a.png", "--quiet"},
                                    [&] { limit(RLIMIT_AS, megabytes << 20); });
    if (outcome.status == 127) continue;  // the loader failed
    if (outcome.status == 0) {
      ++successes;
    } else {
      ++failures;
      expectFailed(outcome, 5, "");
      EXPECT_EQ(std::distance(fs::directory_iterator(results_.path()), {}), successes > 0);
    }
  }

  EXPECT_GT(failures, 0);
  EXPECT_EQ(successes, 2);
}

// The picture alone takes more than the process may.
TEST_F(Limits, AFilmWithoutMemoryIsALimit) {
  if (kSanitized) GTEST_SKIP() << "sanitizers need terabytes of addresses";
  const Outcome outcome = runWhit({"render", tiny_, "-o", results_ / "a.exr", "--size",
                                   "16000x16000", "--max-memory", "64", "--threads", "1"},
                                  [] { limit(RLIMIT_AS, rlim_t{1} << 30); });
  expectFailed(outcome, 5, "out of memory");
}

// The child process that decodes the mesh takes a part of the addresses that are left.
TEST_F(Limits, DracoWorksUnderALimitOfAddressSpace) {
  if (kSanitized) GTEST_SKIP() << "sanitizers need terabytes of addresses";
  const char* const source = std::getenv("WHIT_SOURCE_DIR");
  const std::string model =
      std::string(source ? source : ".") + "/tests/fuzz/corpus/gltf/draco.glb";
  const Outcome outcome =
      runWhit({"info", model, "--quiet"}, [] { limit(RLIMIT_AS, rlim_t{6'000'000} << 10); });
  if (outcome.err.find("KHR_draco_mesh_compression") != std::string::npos) {
    GTEST_SKIP() << "built without libdraco";
  }

  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(hasText(outcome.out, "triangles   8"));
}

TEST_F(Limits, WorkersAreNoMoreThanTheProcessMayUse) {
  const auto threadsWith = [&](int cpus) {
    const Outcome outcome =
        runWhit({"render", tiny_, "-o", results_ / "a.exr", "--quiet", "--json", "-"}, [cpus] {
          cpu_set_t allowed, wanted;
          sched_getaffinity(0, sizeof allowed, &allowed);
          CPU_ZERO(&wanted);
          for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&wanted) < cpus; ++i) {
            if (CPU_ISSET(i, &allowed)) CPU_SET(i, &wanted);
          }
          sched_setaffinity(0, sizeof wanted, &wanted);
        });
    return nlohmann::json::parse(outcome.out)["threads"].get<int>();
  };

  EXPECT_EQ(threadsWith(1), 1);
  cpu_set_t here;
  sched_getaffinity(0, sizeof here, &here);
  EXPECT_LE(threadsWith(2), std::min(2, CPU_COUNT(&here)));
}

}  // namespace
}  // namespace whit::cli
