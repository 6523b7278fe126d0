// The lookup in the shadow cache against a scalar version, on tables made up for it: which rays
// leave the queue, which are kept and in what order, and which parts are requested.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/image.h"
#include "simd/kernels.h"
#include "stages/columns.h"
#include "stages/shadow_cache_view.h"

namespace whit::test {
namespace {

constexpr std::size_t kSlots = 1024, kTriangles = 48;
constexpr std::uint32_t kPlaces = 9;

struct Tables {
  std::vector<TriangleRecord> triangles;
  std::vector<std::uint32_t> first, parts, cells;
};

class MadeUp {
 public:
  explicit MadeUp(unsigned seed) : random_(seed) {
    makeTables();
    rays_.allocate(kSlots, FeatureSet());
    hits_.allocate(kSlots, FeatureSet().with(Feature::instances));
    unshadowed_.allocate(kSlots, FeatureSet());
    for (std::size_t slot = 0; slot < kSlots; ++slot) {
      makeHit(slot);
      unshadowed_->visible[slot] = 0;
      // In rows without gaps, and between them rows with.
      if ((slot / 64) % 2 == 0 || random_() % 3 == 0) makeRay(slot);
    }
    wanted_.assign(tables_.parts.size(), 0);
  }

  Chunk chunk(FrameConstants& constants, ShadingTables& shading, ShadowCacheView& view,
              TraceMeter& meter) {
    shading.triangles = tables_.triangles.data();
    view = {tables_.first.data(), tables_.parts.data(), tables_.cells.data(), wanted_.data()};
    constants.tables = &shading;
    constants.shadowCache = &view;
    constants.features = FeatureSet().with(Feature::instances);
    Chunk c;
    c.frame = &constants;
    c.meter = &meter;
    c.n = kSlots;
    c.hits = *hits_;
    c.unshadowed = *unshadowed_;
    c.shadows = *rays_;
    c.shadowCount = count_;
    return c;
  }

  // What the tables say of the ray of a slot, one number after the other.
  ShadowState stateOf(std::size_t slot, bool near) const {
    const std::uint32_t part = partOf(slot);
    if (part == kNoParts) return ShadowState::mixed;
    const std::uint32_t word = tables_.parts[part];
    auto state = static_cast<ShadowState>(word & 3);
    if (word > 3) {
      const float side = sideOf(slot) * kCellsASide;
      const auto column = static_cast<std::uint32_t>(hits_->u[slot] * side) % kCellsASide;
      const auto row = static_cast<std::uint32_t>(hits_->v[slot] * side) % kCellsASide;
      const std::uint32_t at =
          ((word >> 2) - 1) * kWordsAPlace + row * kWordsARow + column / kCellsAWord;
      state = static_cast<ShadowState>(tables_.cells[at] >> (2 * (column % kCellsAWord)) & 3);
    }
    return near || state == ShadowState::unknown ? state : ShadowState::mixed;
  }
  std::uint32_t partOf(std::size_t slot) const {
    const std::uint32_t word = tables_.first[hits_->triangle[slot]];
    if (word == kNoParts || static_cast<std::int32_t>(hits_->instance[slot]) >= 0) return kNoParts;
    const float u = hits_->u[slot], v = hits_->v[slot], side = sideOf(slot);
    if (std::min(std::min(u, v), 1 - u - v) < kShadowRim / side) return kNoParts;
    const auto column = static_cast<std::uint32_t>(u * side);
    const auto row = static_cast<std::uint32_t>(v * side);
    return (word >> kPartBits) + row * static_cast<std::uint32_t>(side) + column;
  }

  void knowNothing() { std::fill(tables_.parts.begin(), tables_.parts.end(), 0); }

  struct Ray {
    std::uint32_t slot;
    bool near;
    float tFar;
  };
  std::vector<Ray> rays;
  const std::vector<std::uint8_t>& wanted() const { return wanted_; }

 private:
  float uniform(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random_);
  }
  float sideOf(std::size_t slot) const {
    return static_cast<float>(
        1u << (tables_.first[hits_->triangle[slot]] & ((1u << kPartBits) - 1)));
  }

  // Some triangles have one state all over, some none that decides.
  std::uint32_t makePart(std::size_t triangle, unsigned k) {
    if (triangle % 7 < 2) return static_cast<std::uint32_t>(ShadowState::lit) + triangle % 2;
    const auto any = static_cast<std::uint32_t>(random_());
    if (triangle % 7 == 2) return any % 2 == 0 ? 0 : static_cast<std::uint32_t>(ShadowState::mixed);
    return k % 2 == 0 ? any % 4 : (any % kPlaces + 1) << 2;
  }

