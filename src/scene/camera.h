// Pinhole and orthographic cameras, with or without a lens, and camera paths.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/vec3.h"

namespace whit {

// Members are listed in scene/members.h.
struct Camera {
  std::string name = "default";
  Vec3f eye{0, 0, 5};
  Vec3f at{0, 0, 0};
  Vec3f up{0, 1, 0};
  float fov = 45;  // vertical, degrees
  // Above 0: rays are parallel and start in the plane through the eye, of which the picture shows
  // this height; there is no fov.
  float orthographicHeight = 0;
  float aperture = 0;  // radius of the lens, in scene units; 0: everything is sharp
  // Distance of the plane that is in focus, along the view axis; 0: it contains `at`.
  float focus = 0;

  bool hasLens() const { return aperture > 0; }
  double focusDistance() const;
};

// Compares all members but the name.
bool sameView(const Camera& a, const Camera& b);

struct Keyframe {
  float time = 0;  // seconds
  Camera camera;
};

// Interpolates the keyframes at `time`: Catmull-Rom through eye and at, linearly in all other
// members. Clamped to the ends. Needs at least one keyframe, in order of time.
Camera cameraAt(const std::vector<Keyframe>& path, double time);

// Input of the ray generator, computed once a frame in double: the direction through image
// position (x, y), in pixels from the top left, is forward + (x - w/2) * right - (y - h/2) * up,
// normalized. Directions never come from a difference of world positions, so a camera far from the
// origin loses nothing (hard case H75). Orthographic rays have the direction forward and start as
// far aside of the eye.
//
// With a lens, a ray starts at a point of the disk of radius `aperture` about that start, which is
// perpendicular to `forward`, and meets the ray from the center in the plane of focus.
struct CameraFrame {
  Vec3d eye, forward, right, up;
  int width = 0, height = 0;
  // Half the sides of the box around the points where rays start; 0: all start at the eye.
  Vec3d reach;
  // The dielectrics that the eye is inside of, as rays carry them (stages/columns.h); whoever
  // renders looks for them (reference/media.h).
  std::uint32_t media = 0;
  bool orthographic = false;
  bool mediaVary = false;  // each ray may start in others
  double aperture = 0, focus = 1;
};
// Distinguishes the random numbers that choose points of the lens (sampling/random_streams.h).
inline constexpr std::uint32_t kLensSalt = 0x3c1d5e97u;

CameraFrame makeCameraFrame(const Camera& camera, int width, int height);

// The footprint of a pixel: how wide it is where its ray starts, and how much wider with each unit
// of the way.
struct RayCone {
  double width = 0, spread = 0;
  double widthAt(double way) const { return width + spread * way; }
};
RayCone pixelCone(const CameraFrame& camera);

}  // namespace whit
