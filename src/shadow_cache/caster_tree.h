// Bounding boxes of the surfaces that cast shadows, to gather those that a shaft of shadow rays may
// hit. There is one tree for each light, because each triangle's box is grown by its influence
// there.
#pragma once

#include <cstdint>
#include <vector>

#include "core/huge_vector.h"
#include "core/vec3.h"
#include "shadow_cache/shaft.h"

namespace whit {

// A triangle of the world, by its number in Scene::triangles; or a box that is taken for solid, and
// does not hide anything for sure: around a sphere or an instance.
struct CasterRef {
  static constexpr std::uint32_t kBox = 0x80000000u;
  std::uint32_t number = 0;  // or kBox + its place among the solid boxes
  bool opaque = false;       // all over: no mask
  bool isBox() const { return (number & kBox) != 0; }
};

// The casters of a scene, in an order in which neighbors follow one another.
struct CasterList {
  std::vector<CasterRef> casters;
  std::vector<Box> solid;
  double size = 0;  // of the scene: its diagonal
  Box bounds;

  explicit CasterList(const Scene& scene);
  Box boxOf(const Scene& scene, const CasterRef& caster) const;
  std::uint64_t bytes() const;
};

// A triangle that a shaft may hit if it comes nearer than `growth` to it.
struct Candidate {
  CasterRef caster;
  float growth = 0;
};

class CasterTree {
 public:
  CasterTree(const Scene& scene, const CasterList& list, const LightPoint& light);

  // Gathers the triangles whose boxes the shaft does not surely miss.
  void gather(const simd::CasterKernels& kernels, const simd::RoundedShaft& shaft,
              std::vector<Candidate>& found) const;
  std::uint64_t bytes() const;
  static std::uint64_t bytesFor(std::size_t casters) {
    return casters * (sizeof(float) + sizeof(simd::BoxBlock) / (kChildren - 1));
  }

 private:
  static constexpr std::size_t kChildren = simd::BoxBlock::kBoxes;

  const CasterList& list_;
  std::vector<float> growth_;  // of each caster
  // Boxes of the casters, of blocks of kChildren of them that follow one another, of such blocks
  // and so on.
  std::vector<HugeVector<simd::BoxBlock>> levels_;
};

}  // namespace whit
