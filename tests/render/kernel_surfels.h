// The kernel interpolateSurfels by itself, on hits made by hand, and its scalar reference.
#pragma once

#include "reference/find_intersections.h"
#include "reference/small_chunk.h"
#include "render/every_target.h"
#include "render/renderer.h"

namespace whit::test {

// Holds slots 0 to kBlock - 1 of a frame of `scene`, with the columns of every effect, for the
// target `simd`. Leaves that target chosen.
class KernelSurfels {
 public:
  KernelSurfels(const Scene& scene, const std::string& simd)
      : renderer_(scene, optionsFor(simd)), small_(scene, renderer_.plan().features) {
    constants_.tables = &renderer_.tables();
    constants_.accel = &renderer_.accel();
    constants_.features = renderer_.plan().features;
    constants_.options = renderer_.options();

    Chunk& c = chunk();
    c.frame = &constants_;
    c.n = kBlock;
    for (const auto i : indices(kBlock)) c.hits.triangle[i] = c.hits.instance[i] = kMiss;
  }

  // Sets a ray of weight 1 that has gone 1 far along `direction`, in the media of `stack`, to the
  // middle of a triangle.
  void hit(std::size_t slot, std::uint32_t triangle, const Vec3f& direction,
           std::uint32_t stack = 0, std::uint32_t instance = kMiss) {
    Chunk& c = chunk();

    setRay(c.rays, slot, {0, 0, 0}, direction);
    c.rays.weight.set(slot, Rgb(1.0f));
    c.rays.throughput[slot] = 1;
    c.rays.media[slot] = stack;
    c.hits.triangle[slot] = triangle;
    c.hits.instance[slot] = instance;
    c.hits.t[slot] = 1;
    c.hits.u[slot] = c.hits.v[slot] = 0.25f;
  }

  void interpolate() { simd::kInterpolateSurfels.find()(chunk()); }

  Chunk& chunk() { return small_.chunk; }
  SurfelRow scalar(std::size_t slot) {
    return *reference::findIntersections(small_.world, chunk(), slot);
  }

 private:
  static RenderOptions optionsFor(const std::string& simd) {
    RenderOptions o;
    o.simd = simd;
    o.threads = 1;
    o.effects = EffectChoice::all;
    return o;
  }

  Renderer renderer_;
  SmallChunk small_;
  FrameConstants constants_;
};

}  // namespace whit::test
