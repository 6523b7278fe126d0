#include "shadow_cache/decide_part.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

namespace whit {

using simd::CasterBits;
using simd::CasterBlock;
using simd::kNoCaster;

namespace {

// A shaft with more triangles than this is not examined further: the part is mixed.
constexpr std::size_t kMostCasters = 1 << 14;
constexpr std::size_t kInBlock = CasterBlock::kCasters;

void setCorners(CasterBlock& block, std::size_t i, const TriangleRecord& record) {
  for (std::size_t k = 0; k < 9; ++k) {
    block.corner[k / 3][k % 3][i] = double{record.position[k]};
  }
}

void copyCaster(const CasterBlock& from, std::size_t i, CasterBlock& to, std::size_t j) {
  const auto copy = [i, j](const CasterBlock::Row& a, CasterBlock::Row& b) { b[j] = a[i]; };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < 3; ++k) {
      copy(from.corner[k][axis], to.corner[k][axis]);
      copy(from.gradient[k][axis], to.gradient[k][axis]);
    }
    copy(from.normal[axis], to.normal[axis]);
    copy(from.edgeBound[axis], to.edgeBound[axis]);
  }
  copy(from.lightHeight, to.lightHeight);
  copy(from.slopeBound, to.slopeBound);
  copy(from.heightBound, to.heightBound);
  copy(from.growth, to.growth);
}

CasterBits firstBits(std::size_t count) { return static_cast<CasterBits>((1u << count) - 1); }

class PartDecider {
 public:
  PartDecider(const ShadowWorld& world, std::uint32_t self, const ReceivingTriangle& triangle,
              PartScratch& scratch)
      : world_(world),
        self_(self),
        triangle_(triangle),
        scratch_(scratch),
        light_{world.light.position, world.light.directional} {
    scratch_.gathered.clear();
    scratch_.casters.clear();
    scratch_.boxes.clear();
    scratch_.asked.clear();
  }

  PartShadow decide(const WeightSquare& square, const Receiver& receiver) {
    if (!hiddenAsOthers(receiver)) decideAll(square, receiver);
    if (!result_.known()) result_.whole = ShadowState::mixed;
    return result_;
  }

 private:
  simd::CasterReceiver seenBy(const Receiver& receiver) const {
    return {receiver.corners.data(), receiver.count, receiver.center, receiver.radius,
            receiver.reach};
  }

  // By what has hidden others.
  bool hiddenAsOthers(const Receiver& receiver) {
    CasterBits asked = firstBits(std::min(scratch_.hidden, kInBlock)), met = 0;
    for (std::size_t i = 0; i < kInBlock; ++i) {
      if (scratch_.hiderNumbers[i] == self_) asked &= static_cast<CasterBits>(~(1u << i));
    }
    if (asked == 0) return false;
    world_.kernels.setCasters(scratch_.hiders, light_, seenBy(receiver));
    const std::size_t hider =
        world_.kernels.meetCasters({&scratch_.hiders, 1, &asked, &asked, &met}, light_,
                                   receiver.corners.data(), receiver.count);
    if (hider == kNoCaster) return false;
    result_.whole = ShadowState::dark;
    return true;
  }

  // Decides all cells; `receiver` is the part.
  void decideAll(const WeightSquare& square, const Receiver& receiver) {
    const Shaft shaft(receiver, world_.light, world_.list.size);
    world_.tree.gather(world_.kernels, shaft.rounded(), scratch_.gathered);
    takeBoxes();
    passBy(shaft);
    if (scratch_.gathered.size() > kMostCasters) return;
    const std::uint32_t hider = keepMet(receiver);
    if (hider != self_) {
      result_.whole = hiddenBy(hider, kCellsASide, 0, 0);
      return;
    }
    auto& asked = scratch_.asked;
    const std::size_t blocks = scratch_.casters.blockCount();
    asked.assign(blocks, firstBits(kInBlock));
    if (const std::size_t rest = scratch_.casters.count % kInBlock; rest != 0) {
      asked.back() = firstBits(rest);
    }
    const bool any = blocks + scratch_.boxes.size() > 0;
    result_.whole = decideBetween(square, kCellsASide, 0, 0, any, {0, 0, scratch_.boxes.size()});
  }

