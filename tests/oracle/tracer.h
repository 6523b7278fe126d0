// The oracle: Whitted's recursion in double precision, written from the formulas and from
// scenes/README.md. It shares no code with what it judges.
#pragma once

#include "oracle/geometry.h"
#include "oracle/media.h"
#include "oracle/scene.h"

namespace oracle {

// What a pixel shows.
struct Sight {
  Color radiance;
  // How much of the pixel went through a surface whose vertex normals point elsewhere than its
  // plane, so that a ray cannot go where they say: what then happens no formula decides.
  double undecided = 0;
};

struct Arrival;

class Tracer {
 public:
  // Both outlive the tracer.
  Tracer(const Scene& scene, const Options& options);

  // Through the image position (x, y), in pixels from the top left.
  Sight look(double x, double y) const;

 private:
  struct Surface;

  Ray eyeRay(double x, double y) const;
  Media mediaAround(const Vec& point) const;
  Color trace(const Ray& ray, int depth, double weight, const Media& media,
              double& undecided) const;
  Surface surfaceAt(const Ray& ray, const Hit& hit) const;
  Color lightFrom(const Surface& surface, double weight, double& undecided) const;
  bool lit(const Surface& surface, const Arrival& arrival, const Light& light) const;
  Color impulses(const Surface& surface, int depth, double weight, const Media& media,
                 const Media& behind, double& undecided) const;

  const Scene& scene_;
  const Options& options_;
  Geometry geometry_;
};

}  // namespace oracle
