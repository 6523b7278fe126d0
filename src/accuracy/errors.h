// The errors of a sweep's points against the truth, apart by cause.
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

// Of one scene and view.
class ErrorMeter {
 public:
  // `scene` has exact spheres. `base` gives the samples that the exact picture at equal samples
  // has, and the display. `transport`: the picture that is the truth; null: the reference is, of
  // `samples` samples. Must outlive the meter.
  ErrorMeter(const Scene& scene, const Camera& camera, const RenderOptions& base,
             const Exactness& exactness, ReferenceCache& cache, int samples,
             const TransportPicture* transport, Progress* progress);

  // Fills in the point's errors from its last frame, with what arithmetic does if `arithmetic`. A
  // knob of arithmetic leaves those of sampling and algorithm as they are: not filled in.
  void measure(Point& point, FrameSource& frames, bool arithmetic);
  // Fills in its pictures. Not for more than a few hundred points: they stay in memory.
  void depict(Point& point, const Image& image) const;
  std::string pngOf(const Image& image) const;  // as it is displayed

  const ReferencePicture& reference() const { return *reference_; }
  const Image& truth() const { return transport_ ? transport_->image : reference_->image; }
  const Image& exact() const { return exact_->image; }  // at the baseline's samples

 private:
  ImageDifference against(const Image& a, const Image& b, SrgbEncoding encoding) const;
  const Image& limitOf(const Point& point) const;
  const Image& withoutApproximations(const Point& point, const Image& own);
  // Of the point's own options; points that the scalar reference does not tell apart share it.
  const ReferencePaths& referencePaths(const Point& point, FrameSource& frames);

  const Scene& scene_;
  Camera camera_;
  RenderOptions base_;
  Exactness exactness_;
  const ReferencePicture *reference_, *exact_;
  const TransportPicture* transport_;
  std::optional<ImageDifference> leftOut_;     // by the model, against the truth with all transport
  HdrFlip hdrFlip_;                            // against the truth
  std::map<std::string, Image> exactPackets_;  // by digest of their options
  std::map<std::string, ReferencePaths> referencePaths_;
};

ArithmeticError arithmeticError(Renderer& renderer, const Camera& camera, const Film& film,
                                const ReferencePaths& reference);

}  // namespace whit::accuracy
