// Embree as the finder of candidates for computations in double (surfaces/intersector.h). Origins
// and directions are rounded to float for it.
#pragma once

#include "accel/accel.h"
#include "surfaces/intersector.h"

namespace whit {

class EmbreeIntersector : public Intersector {
 public:
  explicit EmbreeIntersector(const Accel& accel) : accel_(accel) {}
  bool closest(const Ray& ray, Candidate& candidate) const override;
  bool occluded(const Ray& ray, double tFar) const override;

 private:
  const Accel& accel_;
};

}  // namespace whit
