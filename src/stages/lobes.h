// Lobes by which surfaces reflect and transmit the scene, sampled by rays that are drawn at random.
// What a lobe is to plan, tables, kernels and reference stands here alone; how a ray of it is
// drawn, in reference/add_impulses.h and simd/add_impulses.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/options.h"
#include "sampling/random_streams.h"
#include "scene/material.h"
#include "stages/ray_kinds.h"
#include "stages/shading_tables.h"

namespace whit {

struct Lobe {
  Effect effect;                            // frames with this effect sample the lobe
  bool (Material::*isOf)(EffectSet) const;  // the materials that have it in frames
  std::uint32_t flag;                       // materials with this flag have the lobe
  RayKind kind;                             // kind of the lobe's rays
  int (*samples)(const RenderOptions&);     // number of rays for a surfel that the eye sees
  std::uint32_t firstBranch;                // first branch of the rays for childStream(); 64 follow
  std::uint32_t salt;                       // salt of the rays' lattice; 0: the path's own lattice
  Lattice lattice;

  bool isSampled(const Material& material, EffectSet effects) const {
    return (material.*isOf)(effects);
  }
};

inline constexpr Lobe kGlossyLobe{Effect::glossyReflection,
                                  &Material::scatters,
                                  kMaterialScatters,
                                  RayKind::reflection,
                                  glossySamples,
                                  3,
                                  0,
                                  kFacetLattice};
inline constexpr Lobe kDiffuseLobe{Effect::indirect,
                                   &Material::diffuses,
                                   kMaterialDiffuses,
                                   RayKind::indirect,
                                   [](const RenderOptions& o) { return o.indirect; },
                                   128,
                                   0x5851f42du,
                                   kLobeLattice};
// What frosted glass transmits. The points are those of the glossy lobe, so that each facet that is
// drawn both reflects and transmits.
inline constexpr Lobe kFrostedLobe{Effect::glossyReflection,
                                   &Material::frosts,
                                   kMaterialFrosts,
                                   RayKind::refraction,
                                   glossySamples,
                                   256,
                                   0,
                                   kFacetLattice};
inline constexpr std::array kLobes{kGlossyLobe, kFrostedLobe, kDiffuseLobe};

// Where a surface behind the first hit has both lobes, one of them is followed, or the rays would
// double at every bounce and the cutoff would end them all. It is drawn with a probability in
// proportion to the largest channel of its weight, and its weight is divided by that probability,
// so that the mean stays. The choice comes before the cutoff, which then sees the weight of both.
inline constexpr std::uint32_t kLobeSalt = 0x9216d5d9u;
constexpr bool choosesLobe(EffectSet effects) {
  return effects.has(kGlossyLobe.effect) && effects.has(kDiffuseLobe.effect);
}

// True if frames with these effects sample any lobe.
constexpr bool samplesLobes(EffectSet effects) {
  return std::ranges::any_of(kLobes, [&](const Lobe& lobe) { return effects.has(lobe.effect); });
}

// True if frames with these effects sample what arrives at surfaces: by lobes, of lights with a
// radius or of ambient light.
constexpr bool samplesLight(EffectSet effects) {
  return samplesLobes(effects) || effects.has(Effect::softShadows) ||
         effects.has(Effect::ambientOcclusion);
}

// True if --adaptive decides how many samples each pixel gets. It does not where light is sampled:
// pixels whose first samples agree because all of them missed the light would end there, and the
// picture would be too dark. `effects` are the scene's.
inline bool samplesAdaptively(const RenderOptions& options, EffectSet effects) {
  const EffectSet used = effects.without(options.disable).without(optionalEffectsOff(options));
  const ChannelSet kept = keptChannels(options);
  const bool overAll = kept.has(Channel::alpha) || kept.has(Channel::error);  // need all samples
  return options.adaptive && options.spp > 1 && !samplesLight(used) && !overAll;
}

// Sample k of the surfel that `path` has led to.
constexpr UnitPoint pointOf(const Lobe& lobe, std::uint32_t path, LobeSampling sampling,
                            std::uint32_t k) {
  sampling.lattice = lobe.lattice;
  return lobe.salt == 0 ? lobePoint(path, sampling, k) : saltedPoint(path, sampling, lobe.salt, k);
}

}  // namespace whit
