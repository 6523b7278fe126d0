// The kernels in which filling the shadow cache spends its time, against their scalar versions.
#include "simd/meet_casters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "render/caster_reference.h"
#include "simd/kernels.h"

namespace whit::test {
namespace {

constexpr std::size_t kInBlock = simd::CasterBlock::kCasters;

TriangleRecord recordOf(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  return {{a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z}, {}, 0};
}
Vec3f cornerOf(const TriangleRecord& t, int i) {
  return {t.position[3 * i], t.position[3 * i + 1], t.position[3 * i + 2]};
}

// A receiver, a light and eight triangles.
struct Setting {
  TriangleRecord receiving{};
  LightPoint light;
  std::vector<TriangleRecord> triangles;
  std::vector<double> growth;

  simd::CasterBlock block() const {
    simd::CasterBlock block{};
    for (std::size_t i = 0; i < kInBlock; ++i) {
      for (std::size_t k = 0; k < 9; ++k) {
        block.corner[k / 3][k % 3][i] = double{triangles[i].position[k]};
      }
      block.growth[i] = growth[i];
    }
    return block;
  }
};

class Settings {
 public:
  Setting next(int number) {
    Setting s;
    const Vec3f base = point() * 2.0f;
    const float size = std::exp2(unit(random_) * 5 - 3);
    s.receiving = recordOf(base, base + point() * size, base + point() * size);
    s.light = {Vec3d(point()) * 3.0, number % 4 == 0};
    for (std::size_t i = 0; i < kInBlock; ++i) {
      s.triangles.push_back(number % 3 == 0 ? awkward(s, i) : plain());
      s.growth.push_back(i % 2 == 0 ? 0 : std::exp2(double{unit(random_)} * 8 - 8));
    }
    return s;
  }

 private:
  float unit(std::mt19937& random) { return std::uniform_real_distribution<float>(-1, 1)(random); }
  Vec3f point() { return {unit(random_), unit(random_), unit(random_)}; }
  TriangleRecord plain() {
    const Vec3f at = point() * 1.5f;
    const float extent = std::exp2(unit(random_) * 3 + 1);
    return recordOf(at + point() * extent, at + point() * extent, at);
  }
  // Of every kind that divides by next to nothing, or has a sum that is nothing.
  TriangleRecord awkward(const Setting& s, std::size_t kind) {
    const Vec3f a = point(), b = point(), light(s.light.position);
    const Vec3f corner = cornerOf(s.receiving, 0);
    switch (kind) {
      case 0:
        return recordOf(a, a, b);
      case 1:
        return recordOf(a, a + b, a + b * 2.0f);
      case 2:
        return recordOf(light, a, b);
      case 3:
        return recordOf(light + a, light - a, b);
      case 4:
        return s.receiving;
      case 5:
        return recordOf(corner, a, b);
      case 6:
        return recordOf(a, b, a + (b - a) * 0.5f + point() * 0x1p-18f);
      default:
        return recordOf(a * 1e5f, b * 1e5f, point() * 1e5f);
    }
  }

