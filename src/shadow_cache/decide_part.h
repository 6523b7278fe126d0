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

// Triangles in blocks, as kernels take them.
struct CasterBlocks {
  std::vector<simd::CasterBlock> blocks;
  std::vector<std::uint32_t> numbers;  // kCasters a block
  std::vector<simd::CasterBits> opaque;
  std::size_t count = 0;  // of casters

  void clear() { count = 0; }
  // One more, from place `i` of a block.
  void add(const CasterRef& caster, const simd::CasterBlock& from, std::size_t i);
  std::size_t blockCount() const {
    return (count + simd::CasterBlock::kCasters - 1) / simd::CasterBlock::kCasters;
  }
};

// A worker's own memory.
struct PartScratch {
  // Triangles that have hidden other parts recently and are likely to hide the next one.
  simd::CasterBlock hiders{};
  std::array<std::uint32_t, simd::CasterBlock::kCasters> hiderNumbers{};
  std::size_t hidden = 0;  // that added one to them
  std::vector<Candidate> gathered;
  // The triangles that may hide the part, and boxes among them.
  CasterBlocks casters;
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
