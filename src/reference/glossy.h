// Rays that a rough surface reflects: samples of its GGX lobe.
#pragma once

#include "reference/impulses.h"
#include "sampling/random_streams.h"

namespace whit::reference {

// A normal of the microsurface, drawn from those that can be seen along `view`, each as often as it
// is seen (Heitz 2018, "Sampling the GGX distribution of visible normals", JCGT 7(4); by the
// spherical cap of Dupuy and Benyoub 2023, "Sampling visible GGX normals with spherical caps",
// Computer Graphics Forum 42(8)). The surface's normal is z; `view` is a unit vector above it; of
// width 0 the surface is smooth and the result z.
Vec3d visibleNormal(const Vec3d& view, double alpha, const UnitPoint& at);

// The rays of a surfel, each to count for 1 / number of its lobe.
int lobeRays(const Surfel& surfel, const LobeSampling& sampling);

// The ray mirrored by the visible normal at `at`, with the weight F G2 / G1 (height-correlated
// Smith masking, as in glossyLobe): its mean over the unit square is what the lobe reflects. Weight
// 0 for rays that end in the surface: what several bounces between its facets would rescue is lost.
// `stack` is that of the incoming ray.
Impulse glossyImpulse(const Surfel& surfel, MediaStack stack, const UnitPoint& at,
                      const ShadingChoices& choices = {});

}  // namespace whit::reference
