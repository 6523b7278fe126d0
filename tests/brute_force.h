// Tests every triangle and sphere against every ray, in double: an oracle for small scenes.
#pragma once

#include "bake/scene.h"
#include "surfaces/intersector.h"

namespace whit {

// Alpha masks and instances are the effects that matter here: without them masks cut no holes and
// instanced geometry is not there.
class BruteForce : public Intersector {
 public:
  explicit BruteForce(const Scene& scene, EffectSet effects = EffectSet::all())
      : scene_(scene), effects_(effects) {}
  bool closest(const Ray& ray, Candidate& candidate) const override;
  bool occluded(const Ray& ray, double tFar) const override;

 private:
  const Scene& scene_;
  EffectSet effects_;
};

}  // namespace whit
