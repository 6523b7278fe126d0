// What options cost at a view, in time and in error: blocks of pixels from all over the picture are
// rendered with and without them. --budget (budget.h) and the viewer choose options by it.
//
// Costs of knobs are factors of the time of a sample. Errors of knobs that approximate add up in
// squares.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/options.h"
#include "render/renderer.h"

namespace whit {

// The knobs are measured in this order, and a small budget ends the measurements early: those that
// matter most come first.
inline constexpr std::array kChosenKnobs{"glossy",       "ambient-samples", "light-samples",
                                         "indirect",     "depth",           "cutoff",
                                         "light-cutoff", "texture-filter",  "fresnel"};

// Blocks of a packet are enough for times, and stand for the picture from this number on.
inline constexpr int kPacketSide = 4;
inline constexpr double kLeastPackets = 128;

constexpr double squared(double x) { return x * x; }

// Renders some of the picture's pixels, in blocks.
class Prober {
 public:
  Prober(Renderer& renderer, const Camera& camera, Film& film, bool inCodes)
      : renderer_(renderer), camera_(camera), film_(film), inCodes_(inCodes) {}

  double pixels() const { return static_cast<double>(film_.image.pixels.size()); }

  // From now on so many blocks are rendered, or all.
  void chooseBlocks(int side, double count);
  double probed() const { return static_cast<double>(blocks_.size()) * side_ * side_; }

  FrameStats render(RenderOptions options, int spp);

  // Microseconds of a sample of a pixel. The first frame after a change fills new queues and does
  // not count.
  double time(const RenderOptions& options, int spp);

  // The blocks as last rendered, or as another picture of the film's size has them.
  Image mosaic() const { return mosaic(film_.image); }
  Image mosaic(const Image& picture) const;

  // Mean FLIP, or the root mean square in codes.
  double difference(const Image& a, const Image& b) const;

  // Milliseconds of the whole picture, by the rays of packets from all over it, which stand for it
  // better than a few tiles, and by the time of a ray in larger blocks, whose rays are as coherent
  // as those of the picture. Takes about the share of the picture's time.
  double wholePictureMs(const RenderOptions& options, double share);

 private:
  Renderer& renderer_;
  const Camera& camera_;
  Film& film_;
  bool inCodes_;
  int side_ = 1;
  PixelLists blocks_, lists_;
};

// A value of a knob, with its cost and its error against the middle of the model.
struct Level {
  std::string value;
  double cost = 1;    // factor of the time of a sample
  double bias2 = 0;   // squared error that more samples of pixels do not take away
  double noise2 = 0;  // added to the squared error of one sample
};
// Values of a knob that are chosen from.
struct Ladder {
  std::string name, exact, off;  // off: without samples; empty for other knobs
  std::vector<Level> levels;     // the first is the one of the middle
};

}  // namespace whit
