// The pictures that points are measured against: those of the scalar reference, each rendered once,
// and the picture with all transport.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "accuracy/measurement.h"
#include "core/progress.h"

namespace whit::accuracy {

// The cutoff of the picture with all transport. Paths between diffuse surfaces do not end by
// themselves.
inline constexpr float kTransportCutoff = 1e-4f;
// Returns options of packets that are exact and have all transport, with `samples` samples in every
// pixel.
RenderOptions transportOptions(const RenderOptions& options, int samples);

struct ReferencePicture {
  Image image;
  double renderMs = 0;  // the time that rendering took
  double rays = 0;      // number of rays
};

// The picture with all light that whit can transport. Packets render it in several passes of
// independent noise. The reference in double would take a hundred times as long, so that its noise
// would be far above the rounding errors that it avoids.
struct TransportPicture : TransportFacts {
  Image image;
};

// The number of passes of the picture with all transport; even, so that both halves are alike.
inline constexpr int kTransportPasses = 8;

// The mean of independent pictures of one view, which differ in their noise, and its error.
class PassMean {
 public:
  void add(const Image& pass) { passes_.push_back(pass); }

  // Needs one pass or more.
  Image mean() const { return picture(0, 1); }
  // The mean of the passes with even or odd numbers, to tell how visible noise is. Needs two passes
  // or more.
  Image half(bool odd) const { return picture(odd ? 1 : 0, 2); }
  // The standard error of the mean in linear radiance: the root mean square over pixels and
  // channels. Needs two passes or more.
  double standardError() const;
  // The mean over pixels and channels.
  double meanRadiance() const;

 private:
  // The means of every step-th pass, from `first` on.
  std::vector<RgbD> means(std::size_t first, std::size_t step) const;
  Image picture(std::size_t first, std::size_t step) const;

  std::vector<Image> passes_;
};

// Returns the mean of kTransportPasses passes with these options, which must have Mode::packets;
// each has options.spp samples.
TransportPicture renderTransport(const Scene& scene, const Camera& camera,
                                 const RenderOptions& options, Progress* progress);

// Keeps the pictures of one scene and camera by their options.
class ReferenceCache {
 public:
  ReferenceCache(const Scene& scene, const Camera& camera) : scene_(scene), camera_(camera) {}

  // Returns the picture with these options, which must have Mode::reference. It is rendered once.
  const ReferencePicture& get(const RenderOptions& options, Progress* progress);

 private:
  const Scene& scene_;
  Camera camera_;
  std::map<std::string, ReferencePicture> pictures_;
};

}  // namespace whit::accuracy
