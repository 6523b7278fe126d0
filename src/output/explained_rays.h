// The rays of a pixel as packets and the scalar reference have traced them, and words for them.
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
  std::vector<std::size_t> counterpart;  // the reference's node for each node of the packets

  // True if the two differ at this node, in its surface, shadows or impulses.
  bool divergesAt(std::size_t node) const;
  // True if they differ at this node and not at its parent.
  bool divergesFirstAt(std::size_t node) const;
};

// `film` gives the size of the picture; see inspect/ray_tree.h.
ExplainedRays explainRays(Renderer& renderer, const Camera& camera, const Film& film, int x, int y);

// Returns the radiance that `own`, radiance of a node, adds to the pixel.
RgbD contributionOf(const RayTree& tree, std::size_t node, const RgbD& own);

std::string materialName(const Scene& scene, std::uint32_t material);
std::string lightName(const Scene& scene, std::uint32_t light);
// The name of the medium in which a ray travels.
std::string mediumName(const Scene& scene, std::uint32_t media);
const char* nameOf(PathEnd end);    // "" for none
std::string colorOf(RayLook look);  // color of its lines, "#ff0000"

// The words that describe a ray of the packets.
struct RayText {
  std::string hit, medium;  // "glass, 2.5 away" and "vacuum"
  // They say whether the reference diverges here, what the ray adds, and how it ends.
  std::vector<std::string> lines;
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
