// Decides one part of a triangle, and its cells.
#pragma once

#include <array>
#include <vector>

#include "shadow_cache/caster_tree.h"

namespace whit {

// The state of a whole part, or of its cells if they do not share one.
struct PartShadow {
  ShadowState whole = ShadowState::unknown;
  bool divided = false;
  std::array<std::uint32_t, kWordsAPlace> cells{};  // as ShadowCacheView::cells
  bool known() const { return divided || whole != ShadowState::unknown; }
};

// A worker's own memory.
struct PartScratch {
  std::vector<Candidate> gathered;
  // The gathered triangles in blocks, as kernels take them, and their opaque lanes.
  std::vector<simd::CasterBlock> blocks;
  std::vector<simd::CasterBits> opaque;
  std::vector<std::uint32_t> boxes;     // one depth after the other
  std::vector<simd::CasterBits> asked;  // of the blocks, likewise
};

// The possible occluders of a light's rays.
struct ShadowWorld {
  const Scene& scene;
  const CasterList& list;
  const CasterTree& tree;
  const LightPoint& light;
  const simd::CasterKernels& kernels;
  double finest;  // cells with edges of no more are not divided
};

// `part` is one of those that divide the triangle.
PartShadow decidePart(const ShadowWorld& world, std::uint32_t triangle, const WeightSquare& part,
                      PartScratch& scratch);

}  // namespace whit
