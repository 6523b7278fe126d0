// The rays of a pixel as both ways to trace have found them, and the words for what is in them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/display.h"
#include "core/text.h"
#include "inspect/ray_lines.h"
#include "io/json_reader.h"

namespace whit {

struct ExplainedRays {
  RayTree packets, reference;
  std::vector<std::size_t> counterpart;  // the reference's node for each of the packets'

  // Where the two part: the surface, shadows or impulses differ.
  bool partsAt(std::size_t node) const;
  bool partsFirstAt(std::size_t node) const;  // and did not before
};

// `film` gives the size of the picture; see inspect/ray_tree.h.
ExplainedRays explainRays(Renderer& renderer, const Camera& camera, const Film& film, int x, int y);

// The radiance that `own` of a node adds to the pixel.
RgbD contributionOf(const RayTree& tree, std::size_t node, const RgbD& own);

std::string materialName(const Scene& scene, std::uint32_t material);
std::string lightName(const Scene& scene, std::uint32_t light);
// The name of the medium in which a ray travels.
std::string mediumName(const Scene& scene, std::uint32_t media);
const char* nameOf(PathEnd end);    // "" for none
std::string colorOf(RayLook look);  // color of its lines, "#ff0000"

// The words that describe a ray of the packets.
struct RayText {
  std::string hit, medium;         // "glass, 2.5 away" and "vacuum"
  std::vector<std::string> lines;  // where the reference parts, what the ray adds, and how it ends
};
RayText describeRay(const Scene& scene, const ExplainedRays& rays, std::size_t node);
// Returns by how many 8-bit codes a channel of the pixel changes at most without the node and all
// below it.
int codesAddedBy(const RayTree& tree, std::size_t node, const RenderOptions& options);
// The tree of the packets for pages, as JSON: nodes with their words, and with what each alone adds
// to the pixel.
Json pageTree(const std::vector<RayText>& words, const ExplainedRays& rays,
              const RenderOptions& options);

inline std::array<std::uint8_t, 3> codesOf(const Rgb& pixel, const RenderOptions& o) {
  return displayCodes(pixel, std::exp2(double{o.exposure.ev}), o.toneCurve);
}
inline std::string textOf(const RgbD& c) { return formatted("%.5f %.5f %.5f", c.x, c.y, c.z); }

}  // namespace whit
