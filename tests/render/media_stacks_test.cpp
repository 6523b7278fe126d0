// The stacks of nested media that the kernels keep: every stack of up to four media against the
// reference.
#include <gtest/gtest.h>

#include "reference/media.h"
#include "reference/small_scenes.h"
#include "render/kernel_surfels.h"

namespace whit::test {
namespace {

constexpr std::uint32_t kMedia = 5;  // four that fit a stack, and one that is in none

// Rounding of an exponential in float and of its argument.
constexpr double kAbsorbed = 12 * 0x1p-24;

// Triangle 2 m of the scene bounds medium m + 1.
Scene sceneOfMedia(const std::vector<int>& priorities) {
  SceneBuilder builder;
  for (std::uint32_t m = 0; m < kMedia; ++m) {
    Material glass = glassMaterial(1.1f + 0.1f * static_cast<float>(m), priorities[m]);
    glass.absorption = Rgb(0.25f * static_cast<float>(m + 1));
    builder.add(floorAt(static_cast<float>(m), 1), glass);
  }
  return builder.build();
}

// Lists all stacks of up to four of the media 1 to 4; the empty stack comes first.
std::vector<std::uint32_t> everyStack() {
  std::vector<std::uint32_t> stacks{0};
  for (std::size_t first = 0, depth = 0; depth < 4; ++depth) {
    const std::size_t end = stacks.size();
    for (; first < end; ++first) {
      for (std::uint32_t medium = 1; medium < kMedia; ++medium) {
        stacks.push_back(stacks[first] << 8 | medium);
      }
    }
  }
  return stacks;
}

// A ray in each stack hits each medium from outside and from inside.
void expectTheStacksOfTheReference(const Scene& scene, const std::string& simd) {
  KernelSurfels kernel(scene, simd);
  const std::vector<std::uint32_t> stacks = everyStack();
  ASSERT_EQ(stacks.size(), 1u + 4 + 16 + 64 + 256);

  for (const std::uint32_t stack : stacks) {
    // Each medium has a slot for a ray from outside and a slot for a ray from inside.
    for (std::uint32_t slot = 0; slot < 2 * kMedia; ++slot) {
      kernel.hit(slot, slot & ~1u, {0, slot % 2 ? 1.0f : -1.0f, 0}, stack);
    }

    kernel.interpolate();
    const double left = reference::transmittance(scene, stack, 1).x;
    const Chunk& c = kernel.chunk();

    for (const auto slot : indices(2 * kMedia)) {
      SCOPED_TRACE(testing::Message() << "stack " << stack << " slot " << slot);
      const SurfelRow scalar = kernel.scalar(slot);
      ASSERT_EQ(c.surfels.mediaBehind[slot], scalar.mediaBehind);
      ASSERT_EQ(c.surfels.flags[slot], scalar.flags);
      ASSERT_NEAR(c.rays.weight.x[slot], left, kAbsorbed);
    }
  }
}

// Depending on the priorities, the medium that counts is the newest, the oldest or one between; of
// two equal ones it is the newer.
TEST(MediaStacks, AreThoseOfTheReferenceOnEveryTarget) {
  for (const std::vector<int>& priorities :
       {std::vector<int>{0, 0, 0, 0, 0}, {1, 2, 3, 4, 5}, {4, 3, 2, 1, 0}, {-1, 3, 3, -2, 2}}) {
    const Scene scene = sceneOfMedia(priorities);

    ASSERT_EQ(scene.media.size(), 1u + kMedia);
    forEachTarget([&](const std::string& target) { expectTheStacksOfTheReference(scene, target); });
  }
}

}  // namespace
}  // namespace whit::test
