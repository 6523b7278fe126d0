// When to look for verdicts of shadow (verdicts/verdict_tables.h) in a run of frames: of those
// parts of triangles that so many rays ask for that proving costs less than tracing them.
#pragma once

#include <cstdint>

#include "render/renderer.h"

namespace whit {

// The frames and samples of a run that may use the shadow cache.
struct VerdictRun {
  std::size_t frames = 1;       // to come, of neighboring views
  std::size_t pixels = 0;       // of each
  std::uint64_t mostBytes = 0;  // that tables may take
};

// Looking for verdicts pays in runs that trace so many samples of pixels.
double samplesThatPay(const Scene& scene);

class VerdictSchedule {
 public:
  // One tile of this many collects requests in each frame.
  static constexpr std::uint32_t kTurns = 8;

  // `renderer` must outlive it. Nothing happens where tables would not pay, or --verdicts says off.
  VerdictSchedule(Renderer& renderer, const VerdictRun& run);

  // Before a frame of many samples: one of a single sample asks for what all of them will. `film`
  // is overwritten.
  void prepare(const Camera& camera, Film& film);
  // After each frame.
  void frameDone();

  bool used() const { return used_; }
  double fillMs() const { return fillMs_; }

 private:
  void fill(double repeats);

  Renderer& renderer_;
  VerdictRun run_;
  bool used_ = false;
  std::size_t done_ = 0;
  double fillMs_ = 0;
};

}  // namespace whit
