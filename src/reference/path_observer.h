// Sees the paths that the tracer follows.
#pragma once

#include "core/vec3.h"
#include "stages/ray_kinds.h"
#include "surfaces/intersector.h"

namespace whit::reference {

struct Impulse;

class PathObserver {
 public:
  virtual ~PathObserver() = default;

  // Called for each surface that a path goes on from: among coplanar ones, the one that was chosen.
  virtual void hit(const Candidate&) const {}

  // Called before each impulse is followed, and with the radiance that it returns, unweighted.
  virtual void began(const Impulse&, RayKind) const {}
  virtual void ended(const RgbD& /*radiance*/) const {}

  // Called when the sample that was begun last is traced again (sampling/ray_limit.h).
  virtual void beganAgain() const {}
};

inline const PathObserver kUnobserved;

}  // namespace whit::reference
