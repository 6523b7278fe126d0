// Embree as the reference's finder of candidate triangles. Origins and directions are rounded to
// float for it; the reference computes the hit again in double.
#pragma once

#include "accel/accel.h"
#include "reference/intersector.h"

namespace whit {

class EmbreeIntersector : public reference::Intersector {
 public:
  explicit EmbreeIntersector(const Accel& accel) : accel_(accel) {}
  bool closest(const reference::Ray& ray, reference::Candidate& candidate) const override;
  bool occluded(const reference::Ray& ray, double tFar) const override;

 private:
  const Accel& accel_;
};

}  // namespace whit
