// Rays by the handful through the parts of the vector pipeline: Embree and the kernels, one stage
// after the other, on the very columns that a frame uses.
#pragma once

#include <vector>

#include "core/worker_pool.h"
#include "render/renderer.h"
#include "verify/case.h"

namespace whit::verify {

struct ProbeRay {
  Vec3f origin, direction;
  std::uint32_t media = 0;
};

struct ProbeChild {
  ProbeRay ray;
  Rgb weight;
  std::uint32_t parent = 0;
};

RenderOptions optionsOf(const Setup& setup);
RenderOptions optionsOf(const Setup& setup, const ImageSize& size);

class Probe {
 public:
  // With every effect compiled in, so that all columns are there. `scene` must outlive the probe.
  Probe(const Scene& scene, const Setup& setup);

  // generateRays' output, made by hand; then findIntersections.
  void cast(const std::vector<ProbeRay>& rays);
  // The same from hits that are given: interpolateSurfels alone.
  void load(const std::vector<ProbeRay>& rays);
  void hit(std::size_t i, std::uint32_t triangle, float t, float u, float v);
  void interpolate();
  // Surfels made by hand: one of `material` with these normals at the origin, for kernels that do
  // not look at geometry.
  void surfel(std::size_t i, std::uint32_t material, const Vec3f& ng, const Vec3f& ns);

  // addImpulses of all surfels, however little they contribute.
  std::vector<ProbeChild> reflections();
  std::vector<ProbeChild> refractions();
  // findRadianceAndShadowRays and checkShadows: shadow rays, of which `visible` were not blocked.
  std::size_t light(const Light& light);

  // Overwrites every slot of every column with these bits.
  void poison(std::uint32_t bits);

  std::size_t size() const { return count_; }
  bool isHit(std::size_t i) const { return hits_->triangle[i] != kMiss; }
  Vec3f position(std::size_t i) const {
    return {surfels_->posX[i], surfels_->posY[i], surfels_->posZ[i]};
  }
  Vec3f ng(std::size_t i) const { return {surfels_->ngX[i], surfels_->ngY[i], surfels_->ngZ[i]}; }
  Vec3f ns(std::size_t i) const { return {surfels_->nsX[i], surfels_->nsY[i], surfels_->nsZ[i]}; }
  ProbeRay ray(std::size_t i) const;
  Rgb unshadowed(std::size_t i) const {
    return {unshadowed_->r[i], unshadowed_->g[i], unshadowed_->b[i]};
  }
  bool visible(std::size_t i) const { return unshadowed_->visible[i] > 0; }

  const RayColumns& rays() const { return *rays_; }
  const HitColumns& hits() const { return *hits_; }
  const SurfelColumns& surfels() const { return *surfels_; }
  const ShadingTables& tables() const { return renderer_.tables(); }

 private:
  void reserve(std::size_t count);
  void endSurfels();
  void run(const simd::Kernel& kernel);
  std::vector<ProbeChild> childrenBy(const simd::Kernel& kernel);

  Renderer renderer_;
  FlushDenormals flush_;  // as in a frame's workers
  FrameConstants constants_;
  TraceMeter meter_;
  Chunk chunk_;
  std::size_t count_ = 0;
  ColumnStore<RayColumns> rays_, children_;
  ColumnStore<HitColumns> hits_;
  ColumnStore<SurfelColumns> surfels_;
  ColumnStore<UnshadowedColumns> unshadowed_;
  ColumnStore<ShadowColumns> shadows_;
};

// The rays alone.
std::vector<ProbeRay> raysOf(const std::vector<ProbeChild>& children);

// Primary rays of the pixels (packed), through their centers, by the kernel.
ColumnStore<RayColumns> raysThrough(const std::vector<std::uint32_t>& pixels,
                                    const CameraRays& camera);

// What most cases look at: the picture from one camera.
Image pictureOf(const Scene& scene, const Camera& camera, const RenderOptions& options,
                FrameStats* stats = nullptr);

}  // namespace whit::verify
