// Every kernel and every variant of it that is compiled: the one table from which the kernels are
// instantiated, named and listed (whit info --kernels). An effect that changes what a kernel does
// in each lane is a choice of that kernel; it is compiled once for every subset of its choices, and
// once more for every SIMD target. All other effects leave out whole kernels (render/plan.h) or are
// branches that go the same way for a whole call.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/effects.h"
#include "stages/stage.h"

namespace whit::simd {

struct Kernel {
  std::string_view name;
  Stage stage;
  EffectSet choices;

  constexpr std::size_t variantCount() const { return std::size_t{1} << std::popcount(bits()); }

  // Variant `index` has the k-th choice, counted from the lowest bit, where bit k of `index` is
  // set.
  constexpr EffectSet variant(std::size_t index) const {
    EffectSet set;
    std::size_t k = 0;
    for (std::uint32_t rest = bits(); rest != 0; rest &= rest - 1, ++k) {
      if ((index >> k & 1) != 0) set = EffectSet(set.bits() | (rest & (~rest + 1)));
    }
    return set;
  }

  // The variant that runs in a frame with these effects.
  constexpr std::size_t variantFor(EffectSet effects) const {
    std::size_t index = 0, k = 0;
    for (std::uint32_t rest = bits(); rest != 0; rest &= rest - 1, ++k) {
      if ((effects.bits() & rest & (~rest + 1)) != 0) index |= std::size_t{1} << k;
    }
    return index;
  }

 private:
  constexpr std::uint32_t bits() const { return choices.bits(); }
};

inline constexpr Kernel kInterpolateSurfels{
    "interpolateSurfels", Stage::findIntersections,
    EffectSet().with(Effect::smoothNormals).with(Effect::textures).with(Effect::normalMaps)};
inline constexpr Kernel kFindRadianceAndShadowRays{
    "findRadianceAndShadowRays", Stage::findRadianceAndShadowRays,
    EffectSet().with(Effect::glossy).with(Effect::spotLights).with(Effect::directionalLights)};

// In the order of the stages.
inline constexpr std::array kKernels{
    Kernel{"generateRays", Stage::generateRays, {}},
    Kernel{"packRays", Stage::findIntersections, {}},
    Kernel{"unpackHits", Stage::findIntersections, {}},
    kInterpolateSurfels,
    Kernel{"liftShadowOrigins", Stage::findIntersections, {}},
    Kernel{"writeEmittedAndReflectiveAmbient", Stage::writeEmittedAndReflectiveAmbient, {}},
    kFindRadianceAndShadowRays,
    Kernel{"packShadowRays", Stage::checkShadows, {}},
    Kernel{"unpackVisibility", Stage::checkShadows, {}},
    Kernel{"addShading", Stage::addShading, {}},
    Kernel{"addReflections", Stage::addImpulses, {}},
    Kernel{"addGlossyReflections", Stage::addImpulses, {}},
    Kernel{"addRefractions", Stage::addImpulses, {}},
    Kernel{"returnImpulses", Stage::addImpulses, {}},
    Kernel{"encodeDisplay", Stage::updateImage, {}},
};

// One function a variant: make.operator()<bits>() for each of the kernel's sets of bits, in order.
template <const Kernel& kKernel, typename Make, std::size_t... kIndex>
constexpr auto variantTable(Make make, std::index_sequence<kIndex...>) {
  return std::array{make.template operator()<kKernel.variant(kIndex).bits()>()...};
}
template <const Kernel& kKernel, typename Make>
constexpr auto variantTable(Make make) {
  return variantTable<kKernel>(make, std::make_index_sequence<kKernel.variantCount()>());
}

// "textures+smoothNormals", "plain" for none.
std::string variantName(EffectSet variant);

// Names, as in --simd, of the targets that the kernels were compiled for, best first.
std::vector<std::string> compiledTargets();

}  // namespace whit::simd
