#include "verdicts/decide_part.h"

#include <algorithm>
#include <cmath>

namespace whit {

namespace {

// So many triangles in a shaft are not looked at one by one: the part is mixed.
constexpr std::size_t kMostCasters = 1 << 14;

class PartDecider {
 public:
  PartDecider(const ShadowWorld& world, std::uint32_t self, const ReceivingTriangle& triangle,
              PartScratch& scratch)
      : world_(world), self_(self), triangle_(triangle), scratch_(scratch) {
    scratch_.casters.clear();
    scratch_.candidates.clear();
    scratch_.remaining.clear();
  }

  PartVerdict decide(const WeightSquare& square, const Receiver& receiver) {
    result_.whole = decideAll(square, receiver);
    if (!result_.known()) result_.whole = Verdict::mixed;
    return result_;
  }

 private:
  // Of all cells; `receiver` is the part.
  Verdict decideAll(const WeightSquare& square, const Receiver& receiver) {
    for (const Candidate& candidate : scratch_.gathered) {
      const CasterRef& ref = candidate.caster;
      if (ref.number == self_) continue;
      const std::uint32_t record = ref.isBox() ? self_ : ref.number;
      const Caster caster(world_.scene.triangles[record], world_.light);
      if (!ref.isBox()) {
        const Meeting meeting = caster.meet(receiver);
        if (meeting == Meeting::never) continue;
        if (meeting == Meeting::always && ref.opaque) return hiddenBy(ref, kCellsASide, 0, 0);
      }
      scratch_.remaining.push_back(static_cast<std::uint32_t>(scratch_.casters.size()));
      scratch_.casters.push_back(caster);
      scratch_.candidates.push_back(candidate);
    }
    return decideBetween(square, kCellsASide, 0, 0, 0, scratch_.remaining.size());
  }

  // Of `side` cells from (column, row) on; what may be in the way is remaining[begin, end), all of
  // which meet them for all that is known.
  Verdict decideBetween(const WeightSquare& square, int side, int column, int row,
                        std::size_t begin, std::size_t end) {
    if (begin == end) return set(side, column, row, Verdict::lit);
    if (side == 1 || square.side * triangle_.longest() <= world_.finest)
      return set(side, column, row, Verdict::mixed);
    return decideQuarters(square, side / 2, column, row, begin, end);
  }

  Verdict decide(const WeightSquare& square, int side, int column, int row, std::size_t begin,
                 std::size_t end) {
    const Receiver receiver = triangle_.piece(square);
    // In the rim: nothing asks for it, and any verdict is as good.
    if (receiver.count == 0) return Verdict::unknown;
    const std::size_t first = scratch_.remaining.size();
    const Shaft shaft(receiver, world_.light, world_.list.size);
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t place = scratch_.remaining[i];
      const auto& [ref, growth] = scratch_.candidates[place];
      if (ref.isBox()) {
        if (shaft.misses(world_.list.solid[ref.number - CasterRef::kBox])) continue;
      } else {
        if (shaft.misses(world_.scene.triangles[ref.number], double{growth})) continue;
        const Meeting meeting = scratch_.casters[place].meet(receiver);
        if (meeting == Meeting::never) continue;
        if (meeting == Meeting::always && ref.opaque) {
          scratch_.remaining.resize(first);
          return hiddenBy(ref, side, column, row);
        }
      }
      scratch_.remaining.push_back(place);
    }
    const Verdict verdict =
        decideBetween(square, side, column, row, first, scratch_.remaining.size());
    scratch_.remaining.resize(first);
    return verdict;
  }

  Verdict decideQuarters(const WeightSquare& square, int side, int column, int row,
                         std::size_t begin, std::size_t end) {
    const double half = square.side / 2;
    Verdict all = Verdict::unknown;
    bool same = true;
    for (int quarter = 0; quarter < 4; ++quarter) {
      const int x = quarter % 2, y = quarter / 2;
      const Verdict verdict = decide({square.u + half * x, square.v + half * y, half}, side,
                                     column + side * x, row + side * y, begin, end);
      if (verdict == Verdict::unknown) continue;
      if (all == Verdict::unknown) all = verdict;
      same = same && verdict == all;
    }
    if (!same) result_.divided = true;
    return same ? all : Verdict::mixed;
  }

  Verdict hiddenBy(const CasterRef& caster, int side, int column, int row) {
    auto& hiders = scratch_.hiders;
    if (std::find(hiders.begin(), hiders.end(), caster.number) == hiders.end()) {
      hiders[scratch_.nextHider++ % hiders.size()] = caster.number;
    }
    return set(side, column, row, Verdict::dark);
  }

  Verdict set(int side, int column, int row, Verdict verdict) {
    for (int y = row; y < row + side; ++y) {
      for (int x = column; x < column + side; ++x) {
        result_.cells[static_cast<std::size_t>(y)] |= static_cast<std::uint32_t>(verdict)
                                                      << (2 * x);
      }
    }
    return verdict;
  }

  const ShadowWorld& world_;
  std::uint32_t self_;
  const ReceivingTriangle& triangle_;
  PartScratch& scratch_;
  PartVerdict result_;
};

}  // namespace

PartVerdict decidePart(const ShadowWorld& world, std::uint32_t triangle, const WeightSquare& part,
                       PartScratch& scratch) {
  const PartVerdict mixed{Verdict::mixed, false, {}};
  const ReceivingTriangle receiving(world.scene.triangles[triangle],
                                    static_cast<int>(std::lround(1 / part.side)));
  if (receiving.isSliver()) return mixed;
  const Receiver receiver = receiving.piece(part);
  if (receiver.count == 0) return mixed;
  for (const std::uint32_t hider : scratch.hiders) {
    if (hider == PartScratch::kNone || hider == triangle) continue;
    const Caster caster(world.scene.triangles[hider], world.light);
    if (caster.meet(receiver) == Meeting::always) return {Verdict::dark, false, {}};
  }
  scratch.gathered.clear();
  world.tree.gather(world.scene, Shaft(receiver, world.light, world.list.size), scratch.gathered);
  if (scratch.gathered.size() > kMostCasters) return mixed;
  return PartDecider(world, triangle, receiving, scratch).decide(part, receiver);
}

}  // namespace whit
