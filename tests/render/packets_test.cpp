// Rays are packed on every target and for every width of packets. That hits and visibility come
// back to their rays is seen by pictures of all widths (hard cases H59b and H83b).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "render/every_target.h"
#include "set_columns.h"
#include "stages/columns.h"

namespace whit::test {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kReach = 1000;
constexpr std::size_t kColumns = 20, kPacked = 37;  // not a multiple of any width

class Packets : public testing::Test {
 protected:
  // Calls check(width) for each width and target.
  template <typename Check>
  void forEachWidthAndTarget(const Check& check) {
    forEachTarget([&](const std::string&) {
      for (const std::size_t width : {4u, 8u, 16u}) {
        SCOPED_TRACE(width);
        words.assign((kPacked + width) / width * width * kColumns, -7.0f);
        check(width);
      }
    });
  }

  PacketWords packets(std::size_t width) { return {words.data(), kColumns * width, width}; }

  float& word(std::size_t ray, std::size_t column, std::size_t width) {
    return words[ray / width * kColumns * width + column * width + ray % width];
  }

  std::vector<float> words;
};

template <typename Columns>
void fillRays(const Columns& rays) {
  for (const auto i : indices(kPacked)) {
    const auto x = static_cast<float>(i);
    setRay(rays, i, {x, -2 * x, x + 0.5f}, {1, -x, 0.25f * x});
  }
}

// Makes some rays invalid, each in another way; the rays between them stay valid.
template <typename Columns>
std::vector<std::size_t> spoilSome(const Columns& rays) {
  rays.org.x[3] = std::nanf("");
  rays.dir.z[5] = kInf;
  rays.org.y[20] = -kInf;
  rays.dir.x[36] = -0.999f * kReach;
  return {3, 5, 20, 36};
}

TEST_F(Packets, HoldTheRaysAndEmptyOnesInTheirPlace) {
  ColumnStore<RayColumns> rays(kPacked, FeatureSet());
  fillRays(*rays);
  const std::vector<std::size_t> bad = spoilSome(*rays);
  forEachWidthAndTarget([&](std::size_t width) {
    simd::findPacketKernels().packRays(*rays, kPacked, kReach, packets(width));
    for (const auto i : indices((kPacked + width - 1) / width * width)) {
      // Invalid rays and lanes behind the last ray are inactive: their tFar is negative.
      const float place = i < kPacked ? kReach / 4 : 0;
      Vec3f origin(place), direction{0, 0, 1};
      float reach = -1;
      if (i < kPacked && !contains(bad, i)) {
        origin = rays->org.at(i);
        direction = rays->dir.at(i);
        reach = kInf;
      }

      const auto at = [&](std::size_t column) { return word(i, column, width); };
      using namespace packet_column;
      EXPECT_EQ((Vec3f{at(orgX), at(orgY), at(orgZ)}), origin) << i;
      EXPECT_EQ((Vec3f{at(dirX), at(dirY), at(dirZ)}), direction) << i;
      EXPECT_EQ(at(tFar), reach) << i;
    }

    // Kernels leave the columns alone that they do not know.
    for (const std::size_t c : {3u, 7u, 9u, 10u, 11u, 12u, 19u}) EXPECT_EQ(word(0, c, width), -7);
  });
}

TEST_F(Packets, HoldWhereShadowRaysEnd) {
  ColumnStore<ShadowColumns> rays(kPacked, FeatureSet());
  fillRays(*rays);
  for (const auto i : indices(kPacked)) rays->tFar[i] = 1 - 0.01f * static_cast<float>(i);
  const std::vector<std::size_t> bad = spoilSome(*rays);
  forEachWidthAndTarget([&](std::size_t width) {
    simd::findPacketKernels().packShadowRays(*rays, kPacked, kReach, packets(width));
    for (const auto i : indices(kPacked)) {
      const bool good = !contains(bad, i);
      EXPECT_EQ(word(i, packet_column::tFar, width), good ? rays->tFar[i] : -1) << i;
    }
  });
}

}  // namespace
}  // namespace whit::test
