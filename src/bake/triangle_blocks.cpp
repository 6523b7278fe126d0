#include "bake/triangle_blocks.h"

#include <algorithm>

#include "core/worker_pool.h"

namespace whit {

namespace {

constexpr std::size_t kBlocksAtATime = 4096;

Box boxOfTriangles(const TriangleRecord* first, std::uint32_t count) {
  Box box;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float* p = first[i].position;
    for (int corner = 0; corner < 3; ++corner, p += 3) box.add({p[0], p[1], p[2]});
  }
  return box;
}

// Calls make(i) for all i below `count`, on several threads where that pays.
template <typename Make>
void forBlocks(int threads, std::size_t count, const Make& make) {
  const auto part = [&](std::size_t i, int) {
    const std::size_t end = std::min(count, (i + 1) * kBlocksAtATime);
    for (std::size_t block = i * kBlocksAtATime; block < end; ++block) make(block);
  };
  const std::size_t parts = (count + kBlocksAtATime - 1) / kBlocksAtATime;
  if (parts == 1) return part(0, 0);
  parallelFor(threads, parts, part);
}

}  // namespace

TriangleBlocks::TriangleBlocks(const Scene& scene, const Geometry& geometry, int threads)
    : triangles_(geometry.classBegin.back()) {
  if (triangles_ == 0) return;
  const TriangleRecord* const own = scene.triangles.data() + geometry.firstTriangle;
  std::uint32_t below = triangles_;
  do {
    std::vector<Box> boxes((std::size_t{below} + kChildren - 1) / kChildren);
    forBlocks(threads, boxes.size(), [&](std::size_t block) {
      const auto first = static_cast<std::uint32_t>(block * kChildren);
      const std::uint32_t count = std::min(kChildren, below - first);
      if (levels_.empty()) {
        boxes[block] = boxOfTriangles(own + first, count);
        return;
      }
      for (std::uint32_t i = first; i < first + count; ++i) {
        boxes[block].add(levels_.back()[i].lower);
        boxes[block].add(levels_.back()[i].upper);
      }
    });
    below = static_cast<std::uint32_t>(boxes.size());
    levels_.push_back(std::move(boxes));
  } while (below > 1);
}

}  // namespace whit
