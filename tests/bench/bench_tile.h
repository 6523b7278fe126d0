// One tile of a scene, taken through the stages of depth 0, so that each step of the plan can be
// run again and again on the input that it has in a frame.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "simd/kernels.h"

namespace whit::bench {

inline constexpr ImageSize kSize{480, 300};
inline constexpr std::size_t kTileRays = 32 * 32;

class BenchTile {
 public:
  // `target` is the SIMD target of its kernels. The scene must outlive the tile. Without `pixels`
  // the tile is chosen.
  BenchTile(const Scene& scene, const std::string& target, const RenderOptions& choices,
            const std::vector<std::uint32_t>& pixels)
      : scene_(scene),
        options_(timed(choices, target)),
        renderer_(scene_, options_),
        film_(makeFilm(scene_, options_)),
        constants_(renderer_.constantsOf(renderer_.prepareView(camera(), film_))),
        work_(plan(), kTileRays) {
    sizeDisplay(film_);
    work_.reserveCodes(kTileRays);
    pixels_ = pixels.empty() ? pickTile() : pixels;
    pixels_.reserve(kTileRays + 2 * kBlock);
    run();
  }

  // Runs all steps of depth 0 from the beginning, light by light.
  void run() {
    chunk_ = Chunk();
    chunk_.frame = &constants_;
    chunk_.film = &film_;
    chunk_.meter = &meter_;
    chunk_.pixels = pixels_;

    work_.startQueue(pixels_.size());
    work_.takeChunk(0, chunk_);
    for (const Step& step : plan().perSample) runStep(step);
    for (const Step& step : plan().perQueue) runStep(step);

    for (const LightSteps& light : plan().perLight) {
      chunk_.turnTo(light.light, light.sample, light.samples);
      for (const Step& step : light.steps) runStep(step);
    }

    // Children have room for the most that all surfels can have.
    std::size_t most = 0;
    for (const Step& step : plan().impulses) most += step.childrenAtEye;
    if (most > 0) work_.reserveChildren(most * kTileRays, chunk_);
    for (const Step& step : plan().impulses) runStep(step);
    for (const Step& step : plan().perTile) runStep(step);
  }

  // Runs a step once more on the tile as it is after run(). Steps that append children begin again
  // with none.
  void runStep(const Step& step) {
    if (step.childrenAtEye > 0 && &step == &plan().impulses.front()) chunk_.childCount = 0;
    if (step.runsFor(chunk_.materialFlags)) step.run(chunk_);
  }

  // Returns the chunk that a step is timed on.
  Chunk chunkFor(const Step& step) const {
    Chunk chunk = chunk_;
    if (step.childrenAtEye > 0) chunk.childCount = 0;
    if (step.name == "returnImpulses") {
      // Children of this depth, as many as there are, and as bright as their parents.
      chunk.rays = chunk_.children;
      chunk.n = std::min(chunk_.childCount, kTileRays);
      chunk.parentRadiance = chunk_.radiance;
    }
    return chunk;
  }

  // Returns the number of rays, shadow rays or children that the step processes.
  std::size_t raysOf(const Step& step) const {
    if (step.name == "checkShadows") return chunk_.shadowCount;
    return chunkFor(step).n;
  }

  // Returns the bits of everything that the steps write.
  std::vector<std::uint32_t> bits() const {
    std::vector<std::uint32_t> all;
    append(all, chunk_.rays, chunk_.n);
    append(all, chunk_.surfels, chunk_.n);
    append(all, chunk_.radiance, chunk_.n);
    if (plan().writes(Part::unshadowed)) append(all, chunk_.unshadowed, chunk_.n);
    append(all, chunk_.shadows, chunk_.shadowCount);
    append(all, chunk_.children, chunk_.childCount);
    all.insert(all.end(), chunk_.codes, chunk_.codes + chunk_.n);
    return all;
  }

  const Plan& plan() const { return renderer_.plan(); }
  const Chunk& chunk() const { return chunk_; }
  Renderer& renderer() { return renderer_; }
  Camera camera() const { return chooseCamera(scene_, options_); }
  const std::vector<std::uint32_t>& pixels() const { return pixels_; }
  // A film for a picture of the whole scene that is rendered quickly.
  Film smallFilm() const {
    RenderOptions options = options_;
    options.size = ImageSize{96, 60};
    return makeFilm(scene_, options);
  }

 private:
  static RenderOptions timed(RenderOptions o, const std::string& target) {
    o.size = kSize;
    o.threads = 1;
    o.simd = target;
    return o;
  }

  // The tile whose surfels have the most children: there every kernel has work.
  std::vector<std::uint32_t> pickTile() {
    std::vector<std::uint32_t> best;
    std::size_t most = 0;
    PixelLists tiles = makeTiles(Crop{0, 0, kSize.width, kSize.height}, 32);

    for (const auto& tile : tiles) {
      // Tiles at the border are smaller.
      if (tile.size() != kTileRays) continue;
      pixels_ = tile;
      pixels_.reserve(kTileRays + 2 * kBlock);
      run();
      if (best.empty() || chunk_.childCount > most) {
        best = tile;
        most = chunk_.childCount;
      }
    }
    return best;
  }

  template <typename Columns>
  static void append(std::vector<std::uint32_t>& all, const Columns& columns, std::size_t count) {
    Columns::forEachColumn(columns, [&](const char*, const auto* column, Feature) {
      if (!column) return;
      const std::size_t old = all.size();
      all.resize(old + count);
      if (count > 0) std::memcpy(all.data() + old, column, count * sizeof(std::uint32_t));
    });
  }

  const Scene& scene_;
  RenderOptions options_;
  Renderer renderer_;
  Film film_;
  FrameConstants constants_;
  Workspace work_;
  TraceMeter meter_;
  std::vector<std::uint32_t> pixels_;
  Chunk chunk_;
};

}  // namespace whit::bench
