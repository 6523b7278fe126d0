// The errors of a sweep's points against the truth, separated by cause.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "accuracy/measurement.h"
#include "accuracy/reference_cache.h"
#include "accuracy/timing.h"
#include "inspect/hdr_flip.h"
#include "inspect/path_divergence.h"

namespace whit::accuracy {

// Measures the points of one scene and view.
class ErrorMeter {
 public:
  // `scene` has exact spheres. `base` has the display and the number of samples of the exact
  // picture at equal samples. The truth is `transport`, or the reference of `samples` samples if
  // that is null. Scene, cache and `transport` must outlive the meter.
  ErrorMeter(const Scene& scene, const Camera& camera, const RenderOptions& base,
             const Exactness& exactness, ReferenceCache& cache, int samples,
             const TransportPicture* transport, Progress* progress);

  // Sets the point's errors from its last frame. Errors of arithmetic are measured only if
  // `arithmetic` is true. For a knob of arithmetic the errors of sampling and algorithm are not
  // set, because they are the baseline's.
  void measure(Point& point, FrameSource& frames, bool arithmetic);
  // Sets the point's pictures, which stay in memory.
  void addPictures(Point& point, const Image& image) const;
  std::string pngOf(const Image& image) const;  // the displayed image

  const ReferencePicture& reference() const { return *reference_; }
  const Image& truth() const { return transport_ ? transport_->image : reference_->image; }

 private:
  ImageDifference against(const Image& a, const Image& b, SrgbEncoding encoding) const;
  // The picture that more samples of the point converge to.
  const Image& limitOf(const Point& point) const;
  const Image& withoutApproximations(const Point& point, const Image& own);
  // Paths of the scalar reference with the point's own options. Points whose options differ only in
  // ways that the scalar reference ignores share them.
  const ReferencePaths& referencePaths(const Point& point, FrameSource& frames);

  const Scene& scene_;
  Camera camera_;
  RenderOptions base_;
  Exactness exactness_;
  const ReferencePicture *reference_, *exact_;
  const TransportPicture* transport_;
  // The difference of the reference from the picture with all transport.
  std::optional<ImageDifference> leftOut_;
  HdrFlip hdrFlip_;                            // against the truth
  std::map<std::string, Image> exactPackets_;  // key: digest of the options
  std::map<std::string, ReferencePaths> referencePaths_;
};

ArithmeticError arithmeticError(Renderer& renderer, const Camera& camera, const Film& film,
                                const ReferencePaths& reference);

}  // namespace whit::accuracy