  void makeTables() {
    for (std::size_t i = 0; i < kTriangles; ++i) {
      TriangleRecord record{};
      for (float& x : record.position) x = uniform(-2, 2);
      tables_.triangles.push_back(record);
      const unsigned power = random_() % 4, parts = 1u << (2 * power);
      if (i % 7 == 3) {
        tables_.first.push_back(kNoParts);
        continue;
      }
      tables_.first.push_back(static_cast<std::uint32_t>(tables_.parts.size()) << kPartBits |
                              power);
      for (unsigned k = 0; k < parts; ++k) tables_.parts.push_back(makePart(i, k));
    }
    for (std::uint32_t i = 0; i < kPlaces * kWordsAPlace; ++i) {
      tables_.cells.push_back(static_cast<std::uint32_t>(random_()));
    }
  }

  // Neighbors often lie on one triangle; every fifth in a corner, where the rim is.
  void makeHit(std::size_t slot) {
    hits_->triangle[slot] = slot % 4 != 0 ? hits_->triangle[slot - 1]
                                          : static_cast<std::uint32_t>(random_() % kTriangles);
    hits_->instance[slot] = slot % 11 == 5 ? 0u : kMiss;
    float u = uniform(0, 1), v = uniform(0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    if (slot % 5 == 0) u *= 2 * kShadowRim;
    hits_->u[slot] = u;
    hits_->v[slot] = v;
  }

  void makeRay(std::size_t slot) {
    const float* p = tables_.triangles[hits_->triangle[slot]].position;
    const float u = hits_->u[slot], v = hits_->v[slot], w = 1 - u - v;
    const auto at = [&](int axis) { return w * p[axis] + u * p[3 + axis] + v * p[6 + axis]; };
    const auto size = [&](int axis) {
      return w * std::fabs(p[axis]) + u * std::fabs(p[3 + axis]) + v * std::fabs(p[6 + axis]);
    };
    const float reach = kCachedShadowReach * (size(0) + size(1) + size(2));
    const bool near = random_() % 6 != 0;
    Vec3f start{at(0), at(1), at(2)};
    // Clear of what rounding makes of the bound itself.
    start[static_cast<int>(random_() % 3)] += (near ? 0.7f : 1.5f) * reach;
    rays_->orgX[count_] = start.x;
    rays_->orgY[count_] = start.y;
    rays_->orgZ[count_] = start.z;
    rays_->dirX[count_] = rays_->dirY[count_] = rays_->dirZ[count_] = 1;
    rays_->tFar[count_] = static_cast<float>(count_);
    rays_->slot[count_] = static_cast<std::uint32_t>(slot);
    rays.push_back({static_cast<std::uint32_t>(slot), near, static_cast<float>(count_)});
    ++count_;
  }

  std::mt19937 random_;
  Tables tables_;
  ColumnStore<ShadowColumns> rays_;
  ColumnStore<HitColumns> hits_;
  ColumnStore<UnshadowedColumns> unshadowed_;
  std::vector<std::uint8_t> wanted_;
  std::size_t count_ = 0;
};

void expectAsTheReference(MadeUp& made, bool empty) {
  FrameConstants constants;
  ShadingTables shading;
  ShadowCacheView view;
  TraceMeter meter;
  Chunk c = made.chunk(constants, shading, view, meter);
  if (empty) made.knowNothing();
  simd::kDecideShadows.find()(c);
  std::size_t kept = 0, lit = 0, dark = 0;
  std::vector<std::uint8_t> wanted(made.wanted().size(), 0);
  for (const MadeUp::Ray& ray : made.rays) {
    const std::uint32_t part = made.partOf(ray.slot);
    const ShadowState state = made.stateOf(ray.slot, ray.near);
    if (part != kNoParts && state == ShadowState::unknown && wanted[part] < 255) {
      ++wanted[part];
    }
    EXPECT_EQ(c.unshadowed.visible[ray.slot], state == ShadowState::lit ? 1 : 0) << ray.slot;
    lit += state == ShadowState::lit;
    dark += state == ShadowState::dark;
    if (state == ShadowState::lit || state == ShadowState::dark) continue;
    ASSERT_LT(kept, c.shadowCount);
    EXPECT_EQ(c.shadows.slot[kept], ray.slot);
    EXPECT_EQ(c.shadows.tFar[kept], ray.tFar);
    ++kept;
  }
  EXPECT_EQ(c.shadowCount, kept);
  EXPECT_EQ(meter.shadows.lit, lit);
  EXPECT_EQ(meter.shadows.dark, dark);
  EXPECT_EQ(made.wanted(), wanted);
  if (!empty) {
    EXPECT_GT(lit, 40u);
    EXPECT_GT(dark, 40u);
  }
}

TEST(DecideShadows, DoesAsItsReferenceOnEveryTarget) {
  for (const std::string& target : simd::availableTargets()) {
    simd::chooseTarget(target);
    for (unsigned seed = 0; seed < 20; ++seed) {
      SCOPED_TRACE(target + ", seed " + std::to_string(seed));
      for (const bool empty : {false, true}) {
        MadeUp made(seed);
        expectAsTheReference(made, empty);
      }
    }
  }
  simd::chooseTarget("auto");
}

}  // namespace
}  // namespace whit::test
