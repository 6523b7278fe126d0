#include "make/turntable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "core/affine.h"
#include "core/index.h"
#include "core/vec3.h"
#include "make/placed_triangles.h"

namespace whit {
namespace {

// Number of slices of equal height that make up the silhouette of a model on a turntable.
constexpr std::size_t kSlices = 64;

// The distance of the scene's outermost points from the axis, for each slice of its height.
struct Silhouette {
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  std::array<double, kSlices> radius{};

  std::size_t sliceOf(double y) const {
    const double share = high > low ? (y - low) / (high - low) : 0;
    return std::min(static_cast<std::size_t>(share * kSlices), kSlices - 1);
  }
  double begin(std::size_t slice) const {
    return low + (high - low) * static_cast<double>(slice) / kSlices;
  }
};

Silhouette silhouetteOf(const SceneDescription& scene, const Vec3d& center) {
  Silhouette silhouette;
  // The range of heights defines the slices, so it is found in a pass of its own.
  forEachPlacedCorner(scene, kEveryTriangle, [&](const Vec3d& corner) {
    const Vec3d p = corner - center;
    silhouette.low = std::min(silhouette.low, p.y);
    silhouette.high = std::max(silhouette.high, p.y);
  });

  forEachPlacedCorner(scene, kEveryTriangle, [&](const Vec3d& corner) {
    const Vec3d p = corner - center;
    double& radius = silhouette.radius[silhouette.sliceOf(p.y)];
    radius = std::max(radius, std::hypot(p.x, p.z));
  });
  return silhouette;
}

// Returns the distance from the center at which an eye sees the whole circle of this radius and
// height. `sine` is that of the eye's elevation, `half` half the picture's height at distance 1.
double distanceFor(double radius, double y, double sine, double half, double aspect) {
  constexpr int kAngles = 64;
  const double cosine = std::sqrt(1 - sine * sine);

  // The circle is sampled at kAngles points, each of which needs a distance of its own.
  double distance = 0;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = 2 * std::numbers::pi * i / kAngles;
    const double across = radius * std::sin(angle), along = radius * std::cos(angle);

    // `up` lies in the plane of the picture, `near` points towards the eye.
    const double up = y * cosine - along * sine, near = along * cosine + y * sine;
    distance = std::max(distance, near + std::max(std::abs(across) / aspect, std::abs(up)) / half);
  }
  return distance;
}

}  // namespace

Camera turned(const Turntable& turntable, double turns) {
  const double whole = turns - std::floor(turns);
  if (whole == 0) return turntable.camera;

  const Affine rotation = Affine::rotation(turntable.axis, 360 * whole);
  Camera camera = turntable.camera;
  const auto around = [&](const Vec3f& p) {
    return Vec3f(turntable.pivot + rotation.vector(Vec3d(p) - turntable.pivot));
  };

  camera.eye = around(camera.eye);
  camera.at = around(camera.at);
  camera.up = Vec3f(rotation.vector(Vec3d(camera.up)));
  return camera;
}

Turntable aroundModel(const SceneDescription& scene, const ModelView& view, int width, int height) {
  Turntable turntable{view.camera, Vec3d(view.camera.eye)};
  if (view.inside || !(view.radius > 0)) return turntable;

  const Vec3d side = normalized(Vec3d(view.camera.eye) - Vec3d(view.camera.at));
  const double half = std::tan(view.camera.fov * (std::numbers::pi / 360)) / kModelMargin;
  const double aspect = static_cast<double>(width) / height;

  // While the model turns, each slice of its silhouette sweeps a ring. The picture holds the edges
  // of all rings.
  const Silhouette silhouette = silhouetteOf(scene, view.center);
  double distance = 0;
  for (const auto i : indices(kSlices)) {
    for (const double y : {silhouette.begin(i), silhouette.begin(i + 1)}) {
      distance = std::max(distance, distanceFor(silhouette.radius[i], y, side.y, half, aspect));
    }
  }

  turntable.pivot = view.center;
  turntable.camera.at = Vec3f(view.center);
  turntable.camera.eye = Vec3f(view.center + side * (distance / scene.zoom));
  return turntable;
}

Turntable aroundTarget(const Camera& camera) {
  return {camera, Vec3d(camera.at), normalized(Vec3d(camera.up), Vec3d{0, 1, 0})};
}

}  // namespace whit