  std::mt19937 random_{11};
};

struct Bits {
  unsigned met = 0, hiding = 0;
};

// One triangle hides the receiver at a time: so each is asked about alone, but without `opaque`
// where all are asked together.
Bits meet(const simd::CasterKernels& kernels, const simd::CasterBlock& block, const Setting& s,
          const Receiver& receiver) {
  Bits bits;
  const auto ask = [&](simd::CasterBits asked, simd::CasterBits opaque, simd::CasterBits& met) {
    return kernels.meetCasters({&block, 1, &asked, &opaque, &met}, s.light, receiver);
  };
  simd::CasterBits together = 0;
  EXPECT_EQ(ask(0xff, 0, together), simd::kNoCaster);
  for (unsigned i = 0; i < kInBlock; ++i) {
    const auto one = static_cast<simd::CasterBits>(1u << i);
    simd::CasterBits met = 0;
    const std::size_t hider = ask(one, 0xff, met);
    EXPECT_TRUE(hider == simd::kNoCaster || hider == i);
    if (hider == i) bits.hiding |= one;
    simd::CasterBits alone = 0;
    EXPECT_EQ(ask(one, 0, alone), simd::kNoCaster);
    EXPECT_EQ(alone, together & one);
  }
  bits.met = together;
  return bits;
}

Bits expected(const Setting& s, const Receiver& receiver) {
  Bits bits;
  for (unsigned i = 0; i < kInBlock; ++i) {
    const Meeting meeting = Caster(s.triangles[i], s.light).meet(receiver);
    if (meeting != Meeting::never) bits.met |= 1u << i;
    if (meeting == Meeting::always) bits.hiding |= 1u << i;
  }
  return bits;
}

class OnEachTarget : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { simd::chooseTarget(GetParam()); }
  void TearDown() override { simd::chooseTarget("auto"); }
};

using CasterKernels = OnEachTarget;

TEST_P(CasterKernels, MeetWhatTheirReferenceMeets) {
  const simd::CasterKernels kernels = simd::findCasterKernels();
  Settings settings;
  int never = 0, always = 0, unsure = 0;
  for (int n = 0; n < 2000; ++n) {
    const Setting s = settings.next(n);
    const ReceivingTriangle receiving(s.receiving, 1);
    const Receiver receiver = receiving.piece({0.25, 0.25, n % 2 == 0 ? 0.25 : 0.5});
    if (receiving.isSliver() || receiver.count == 0) continue;
    simd::CasterBlock block = s.block();
    kernels.setCasters(block, s.light, receiver);
    const Bits bits = meet(kernels, block, s, receiver), scalar = expected(s, receiver);
    ASSERT_EQ(bits.met, scalar.met) << n;
    ASSERT_EQ(bits.hiding, scalar.hiding) << n;
    for (unsigned i = 0; i < kInBlock; ++i) {
      ++((bits.hiding >> i & 1) != 0 ? always : (bits.met >> i & 1) != 0 ? unsure : never);
    }
  }
  EXPECT_GT(never, 5000);
  EXPECT_GT(always, 300);
  EXPECT_GT(unsure, 300);
}

// Bounds of a receiver are no narrower than those of its pieces: what they prove of a piece, its
// own prove as well, and next to nothing is lost.
TEST_P(CasterKernels, ProveNoMoreOfAPieceThanItsOwnBounds) {
  const simd::CasterKernels kernels = simd::findCasterKernels();
  Settings settings;
  int proved = 0, lost = 0;
  for (int n = 0; n < 2000; ++n) {
    const Setting s = settings.next(n);
    const ReceivingTriangle receiving(s.receiving, 1);
    const Receiver whole = receiving.piece({0, 0, 1}),
                   piece = receiving.piece({0.25, 0.125, 0.125});
    if (receiving.isSliver() || piece.count == 0) continue;
    EXPECT_GE(whole.reach, piece.reach);
    simd::CasterBlock block = s.block();
    kernels.setCasters(block, s.light, whole);
    const Bits bits = meet(kernels, block, s, piece), own = expected(s, piece);
    ASSERT_EQ(own.met & ~bits.met, 0u) << n;
    ASSERT_EQ(bits.hiding & ~own.hiding, 0u) << n;
    for (unsigned i = 0; i < kInBlock; ++i) {
      if ((own.met >> i & 1) == 0 || (own.hiding >> i & 1) != 0) ++proved;
      if (((bits.met & ~own.met) | (own.hiding & ~bits.hiding)) >> i & 1) ++lost;
    }
  }
  EXPECT_GT(proved, 8000);
  EXPECT_LT(lost, proved / 50);
}

TEST_P(CasterKernels, PassWhatTheShaftMisses) {
  const simd::CasterKernels kernels = simd::findCasterKernels();
  Settings settings;
  int passed = 0, left = 0, passedBoxes = 0, missedBoxes = 0;
  for (int n = 0; n < 2000; ++n) {
    const Setting s = settings.next(n);
    const ReceivingTriangle receiving(s.receiving, 1);
    const Receiver receiver = receiving.piece({0.25, 0.25, 0.25});
    if (receiving.isSliver() || receiver.count == 0) continue;
    const Shaft shaft(receiver, s.light, 8);
    const simd::CasterBlock block = s.block();
    simd::CasterBits met = 0xff;
    simd::BoxBlock boxes;
    const bool any = kernels.passCasters({&block, 1, nullptr, nullptr, &met}, shaft.sides());
    EXPECT_EQ(any, met != 0);
    for (std::size_t i = 0; i < kInBlock; ++i) {
      const bool misses = shaftMisses(shaft.sides(), s.triangles[i], s.growth[i]);
      ASSERT_EQ((met >> i & 1) == 0, misses) << n;
      ++(misses ? passed : left);
      Box box;
      for (int k = 0; k < 3; ++k) box.add(cornerOf(s.triangles[i], k));
      setBox(boxes, i, box);
    }
    const unsigned metBoxes = kernels.meetBoxes(shaft.rounded(), boxes);
    for (std::size_t i = 0; i < kInBlock; ++i) {
      Box box;
      for (int k = 0; k < 3; ++k) box.add(cornerOf(s.triangles[i], k));
      const bool misses = shaft.misses(box);
      missedBoxes += misses;
      if ((metBoxes >> i & 1) != 0) continue;
      ++passedBoxes;
      ASSERT_TRUE(misses) << n;
    }
  }
  EXPECT_GT(passed, 1000);
  EXPECT_GT(left, 1000);
  EXPECT_GT(passedBoxes, 1000);
  EXPECT_GT(passedBoxes, missedBoxes - missedBoxes / 100);
}

TEST_P(CasterKernels, AskOnlyAboutThoseThatAreAskedFor) {
  const simd::CasterKernels kernels = simd::findCasterKernels();
  // A roof over all of the receiver.
  Setting s;
  s.receiving = recordOf({0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  s.light = {{0, 8, 0}, false};
  s.triangles.assign(kInBlock, recordOf({-20, 2, -20}, {20, 2, -20}, {0, 2, 40}));
  s.growth.assign(kInBlock, 0);
  const Receiver receiver = ReceivingTriangle(s.receiving, 1).piece({0.25, 0.25, 0.25});
  std::vector<simd::CasterBlock> blocks(3, s.block());
  for (auto& block : blocks) kernels.setCasters(block, s.light, receiver);
  const auto ask = [&](std::vector<simd::CasterBits> asked, std::vector<simd::CasterBits> opaque) {
    std::vector<simd::CasterBits> met(3);
    return kernels.meetCasters({blocks.data(), 3, asked.data(), opaque.data(), met.data()}, s.light,
                               receiver);
  };
  EXPECT_EQ(ask({0xff, 0xff, 0xff}, {0, 0, 0}), simd::kNoCaster);
  EXPECT_EQ(ask({0, 0, 0}, {0xff, 0xff, 0xff}), simd::kNoCaster);
  EXPECT_EQ(ask({0xff, 0xff, 0xff}, {0, 0x20, 0x01}), 13u);
  EXPECT_EQ(ask({0xff, 0xdf, 0xff}, {0, 0x20, 0x80}), 23u);
}

INSTANTIATE_TEST_SUITE_P(Targets, CasterKernels, testing::ValuesIn(simd::availableTargets()),
                         [](const auto& of) { return of.param; });

}  // namespace
}  // namespace whit::test
