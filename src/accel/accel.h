// The acceleration structure: the only folder that includes Embree. Rays come in columns, go to
// Embree in packets of 1, 4, 8 or 16, and come back as hits in columns.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "bake/scene.h"
#include "core/options.h"
#include "core/progress.h"
#include "stages/chunk.h"

namespace whit {

// The hit of a single ray; the numbers are those of HitColumns.
struct Hit {
  std::uint32_t triangle = kMiss, instance = kNoInstance;
  float t = 0, u = 0, v = 0;
  bool found() const { return triangle != kMiss; }
};

class Accel {
 public:
  // `scene` must outlive the structure. Only masks, instances and spheres of these effects are
  // there. `threads` build it; 0: all. Rays are packed by kernels of the SIMD target that is chosen
  // now (simd/kernels.h). Throws Error(limit) when memory runs out, Error(usage) when Embree lacks
  // the target's instruction set.
  Accel(const Scene& scene, const RenderOptions& options, EffectSet effects = EffectSet::all(),
        int threads = 0, Progress* progress = nullptr);
  ~Accel();
  Accel(const Accel&) = delete;
  Accel& operator=(const Accel&) = delete;

  // Follows moveScene() of the scene that this was built from. Geometry that stands still keeps its
  // BVH. Throws as the constructor. Not while tracing.
  void sceneMoved();

  // Finds the nearest hits of the chunk's rays, segment by segment; slots behind the last ray
  // become misses, up to a whole block. A ray's hit does not depend on the rays beside it, except
  // where two surfaces coincide (a later step decides: render/steps.h) or cross at the very
  // distance of the hit, to the last bit: Embree then chooses one of them. Rays of depth 0 pass the
  // surfaces that their eye lies in.
  void findHits(Chunk& c) const noexcept;
  // Writes visible[slot] = 1 for each of the chunk's shadow rays that hits nothing before tFar,
  // else 0.
  void checkShadows(Chunk& c) const noexcept;

  // Robust traversal lets no ray through an edge, but about one in a thousand through a corner that
  // it hits exactly (hard case H14). In a scene that is closed around its cameras, rays without a
  // hit are therefore traced again, one by one, in directions a unit in the last place away. Such
  // rays are so rare there that this costs nothing. They count once. Not while tracing.
  void setEnclosed(bool enclosed) { enclosed_ = enclosed; }
  bool enclosed() const { return enclosed_; }

  // Single rays, for the reference's candidates.
  Hit closest(const Vec3f& origin, const Vec3f& direction, float tNear = 0) const noexcept;
  bool occluded(const Vec3f& origin, const Vec3f& direction, float tFar) const noexcept;

  int packet() const;
  std::string description() const;  // "3.13.5 avx2"
  std::uint64_t memoryBytes() const;

  struct Impl;  // accel.cpp; no other folder sees Embree

 private:
  const Scene& scene_;
  std::unique_ptr<Impl> impl_;
  bool enclosed_ = false;
};

// Steps of a plan; the frame's Accel performs them.
void findHits(Chunk& c);
void checkShadows(Chunk& c);

}  // namespace whit
