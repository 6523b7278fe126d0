// The vector kernels, seen from the rest of the program: the one table from which they are named,
// listed (whit info) and found.
//
// A kernel that is a step of its own is a function of a chunk (stages/chunk.h); the others work for
// steps that call Embree or write the film. Kernels run over the slots [0, n) of their columns with
// the SIMD target that was chosen last, throw nothing and allocate nothing. Slots from n to the
// next multiple of 16 may hold anything and be overwritten with anything; but their hits and
// surfels must be misses. No bits in any lane lead a kernel out of its tables. The scalar
// reference of each is in src/reference, in the file of the same stage, written to the same
// formulas in double.
//
// Each kernel is compiled once for every SIMD target, and looked up once a plan. What a frame lacks
// leaves out whole kernels (render/plan.h) or is a branch that goes the same way for a whole call
// (stages/columns.h). Template bits for effects, with one function for each subset of them, gained
// less than the noise of a measurement and multiplied the time to compile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "stages/chunk.h"
#include "stages/packet_words.h"
#include "stages/stage.h"

namespace whit::simd {

struct Kernel {
  std::string_view name;
  Stage stage;
  // Returns its function for the chosen target; null where it is no step of its own.
  StepFunction (*find)() = nullptr;
  Parts reads, writes;
};

// Defines find##Name() below; after HWY_ONCE, once for each kernel. The type of a table of targets
// does not allow for noexcept.
#define WHIT_EXPORT_KERNEL(Name) \
  HWY_EXPORT(Name);              \
  StepFunction find##Name() { return HWY_DYNAMIC_DISPATCH(Name); }

// Declares find##Name(), which returns the kernel's function for the chosen target, and its row of
// the table: WHIT_KERNEL(AddShading, "addShading", stage, {what it reads}, {what it writes}).
#define WHIT_KERNEL(Name, name, stage, ...) \
  StepFunction find##Name();                \
  inline constexpr Kernel k##Name { name, Stage::stage, find##Name, __VA_ARGS__ }

// Origin, direction, weight 1, throughput 1, parent = slot, the media around the eye, and the
// number of the path.
WHIT_KERNEL(GenerateRays, "generateRays", generateRays, {Part::pixels}, {Part::rays});

// Rays into Embree's packets, and what comes back (PacketKernels below).
inline constexpr Kernel kPackRays{"packRays", Stage::findIntersections, nullptr, {Part::rays}, {}};
inline constexpr Kernel kUnpackHits{
    "unpackHits", Stage::findIntersections, nullptr, {}, {Part::hits}};

// Surfels from hits, and the kMaterial flags of them all. Absorption in the medium that a ray came
// through is multiplied into its weight and throughput.
WHIT_KERNEL(InterpolateSurfels, "interpolateSurfels", findIntersections, {Part::rays, Part::hits},
            {Part::surfels, Part::rays});

// The width of lobes whose roughness is in a map.
WHIT_KERNEL(LookUpRoughness, "lookUpRoughness", findIntersections,
            {Part::rays, Part::hits, Part::surfels}, {Part::surfels});

// The share of each surface that is there, by number or map.
WHIT_KERNEL(LookUpCoverage, "lookUpCoverage", findIntersections,
            {Part::rays, Part::hits, Part::surfels}, {Part::surfels});

// The share of indirect light that maps of occlusion leave.
WHIT_KERNEL(LookUpOcclusion, "lookUpOcclusion", findIntersections,
            {Part::rays, Part::hits, Part::surfels}, {Part::surfels});

// Factors of mirror and transmission by maps and vertex colors.
WHIT_KERNEL(LookUpMirror, "lookUpMirror", findIntersections,
            {Part::rays, Part::hits, Part::surfels}, {Part::surfels});
WHIT_KERNEL(LookUpTransmission, "lookUpTransmission", findIntersections,
            {Part::rays, Part::hits, Part::surfels}, {Part::surfels});

// Finds what glossy lobes take of the light, and scales diffuse colors to what mirror, Fresnel's
// law, lobe and transmission leave.
WHIT_KERNEL(FindLayers, "findLayers", findIntersections, {Part::rays, Part::surfels},
            {Part::surfels});

// Computes how far above the facet shadow rays start, for surfels between vertex normals that
// differ, and stores it as shadowOffset (Hanika 2021, "Hacking the shadow terminator", Ray Tracing
// Gems II, chapter 4).
WHIT_KERNEL(LiftShadowOrigins, "liftShadowOrigins", findIntersections, {Part::hits, Part::surfels},
            {Part::surfels});

WHIT_KERNEL(WriteEmittedAndReflectiveAmbient, "writeEmittedAndReflectiveAmbient",
            writeEmittedAndReflectiveAmbient, {Part::rays, Part::surfels}, {Part::radiance});

// Multiplies what the fog leaves into the weight and throughput of rays in air. What it adds is
// divided by what it leaves, because a ray's weight multiplies all of its radiance.
WHIT_KERNEL(AddFog, "addFog", writeEmittedAndReflectiveAmbient,
            {Part::rays, Part::hits, Part::surfels, Part::radiance}, {Part::rays, Part::radiance});

// Unshadowed radiance from the chunk's light, and a shadow ray for each slot where it is not zero.
// `visible` is 0 in the slots that have one, and 0 where nothing contributes. Without
// Feature::shadows no rays are written and `visible` is 1 where light falls.
WHIT_KERNEL(FindRadianceAndShadowRays, "findRadianceAndShadowRays", findRadianceAndShadowRays,
            {Part::rays, Part::surfels}, {Part::unshadowed, Part::shadows});

// Writes one sample of the ambient light, and for each slot that reflects some of it a ray as long
// as the occlusion radius, with or without Feature::shadows.
WHIT_KERNEL(FindAmbientAndOcclusionRays, "findAmbientAndOcclusionRays", findRadianceAndShadowRays,
            {Part::rays, Part::surfels}, {Part::unshadowed, Part::shadows});

inline constexpr Kernel kPackShadowRays{
    "packShadowRays", Stage::checkShadows, nullptr, {Part::shadows}, {}};
inline constexpr Kernel kUnpackVisibility{
    "unpackVisibility", Stage::checkShadows, nullptr, {}, {Part::unshadowed}};

// radiance += unshadowed where visible.
WHIT_KERNEL(AddShading, "addShading", addShading, {Part::unshadowed, Part::radiance},
            {Part::radiance});

// Appends the children of the surfels to the chunk's. A child whose throughput is below the cutoff
// is not written; under --roulette it is written by chance, with a larger weight. There must be
// room for one child per slot, or for sampled lobes for lobeSampling().count children per slot.
WHIT_KERNEL(AddReflections, "addReflections", addImpulses, {Part::rays, Part::surfels},
            {Part::children, Part::radiance});
// Samples of the surfels' glossy lobes, each written with its share of the weight; whether it is
// worth tracing is decided as if it were the whole lobe.
WHIT_KERNEL(AddGlossyReflections, "addGlossyReflections", addImpulses, {Part::rays, Part::surfels},
            {Part::children, Part::radiance});
WHIT_KERNEL(AddRefractions, "addRefractions", addImpulses, {Part::rays, Part::surfels},
            {Part::children, Part::radiance});
// Samples of what frosted glass transmits, written and decided on like those of glossy lobes.
WHIT_KERNEL(AddFrostedRefractions, "addFrostedRefractions", addImpulses,
            {Part::rays, Part::surfels}, {Part::children, Part::radiance});
// Rays drawn by the cosine to the normals of diffuse surfels, written and decided on like samples
// of glossy lobes.
WHIT_KERNEL(AddIndirect, "addIndirect", addImpulses, {Part::rays, Part::surfels},
            {Part::children, Part::radiance});
// The way back: parent radiance += weight * radiance, child by child in slot order.
WHIT_KERNEL(ReturnImpulses, "returnImpulses", addImpulses,
            {Part::rays, Part::radiance, Part::parentRadiance}, {Part::parentRadiance});

// Multiplies the radiance of the queue of depth 0 by the weight that its rays have kept on the way
// from the eye to the first surface. Only plans with absorption or fog need it.
WHIT_KERNEL(ReturnToEye, "returnToEye", addImpulses, {Part::rays, Part::radiance},
            {Part::radiance});

// Exposure, tone curve and sRGB (encodeDisplay below).
inline constexpr Kernel kEncodeDisplay{
    "encodeDisplay", Stage::updateImage, nullptr, {Part::radiance}, {Part::codes}};

// In the order of the stages.
inline constexpr std::array kKernels{kGenerateRays,
                                     kPackRays,
                                     kUnpackHits,
                                     kInterpolateSurfels,
                                     kLookUpRoughness,
                                     kLookUpCoverage,
                                     kLookUpOcclusion,
                                     kLookUpMirror,
                                     kLookUpTransmission,
                                     kFindLayers,
                                     kLiftShadowOrigins,
                                     kWriteEmittedAndReflectiveAmbient,
                                     kAddFog,
                                     kFindRadianceAndShadowRays,
                                     kFindAmbientAndOcclusionRays,
                                     kPackShadowRays,
                                     kUnpackVisibility,
                                     kAddShading,
                                     kAddReflections,
                                     kAddGlossyReflections,
                                     kAddRefractions,
                                     kAddFrostedRefractions,
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

// The tables that the numbers of hits refer to.
struct HitTables {
  const TriangleRecord* triangles = nullptr;
  std::size_t triangleCount = 1;  // spheres included
  std::uint32_t firstSphere = 0;  // from here on they are spheres
  const InstanceTransform* instances = nullptr;
  std::size_t instanceCount = 1;
};

// Between columns and Embree's packets. Lanes left over get empty rays, and so do rays that Embree
// cannot take: it ends the program at a NaN or where the sum of the coordinates' sizes is beyond
// `reach` (hard case H28).
struct PacketKernels {
  void (*packRays)(const RayColumns& rays, std::size_t n, float reach, const PacketWords& to);
  void (*packShadowRays)(const ShadowColumns& rays, std::size_t n, float reach,
                         const PacketWords& to);
  // A triangle's number is its own plus that of the first triangle of its class: `triangleBase` has
  // those of the world and of one instance after the other. Without a column of instances all hits
  // are in the world.
  void (*unpackHits)(const PacketWords& from, std::size_t n, const std::uint32_t* triangleBase,
                     const HitColumns& hits);
  // Computes t, u and v of hits on triangles from the corners: the last bits of Embree's depend on
  // the processor. Hits are in the world unless there is a column of instances.
  void (*refineHits)(const HitTables& tables, const RayColumns& rays, std::size_t n,
                     const HitColumns& hits);
  // visible[slot[i]]: 1 where ray i hit nothing, otherwise 0.
  void (*unpackVisibility)(const PacketWords& from, std::size_t n, const std::uint32_t* slot,
                           float* visible);
};
// Returns the kernels for the chosen target.
PacketKernels findPacketKernels();

// Radiance of n slots to packed codes r | g << 8 | b << 16 | 255 << 24.
struct EncodeArgs {
  float exposureScale = 1;
  ToneCurve curve = ToneCurve::none;
  RadianceColumns radiance;
  std::size_t n = 0;
  std::uint32_t* codes = nullptr;
};
void encodeDisplay(const EncodeArgs& args) noexcept;

// Returns the compiled targets that this machine has, best first, by their names for --simd.
std::vector<std::string> availableTargets();
// Chooses a target; "auto" is the best. Returns false if this machine or build lacks it. Kernels
// that were found earlier keep their target. While other threads call kernels, only the target that
// they use may be chosen.
bool chooseTarget(const std::string& name);
// Returns the name of the target that was chosen last.
std::string chosenTarget();

}  // namespace whit::simd
