// The Embree scene of the ray queries: triangles that are enlarged by Embree's rounding errors, and
// boxes around spheres, so that no candidate is missed.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "accel/embree_scene.h"
#include "accel/exact_intersector.h"
#include "bake/facet.h"

namespace whit {

// Maps the space of a geometry to Embree's: (point - center) / scale.
struct QueryFrame {
  Vec3d center;
  double scale = 1;
  Vec3d of(const Vec3d& point) const { return (point - center) / scale; }
};

// Embree gets the scene moved and scaled into the unit ball, and each ray from the point where it
// enters a slightly larger ball. Embree's errors then have one size, however far away a ray starts.
constexpr double kBall = 1.25;
// Bounds on Embree's rounding errors, in units of the ball. kAcrossError bounds the error across a
// triangle's edges as seen along the ray, unless an edge is foreshortened to less than a sixteenth
// of its length. kAlongError bounds the error along the ray, unless a triangle is seen at less than
// a thousandth of its area.
constexpr double kAcrossError = 0x1p-17, kAlongError = 0x1p-13;

// The triangles of an Embree geometry, as its filter reads them.
struct EnlargedTriangles {
  std::uint32_t first = 0;  // index of the first one in Scene::triangles
  // A hit on the enlarged triangle surely lies within the triangle if all of its weights are above
  // this margin. The margin is infinite where a mask or the side counts as well.
  std::vector<float> margins;
};

// The spheres of an Embree geometry. Each is tested where Embree finds its box.
struct QuerySpheres {
  std::uint32_t first = 0;  // index of the first one in Scene::triangles
  std::vector<Box> boxes;
};

class QueryScene {
 public:
  QueryScene(const Scene& scene, int threads, Progress* progress);

  const ExactIntersector& exact() const { return exact_; }
  const Scene& source() const { return scene_; }
  const QueryFrame& frame() const { return frames_[0]; }
  RTCScene embree() const { return scenes_[0].get(); }
  // The surface that a candidate of Embree is on.
  static PlacedTriangleId placed(const EmbreeContext* context, std::uint32_t number);

 private:
  std::vector<double> enlargements() const;
  void addTriangles(std::size_t index, double enlargement, int threads);
  void addSpheres(std::size_t index, double enlargement);
  void addInstance(std::uint32_t number);
  float marginOf(std::uint32_t number, const Corners& corners, double enlargement) const;

  const Scene& scene_;
  ExactIntersector exact_;
  std::vector<QueryFrame> frames_;  // a frame for each geometry; the first is the world's
  std::deque<EnlargedTriangles> triangles_;
  std::deque<QuerySpheres> spheres_;
  DeviceHandle device_;
  std::vector<SceneHandle> scenes_;  // a scene for each geometry
};

}  // namespace whit
