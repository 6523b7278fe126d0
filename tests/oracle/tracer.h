// The oracle: Whitted's recursion in double precision, written from the formulas and from
// scenes/README.md. It shares no code with what it judges.
#pragma once

#include <memory>

#include "oracle/faces.h"
#include "oracle/random_parts.h"
#include "oracle/scene.h"
#include "oracle/sight.h"

namespace oracle {

class Tracer {
 public:
  virtual ~Tracer() = default;

  // Through the image position (x, y), in pixels from the top left. All of a pixel are sampled
  // alike.
  virtual Sight look(double x, double y) const = 0;
  // Returns an unbiased estimate of the pixel's mean radiance: the ray goes through a random point
  // of the pixel and of the lens, and each integral on its path gets one sample.
  virtual Color sample(int x, int y, Random& random) const = 0;
  // What lies there.
  virtual const Face* nearest(double x, double y) const = 0;
};

// Both outlive the tracer.
std::unique_ptr<Tracer> makeTracer(const Scene& scene, const Options& options);

}  // namespace oracle
