// The verdict of one part of a triangle, and of its cells.
#pragma once

#include <array>
#include <vector>

#include "verdicts/caster_tree.h"

namespace whit {

// Of the whole part, or where its cells do not share one, of these.
struct PartVerdict {
  Verdict whole = Verdict::unknown;
  bool divided = false;
  std::array<std::uint32_t, kCellsASide> cells{};  // as VerdictView::cells
  bool known() const { return divided || whole != Verdict::unknown; }
};

// A worker's own memory.
struct PartScratch {
  std::vector<Candidate> gathered;
  // Of them those that may meet the part.
  std::vector<Candidate> candidates;
  std::vector<Caster> casters;
  std::vector<std::uint32_t> remaining;  // places among these, one depth after the other
  // What has hidden other parts of late: likely to hide the next one.
  static constexpr std::size_t kRemembered = 4;
  std::array<std::uint32_t, kRemembered> hiders{kNone, kNone, kNone, kNone};
  std::size_t nextHider = 0;
  static constexpr std::uint32_t kNone = 0xffffffffu;
};

// What stands in the way of a light's rays.
struct ShadowWorld {
  const Scene& scene;
  const CasterList& list;
  const CasterTree& tree;
  const LightPoint& light;
  double finest;  // cells with edges of no more are not divided
};

// `part` is one of those that divide the triangle.
PartVerdict decidePart(const ShadowWorld& world, std::uint32_t triangle, const WeightSquare& part,
                       PartScratch& scratch);

}  // namespace whit
