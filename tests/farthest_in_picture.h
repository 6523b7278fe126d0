// How far points reach in a picture.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/camera.h"

namespace whit {

// Returns how far the farthest of the points lies from the middle of the picture, in halves of its
// width or height. The points must lie before the camera.
inline double farthestInPicture(const CameraFrame& frame, const std::vector<Vec3d>& points) {
  double farthest = 0;
  for (const Vec3d& point : points) {
    const Vec3d way = point - frame.eye;
    const double depth = dot(way, frame.forward);
    EXPECT_GT(depth, 0);
    const double x = dot(way, frame.right) / dot(frame.right, frame.right) / depth;
    const double y = dot(way, frame.up) / dot(frame.up, frame.up) / depth;
    farthest = std::max({farthest, 2 * std::abs(x) / frame.width, 2 * std::abs(y) / frame.height});
  }
  return farthest;
}

}  // namespace whit
