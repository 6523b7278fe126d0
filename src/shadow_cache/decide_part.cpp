#include "shadow_cache/decide_part.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace whit {

using simd::CasterBits;
using simd::CasterBlock;
using simd::kNoCaster;

namespace {

// A shaft with more triangles than this is not examined further: the part is mixed.
constexpr std::size_t kMostCasters = 1 << 14;
constexpr std::size_t kInBlock = CasterBlock::kCasters;

class PartDecider {
 public:
  PartDecider(const ShadowWorld& world, std::uint32_t self, const ReceivingTriangle& triangle,
              PartScratch& scratch)
      : world_(world), self_(self), triangle_(triangle), scratch_(scratch) {
    scratch_.gathered.clear();
    scratch_.opaque.clear();
    scratch_.boxes.clear();
    scratch_.asked.clear();
  }

  PartShadow decide(const WeightSquare& square, const Receiver& receiver) {
    decideAll(square, receiver);
    if (!result_.known()) result_.whole = ShadowState::mixed;
    return result_;
  }

 private:
  // Decides all cells; `receiver` is the part.
  void decideAll(const WeightSquare& square, const Receiver& receiver) {
    const Shaft shaft(receiver, world_.light, world_.list.size);
    world_.tree.gather(world_.kernels, shaft.rounded(), scratch_.gathered);
    takeBoxes();
    keepCasters([&](CasterBlock& block, const Lanes& lanes) {
      CasterBits met = lanes.used;
      world_.kernels.passCasters({&block, 1, nullptr, nullptr, &met}, shaft.sides());
      return met;
    });
    if (scratch_.gathered.size() > kMostCasters) return;
    keepCasters([&](CasterBlock& block, const Lanes& lanes) {
      CasterBits met = 0;
      world_.kernels.setCasters(block, world_.light, receiver);
      const std::size_t hider = world_.kernels.meetCasters(
          {&block, 1, &lanes.used, &lanes.opaque, &met}, world_.light, receiver);
      if (hider != kNoCaster) result_.whole = ShadowState::dark;
      return met;
    });
    if (result_.known()) return;
    loadBlocks(receiver);
    const bool any = scratch_.gathered.size() + scratch_.boxes.size() > 0;
    result_.whole = decideBetween(square, kCellsASide, 0, 0, any, {0, 0, scratch_.boxes.size()});
  }

  // Boxes out of what was gathered, and the triangle itself.
  void takeBoxes() {
    std::erase_if(scratch_.gathered, [this](const Candidate& candidate) {
      const CasterRef& ref = candidate.caster;
      if (ref.isBox()) scratch_.boxes.push_back(ref.number - CasterRef::kBox);
      return ref.isBox() || ref.number == self_;
    });
  }

  struct Lanes {
    CasterBits used = 0, opaque = 0;
  };

  // Loads the next casters that were gathered, from `first` on.
  Lanes load(std::size_t first, CasterBlock& block) const {
    Lanes lanes;
    const std::size_t count = std::min(kInBlock, scratch_.gathered.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [ref, growth] = scratch_.gathered[first + i];
      const TriangleRecord& record = world_.scene.triangles[ref.number];
      for (std::size_t k = 0; k < 9; ++k) {
        block.corner[k / 3][k % 3][i] = double{record.position[k]};
      }
      block.growth[i] = double{growth};
      lanes.used |= static_cast<CasterBits>(1u << i);
      lanes.opaque |= static_cast<CasterBits>(unsigned{ref.opaque} << i);
    }
    return lanes;
  }

  // Keeps those of the gathered casters that `test` returns a bit for, a block at a time, until the
  // part is decided.
  template <typename Test>
  void keepCasters(const Test& test) {
    auto& gathered = scratch_.gathered;
    CasterBlock block{};
    std::size_t kept = 0;
    for (std::size_t first = 0; first < gathered.size() && !result_.known(); first += kInBlock) {
      const Lanes lanes = load(first, block);
      for (unsigned rest = test(block, lanes); rest != 0; rest &= rest - 1) {
        gathered[kept++] = gathered[first + static_cast<std::size_t>(std::countr_zero(rest))];
      }
    }
    gathered.resize(kept);
  }

  // Loads all casters that are left, with the bounds of the part.
  void loadBlocks(const Receiver& receiver) {
    const std::size_t count = (scratch_.gathered.size() + kInBlock - 1) / kInBlock;
    if (scratch_.blocks.size() < count) scratch_.blocks.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Lanes lanes = load(i * kInBlock, scratch_.blocks[i]);
      world_.kernels.setCasters(scratch_.blocks[i], world_.light, receiver);
      scratch_.opaque.push_back(lanes.opaque);
      scratch_.asked.push_back(lanes.used);
    }
  }

