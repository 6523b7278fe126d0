// Sends a few rays through single stages of the vector pipeline, on the columns that a frame uses.
#pragma once

#include <array>
#include <vector>

#include "core/flush_denormals.h"
#include "render/renderer.h"
#include "verify/case.h"

namespace whit::verify {

struct ProbeRay {
  Vec3f origin, direction;
  std::uint32_t media = 0;
};

inline std::string textOf(const ProbeRay& ray) {
  return "from " + textOf(ray.origin) + " along " + textOf(ray.direction);
}

struct ProbeChild {
  ProbeRay ray;
  Rgb weight;
  std::uint32_t parent = 0;
};

RenderOptions optionsOf(const Setup& setup);
RenderOptions optionsOf(const Setup& setup, const ImageSize& size);

class Probe {
 public:
  // The plan has the steps of every effect, so that all columns are there. `scene` must outlive the
  // probe.
  Probe(const Scene& scene, const Setup& setup);
  // Also casts these rays.
  Probe(const Scene& scene, const Setup& setup, const std::vector<ProbeRay>& rays);

  // Takes the rays as the output of generateRays and runs findIntersections.
  void cast(const std::vector<ProbeRay>& rays);
  // Takes rays and hits as given and runs interpolateSurfels alone.
  void load(const std::vector<ProbeRay>& rays);
  void hit(std::size_t i, std::uint32_t triangle, float t, float u, float v);
  void interpolate();
  // Loads `count` rays down the z axis; ray i hits triangle i at weights of 1/4. Then interpolates.
  void hitEach(std::uint32_t count);
  // Makes a surfel of `material` with these normals at the origin, for kernels that do not look at
  // geometry.
  void surfel(std::size_t i, std::uint32_t material, const Vec3f& ng, const Vec3f& ns);

  // Runs addImpulses for all surfels, however little they contribute.
  std::vector<ProbeChild> reflections();
  std::vector<ProbeChild> refractions();
  // Runs findRadianceAndShadowRays and checkShadows. Returns the number of shadow rays;
  // visible() returns true for those that are not occluded.
  std::size_t light(const Light& light);

  // Overwrites every slot of every column with these bits.
  void poison(std::uint32_t bits);

  std::size_t size() const { return count_; }
  bool isHit(std::size_t i) const { return hits_->triangle[i] != kMiss; }
  // Returns true if ray i missed in both probes, or has the same hit bit for bit.
  bool sameHit(const Probe& other, std::size_t i) const;
  Vec3f position(std::size_t i) const { return surfels_->pos.at(i); }
  Vec3f ng(std::size_t i) const { return surfels_->ng.at(i); }
  Vec3f ns(std::size_t i) const { return surfels_->ns.at(i); }
  ProbeRay ray(std::size_t i) const;
  Rgb unshadowed(std::size_t i) const { return Rgb(unshadowed_->rgb.at(i)); }
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

std::vector<ProbeRay> raysOf(const std::vector<ProbeChild>& children);

// Primary rays through the centers of these packed pixels, made by the kernel.
ColumnStore<RayColumns> raysThrough(const std::vector<std::uint32_t>& pixels,
                                    const CameraFrame& camera);

Image pictureOf(const Scene& scene, const Camera& camera, const RenderOptions& options,
                FrameStats* stats = nullptr);

// Renders a picture by packets and by the scalar reference, which share no code for coplanar faces
// nor for the media around the eye.
std::array<Image, 2> picturesOf(const Scene& scene, const Camera& camera,
                                const RenderOptions& options);

// Counts the pixels whose bits differ. With `mirrored`, column x of `a` is column w - 1 - x of `b`.
void countOtherPixels(Finding& finding, const Image& a, const Image& b, const std::string& what,
                      bool mirrored = false);

// Number of media on a stack of media.
inline int mediaCount(std::uint32_t stack) {
  int count = 0;
  for (; stack != 0; stack >>= 8) count += (stack & 0xFFu) != 0;
  return count;
}

// Counts the rays of a probe that hit something although they must not, or the other way round.
void countHits(Finding& finding, const Probe& probe, bool mustHit);

// Calls visit(x, y) for every pixel of a picture.
template <typename Visit>
void forEachPixel(int width, int height, const Visit& visit) {
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) visit(x, y);
  }
}

// Calls visit(start, direction, x, y) for the ray through the center of every pixel of a picture.
template <typename Visit>
void forEachRay(const Camera& camera, int width, int height, const Visit& visit) {
  const CameraFrame frame = makeCameraFrame(camera, width, height);
  forEachPixel(width, height, [&](int x, int y) {
    const Vec3d aside = frame.right * (x + 0.5 - width / 2.0) - frame.up * (y + 0.5 - height / 2.0);
    if (frame.orthographic) {
      visit(frame.eye + aside, frame.forward, x, y);
    } else {
      visit(frame.eye, normalized(frame.forward + aside), x, y);
    }
  });
}

}  // namespace whit::verify
