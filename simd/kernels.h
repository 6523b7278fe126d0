// The vector stages, seen from the rest of the program. Each call runs over the slots [0, n) of its
// columns with the best SIMD target of the CPU (or the one that was chosen), dispatched once a
// call. Kernels are noexcept and allocate nothing. Slots from n to the next multiple of 16 may be
// overwritten with anything; their hits must be misses.
//
// The scalar twin of every kernel is in src/reference, written to the same formulas in double.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/effects.h"
#include "core/options.h"
#include "sampling/random_streams.h"
#include "stages/columns.h"
#include "stages/packet_words.h"
#include "stages/shading_tables.h"

namespace whit::simd {

// A CameraFrame in float, for one sample of the pattern.
struct CameraRays {
  Vec3f eye, forward, right, up;
  float halfWidth = 0, halfHeight = 0;
  float sampleX = 0.5f, sampleY = 0.5f;
  std::uint32_t sampleNumber = 0;  // the sample's place in the pattern
  std::uint32_t media = 0;         // CameraFrame's
  bool orthographic = false;
  float coneWidth = 0;  // RayCone's, where there are cones
};

// Pixels are packed (core/pixel.h). Writes origin, direction, weight 1, throughput 1, parent =
// slot, the media around the eye, and the number of the path.
void generateRays(const CameraRays& camera, const std::uint32_t* pixels, std::size_t n,
                  const RayColumns& rays) noexcept;

// Rays [0, n) into Embree's packets, and what comes back. Lanes left over get empty rays, and so do
// rays that Embree cannot take: it ends the program at a NaN or where the sum of the coordinates'
// sizes is beyond `reach` (hard case H28).
void packRays(const RayColumns& rays, std::size_t n, float reach, const PacketWords& to) noexcept;
void packShadowRays(const ShadowColumns& rays, std::size_t n, float reach,
                    const PacketWords& to) noexcept;
// Of scenes without instances: a triangle's number is that of its class's first one plus its own.
void unpackHits(const PacketWords& from, std::size_t n, const std::uint32_t* triangleBase,
                const HitColumns& hits) noexcept;
// visible[slot[i]]: 1 where ray i met nothing, otherwise 0.
void unpackVisibility(const PacketWords& from, std::size_t n, const std::uint32_t* slot,
                      float* visible) noexcept;

// Second half of findIntersections: surfels from hits. Absorption in the medium that a ray came
// through is multiplied into its weight and throughput. Returns the kMaterial flags that the
// material of some surfel has: what none has, the stages that follow can leave out. Where there are
// cones, `coneSpread` is that of all rays.
std::uint32_t interpolateSurfels(const ShadingTables& tables, EffectSet effects,
                                 const RayColumns& rays, const HitColumns& hits, std::size_t n,
                                 const SurfelColumns& surfels, float coneSpread = 0) noexcept;

// Of surfels between vertex normals that differ: how far shadow rays start above the facet, into
// the lift columns (Hanika 2021, "Hacking the shadow terminator", Ray Tracing Gems II, chapter 4).
void liftShadowOrigins(const ShadingTables& tables, EffectSet effects, const HitColumns& hits,
                       std::size_t n, const SurfelColumns& surfels) noexcept;

void writeEmittedAndReflectiveAmbient(const ShadingTables& tables, EffectSet effects,
                                      const RayColumns& rays, const SurfelColumns& surfels,
                                      std::size_t n, const RadianceColumns& radiance) noexcept;

// Unshadowed radiance from one light, and a shadow ray for each slot where it is not zero. Returns
// the number of shadow rays; `visible` is 0 in the slots that have one, and 0 where nothing
// contributes. Without Effect::shadows no rays are written and `visible` is 1 where light falls.
std::size_t findRadianceAndShadowRays(const ShadingTables& tables, EffectSet effects,
                                      const Light& light, const RayColumns& rays,
                                      const SurfelColumns& surfels, std::size_t n,
                                      const UnshadowedColumns& unshadowed,
                                      const ShadowColumns& shadows) noexcept;

// radiance += unshadowed where visible.
void addShading(const UnshadowedColumns& unshadowed, std::size_t n,
                const RadianceColumns& radiance) noexcept;

// Children of the surfels, appended to `children` from slot `first` on; return their number. A
// child whose throughput is below `cutoff` is not written. `children` must have room for n.
std::size_t addReflections(const ShadingTables& tables, EffectSet effects, float cutoff,
                           const RayColumns& rays, const SurfelColumns& surfels, std::size_t n,
                           const RayColumns& children, std::size_t first) noexcept;
std::size_t addRefractions(const ShadingTables& tables, EffectSet effects, float cutoff,
                           const RayColumns& rays, const SurfelColumns& surfels, std::size_t n,
                           const RayColumns& children, std::size_t first) noexcept;

// Samples of the surfels' glossy lobes, each written with its share of the weight; whether it is
// worth tracing is decided as if it were the whole lobe. `children` must have room for n times
// sampling.count; paths and glossy columns must be there.
std::size_t addGlossyReflections(const ShadingTables& tables, EffectSet effects, float cutoff,
                                 const LobeSampling& sampling, const RayColumns& rays,
                                 const SurfelColumns& surfels, std::size_t n,
                                 const RayColumns& children, std::size_t first) noexcept;

// The way back: parent radiance += weight * radiance, child by child in slot order.
void returnImpulses(const RayColumns& children, const RadianceColumns& childRadiance, std::size_t n,
                    const RadianceColumns& parentRadiance) noexcept;

// Exposure, tone curve and sRGB: radiance to packed codes r | g << 8 | b << 16 | 255 << 24.
void encodeDisplay(float exposureScale, ToneCurve curve, SrgbEncoding encoding,
                   const RadianceColumns& radiance, std::size_t n, std::uint32_t* codes) noexcept;

// Names as in --simd. chooseTarget("auto") takes the best; false: this machine or build lacks it.
// Not thread-safe; call before any kernel runs.
std::vector<std::string> availableTargets();
bool chooseTarget(const std::string& name);
std::string chosenTarget();

}  // namespace whit::simd
