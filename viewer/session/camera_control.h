// Flying, looking around and orbiting. The camera's control knows neither window nor clock.
#pragma once

#include "bake/scene.h"

namespace whit::view {

// What the user asks for in one step of the camera. Directions are -1, 0 or 1.
struct CameraMotion {
  double forward = 0, right = 0, up = 0;  // moves
  bool fast = false;
  double turnRight = 0, turnUp = 0;  // arrow keys
  double turnX = 0, turnY = 0;       // pixels dragged; y grows downwards
  double panX = 0, panY = 0;         // dragged shares of the window's height
  double wheel = 0;                  // notches
};

inline constexpr double kFastFactor = 4;
// A notch of the wheel multiplies the distance to the point that is orbited by this factor.
inline constexpr double kZoomFactor = 0.88;
// In a room, a notch goes as far as the camera walks in this time.
inline constexpr double kNotchSeconds = 0.3;
inline constexpr double kRadiansPerPixel = 0.004;         // mouse
inline constexpr double kRadiansPerSecond = 1.2;          // arrow keys
inline constexpr double kSteepestRadians = 1.5533430;     // 89 degrees: `up` stays meaningful
inline constexpr double kNearest = 1e-3, kFarthest = 10;  // distances, in diagonals of the model

// Returns the speed of walking, in units a second: it crosses the scene in twelve seconds.
double cruisingSpeed(const Scene& scene);

// Returns the bounds of what a scene shows: all of a model, and of a scene file what stands on its
// floor, which may reach far beyond.
Box subjectOf(const Scene& scene);
// Returns these bounds if the camera sees them from outside; empty where it is in a room.
Box boundsToOrbit(const Box& subject, const Camera& camera);

class CameraControl {
 public:
  // `speed` is in scene units a second.
  CameraControl(const Camera& camera, double speed) : speed_(speed) { set(camera); }

  // `model` bounds the point to orbit; an empty box means that nothing is orbited.
  void set(const Camera& camera, const Box& model = {});
  // The camera of the last set(), bit for bit, until something moves it.
  const Camera& camera() const { return camera_; }
  bool orbits() const { return !model_.empty(); }

  // Turns first, then moves, but not out of the range of coordinates that scenes have. Dragging
  // and the wheel leave the point that is orbited in the model's bounds and in the middle of the
  // picture. Returns whether the camera changed.
  bool step(const CameraMotion& motion, double seconds);

  // Goes back or closer until the model fills a picture of this width over height.
  void fit(double aspect);

 private:
  Vec3d forward() const;
  Vec3d center() const { return eye_ + forward() * distance_; }
  void turn(double rightwards, double upwards);
  bool drag(const CameraMotion& motion);
  void lookFrom(const Vec3d& center, double distance);
  void writeCamera();

  Camera camera_;
  double speed_;
  Box model_, reach_;  // bounds of the model, and of the points that may be orbited
  // In double, so that slow motion far from the origin does not stall.
  Vec3d eye_, up_, right_;  // right_ is perpendicular to up_, both of unit length
  double elevation_ = 0;    // angle of the view above the plane perpendicular to up_, radians
  double distance_ = 1;     // to the point that is orbited
};

}  // namespace whit::view
