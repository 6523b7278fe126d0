// H59 where it is hardest: rays at the edges that triangles share. Which of the triangles is hit
// there depends on the order in which they are tested, and a ray's hit must not depend on the rays
// beside it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <random>

#include "accel/accel.h"
#include "set_columns.h"
#include "unit/scene_builder.h"
#include "verify/scene_builder.h"

namespace whit::test {
namespace {

constexpr std::size_t kRays = 20000;
constexpr int kSide = 32;

// A crumpled sheet has whole numbers for x and y and halves for z, so that the middles of edges are
// floats and rays reach them without any rounding: a ray hits both triangles, at one distance.
Mesh sheet(std::mt19937& random) {
  return verify::sheetOf(kSide + 1, kSide + 1, [&](int x, int y) {
    return Vec3f(Vec3d(x, y, 0.5 * static_cast<double>(random() % 3)));
  });
}

struct Rays {
  std::vector<Vec3f> origin, direction;  // not of unit length, which would round
};

// The rays start above the sheet and go through middles of its edges; every fourth goes anywhere.
Rays raysAtEdges(const Mesh& mesh, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0, kSide);
  Rays rays;

  for (const auto i : indices(kRays)) {
    const auto& corners = mesh.triangles[random() % mesh.triangles.size()];
    const std::size_t side = random() % 3;
    Vec3f target = (mesh.positions[corners[side]] + mesh.positions[corners[(side + 1) % 3]]) * 0.5f;
    if (i % 4 == 0) target = {uniform(random), uniform(random), 0.5f};
    const auto whole = [&] { return static_cast<float>(random() % kSide); };
    rays.origin.push_back({whole(), whole(), 8});
    rays.direction.push_back(target - rays.origin.back());
  }
  return rays;
}

using HitBits = std::array<std::uint32_t, 4>;  // triangle, and the bits of t, u, v

std::vector<HitBits> trace(const Accel& accel, const Rays& rays,
                           const std::vector<std::size_t>& order, bool coherent) {
  ColumnStore<RayColumns> columns;
  ColumnStore<HitColumns> hits;
  columns.allocate(roundUpToBlock(kRays), FeatureSet());
  hits.allocate(roundUpToBlock(kRays), FeatureSet());

  for (const auto k : indices(kRays)) {
    setRay(*columns, k, rays.origin[order[k]], rays.direction[order[k]]);
  }

  FrameConstants constants;
  constants.accel = &accel;
  TraceMeter meter;

  Chunk chunk;
  chunk.frame = &constants;
  chunk.meter = &meter;
  chunk.coherent = coherent;
  chunk.n = kRays;
  chunk.segments[0] = {RayKind::primary, 0, kRays};
  chunk.segmentCount = 1;
  chunk.rays = *columns;
  chunk.hits = *hits;
  findHits(chunk);

  std::vector<HitBits> result(kRays);
  for (const auto k : indices(kRays)) {
    HitBits& hit = result[order[k]];
    hit = {hits->triangle[k], 0, 0, 0};
    if (hit[0] == kMiss) continue;
    hit[1] = std::bit_cast<std::uint32_t>(hits->t[k]);
    hit[2] = std::bit_cast<std::uint32_t>(hits->u[k]);
    hit[3] = std::bit_cast<std::uint32_t>(hits->v[k]);
  }
  return result;
}

TEST(EdgeHits, H59_doNotDependOnTheRaysBeside) {
  constexpr unsigned kSeed = 7;
  std::mt19937 random(kSeed);
  const Mesh mesh = sheet(random);
  const Rays rays = raysAtEdges(mesh, random);
  const Scene scene = finalized(sceneOf(mesh));
  std::vector<std::size_t> order(kRays);
  std::iota(order.begin(), order.end(), 0);

  RenderOptions single;
  single.packet = 1;
  const std::vector<HitBits> expected = trace(Accel(scene, single), rays, order, true);

  for (const int packet : {4, 8, 16}) {
    RenderOptions options;
    options.packet = packet;
    const Accel accel(scene, options);
    for (int turn = 0; turn < 4; ++turn) {
      const std::vector<HitBits> found = trace(accel, rays, order, turn % 2 == 0);
      std::size_t differ = 0, first = 0;
      for (std::size_t i = kRays; i-- > 0;) {
        if (found[i] == expected[i]) continue;
        ++differ;
        first = i;
      }

      EXPECT_EQ(differ, 0u) << "packets of " << packet << ", turn " << turn << ", seed " << kSeed
                            << ", first ray " << first;
      // In another order, other rays share a packet.
      std::shuffle(order.begin(), order.end(), random);
    }
  }
}

}  // namespace
}  // namespace whit::test
