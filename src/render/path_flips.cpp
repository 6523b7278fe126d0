#include "render/path_flips.h"

#include <atomic>

#include "reference/reference.h"
#include "render/embree_intersector.h"
#include "render/pixel_tracker.h"
#include "render/renderer_parts.h"

namespace whit {

namespace {

// splitmix64's finaliser: sums of it tell multisets apart.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}
std::uint64_t hitEvent(std::uint32_t triangle, std::uint32_t instance) {
  return mixed(mixed(triangle) ^ instance);
}
std::uint64_t shadowEvent(bool visible) { return mixed(visible ? 0x51 : 0x52); }

// A pixel's signature: the sum of its events, whatever their order.
class SignatureObserver : public StageObserver {
 public:
  SignatureObserver(const Crop& window, bool tracesShadows, bool instances)
      : window_(window),
        width_(static_cast<std::size_t>(window.x1 - window.x0)),
        tracesShadows_(tracesShadows),
        instances_(instances),
        signatures_(width_ * static_cast<std::size_t>(window.y1 - window.y0)) {}

  void after(Stage stage, const ChunkView& chunk) override {
    tracker_.follow(stage, chunk);
    if (stage == Stage::findIntersections) {
      for (std::size_t i = 0; i < chunk.n; ++i) {
        if (chunk.hits.triangle[i] == kMiss) continue;
        const std::uint32_t instance = instances_ ? chunk.hits.instance[i] : kMiss;
        at(tracker_.pixel(chunk, i)) += hitEvent(chunk.hits.triangle[i], instance);
      }
    } else if (stage == Stage::checkShadows && tracesShadows_) {
      for (std::size_t k = 0; k < chunk.shadowCount; ++k) {
        const std::uint32_t slot = chunk.shadows.slot[k];
        at(tracker_.pixel(chunk, slot)) += shadowEvent(chunk.unshadowed.visible[slot] > 0);
      }
    }
  }

  std::uint64_t signature(int x, int y) const { return signatures_[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - window_.y0) * width_ +
           static_cast<std::size_t>(x - window_.x0);
  }
  std::uint64_t& at(std::uint32_t pixel) {
    return signatures_[index(static_cast<int>(pixel & 0xFFFFu), static_cast<int>(pixel >> 16))];
  }

  Crop window_;
  std::size_t width_;
  bool tracesShadows_, instances_;
  PixelTracker tracker_;
  std::vector<std::uint64_t> signatures_;
};

class RecordingIntersector : public reference::Intersector {
 public:
  explicit RecordingIntersector(const Accel& accel) : embree_(accel) {}
  bool closest(const reference::Ray& ray, reference::Candidate& c) const override {
    const bool hit = embree_.closest(ray, c);
    if (hit) signature += hitEvent(c.triangle, c.instance);
    return hit;
  }
  bool occluded(const reference::Ray& ray, double tFar) const override {
    const bool blocked = embree_.occluded(ray, tFar);
    signature += shadowEvent(!blocked);
    return blocked;
  }
  mutable std::uint64_t signature = 0;

 private:
  EmbreeIntersector embree_;
};

}  // namespace

ReferencePaths traceReferencePaths(Renderer& renderer, const Camera& camera, const Film& film) {
  Renderer::Parts& p = renderer.parts();
  Film scratch = film;
  const FrameJob job = p.makeJob(camera, scratch, scratch.image.window);
  const reference::Settings settings = p.referenceSettings();
  ReferencePaths paths{film.image, std::vector<std::uint64_t>(film.image.pixels.size())};
  const Crop& window = film.image.window;
  std::atomic<int> nextRow{window.y0};
  p.pool->run([&](int) {
    const RecordingIntersector intersector(*p.accel);
    const reference::Tracer tracer(p.scene, intersector, settings);
    reference::RayCounts counts;
    for (int y = nextRow++; y < window.y1; y = nextRow++) {
      for (int x = window.x0; x < window.x1; ++x) {
        intersector.signature = 0;
        paths.image.at(x, y) = Rgb(tracer.pixel(job.camera, x, y, counts));
        paths.signatures[paths.image.index(x, y)] = intersector.signature;
      }
    }
  });
  return paths;
}

PathComparison comparePaths(Renderer& renderer, const Camera& camera, const Film& film) {
  return comparePaths(renderer, camera, film, traceReferencePaths(renderer, camera, film));
}

PathComparison comparePaths(Renderer& renderer, const Camera& camera, const Film& film,
                            const ReferencePaths& reference) {
  Renderer::Parts& p = renderer.parts();
  Film scratch = film;
  FrameJob job = p.makeJob(camera, scratch, scratch.image.window);
  const Crop& window = film.image.window;
  SignatureObserver observer(window, p.plan.traceShadows, p.plan.groups.instances);
  p.renderObserved(job, observer);
  PathComparison result{scratch.image, reference.image, {}, 0};
  result.flipped.resize(film.image.pixels.size());
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x) {
      const std::size_t i = film.image.index(x, y);
      if (reference.signatures[i] == observer.signature(x, y)) continue;
      result.flipped[i] = 1;
      ++result.flips;
    }
  }
  return result;
}

}  // namespace whit
