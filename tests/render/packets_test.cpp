// Rays are packed and hits are unpacked, on every target and for every width of packets.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
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
  for (std::size_t i = 0; i < kPacked; ++i) {
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
    for (std::size_t i = 0; i < (kPacked + width - 1) / width * width; ++i) {
      // Invalid rays and lanes behind the last ray are inactive: their tFar is negative.
      const float place = i < kPacked ? kReach / 4 : 0;
      Vec3f origin(place), direction{0, 0, 1};
      float reach = -1;
      if (i < kPacked && std::ranges::find(bad, i) == bad.end()) {
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
  for (std::size_t i = 0; i < kPacked; ++i) rays->tFar[i] = 1 - 0.01f * static_cast<float>(i);
  const std::vector<std::size_t> bad = spoilSome(*rays);
  forEachWidthAndTarget([&](std::size_t width) {
    simd::findPacketKernels().packShadowRays(*rays, kPacked, kReach, packets(width));
    for (std::size_t i = 0; i < kPacked; ++i) {
      const bool good = std::ranges::find(bad, i) == bad.end();
      EXPECT_EQ(word(i, packet_column::tFar, width), good ? rays->tFar[i] : -1) << i;
    }
  });
}

float floatOf(std::uint32_t bits) { return std::bit_cast<float>(bits); }

TEST_F(Packets, GiveHitsBackWithTheNumbersOfTheirTriangles) {
  // The world and two instances have four classes of triangles each.
  std::vector<std::uint32_t> triangleBase(3 * kTriangleClasses);
  for (std::uint32_t i = 0; i < triangleBase.size(); ++i) triangleBase[i] = 1000 * (i + 1);

  // Embree's ids: of none, of the world in scenes that move, and of the instances.
  const std::uint32_t ids[] = {kMiss, 0, kFirstInstanceId, kFirstInstanceId + 1};
  const std::uint32_t instances[] = {kMiss, kMiss, 0, 1}, placed[] = {0, 0, 1, 2};

  for (const bool instanced : {false, true}) {
    forEachWidthAndTarget([&](std::size_t width) {
      for (std::uint32_t i = 0; i < kPacked; ++i) {
        const bool missed = i % 5 == 4;
        word(i, packet_column::tFar, width) = static_cast<float>(i) + 0.5f;
        word(i, packet_column::u, width) = 0.125f;
        word(i, packet_column::v, width) = 0.01f * static_cast<float>(i);
        word(i, packet_column::primitive, width) = floatOf(7 * i);
        word(i, packet_column::geometry, width) = floatOf(missed ? kMiss : i % 5);
        word(i, packet_column::instance, width) = floatOf(missed ? kMiss : ids[i % 4]);
      }

      FeatureSet features;
      if (instanced) features = features.with(Feature::instances);
      ColumnStore<HitColumns> hits(kPacked, features);
      simd::findPacketKernels().unpackHits(packets(width), kPacked, triangleBase.data(), *hits);

      for (std::uint32_t i = 0; i < kPacked; ++i) {
        const bool missed = i % 5 == 4;
        const std::size_t base = (instanced ? placed[i % 4] * kTriangleClasses : 0) + i % 5;
        EXPECT_EQ(hits->t[i], static_cast<float>(i) + 0.5f);
        EXPECT_EQ(hits->u[i], 0.125f);
        EXPECT_EQ(hits->v[i], 0.01f * static_cast<float>(i));
        EXPECT_EQ(hits->triangle[i], missed ? kMiss : triangleBase[base] + 7 * i) << i;
        if (!instanced) continue;
        EXPECT_EQ(hits->instance[i], missed ? kMiss : instances[i % 4]) << i;
      }
    });
  }
}

TEST_F(Packets, GiveVisibilityBackToTheSlots) {
  forEachWidthAndTarget([&](std::size_t width) {
    std::vector<std::uint32_t> slot(kPacked);
    std::vector<float> visible(4 * kPacked, -7.0f);
    for (std::uint32_t i = 0; i < kPacked; ++i) {
      // Embree sets tFar to -infinity where a ray is occluded.
      constexpr float kFar[] = {-kInf, 0, 0.75f};
      slot[i] = 3 * i;
      word(i, packet_column::tFar, width) = kFar[i % 3];
    }

    simd::findPacketKernels().unpackVisibility(packets(width), kPacked, slot.data(),
                                               visible.data());

    for (std::size_t at = 0; at < visible.size(); ++at) {
      const bool written = at % 3 == 0 && at / 3 < kPacked;
      const float visibility = at / 3 % 3 == 0 ? 0.0f : 1.0f;
      EXPECT_EQ(visible[at], written ? visibility : -7.0f) << at;
    }
  });
}

}  // namespace
}  // namespace whit::test