  // Boxes out of what was gathered, and the triangle itself.
  void takeBoxes() {
    std::size_t kept = 0;
    for (const Candidate& candidate : scratch_.gathered) {
      const CasterRef& ref = candidate.caster;
      if (ref.isBox()) {
        scratch_.boxes.push_back(ref.number - CasterRef::kBox);
      } else if (ref.number != self_) {
        scratch_.gathered[kept++] = candidate;
      }
    }
    scratch_.gathered.resize(kept);
  }

  // The next casters that were gathered, from `first` on. Returns how many.
  std::size_t load(std::size_t first, CasterBlock& block) const {
    const std::size_t count = std::min(kInBlock, scratch_.gathered.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [ref, growth] = scratch_.gathered[first + i];
      setCorners(block, i, world_.scene.triangles[ref.number]);
      block.growth[i] = double{growth};
    }
    return count;
  }

  // Leaves out of what was gathered what the shaft passes by.
  void passBy(const Shaft& shaft) {
    auto& gathered = scratch_.gathered;
    CasterBlock block{};
    std::size_t kept = 0;
    for (std::size_t first = 0; first < gathered.size(); first += kInBlock) {
      CasterBits met = firstBits(load(first, block));
      world_.kernels.passCasters({&block, 1, nullptr, nullptr, &met}, shaft.sides());
      for (unsigned rest = met; rest != 0; rest &= rest - 1) {
        gathered[kept++] = gathered[first + static_cast<std::size_t>(std::countr_zero(rest))];
      }
    }
    gathered.resize(kept);
  }

  // Collects the remaining triangles that rays may hit into blocks. Returns the number of a
  // triangle that hides the part, or else the part's own triangle.
  std::uint32_t keepMet(const Receiver& receiver) {
    const auto& gathered = scratch_.gathered;
    CasterBlock block{};
    for (std::size_t first = 0; first < gathered.size(); first += kInBlock) {
      const std::size_t count = load(first, block);
      CasterBits opaque = 0, met = 0;
      for (std::size_t i = 0; i < count; ++i) {
        opaque |= static_cast<CasterBits>(unsigned{gathered[first + i].caster.opaque} << i);
      }
      const CasterBits asked = firstBits(count);
      world_.kernels.setCasters(block, light_, seenBy(receiver));
      const std::size_t hider = world_.kernels.meetCasters(
          {&block, 1, &asked, &opaque, &met}, light_, receiver.corners.data(), receiver.count);
      if (hider != kNoCaster) return gathered[first + hider].caster.number;
      for (unsigned rest = met; rest != 0; rest &= rest - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(rest));
        scratch_.casters.add(gathered[first + i].caster, block, i);
      }
    }
    return self_;
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
    const CasterBlocks& casters = scratch_.casters;
    const std::size_t count = casters.blockCount(), mine = scratch_.asked.size();
    scratch_.asked.resize(mine + count);
    const simd::CasterQuestion question{casters.blocks.data(), count,
                                        scratch_.asked.data() + way.blocks, casters.opaque.data(),
                                        scratch_.asked.data() + mine};
    const std::size_t hider =
        world_.kernels.meetCasters(question, light_, receiver.corners.data(), receiver.count);
    if (hider != kNoCaster) return hiddenBy(casters.numbers[hider], side, column, row);
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

  ShadowState hiddenBy(std::uint32_t caster, int side, int column, int row) {
    auto& numbers = scratch_.hiderNumbers;
    const std::span known(numbers.data(), std::min(scratch_.hidden, kInBlock));
    if (std::find(known.begin(), known.end(), caster) == known.end()) {
      const std::size_t place = scratch_.hidden++ % kInBlock;
      numbers[place] = caster;
      setCorners(scratch_.hiders, place, world_.scene.triangles[caster]);
    }
    return set(side, column, row, ShadowState::dark);
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
  simd::CasterLight light_;
  PartShadow result_;
};

}  // namespace

void CasterBlocks::add(const CasterRef& caster, const CasterBlock& from, std::size_t i) {
  const std::size_t block = count / kInBlock, place = count % kInBlock;
  if (block == blocks.size()) {
    blocks.emplace_back();
    opaque.emplace_back();
    numbers.resize(numbers.size() + kInBlock);
  }
  if (place == 0) opaque[block] = 0;
  copyCaster(from, i, blocks[block], place);
  opaque[block] |= static_cast<CasterBits>(unsigned{caster.opaque} << place);
  numbers[count++] = caster.number;
}

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
