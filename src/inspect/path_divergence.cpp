#include "inspect/path_divergence.h"

#include <atomic>

#include "bake/coplanar_triangles.h"
#include "core/image.h"
#include "core/index.h"
#include "inspect/reference_frame.h"
#include "render/embree_intersector.h"

namespace whit {

namespace {

// Sums of mixed numbers tell multisets apart. 0 is no event, because it mixes to 0.
std::uint64_t hitEvent(std::uint32_t triangle, std::uint32_t instance) {
  return mixed64(orderOf({triangle, instance}) + 3);
}
std::uint64_t shadowEvent(bool visible) { return mixed64(std::uint64_t{visible ? 1u : 2u}); }

// A pixel's signature: the sum of its events, whatever their order. Observers of workers that share
// the tiles write to the same signatures, one a pixel of the window.
class SignatureObserver : public StageObserver {
 public:
  SignatureObserver(const Image& image, std::vector<std::uint64_t>& signatures)
      : image_(image), signatures_(signatures) {}

  void after(Stage stage, const Chunk& chunk) override {
    tracker_.follow(stage, chunk);

    if (stage == Stage::findIntersections) {
      for (const auto i : indices(chunk.n)) {
        if (chunk.hits.triangle[i] == kMiss) continue;
        const std::uint32_t instance =
            chunk.has(Feature::instances) ? chunk.hits.instance[i] : kNoInstance;
        at(tracker_.pixel(chunk, i)) += hitEvent(chunk.hits.triangle[i], instance);
      }
    } else if (stage == Stage::checkShadows) {
      for (const auto k : indices(chunk.shadowCount)) {
        const std::uint32_t slot = chunk.shadows.slot[k];
        at(tracker_.pixel(chunk, slot)) += shadowEvent(chunk.unshadowed.visible[slot] > 0);
      }
    }
  }

 private:
  std::uint64_t& at(std::uint32_t pixel) {
    return signatures_[image_.index(pixelX(pixel), pixelY(pixel))];
  }

  const Image& image_;
  PixelTracker tracker_;
  std::vector<std::uint64_t>& signatures_;
};

class RecordingIntersector : public EmbreeIntersector, public reference::PathObserver {
 public:
  using EmbreeIntersector::EmbreeIntersector;
  void hit(const Candidate& c) const override { signature += hitEvent(c.triangle, c.instance); }
  bool occluded(const Ray& ray, double tFar) const override {
    const bool blocked = EmbreeIntersector::occluded(ray, tFar);
    signature += shadowEvent(!blocked);
    return blocked;
  }
  mutable std::uint64_t signature = 0;
};

}  // namespace

ReferencePaths traceReferencePaths(Renderer& renderer, const Camera& camera, const Film& film) {
  const CameraFrame frame = renderer.prepareView(camera, film);
  const reference::Settings settings = referenceSettings(renderer);
  ReferencePaths paths{film.image, std::vector<std::uint64_t>(film.image.pixels.size())};
  const Crop& window = film.image.window;
  std::atomic<int> nextRow{window.y0};

  renderer.scheduler().pool().run([&](int) {
    const RecordingIntersector intersector(renderer.accel());
    const reference::Tracer tracer(renderer.scene(), intersector, settings, intersector);
    reference::RayCounts counts;
    for (int y = nextRow++; y < window.y1; y = nextRow++) {
      for (int x = window.x0; x < window.x1; ++x) {
        intersector.signature = 0;
        paths.image.at(x, y) = Rgb(tracer.pixel(frame, x, y, counts));
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
  Film scratch = film;
  std::vector<std::uint64_t> signatures(film.image.pixels.size());

  // Each worker has its own observer. They share the signatures, because only one worker traces a
  // pixel.
  std::vector<SignatureObserver> signers(renderer.machine().threads,
                                         SignatureObserver(film.image, signatures));
  std::vector<StageObserver*> observers;
  observers.reserve(signers.size());
  for (SignatureObserver& signer : signers) observers.push_back(&signer);
  renderer.render({.camera = camera, .film = scratch, .observers = observers, .uniform = true});

  PathComparison result{scratch.image, reference.image, {}, 0};
  result.diverged.resize(signatures.size());
  for (const auto i : indices(signatures)) {
    result.diverged[i] = signatures[i] != reference.signatures[i];
    result.divergences += result.diverged[i];
  }

  return result;
}

}  // namespace whit
