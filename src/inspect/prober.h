// Renders some of a picture's pixels in blocks, to measure times and errors of options.
#pragma once

#include "core/image.h"
#include "render/renderer.h"

namespace whit {

constexpr double squared(double x) { return x * x; }

// Errors are measured in blocks of this side: large enough for most of FLIP's filters, and small
// enough that a thousand pixels come from all of the picture. Blocks of a packet are enough for
// times.
inline constexpr int kBlockSide = 8, kPacketSide = 4;
inline constexpr double kLeastBlocks = 8, kLeastPackets = 128;
// The time that is expected of a pixel's FLIP.
inline constexpr double kFlipMicroseconds = 1;

class Prober {
 public:
  // Differences are root mean squares of 8-bit codes, or else the mean FLIP.
  Prober(Renderer& renderer, const Camera& camera, Film& film, bool inCodes)
      : renderer_(renderer), camera_(camera), film_(film), inCodes_(inCodes) {}

  double pixels() const { return static_cast<double>(film_.image.pixels.size()); }

  // Later calls of render() trace `count` blocks of side * side pixels, or all blocks if there are
  // no more.
  void chooseBlocks(int side, double count);
  // Number of pixels in the chosen blocks.
  double probed() const { return static_cast<double>(blocks_.size()) * side_ * side_; }

  FrameStats render(RenderOptions options, int spp);
  // Microseconds of a sample of a pixel. The first frame after a change fills new queues and does
  // not count.
  double time(const RenderOptions& options, int spp);
  // Estimates the milliseconds of the whole picture as its rays times the time of a ray. The
  // measurement takes about `share` of the picture's time.
  double wholePictureMs(const RenderOptions& options, double share);

  // Returns the blocks as last rendered, or as another picture of the film's size has them.
  Image mosaic() const { return mosaic(film_.image); }
  Image mosaic(const Image& picture) const;

  double difference(const Image& a, const Image& b) const;

 private:
  Renderer& renderer_;
  const Camera& camera_;
  Film& film_;
  bool inCodes_;
  int side_ = kBlockSide;
  PixelLists blocks_, lists_;
};

}  // namespace whit
