// The rays of a pixel as both ways to trace have found them, and the words for what is in them.
#pragma once

#include <string>
#include <vector>

#include "inspect/ray_tree.h"

namespace whit::cli {

struct ExplainedRays {
  RayTree packets, reference;
  std::vector<std::size_t> counterpart;  // of the packets' nodes in the reference

  // Where the two part: the surface, shadows or impulses differ.
  bool partsAt(std::size_t node) const;
  bool partsFirstAt(std::size_t node) const;  // and did not before
};

// `film` gives the size of the picture; see inspect/ray_tree.h.
ExplainedRays explainRays(Renderer& renderer, const Camera& camera, const Film& film, int x, int y);

// The radiance that `own` of a node adds to the pixel.
RgbD addedBy(const RayTree& tree, std::size_t node, const RgbD& own);

std::string materialName(const Scene& scene, std::uint32_t material);
std::string lightName(const Scene& scene, std::uint32_t light);
// The name of the medium in which a ray travels.
std::string mediumName(const Scene& scene, std::uint32_t media);
const char* nameOf(PathEnd end);  // "" for none
// "glass, 2.5 away", or that it leaves the scene.
std::string metText(const Scene& scene, const RayNode& node);
// How the reference goes on where it parts.
std::string partingText(const Scene& scene, const ExplainedRays& rays, std::size_t node);

}  // namespace whit::cli
