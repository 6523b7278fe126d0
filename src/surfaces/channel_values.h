// Values of output channels that both modes find in the same way: the finish of a surface, and its
// motion in the picture.
#pragma once

#include <vector>

#include "bake/scene.h"
#include "core/channels.h"
#include "scene/camera.h"
#include "surfaces/intersector.h"

namespace whit {

// Where camera and surfaces were in an earlier picture.
struct EarlierView {
  Camera camera;
  CameraFrame frame;           // the camera's, for the size of the present picture
  std::vector<Affine> places;  // transforms of instances, by InstanceRecord::written
  // Vertices of the geometries that bend; empty for the others.
  std::vector<std::vector<Vec3f>> positions;
};

// Returns what a picture of the scene would show now. Throws Error(usage) for a camera whose view
// is not one matrix.
EarlierView rememberView(const Scene& scene, const Camera& camera);

// Returns how far the surface at `position` has moved since then in the picture that `camera` sees
// now, in pixels to the right and downwards; 0 if it was behind the earlier camera.
Vec2f motionOf(const Scene& scene, const EarlierView& earlier, const CameraFrame& camera,
               const Candidate& hit, const Vec3d& position);

// Stores roughness and metallic. `specular` and `alpha` are those of the glossy lobe at the hit,
// and black where there is none.
void keepFinish(const Material& material, const RgbD& specular, double alpha,
                ChannelValues& values);

}  // namespace whit
