// The vector kernels, seen from the rest of the program: the one table from which they are
// instantiated, named, listed (whit info --kernels) and found.
//
// A kernel that is a step of its own is a function of a chunk (stages/chunk.h); the others work for
// steps that call Embree or write the film. Kernels run over the slots [0, n) of their columns with
// the SIMD target that was chosen last, are noexcept and allocate nothing. Slots from n to the next
// multiple of 16 may be overwritten with anything; their hits must be misses. The scalar reference
// of each is in src/reference, in the file of the same stage, written to the same formulas in
// double.
//
// An effect that changes what a kernel does in each lane is a choice of that kernel: a template
// bit. It is compiled once for every subset of its choices, and once more for every SIMD target.
// Which of these functions runs is looked up once a plan. All else that a frame may lack leaves out
// whole kernels (render/plan.h) or is a branch that goes the same way for a whole call
// (stages/features.h).
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/effects.h"
#include "stages/chunk.h"
#include "stages/contract.h"
#include "stages/packet_words.h"

namespace whit::simd {

struct Kernel {
  std::string_view name;
  Stage stage;
  // The function of variant `index` for the chosen target; null where it is no step of its own.
  StepFunction (*find)(std::size_t index) = nullptr;
  Parts reads, writes;
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

  StepFunction functionFor(EffectSet effects) const { return find(variantFor(effects)); }

