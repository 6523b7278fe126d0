// Random small pictures (random_picture.h) on every SIMD target of the machine, and pictures that
// once ended the program or never ended.
//   WHIT_RANDOM_PICTURES=20000 WHIT_RANDOM_TARGET=sse4 build/tests/fuzz_test
//   --gtest_filter='RandomPictures.*'
// renders more of them; WHIT_RANDOM_FIRST=N begins with number N.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "cli/run_program.h"
#include "core/stopwatch.h"
#include "fuzz/random_picture.h"
#include "io/files.h"
#include "simd/kernels.h"

namespace whit::fuzz {
namespace {

std::uint32_t environmentNumber(const char* name, std::uint32_t fallback) {
  const char* text = std::getenv(name);
  return text ? static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10)) : fallback;
}

void renderPictures(std::uint32_t first, std::uint32_t count, const std::string& target) {
  std::uint32_t made = 0, limited = 0, notFinite = 0, slowest = 0;
  double most = 0;
  for (std::uint32_t number = first; number < first + count; ++number) {
    SCOPED_TRACE("picture " + std::to_string(number) + " on " + target);
    // The last number that is printed is that of a picture which ends the program.
    if (std::getenv("WHIT_RANDOM_PICTURES")) std::fprintf(stderr, "%u\n", number);

    FrameStats stats;
    const Stopwatch watch;
    EXPECT_NO_THROW(made += renderPicture(bytesOfPicture(number), target, &stats));
    limited += stats.limitedPixels > 0;
    notFinite += stats.nonFinitePixels > 0;
    if (watch.ms() > most) {
      most = watch.ms();
      slowest = number;
    }
  }

  std::printf(
      "%s: %u of %u pictures, %u with a bound on their rays, %u with pixels that are not "
      "finite; the slowest is %u with %.0f ms\n",
      target.c_str(), made, count, limited, notFinite, slowest, most);
  // If most pictures were refused, the test would test nothing.
  EXPECT_GT(made, count / 2) << "most pictures are refused";
}

TEST(RandomPictures, EndOnEveryTarget) {
  const std::uint32_t count = environmentNumber("WHIT_RANDOM_PICTURES", 60);
  const char* const chosen = std::getenv("WHIT_RANDOM_TARGET");
  for (const std::string& target : simd::availableTargets()) {
    if (!chosen || chosen == target) {
      renderPictures(environmentNumber("WHIT_RANDOM_FIRST", 0), count, target);
    }
  }
  simd::chooseTarget("auto");
}

// These scenes were reported because they crashed the program or never ended.
TEST(ReportedPictures, End) {
  const std::filesystem::path reports = dataFolder() / "reports";
  if (!std::filesystem::exists(reports / "endless.json")) {
    GTEST_SKIP() << "NOT TESTED: no reports in " << dataFolder() << "; set WHIT_DATA";
  }
  const cli::TemporaryFolder folder;

  const std::vector<std::vector<std::string>> commands{
      {"crash_mirror.json"},
      {"crash_indirect.obj", "--indirect", "1", "--spp", "2"},
      {"endless.json", "--indirect", "1", "--ambient-samples", "2"}};
  for (std::vector<std::string> command : commands) {
    command[0] = reports / command[0];
    command.insert(command.begin(), "render");
    command.insert(command.end(), {"--quiet", "-o", folder / "picture.png"});
    EXPECT_EQ(cli::runWhit(command).status, 0) << command[1];
  }
}

}  // namespace
}  // namespace whit::fuzz
