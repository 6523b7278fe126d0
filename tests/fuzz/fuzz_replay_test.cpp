// The corpus, and damaged versions of it, given to the readers.
#include <gtest/gtest.h>

#include <random>

#include "fuzz/damage.h"
#include "fuzz/readers.h"

namespace whit::fuzz {
namespace {

class Replay : public testing::TestWithParam<Reader> {};

TEST_P(Replay, EveryFileIsReadOrRefused) {
  int read = 0;
  for (const std::filesystem::path& file : corpusOf(GetParam())) {
    SCOPED_TRACE(file.filename());
    EXPECT_NO_THROW(read += give(GetParam(), bytesOfFile(file)) == Answer::read);
  }
  EXPECT_GT(read, 0) << "nothing of the corpus can be read at all";
}

// The test tries some versions of each file; tests/fuzz/run.sh tries as many as there is time for.
// Half of them have an undamaged first half, so that the structure leads to what is damaged, such
// as compressed data.
TEST_P(Replay, DamagedFilesAreReadOrRefused) {
  constexpr std::uint32_t kVersions = 24;
  for (const std::filesystem::path& file : corpusOf(GetParam())) {
    const Bytes whole = bytesOfFile(file);
    for (std::uint32_t seed = 0; seed < kVersions; ++seed) {
      SCOPED_TRACE(file.filename().string() + ", seed " + std::to_string(seed));
      EXPECT_NO_THROW(give(GetParam(), damaged(whole, seed)));

      const auto middle = whole.begin() + std::ssize(whole) / 2;
      Bytes bytes(whole.begin(), middle);
      const Bytes behind = damaged({middle, whole.end()}, seed);
      bytes.insert(bytes.end(), behind.begin(), behind.end());
      EXPECT_NO_THROW(give(GetParam(), bytes));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Readers, Replay, testing::ValuesIn(readers()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace whit::fuzz