 private:
  constexpr std::uint32_t bits() const { return choices.bits(); }
};

// Defines find##Name() below by Find##Name() of the chosen target; after HWY_ONCE, once for each.
#define WHIT_EXPORT_KERNEL(Name) \
  HWY_EXPORT(Find##Name);        \
  StepFunction find##Name(std::size_t index) { return HWY_DYNAMIC_DISPATCH(Find##Name)(index); }

// Each of these returns a variant for the chosen target; `index` is that of Kernel::variant.
StepFunction findGenerateRays(std::size_t index);
StepFunction findInterpolateSurfels(std::size_t index);
StepFunction findLookUpRoughness(std::size_t index);
StepFunction findLookUpCoverage(std::size_t index);
StepFunction findLimitDiffuse(std::size_t index);
StepFunction findLiftShadowOrigins(std::size_t index);
StepFunction findWriteEmittedAndReflectiveAmbient(std::size_t index);
StepFunction findFindRadianceAndShadowRays(std::size_t index);
StepFunction findFindAmbientAndOcclusionRays(std::size_t index);
StepFunction findDecideShadows(std::size_t index);
StepFunction findAddShading(std::size_t index);
StepFunction findAddReflections(std::size_t index);
StepFunction findAddGlossyReflections(std::size_t index);
StepFunction findAddRefractions(std::size_t index);
StepFunction findAddIndirect(std::size_t index);
StepFunction findReturnImpulses(std::size_t index);
StepFunction findReturnToEye(std::size_t index);

// Origin, direction, weight 1, throughput 1, parent = slot, the media around the eye, and the
// number of the path.
inline constexpr Kernel kGenerateRays{"generateRays", Stage::generateRays, findGenerateRays,
                                      {Part::pixels}, {Part::rays},        {}};

// Rays into Embree's packets, and what comes back (PacketKernels below).
inline constexpr Kernel kPackRays{"packRays", Stage::findIntersections, nullptr, {Part::rays}, {},
                                  {}};
inline constexpr Kernel kUnpackHits{
    "unpackHits", Stage::findIntersections, nullptr, {}, {Part::hits}, {}};

// Surfels from hits, and the kMaterial flags of them all. Absorption in the medium that a ray came
// through is multiplied into its weight and throughput.
inline constexpr Kernel kInterpolateSurfels{
    "interpolateSurfels",     Stage::findIntersections,    findInterpolateSurfels,
    {Part::rays, Part::hits}, {Part::surfels, Part::rays}, EffectSet().with(Effect::smoothNormals)};

// The width of lobes whose roughness is in a map.
inline constexpr Kernel kLookUpRoughness{
    "lookUpRoughness",   Stage::findIntersections,
    findLookUpRoughness, {Part::rays, Part::hits, Part::surfels},
    {Part::surfels},     {}};

// The share of each surface that is there, by number or map.
inline constexpr Kernel kLookUpCoverage{"lookUpCoverage",   Stage::findIntersections,
                                        findLookUpCoverage, {Part::rays, Part::hits, Part::surfels},
                                        {Part::surfels},    {}};

// Scales diffuse colors to the light that mirror, Fresnel's law and transmission leave.
inline constexpr Kernel kLimitDiffuse{"limitDiffuse",   Stage::findIntersections,
                                      findLimitDiffuse, {Part::rays, Part::surfels},
                                      {Part::surfels},  {}};

// Computes how far shadow rays start above the facet, for surfels between vertex normals that
// differ, into the lift columns (Hanika 2021, "Hacking the shadow terminator", Ray Tracing Gems II,
// chapter 4).
inline constexpr Kernel kLiftShadowOrigins{"liftShadowOrigins",   Stage::findIntersections,
                                           findLiftShadowOrigins, {Part::hits, Part::surfels},
                                           {Part::surfels},       {}};

inline constexpr Kernel kWriteEmittedAndReflectiveAmbient{"writeEmittedAndReflectiveAmbient",
                                                          Stage::writeEmittedAndReflectiveAmbient,
                                                          findWriteEmittedAndReflectiveAmbient,
                                                          {Part::rays, Part::surfels},
                                                          {Part::radiance},
                                                          {}};

// Unshadowed radiance from the chunk's light, and a shadow ray for each slot where it is not zero.
// `visible` is 0 in the slots that have one, and 0 where nothing contributes. Without
// Feature::shadows no rays are written and `visible` is 1 where light falls.
inline constexpr Kernel kFindRadianceAndShadowRays{
    "findRadianceAndShadowRays",
    Stage::findRadianceAndShadowRays,
    findFindRadianceAndShadowRays,
    {Part::rays, Part::surfels},
    {Part::unshadowed, Part::shadows},
    EffectSet().with(Effect::glossy).with(Effect::spotLights).with(Effect::directionalLights)};

// Writes one sample of the ambient light, and for each slot that reflects some of it a ray as long
// as the occlusion radius, with or without Feature::shadows.
inline constexpr Kernel kFindAmbientAndOcclusionRays{
    "findAmbientAndOcclusionRays",     Stage::findRadianceAndShadowRays,
    findFindAmbientAndOcclusionRays,   {Part::rays, Part::surfels},
    {Part::unshadowed, Part::shadows}, {}};

// Removes the rays that the shadow cache decides from the shadow rays; `visible` is 1 where the
// cache says lit.
inline constexpr Kernel kDecideShadows{"decideShadows",
                                       Stage::checkShadows,
                                       findDecideShadows,
                                       {Part::hits, Part::shadows},
                                       {Part::shadows, Part::unshadowed},
                                       {}};

inline constexpr Kernel kPackShadowRays{
    "packShadowRays", Stage::checkShadows, nullptr, {Part::shadows}, {}, {}};
inline constexpr Kernel kUnpackVisibility{
    "unpackVisibility", Stage::checkShadows, nullptr, {}, {Part::unshadowed}, {}};

// radiance += unshadowed where visible.
inline constexpr Kernel kAddShading{"addShading",     Stage::addShading,
                                    findAddShading,   {Part::unshadowed, Part::radiance},
                                    {Part::radiance}, {}};

// Children of the surfels, appended to the chunk's. A child whose throughput is below the cutoff is
// not written, or under --roulette by chance only, and then for more. There must be room for one a
// slot, of sampled lobes for so many a slot as lobeSampling says.
inline constexpr Kernel kAddReflections{"addReflections",   Stage::addImpulses,
                                        findAddReflections, {Part::rays, Part::surfels},
                                        {Part::children},   {}};
// Samples of the surfels' glossy lobes, each written with its share of the weight; whether it is
// worth tracing is decided as if it were the whole lobe.
inline constexpr Kernel kAddGlossyReflections{"addGlossyReflections",   Stage::addImpulses,
                                              findAddGlossyReflections, {Part::rays, Part::surfels},
                                              {Part::children},         {}};
inline constexpr Kernel kAddRefractions{"addRefractions",   Stage::addImpulses,
                                        findAddRefractions, {Part::rays, Part::surfels},
                                        {Part::children},   {}};
// Rays drawn by the cosine to the normals of diffuse surfels, written and decided on like samples
// of glossy lobes.
inline constexpr Kernel kAddIndirect{"addIndirect",    Stage::addImpulses,
                                     findAddIndirect,  {Part::rays, Part::surfels},
                                     {Part::children}, {}};
// The way back: parent radiance += weight * radiance, child by child in slot order.
inline constexpr Kernel kReturnImpulses{
    "returnImpulses",       Stage::addImpulses,
    findReturnImpulses,     {Part::rays, Part::radiance, Part::parentRadiance},
    {Part::parentRadiance}, {}};

// The last of it, where media absorb: what the queue of depth 0 has gathered, times the weight that
// its rays have left between the eye and the first surface.
inline constexpr Kernel kReturnToEye{"returnToEye",    Stage::addImpulses,
                                     findReturnToEye,  {Part::rays, Part::radiance},
                                     {Part::radiance}, {}};

// Exposure, tone curve and sRGB (encodeDisplay below).
inline constexpr Kernel kEncodeDisplay{"encodeDisplay",  Stage::updateImage, nullptr,
                                       {Part::radiance}, {Part::codes},      {}};

// In the order of the stages.
inline constexpr std::array kKernels{kGenerateRays,
                                     kPackRays,
                                     kUnpackHits,
                                     kInterpolateSurfels,
                                     kLookUpRoughness,
                                     kLookUpCoverage,
                                     kLimitDiffuse,
                                     kLiftShadowOrigins,
                                     kWriteEmittedAndReflectiveAmbient,
                                     kFindRadianceAndShadowRays,
                                     kFindAmbientAndOcclusionRays,
                                     kDecideShadows,
                                     kPackShadowRays,
                                     kUnpackVisibility,
                                     kAddShading,
                                     kAddReflections,
                                     kAddGlossyReflections,
                                     kAddRefractions,
                                     kAddIndirect,
                                     kReturnImpulses,
                                     kReturnToEye,
                                     kEncodeDisplay};

// The place of a kernel in the table.
constexpr std::size_t indexOf(const Kernel& kernel) {
  std::size_t index = 0;
  while (kKernels[index].name != kernel.name) ++index;
  return index;
}

// One function a variant: make.operator()<bits>() for each of the kernel's sets of bits, in order.
template <const Kernel& kKernel, typename Make, std::size_t... kIndex>
constexpr auto variantTable(Make make, std::index_sequence<kIndex...>) {
  return std::array{make.template operator()<kKernel.variant(kIndex).bits()>()...};
}
template <const Kernel& kKernel, typename Make>
constexpr auto variantTable(Make make) {
  return variantTable<kKernel>(make, std::make_index_sequence<kKernel.variantCount()>());
}

// Between columns and Embree's packets. Lanes left over get empty rays, and so do rays that Embree
// cannot take: it ends the program at a NaN or where the sum of the coordinates' sizes is beyond
// `reach` (hard case H28).
struct PacketKernels {
  void (*packRays)(const RayColumns& rays, std::size_t n, float reach, const PacketWords& to);
  void (*packShadowRays)(const ShadowColumns& rays, std::size_t n, float reach,
                         const PacketWords& to);
  // For scenes without instances: a triangle's number is the number of its class's first triangle
  // plus its own.
  void (*unpackHits)(const PacketWords& from, std::size_t n, const std::uint32_t* triangleBase,
                     const HitColumns& hits);
  // visible[slot[i]]: 1 where ray i met nothing, otherwise 0.
  void (*unpackVisibility)(const PacketWords& from, std::size_t n, const std::uint32_t* slot,
                           float* visible);
};
// Returns the kernels for the chosen target.
PacketKernels findPacketKernels();

// Radiance of n slots to packed codes r | g << 8 | b << 16 | 255 << 24.
struct EncodeArgs {
  float exposureScale = 1;
  ToneCurve curve = ToneCurve::none;
  SrgbEncoding encoding = SrgbEncoding::exact;
  RadianceColumns radiance;
  std::size_t n = 0;
  std::uint32_t* codes = nullptr;
};
void encodeDisplay(const EncodeArgs& args) noexcept;

// "textures+smoothNormals", "plain" for none.
std::string variantName(EffectSet variant);

// Names as in --simd, best first: of the targets that the kernels were compiled for, and of those
// among them that this machine has. chooseTarget("auto") takes the best; false: this machine or
// build lacks it. Functions that were found before stay those of the target before. Other
// threads may choose the same target and call kernels of it meanwhile, and no other.
std::vector<std::string> compiledTargets();
std::vector<std::string> availableTargets();
bool chooseTarget(const std::string& name);
std::string chosenTarget();

}  // namespace whit::simd
