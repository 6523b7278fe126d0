#include "reference/media.h"

#include <cmath>

#include "stages/columns.h"

namespace whit::reference {

namespace {

constexpr int kStackBits = 32, kEntryBits = 8;

std::uint32_t entryAt(MediaStack stack, int shift) { return stack >> shift & 0xff; }

MediaStack crossed(MediaStack stack, std::uint32_t medium, bool entering) {
  if (entering) return pushMedium(stack, medium);
  return removeMedium(stack, medium);
}

}  // namespace

MediaStack pushMedium(MediaStack stack, std::uint32_t medium) {
  return stack << kEntryBits | medium;
}

MediaStack removeMedium(MediaStack stack, std::uint32_t medium) {
  for (int shift = 0; shift < kStackBits; shift += kEntryBits) {
    if (entryAt(stack, shift) != medium) continue;

    const std::uint32_t newerEntries = stack & ((1u << shift) - 1);
    // In 64 bits, because a shift by all 32 bits of a word is not defined.
    const std::uint64_t olderEntries = std::uint64_t{stack} >> (shift + kEntryBits) << shift;
    return static_cast<MediaStack>(olderEntries) | newerEntries;
  }
  return stack;
}

std::uint32_t currentMedium(const Scene& scene, MediaStack stack) {
  std::uint32_t best = 0;
  for (int shift = 0; shift < kStackBits; shift += kEntryBits) {
    const std::uint32_t medium = entryAt(stack, shift);
    if (medium == 0) continue;
    if (best == 0 || scene.media[medium].priority > scene.media[best].priority) best = medium;
  }
  return best;
}

Crossing crossMedia(const Scene& scene, EffectSet effects, std::uint32_t material, bool entering,
                    MediaStack stack, std::uint32_t others) {
  Crossing crossing;
  crossing.stackBehind = stack;
  if (!effects.has(Effect::transmission) || !scene.materials[material].passesLight()) {
    return crossing;
  }

  // The ray crosses the hit surface and all dielectrics whose faces share its place.
  const std::uint32_t medium = scene.mediumOfMaterial[material];
  crossing.dielectric = true;
  if (medium != 0) crossing.stackBehind = crossed(stack, medium, entering);
  for (; others != 0; others >>= kCrossedBits) {
    const std::uint32_t other = others & ((1u << kCrossedBits) - 1);
    if (other >> 1 == 0) continue;  // kSharesPlace
    crossing.stackBehind = crossed(crossing.stackBehind, other >> 1, (other & 1) != 0);
  }

  // The media of highest priority on both sides refract; where they are the same there is no
  // interface.
  const std::uint32_t before = currentMedium(scene, stack);
  const std::uint32_t behind = currentMedium(scene, crossing.stackBehind);
  crossing.hidden = medium != 0 && before == behind;
  crossing.n1 = scene.media[before].ior;
  crossing.n2 = scene.media[behind].ior;

  return crossing;
}

RgbD transmittance(const Scene& scene, MediaStack stack, double distance) {
  const Rgb& absorption = scene.media[currentMedium(scene, stack)].absorption;
  const auto channel = [&](double sigma) {
    const double opticalDepth = sigma * distance;
    // Zero times infinity: the channel is not absorbed, however far the ray goes.
    return std::isnan(opticalDepth) ? 1.0 : std::exp(-opticalDepth);
  };
  return {channel(absorption.x), channel(absorption.y), channel(absorption.z)};
}

}  // namespace whit::reference
