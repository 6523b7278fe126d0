// Cameras of all projections, and camera paths.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/vec3.h"

namespace whit {

// scenes/README.md says what each one means.
enum class Projection : std::uint8_t {
  perspective,
  equidistant,
  equisolid,
  fisheye,  // OpenCV's
  panorama,
  directions,
  cubeMap
};
enum class Stereo : std::uint8_t { none, leftRight, topBottom };

// Members are listed in scene/members.h.
struct Camera {
  std::string name = "default";
  Vec3f eye{0, 0, 5};
  Vec3f at{0, 0, 0};
  Vec3f up{0, 1, 0};
  Projection projection = Projection::perspective;
  float fov = 45;  // vertical, degrees
  // Above 0: rays are parallel and start in the plane through the eye, of which the picture shows
  // this height; there is no fov.
  float orthographicHeight = 0;
  // Width over height of the view. A narrower picture keeps the width and shows more above and
  // below; 0: every picture has the height of fov or orthographicHeight.
  float aspect = 0;
  float aperture = 0;  // radius of the lens, in scene units; 0: everything is sharp
  // Distance of the plane that is in focus, along the view axis; 0: it contains `at`.
  float focus = 0;
  // fx, fy, cx, cy and perhaps the skew, in pixels of a picture of the size `kSize`, whose first
  // pixel has its center at (0, 0).
  std::vector<float> k = {}, kSize = {};
  // Coefficients in OpenCV's order: k1, k2, p1, p2, k3, k4, k5, k6; of a fisheye k1 to k4.
  std::vector<float> distortion = {};
  float angle = 180;  // angle of a fisheye's image circle in degrees
  std::vector<float> azimuths = {}, elevations = {};  // directions of columns and rows in degrees
  Stereo stereo = Stereo::none;
  float eyeDistance = 0.065f;  // distance of the eyes in scene units

  bool hasLens() const { return aperture > 0; }
  double focusDistance() const;
};

// Returns the camera without aspect, with the fov and orthographicHeight that a picture of this
// aspect ratio (width over height) shows.
Camera fitted(Camera camera, double pictureAspect);

// Compares all members but the name.
bool sameView(const Camera& a, const Camera& b);

struct Keyframe {
  float time = 0;  // seconds
  Camera camera;
};

// Interpolates the keyframes at `time`: Catmull-Rom through eye and at, linearly in all other
// members. Clamped to the ends. Needs at least one keyframe, in order of time.
Camera cameraAt(const std::vector<Keyframe>& path, double time);

// One of the views of equal size that make up a stereo pair or a cube map.
struct CameraView {
  Vec3d aside, forward, right, up;
};

// Input of the ray generator, computed once a frame in double: the direction through image
// position (x, y), in pixels from the top left, is forward + X * right + Y * up, normalized, with
// Y = centerY - y and X = x - centerX + skew * Y. Directions never come from a difference of world
// positions, so a camera far from the origin loses nothing (hard case H75). Orthographic rays have
// the direction forward and start as far aside of the eye.
//
// Other projections bend X |right| and Y |up|, which are tangents, radians or whatever the
// projection takes, into a direction. A ray that sees nothing has the direction 0.
//
// With a lens, a ray starts at a point of the disk of radius `aperture` about that start, which is
// perpendicular to `forward`, and meets the ray from the center in the plane of focus.
struct CameraFrame {
  Vec3d eye, forward, right, up;
  int width = 0, height = 0;
  // Half the sides of the box around the points where rays start; 0: all start at the eye.
  Vec3d reach;
  // Dielectrics that contain the eye, in the encoding of rays (stages/columns.h). The renderer
  // determines them (surfaces/initial_media.h).
  std::uint32_t media = 0;
  bool orthographic = false;
  bool mediaVary = false;  // each ray may start in others
  double aperture = 0, focus = 1;
  // Side of the square that a ray represents in texture lookups, in pixels. It is less than 1 where
  // several samples of a pixel are averaged.
  double footprint = 1;
  Projection projection = Projection::perspective;
  double centerX = 0, centerY = 0, skew = 0;
  std::array<double, 8> distortion{};
  bool distorted = false;
  double limit = 0;  // angle to the axis beyond which a fisheye sees nothing
  std::vector<float> azimuths = {}, elevations = {};  // degrees
  // Views row by row, each viewWidth pixels wide; empty if the whole picture is one view.
  std::vector<CameraView> views = {};
  int viewWidth = 0, viewHeight = 0, viewColumns = 1, viewRows = 1;
  // Radius of the circle about `eye` on which the eyes of stereo panoramas turn: for each azimuth
  // they stand side by side. 0 if the views give the positions of the eyes.
  double turning = 0;

  // True if the sum above is the direction of the ray.
  bool isStraight() const {
    return projection == Projection::cubeMap ||
           (projection == Projection::perspective && !distorted);
  }
  // True if one matrix maps the scene to the picture.
  bool isLinear() const { return isStraight() && views.empty(); }
};
// Ray generators invert a lens's distortion by this many steps of Newton's method. A solution is
// accepted if the lens images it within kLensError, in focal lengths; otherwise the ray sees
// nothing.
inline constexpr int kLensSteps = 10;
inline constexpr double kLensError = 1e-5;
// Salt of the random numbers that choose points of the lens (sampling/random_streams.h).
inline constexpr std::uint32_t kLensSalt = 0x3c1d5e97u;

CameraFrame makeCameraFrame(const Camera& camera, int width, int height);

// Returns where a linear camera sees a point before it: pixels from the top left of the picture.
std::array<double, 2> imagePlace(const CameraFrame& camera, const Vec3d& point);

// Footprint of a ray: its width at the start, and the growth of the width per unit of distance.
struct RayCone {
  double width = 0, spread = 0;
  double widthAt(double way) const { return width + spread * way; }
};
RayCone pixelCone(const CameraFrame& camera);

}  // namespace whit
