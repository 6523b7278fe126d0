// One scene with its spheres exact, or as triangles of so many segments: what --sphere-segments
// changes is loaded, not rendered.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "bake/scene.h"

namespace whit::accuracy {

class SceneVariants {
 public:
  // Loads it with its spheres in so many segments; 0: exact.
  using Load = std::function<Scene(int sphereSegments)>;

  // `given` has been loaded with `segments`, and must outlive the variants.
  SceneVariants(const Scene& given, int segments, Load load)
      : given_(given), segmentsGiven_(segments), load_(std::move(load)) {}

  // Loaded when it is first asked for, and kept.
  const Scene& with(int sphereSegments);
  const Scene& given() const { return given_; }

  // Why that variant is not worth its memory; empty where it is.
  std::string leavesOut(int sphereSegments);

 private:
  const Scene& given_;
  int segmentsGiven_;
  Load load_;
  std::map<int, Scene> others_;
};

}  // namespace whit::accuracy