  // Possible occluders: the blocks asked[blocks..), and boxes[begin, end).
  struct InTheWay {
    std::size_t blocks, begin, end;
  };

  // Decides `side` cells from (column, row) on, which the given occluders may hide.
  ShadowState decideBetween(const WeightSquare& square, int side, int column, int row, bool any,
                            const InTheWay& way) {
    if (!any) return set(side, column, row, ShadowState::lit);
    if (side == 1 || square.side * triangle_.longest() <= world_.finest)
      return set(side, column, row, ShadowState::mixed);
    return decideQuarters(square, side / 2, column, row, way);
  }

  ShadowState decide(const WeightSquare& square, int side, int column, int row,
                     const InTheWay& way) {
    const Receiver receiver = triangle_.piece(square);
    // The piece lies in the rim, which nothing looks up, so any state will do.
    if (receiver.count == 0) return ShadowState::unknown;
    const std::size_t asked = scratch_.asked.size(), boxes = scratch_.boxes.size();
    const ShadowState state = decidePiece(receiver, square, side, column, row, way);
    scratch_.asked.resize(asked);
    scratch_.boxes.resize(boxes);
    return state;
  }

  ShadowState decidePiece(const Receiver& receiver, const WeightSquare& square, int side,
                          int column, int row, const InTheWay& way) {
    const std::size_t count = scratch_.opaque.size(), mine = scratch_.asked.size();
    scratch_.asked.resize(mine + count);
    const simd::CasterQuestion question{scratch_.blocks.data(), count,
                                        scratch_.asked.data() + way.blocks, scratch_.opaque.data(),
                                        scratch_.asked.data() + mine};
    const std::size_t hider = world_.kernels.meetCasters(question, world_.light, receiver);
    if (hider != kNoCaster) return set(side, column, row, ShadowState::dark);
    const Shaft shaft(receiver, world_.light, world_.list.size);
    bool any = world_.kernels.passCasters(question, shaft.sides());
    const std::size_t begin = scratch_.boxes.size();
    for (std::size_t i = way.begin; i < way.end; ++i) {
      const std::uint32_t box = scratch_.boxes[i];
      if (!shaft.misses(world_.list.solid[box])) scratch_.boxes.push_back(box);
    }
    const std::size_t end = scratch_.boxes.size();
    any = any || end > begin;
    return decideBetween(square, side, column, row, any, {mine, begin, end});
  }

  ShadowState decideQuarters(const WeightSquare& square, int side, int column, int row,
                             const InTheWay& way) {
    const double half = square.side / 2;
    ShadowState all = ShadowState::unknown;
    bool same = true;
    for (int quarter = 0; quarter < 4; ++quarter) {
      const int x = quarter % 2, y = quarter / 2;
      const ShadowState state = decide({square.u + half * x, square.v + half * y, half}, side,
                                       column + side * x, row + side * y, way);
      if (state == ShadowState::unknown) continue;
      if (all == ShadowState::unknown) all = state;
      same = same && state == all;
    }
    if (!same) result_.divided = true;
    return same ? all : ShadowState::mixed;
  }

  ShadowState set(int side, int column, int row, ShadowState state) {
    for (int y = row; y < row + side; ++y) {
      for (int x = column; x < column + side; ++x) {
        const int word = y * kWordsARow + x / kCellsAWord;
        result_.cells[static_cast<std::size_t>(word)] |= static_cast<std::uint32_t>(state)
                                                         << (2 * (x % kCellsAWord));
      }
    }
    return state;
  }

  const ShadowWorld& world_;
  std::uint32_t self_;
  const ReceivingTriangle& triangle_;
  PartScratch& scratch_;
  PartShadow result_;
};

}  // namespace

PartShadow decidePart(const ShadowWorld& world, std::uint32_t triangle, const WeightSquare& part,
                      PartScratch& scratch) {
  const PartShadow mixed{ShadowState::mixed, false, {}};
  const ReceivingTriangle receiving(world.scene.triangles[triangle],
                                    static_cast<int>(std::lround(1 / part.side)));
  if (receiving.isSliver()) return mixed;
  const Receiver receiver = receiving.piece(part);
  if (receiver.count == 0) return mixed;
  return PartDecider(world, triangle, receiving, scratch).decide(part, receiver);
}

}  // namespace whit
