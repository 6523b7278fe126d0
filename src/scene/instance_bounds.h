// What there is of a scene once its instances are in place.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "scene/scene.h"

namespace whit {

struct Box {
  Vec3f lower{std::numeric_limits<float>::max()}, upper{std::numeric_limits<float>::lowest()};
  void add(const Vec3f& p) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
};

// Counts and bounds as seen, from `boxes`: one a geometry, in its own space. Left out are instances
// that are so much smaller or flatter than the scene that its rays, in their space, would leave the
// range of coordinates. Throws Error(badScene) for one that is too far away.
void boundInstances(Scene& scene, const std::vector<Box>& boxes, Warnings& warnings);

}  // namespace whit
