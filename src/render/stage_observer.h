// Sees each chunk of rays after each stage: comparison with the reference, debug views, ray logs.
#pragma once

#include <cstdint>
#include <vector>

#include "core/index.h"
#include "stages/chunk.h"
#include "stages/stage.h"

namespace whit {

class StageObserver {
 public:
  virtual ~StageObserver() = default;
  virtual void after(Stage stage, const Chunk& chunk) = 0;
};

// Follows, for observers, which pixel each ray of each queue belongs to.
class PixelTracker {
 public:
  // To be called with every stage that an observer sees.
  void follow(Stage stage, const Chunk& chunk) {
    if (stage == Stage::generateRays) {
      levels_.assign(1, {chunk.pixels.begin(), chunk.pixels.end()});
    } else if (stage == Stage::addImpulses) {
      const std::size_t depth = chunk.depth;
      levels_.resize(depth + 2);
      std::vector<std::uint32_t>& next = levels_[depth + 1];
      next.clear();
      for (const auto i : indices(chunk.childCount)) {
        next.push_back(levels_[depth][chunk.first + chunk.children.parent[i]]);
      }
    }
  }

  // The packed pixel that slot i of the chunk is traced for.
  std::uint32_t pixel(const Chunk& chunk, std::size_t i) const {
    return entryOf(levels_, chunk.depth)[chunk.first + i];
  }

 private:
  std::vector<std::vector<std::uint32_t>> levels_;  // a queue a depth
};

}  // namespace whit
