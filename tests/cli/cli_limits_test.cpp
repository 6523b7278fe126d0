// When something runs out: disk, memory, processors.
#include <sched.h>
#include <sys/resource.h>

#include "run_command.h"
#include "sanitized.h"
#include "source_files.h"

namespace whit::cli {
namespace {

namespace fs = std::filesystem;

void limit(int resource, rlim_t most) {
  const rlimit both{most, most};
  setrlimit(static_cast<__rlimit_resource_t>(resource), &both);
}

class Limits : public TinySceneTest {
 protected:
  Limits() { fs::create_directory(folder_ / "made"); }
  std::ptrdiff_t filesMade() const {
    return std::distance(fs::directory_iterator(folder_ / "made"), {});
  }
};

TEST_F(Limits, AFullDeviceIsAnErrorOfWriting) {
  for (const char* name : {"full.exr", "full.png", "full.json"}) {
    fs::create_symlink("/dev/full", folder_ / name);
  }

  // "No space left on device", or "no space left, or the device failed" where the library that
  // writes keeps the reason to itself.
  expectFailure("render tiny.json -o full.exr", 4, "o space left");
  expectFailure("render tiny.json -o full.png", 4, "o space left");
  expectFailed(run("info tiny.json --json full.json"), 4, "full.json");

  // Standard output on a full device is an error as well.
  const auto toFull = [] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); };
  for (const char* line :
       {"--version", "render --help", "info tiny.json", "render tiny.json -o -"}) {
    expectFailed(run(line, toFull), 4, "to standard output");
  }
}

TEST_F(Limits, AFileThatMayNotGrowIsLeftOutWhole) {
  for (const std::string type : {".exr", ".png"}) {
    const std::string old = "made/old" + type, fresh = "made/new" + type;
    succeed("render tiny.json --size 8x8 -o " + old);
    const std::string before = bytesOf(old);

    ASSERT_LT(before.size(), 4096u);
    for (const std::string& name : {old, fresh}) {
      expectFailed(
          run("render tiny.json --size 200x200 -o " + name, [] { limit(RLIMIT_FSIZE, 4096); }), 4,
          "File too large");
    }

    // The old file is kept, and no part of the new one is left.
    EXPECT_TRUE(bytesOf(old) == before) << "what was there is gone";
    EXPECT_FALSE(exists(fresh));
  }
  EXPECT_EQ(filesMade(), 2) << "temporary files left";
}

// With too little memory the program ends with a message and status 5. The limit grows until there
// is enough; below 64 MB not even the shared libraries find room, and no line of ours runs.
TEST_F(Limits, TooLittleMemoryIsALimit) {
  if (kSanitized) GTEST_SKIP() << "sanitizers need terabytes of addresses";
  int failures = 0, successes = 0;
  for (rlim_t megabytes = 64; successes < 2 && megabytes < 65536; megabytes += megabytes / 4) {
    const Outcome outcome =
        run("render tiny.json -o made/a.png", [&] { limit(RLIMIT_AS, megabytes << 20); });
    if (outcome.status == 127) continue;  // the loader failed
    if (outcome.status == 0) {
      ++successes;
    } else {
      ++failures;
      expectFailed(outcome, 5, "");
      EXPECT_EQ(filesMade(), successes > 0);
    }
  }

  EXPECT_GT(failures, 0);
  EXPECT_EQ(successes, 2);
}

// The picture alone takes more than the process may.
TEST_F(Limits, AFilmWithoutMemoryIsALimit) {
  if (kSanitized) GTEST_SKIP() << "sanitizers need terabytes of addresses";
  expectFailed(run("render tiny.json -o a.exr --size 16000x16000 --max-memory 64 --threads 1",
                   [] { limit(RLIMIT_AS, rlim_t{1} << 30); }),
               5, "out of memory");
}

// The child process that decodes the mesh takes a part of the addresses that are left.
TEST_F(Limits, DracoWorksUnderALimitOfAddressSpace) {
  if (kSanitized) GTEST_SKIP() << "sanitizers need terabytes of addresses";
  const std::string model = sourceFile("tests/fuzz/corpus/gltf/draco.glb");
  const Outcome outcome = run("info " + model, [] { limit(RLIMIT_AS, rlim_t{6'000'000} << 10); });
  if (outcome.err.find("KHR_draco_mesh_compression") != std::string::npos) {
    GTEST_SKIP() << "built without libdraco";
  }

  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(hasText(outcome.out, "triangles   8"));
}

TEST_F(Limits, WorkersAreNoMoreThanTheProcessMayUse) {
  const auto threadsWith = [&](int cpus) {
    const Outcome outcome = run("render tiny.json -o a.exr --json -", [cpus] {
      cpu_set_t allowed, wanted;
      sched_getaffinity(0, sizeof allowed, &allowed);
      CPU_ZERO(&wanted);
      for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&wanted) < cpus; ++i) {
        if (CPU_ISSET(i, &allowed)) CPU_SET(i, &wanted);
      }
      sched_setaffinity(0, sizeof wanted, &wanted);
    });
    return Json::parse(outcome.out)["threads"].get<int>();
  };

  EXPECT_EQ(threadsWith(1), 1);
  cpu_set_t here;
  sched_getaffinity(0, sizeof here, &here);
  EXPECT_LE(threadsWith(2), std::min(2, CPU_COUNT(&here)));
}

}  // namespace
}  // namespace whit::cli
