// The shadow cache: for pieces of receiving triangles it says if shadow rays from there to a light
// are blocked, proved before the rays are traced. The picture keeps every bit, whatever is filled,
// when and by whom, because the cache says what the ray would have found. The tables are filled
// between frames, where rays have requested it. They serve lights and casters that stand still, and
// point and directional lights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "bake/scene.h"
#include "core/huge_vector.h"
#include "core/worker_pool.h"
#include "shadow_cache/caster_tree.h"
#include "shadow_cache/decide_part.h"
#include "stages/shadow_cache_view.h"

namespace whit {

// How triangles are divided, the same for all lights.
struct ShadowParts {
  HugeVector<std::uint32_t> first;   // ShadowCacheView::first, of all triangles
  std::vector<std::uint32_t> owner;  // of each part, its triangle
  double finest = 0;                 // cells with edges of no more are not divided
  std::size_t count() const { return owner.size(); }

  // Returns none if the scene has too many triangles, or coordinates out of the range of the
  // proofs: its own, or those of its rays in the space of an instance.
  static ShadowParts of(const Scene& scene);
};

// Which parts are looked at.
struct FillLimits {
  unsigned leastRays = 1;            // that asked for a part, up to 255
  std::size_t mostParts = SIZE_MAX;  // of each light
};

// The result of filling the cache.
struct FillReport {
  double ms = 0;            // wall-clock
  std::uint64_t parts = 0;  // looked at
};

inline constexpr std::uint64_t kMostBytesALight = std::uint64_t{32} << 20;

class ShadowTables {
 public:
  // For the lights of these numbers, in about `mostBytes`, and no more than kMostBytesALight of
  // them for each. Lights have none where that is too little, or while they are too far away. The
  // scene must outlive them.
  ShadowTables(const Scene& scene, const std::vector<std::size_t>& lights, std::uint64_t mostBytes);
  ~ShadowTables();
  ShadowTables(const ShadowTables&) = delete;
  ShadowTables& operator=(const ShadowTables&) = delete;

  const std::vector<std::size_t>& lights() const { return numbers_; }
  // One a light of the scene; those without a table do not serve. Valid as long as the tables are.
  const std::vector<ShadowCacheView>& views() const { return views_; }

  // Looks at the parts that rays have missed. Not while a frame is traced.
  FillReport fill(WorkerPool& pool, const FillLimits& limits = {});
  // Drops the requests that were not computed yet. Must not be called while a frame is traced.
  void forgetAsked();
  // Drops the cached shadows of lights that have moved. Must not be called while a frame is traced.
  void forgetMovedLights();

  std::uint64_t bytes() const;

 private:
  struct OfLight;

  std::uint64_t fillLight(OfLight& light, WorkerPool& pool, const FillLimits& limits) const;
  void serve(OfLight& light);
  PartShadow decide(const OfLight& light, std::uint32_t part, const simd::CasterKernels& kernels,
                    PartScratch& scratch) const;

  const Scene& scene_;
  std::vector<std::size_t> numbers_;
  ShadowParts parts_;
  std::unique_ptr<CasterList> casters_;
  std::vector<std::unique_ptr<OfLight>> lights_;
  std::vector<ShadowCacheView> views_;
};

}  // namespace whit
