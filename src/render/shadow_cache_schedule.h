// Fills the shadow cache for frames of so many samples that proofs take less time than the rays
// that they save.
#pragma once

#include <cstdint>
#include <optional>

#include "render/renderer.h"

namespace whit {

// The least number of samples of pixels in a frame for which the shadow cache saves time.
double samplesThatPay(const Scene& scene);

// Before a frame: one of a single sample, which overwrites `film`, requests what all of its samples
// will, in tables of at most this many bytes. Returns the milliseconds that filling them took, or
// nothing where the cache is not used. An audit uses it for every frame, with all samples.
std::optional<double> prepareShadowCache(Renderer& renderer, std::uint64_t mostBytes,
                                         const Camera& camera, Film& film);

}  // namespace whit
