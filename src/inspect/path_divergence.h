// Counts the pixels where the vector pipeline and the reference followed different paths.
#pragma once

#include <cstdint>
#include <vector>

#include "render/renderer.h"

namespace whit {

// Both pictures of the film's window, with the same options and samples. A pixel has diverged when
// its hits (triangle and instance), shadow bits or sequence of impulses differ between packets and
// reference: there the two saw different surfaces, and no tolerance on values applies.
struct PathComparison {
  Image packets, reference;
  std::vector<std::uint8_t> diverged;  // 0 or 1, as the pixels of the images
  std::uint64_t divergences = 0;
};
PathComparison comparePaths(Renderer& renderer, const Camera& camera, const Film& film);

// The reference's part of the comparison. Options that change only the kernels (packet width, how
// the film is kept) do not change it, so that renderers may share it.
struct ReferencePaths {
  Image image;
  std::vector<std::uint64_t> signatures;  // hashes of the events along each pixel's paths
};
ReferencePaths traceReferencePaths(Renderer& renderer, const Camera& camera, const Film& film);
PathComparison comparePaths(Renderer& renderer, const Camera& camera, const Film& film,
                            const ReferencePaths& reference);

}  // namespace whit
