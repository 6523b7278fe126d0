#include <algorithm>
#include <array>
#include <cmath>

#include "bake/finalize_steps.h"

namespace whit {

namespace {

// The box of an instance is that of its object, moved: exact unless it is turned.
void addInstance(const Scene& scene, const InstanceRecord& instance, const std::vector<Box>& boxes,
                 Box& all) {
  const Box& own = boxes[instance.geometry];
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d world = instance.toWorld.point(Vec3d(own.corner(corner)));
    if (!(maxComponent(abs(world)) <= kLargestCoordinate)) {
      throwBadScene(scene.name + ": instance of geometry " + std::to_string(instance.geometry),
                    "expected coordinates up to 1.844e18 after its transform");
    }
    all.add(Vec3f(world));
  }
}

// The largest coordinate of everything that rays start from: surfaces and eyes.
float farthestStart(const Scene& scene, const std::vector<Box>& boxes) {
  Box all = boxes[0];
  for (const InstanceRecord& instance : scene.instances) addInstance(scene, instance, boxes, all);
  float farthest = 0;
  const auto add = [&](const Vec3f& p) { farthest = std::max(farthest, maxComponent(abs(p))); };
  if (!all.empty()) add(all.lower), add(all.upper);
  const auto addStarts = [&](const Camera& camera) {
    add(abs(camera.eye) + Vec3f(camera.aperture));
  };
  for (const Camera& camera : scene.cameras) addStarts(camera);
  for (const Keyframe& frame : scene.cameraPath) addStarts(frame.camera);
  return farthest;
}

}  // namespace

void boundInstances(Scene& scene, const std::vector<Box>& boxes, Warnings& warnings) {
  const float farthest = farthestStart(scene, boxes);
  const auto lost = std::erase_if(scene.instances, [&](const InstanceRecord& instance) {
    return !(instanceReach(instance.toWorld) > farthest);
  });
  warnings.add("instance too small or too flat to be traced left out", scene.name, lost);
  Box box = boxes[0];
  for (const InstanceRecord& instance : scene.instances) addInstance(scene, instance, boxes, box);
  countInstanced(scene);
  if (scene.instancedTriangles + scene.instancedSpheres == 0) return;
  scene.lower = box.lower;
  scene.upper = box.upper;
}

void countInstanced(Scene& scene) {
  scene.instancedTriangles = scene.geometries[0].index.size();
  scene.instancedSpheres = scene.geometries[0].spheres;
  for (const InstanceRecord& instance : scene.instances) {
    scene.instancedTriangles += scene.geometries[instance.geometry].index.size();
    scene.instancedSpheres += scene.geometries[instance.geometry].spheres;
  }
}

float instanceReach(const Affine& toWorld) {
  // Far from where products of three floats lose bits or leave their range.
  constexpr double kSmallest = 1e-35, kLargest = 1e35;
  const double determinant = std::abs(toWorld.determinant());
  if (!(determinant >= kSmallest && determinant <= kLargest)) return 0;
  const std::array<Vec3d, 3> adjoint{cross(toWorld.y, toWorld.z), cross(toWorld.z, toWorld.x),
                                     cross(toWorld.x, toWorld.y)};
  double stretch = 0, shift = 0;
  for (const Vec3d& row : adjoint) {
    const Vec3d size = abs(row);
    if (!(maxComponent(size) <= kLargest)) return 0;
    stretch = std::max(stretch, (size.x + size.y + size.z) / determinant);
    shift = std::max(shift, dot(size, abs(toWorld.p)) / determinant);
  }
  // Half of the range is for the rounding of all this.
  const double room = 0.5 * kLargestCoordinate - shift;
  return room > 0 ? static_cast<float>(std::min<double>(room / stretch, kLargestCoordinate)) : 0.0f;
}

}  // namespace whit
