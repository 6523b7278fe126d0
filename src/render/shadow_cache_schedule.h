// Decides when a run of frames fills the shadow cache: for parts of triangles that enough rays
// request, so that proofs cost less than the rays that they save.
#pragma once

#include <cstdint>

#include "render/renderer.h"

namespace whit {

// The frames and samples of a run that may use the shadow cache.
struct ShadowCacheRun {
  std::size_t frames = 1;       // to come, of neighboring views
  std::size_t pixels = 0;       // of each
  std::uint64_t mostBytes = 0;  // that tables may take
};

// The least number of samples of pixels in a run for which the shadow cache saves time.
double samplesThatPay(const Scene& scene);

class ShadowCacheSchedule {
 public:
  // One tile of this many collects requests in each frame.
  static constexpr std::uint32_t kTurns = 8;

  // `renderer` must outlive it. Nothing happens where the cache would not save time, or
  // --shadow-cache is off. An audit fills all that is requested, whether that saves time or not.
  ShadowCacheSchedule(Renderer& renderer, const ShadowCacheRun& run);

  // Before a frame of many samples: one of a single sample asks for what all of them will. Before
  // an audit's first frame: the same frame asks. `film` is overwritten.
  void prepare(const Camera& camera, Film& film);
  // After each frame.
  void frameDone();

  bool used() const { return used_; }
  double fillMs() const { return fillMs_; }

 private:
  bool audits() const { return renderer_.options().shadowCache == ShadowCacheMode::audit; }
  void fill(double repeats);

  Renderer& renderer_;
  ShadowCacheRun run_;
  bool used_ = false;
  std::size_t done_ = 0;
  double fillMs_ = 0;
};

}  // namespace whit
