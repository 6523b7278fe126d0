// A chunk of one block of slots, for the scalar reference of the stages.
#pragma once

#include <algorithm>

#include "brute_force.h"
#include "reference/reference.h"
#include "reference/world.h"
#include "set_columns.h"
#include "stages/chunk.h"

namespace whit::test {

// Tests set rays, hits and so on of slot 0 one by one; everything else is zero. Surfels are fully
// covered, and the factors of their maps are 1.
class SmallChunk {
 public:
  explicit SmallChunk(const Scene& scene, FeatureSet features = FeatureSet::all())
      : rays_(kBlock, features),
        children_(kBlock, features),
        hits_(kBlock, features),
        surfels_(kBlock, features),
        unshadowed_(kBlock, features),
        shadows_(kBlock, features),
        bruteForce_(scene),
        world{scene, EffectSet::all(), nullptr, CameraFrame(), bruteForce_} {
    frame_.features = features;
    chunk.frame = &frame_;
    chunk.n = 1;
    chunk.rays = *rays_;
    chunk.children = *children_;
    chunk.hits = *hits_;
    chunk.surfels = *surfels_;

    const SurfelColumns& s = chunk.surfels;
    if (features.has(Feature::coverage)) std::fill_n(s.coverage, kBlock, 1.0f);
    if (features.has(Feature::occlusionMaps)) std::fill_n(s.occlusion, kBlock, 1.0f);
    for (float* factor : {s.mirror.x, s.mirror.y, s.mirror.z}) {
      if (features.has(Feature::mirrorMaps)) std::fill_n(factor, kBlock, 1.0f);
    }
    for (float* factor : {s.transmission.x, s.transmission.y, s.transmission.z}) {
      if (features.has(Feature::transmissionMaps)) std::fill_n(factor, kBlock, 1.0f);
    }

    chunk.unshadowed = *unshadowed_;
    chunk.shadows = *shadows_;
  }

  SmallChunk(const SmallChunk&) = delete;
  SmallChunk& operator=(const SmallChunk&) = delete;

 private:
  FrameConstants frame_;
  ColumnStore<RayColumns> rays_, children_;
  ColumnStore<HitColumns> hits_;
  ColumnStore<SurfelColumns> surfels_;
  ColumnStore<UnshadowedColumns> unshadowed_;
  ColumnStore<ShadowColumns> shadows_;
  BruteForce bruteForce_;

 public:
  Chunk chunk;
  reference::World world;
};

}  // namespace whit::test
