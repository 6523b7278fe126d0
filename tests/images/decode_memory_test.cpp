// Memory that decoding takes counts in the budget of the scene that the images are for.
#include <thread>

#include "every_format.h"
#include "io/texture_loader.h"

namespace whit {
namespace {

constexpr std::uint64_t kPlenty = 1 << 30;

TEST(MemoryBudget, WhatIsHeldIsGivenBackUnlessKept) {
  MemoryBudget budget(100);
  {
    const MemoryHold held(&budget, 10, 6, "a");
    EXPECT_EQ(budget.left(), 40u);
    EXPECT_EQ(statusOf([&] { MemoryHold(&budget, 41, 1, "b"); }), ExitStatus::limit);
  }
  EXPECT_EQ(budget.left(), 100u);

  MemoryHold first(&budget, 50, 1, "a");
  first = MemoryHold(&budget, 20, 1, "b");
  EXPECT_EQ(budget.left(), 80u);
  first.keep();
  EXPECT_EQ(budget.left(), 80u);

  budget.charge(80, 1, "c");
  EXPECT_EQ(statusOf([&] { budget.charge(1, 1, "d"); }), ExitStatus::limit);
  EXPECT_EQ(statusOf([&] { MemoryHold(&budget, ~std::uint64_t{0}, 8, "d"); }), ExitStatus::limit);
  // A hold without a budget takes any amount.
  MemoryHold(nullptr, ~std::uint64_t{0}, 8, "no budget");
}

TEST(MemoryBudget, ChargingWaitsForWhatOthersHold) {
  MemoryBudget budget(100);
  std::optional<MemoryHold> held(std::in_place, &budget, 60, 1, "a");
  std::thread other([&] { budget.charge(70, 1, "b"); });

  // The other thread can go on only now.
  held.reset();
  other.join();
  EXPECT_EQ(budget.left(), 30u);
}

TEST(DecodeQueue, WhatLackedMemoryIsRunAgainAlone) {
  for (const int threads : {1, 3}) {
    MemoryBudget budget(100);
    DecodeQueue queue(threads, nullptr, "holding");
    std::atomic<int> done{0};
    for (int i = 0; i < 8; ++i) {
      queue.add([&] {
        const MemoryHold held(&budget, 90, 1, "task");
        std::this_thread::yield();
        ++done;
      });
    }
    queue.finish();
    EXPECT_EQ(done, 8);
  }

  MemoryBudget budget(100);
  DecodeQueue queue(2, nullptr, "failing");
  int runs = 0;
  queue.add([&] {
    ++runs;
    MemoryHold(&budget, 101, 1, "too much");
  });

  EXPECT_EQ(statusOf([&] { queue.finish(); }), ExitStatus::limit);
  // A task that lacked memory is tried once more, without others at its side.
  EXPECT_EQ(runs, 2);
}

using DecodeMemory = EveryFormat;

TEST_F(DecodeMemory, TheImageIsHeldForAsLongAsItLives) {
  for (const FormatSample& sample : samples()) {
    MemoryBudget budget(kPlenty);
    limits_.budget = &budget;
    {
      RawImage raw = read(sample.name, sample.bytes);
      EXPECT_EQ(budget.left(), kPlenty - sample.decoded) << sample.name;
      const RawImage moved = std::move(raw);
      EXPECT_EQ(budget.left(), kPlenty - sample.decoded) << sample.name;
    }
    EXPECT_EQ(budget.left(), kPlenty) << sample.name;
  }
}

// Decoding fails with a limit until the budget is large enough, and nothing stays held afterwards.
TEST_F(DecodeMemory, TheDecoderIsHeldAsWell) {
  for (const FormatSample& sample : samples()) {
    const std::string file = save(sample.name, sample.bytes);
    std::uint64_t enough = 0;
    for (std::uint64_t bytes = 16; enough == 0 && bytes < kPlenty; bytes += bytes / 4) {
      MemoryBudget budget(bytes);
      limits_.budget = &budget;
      const ExitStatus status = readStatus(file);
      if (status == ExitStatus::done) enough = bytes;
      EXPECT_TRUE(status == ExitStatus::done || status == ExitStatus::limit) << sample.name;
      EXPECT_EQ(budget.left(), bytes) << sample.name;
    }

    // The decoder needs memory besides the image, but not much.
    EXPECT_GT(enough, sample.decoded + sample.bytes.size() / 2) << sample.name;
    EXPECT_LT(enough, 1u << 20) << sample.name;
  }
}

// The image claims 4104 x 4104 pixels, of which the file holds none. A progressive JPEG is decoded
// through its coefficients, which take 2 bytes each.
TEST_F(DecodeMemory, AProgressiveJpegHoldsItsCoefficients) {
  Bytes file = jpegGray200();
  const Bytes marker{0xff, 0xc0};
  const auto frame = std::search(file.begin(), file.end(), marker.begin(), marker.end());
  frame[1] = 0xc2;
  for (const int at : {5, 7}) frame[at] = 0x10;  // the sides become 0x1008, which is 4104 pixels

  constexpr std::uint64_t kPixels = 4104 * 4104;
  MemoryBudget little(kPixels * 5 / 2), enough(kPixels * 4);

  limits_.budget = &little;
  EXPECT_EQ(readStatus("a.jpg", file), ExitStatus::limit);
  limits_.budget = &enough;
  EXPECT_NE(readStatus("a.jpg", file), ExitStatus::limit);
}

}  // namespace
}  // namespace whit
