// The errors of a sweep's points, by cause, and pictures that show them.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "accuracy/reference_pictures.h"
#include "accuracy/sweep.h"
#include "accuracy/timing.h"
#include "inspect/path_divergence.h"

namespace whit::accuracy {

class ErrorMeter {
 public:
  // `base` is the baseline, and `transport` the picture with all transport if it is the truth. The
  // cache has to outlive the meter.
  ErrorMeter(const Scene& scene, const RenderOptions& base, const Scope& scope,
             std::optional<TransportPicture> transport, ReferenceCache& cache, Progress* progress);

  // Sets the point's errors from its last frame. For a knob of arithmetic the errors of sampling
  // and algorithm are not set, because they are the baseline's.
  void measure(Point& point, FrameSource& frames);
  // Sets the point's pictures, which stay in memory.
  void addPictures(Point& point, const Image& image) const;

  const Image& truth() const { return transport_ ? transport_->image : reference_.image; }
  double referenceMs() const { return reference_.renderMs; }
  // Returns a PNG of the displayed image.
  std::string pngOf(const Image& image) const;

 private:
  // Returns a PNG of the heat map.
  std::string mapPng(const Image& a, const Image& b) const;
  ImageDifference against(const Image& a, const Image& b) const;
  const Image& withoutApproximations(const Point& point, const Image& own);
  const ReferencePaths& referencePaths(const Point& point, FrameSource& frames);

  const Scene& scene_;
  RenderOptions base_;
  Scope scope_;
  Camera camera_;
  std::optional<TransportPicture> transport_;
  // The reference, or the part of Whitted's model in the picture with all transport, and the exact
  // picture at equal samples; both are the cache's.
  const ReferencePicture& reference_;
  const Image& exact_;
  // The difference of the reference from the picture with all transport.
  std::optional<ImageDifference> leftOut_;
  std::map<std::string, Image> exactPackets_;  // key: digest of the options
  std::map<std::string, ReferencePaths> referencePaths_;
};

}  // namespace whit::accuracy
