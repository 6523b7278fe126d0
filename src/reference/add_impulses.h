// addImpulses: the rays that a surfel sends on, mirrored and refracted (Whitted 1980, "An improved
// illumination model for shaded display"), samples of the GGX lobe of a rough one, of what frosted
// glass transmits and of what a diffuse one sees.
#pragma once

#include <algorithm>
#include <array>

#include "core/options.h"
#include "reference/media.h"
#include "reference/world.h"
#include "sampling/random_streams.h"
#include "stages/lobes.h"

namespace whit::reference {

// A ray whose radiance, times `weight`, is part of the surfel's. No ray: weight 0.
struct Impulse {
  RgbD weight;
  Ray ray;  // unit direction
  MediaStack media = 0;
};

struct Impulses {
  Impulse reflected, refracted;

  // Returns an empty impulse for a kind that exists for samples of a lobe only.
  Impulse of(RayKind kind) const {
    if (kind == RayKind::reflection) return reflected;
    return kind == RayKind::refraction ? refracted : Impulse();
  }
};
// Returns the branch number (childStream) of mirrored or refracted rays.
constexpr std::uint32_t branchOf(RayKind kind) {
  return kind == RayKind::refraction ? kRefractedBranch : kMirroredBranch;
}

// `stack` is that of the incoming ray, `crossing` what it makes of the surfel. A hidden surface
// lets the ray pass as it is. A dielectric's weights add up to 1 at most, to 1 with a transmission
// of 1, whatever its coat (Material).
Impulses findImpulses(const Scene& scene, EffectSet effects, const Surfel& surfel,
                      const Crossing& crossing, MediaStack stack,
                      const ShadingChoices& choices = {});

// Points of the unit square that the samples of a surfel's glossy lobe are drawn at.
struct LobePoints {
  std::uint32_t path = 0;
  LobeSampling sampling = {};
};

LobePoints lobePointsOf(const Chunk& chunk, std::size_t slot);

// The mirror's reflectance towards the viewer.
RgbD mirrorOf(const Material& material, EffectSet effects, const Surfel& surfel);

// The share of its lobe that the mirrored ray stands for.
double mirroredShare(const Material& material, EffectSet effects, const Surfel& surfel);

// Returns the share of the light of lamps that a coat leaves for the lobe below.
RgbD underCoat(const Material& material, EffectSet effects, const Surfel& surfel);

// Sets what mirror and interface leave for the lobe, and how frosted glass scatters light.
void findLobes(const Material& material, EffectSet effects, const Crossing& crossing,
               const ShadingChoices& choices, Surfel& surfel);

// Finds what the layers of the surface leave for each other (scene/material.h has the rule): sets
// the lobe's share, and scales the diffuse color, so that a surface never sends out more light than
// it gets.
void findLayers(const Scene& scene, EffectSet effects, const Crossing& crossing,
                const ShadingChoices& choices, const LobePoints& points, Surfel& surfel);

// A reflected direction stays at least this far, as a sine, above the surface, and a refracted one
// below: shading normals would send some through to the wrong side (hard case H32). Less than the
// viewer's own elevation, so that reflections are left alone where the normals agree; of refracted
// rays, those are moved that leave a dense medium within 0.6 degrees of the surface.
double smallestElevation(const Surfel& surfel);
// The same for a direction that is this far from the surface of its own normal.
double smallestElevation(double elevation);
// The unit direction `r` raised to `elevation` above the plane of `normal` if it lies lower.
Vec3d raised(const Vec3d& r, const Vec3d& normal, double elevation);

// The rays that sample a surfel's glossy lobe: a smooth one is sampled by one.
int glossyRays(const Surfel& surfel, const LobeSampling& sampling);

// The ray mirrored by the visible normal at `at`, with the weight F G2 / G1 (height-correlated
// Smith masking, as in glossyLobe) times what lies above leaves: its mean over the unit square is
// what the lobe reflects. Weight 0 for rays that end in the surface: what several bounces between
// its facets would rescue is lost. `stack` is that of the incoming ray. The facets of a frosted
// interface reflect by its indices of refraction.
Impulse glossyImpulse(const Surfel& surfel, MediaStack stack, const UnitPoint& at,
                      const ShadingChoices& choices = {});

// The ray that the visible normal at `at` lets pass, the same one as in glossyImpulse: refracted by
// an interface with the weight (1 - F) G1 (Walter et al. 2007, eq. 41, for visible normals), and by
// a sheet with 1 - F in the direction that it mirrors, mirrored once more at the sheet. A sheet
// masks nothing: what its facets send into it leaves it at the far side. As for smooth glass the
// radiance is not scaled by the square of the indices' ratio, which cancels where light leaves the
// glass again.
Impulse frostedImpulse(const Surfel& surfel, MediaStack stack, const UnitPoint& at,
                       const ShadingChoices& choices = {});

// A ray drawn by the cosine to the shading normal, with the weight of the albedo: its mean over the
// unit square is what the diffuse surface reflects of the radiance around it. `stack` is that of
// the incoming ray.
Impulse indirectImpulse(const Surfel& surfel, MediaStack stack, const UnitPoint& at,
                        const ShadingChoices& choices = {});

// Returns the factor for samples of the lobe. At the surface that the eye sees it is the occlusion
// map: light that went around more corners has met what the map stands for, if it is there. Behind
// it one lobe is chosen (stages/lobes.h) and counts for both; the factor of the other one is 0.
// What glass transmits is neither occluded nor part of that choice.
double factorOfLobe(const Lobe& lobe, const Material& material, EffectSet effects,
                    const Surfel& surfel, int depth, std::uint32_t path);

// A lobe as it is sampled here.
struct SampledLobe {
  Lobe lobe;
  // The rays of a surfel, each to count for 1 / their number of the lobe.
  int (*rays)(const Surfel& surfel, const LobeSampling& sampling);
  // One of them, drawn at a point of the unit square, as if it were the whole lobe.
  Impulse (*impulse)(const Surfel& surfel, MediaStack stack, const UnitPoint& at,
                     const ShadingChoices& choices);
};
inline constexpr std::array kSampledLobes{
    SampledLobe{kGlossyLobe, glossyRays, glossyImpulse},
    SampledLobe{kFrostedLobe, glossyRays, frostedImpulse},
    SampledLobe{kDiffuseLobe,
                [](const Surfel&, const LobeSampling& s) { return static_cast<int>(s.count); },
                indirectImpulse}};

// True if an impulse of this contribution on the path with this number is traced: by --cutoff, or
// by Russian roulette at --roulette (sampling/random_streams.h).
bool survives(const RenderOptions& options, double contribution, std::uint32_t path);
// By how much its weight grows then, and its contribution.
double growthOfSurvivors(const RenderOptions& options, double contribution);

// The row that the step writes for a child. Throughput is what decides whether it is worth tracing;
// samples of a lobe count there as if each were the whole.
RayRow addImpulses(const World& world, const Chunk& chunk, std::size_t child);

}  // namespace whit::reference
