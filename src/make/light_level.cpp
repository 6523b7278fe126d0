#include "make/light_level.h"

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/vec3.h"
#include "make/placed_triangles.h"
#include "scene/light.h"

namespace whit {
namespace {

// Returns the irradiance from the light at a point with this unit normal.
double irradiance(const Light& light, const Vec3d& point, const Vec3d& normal) {
  const Vec3d toLight = towards(light, point), direction = normalized(toLight);
  const double cosine = std::max(0.0, dot(normal, direction));
  if (light.kind == Light::Kind::directional) return luminance(light.intensity) * cosine;

  // Irradiance falls with the squared distance, but grows no more within the light's radius.
  const double radius{light.radius};
  const double square = std::max(dot(toLight, toLight), radius * radius);
  const double cone = light.kind == Light::Kind::spot ? coneOf(light).falloff(direction) : 1;
  return square > 0 ? luminance(light.intensity) * cone * cosine / square : 0;
}

}  // namespace

double lightLevel(const SceneDescription& scene) {
  constexpr std::uint64_t kMostTriangles = 20'000;

  // Each logarithm is weighted by twice the triangle's area; the factor cancels out.
  double sum = 0, area = 0;
  forEachPlacedTriangle(scene, kMostTriangles, [&](const Corners& t) {
    const Vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
    const double weight = length(normal);
    const Vec3d point = (t[0] + t[1] + t[2]) / 3.0;

    double light = 0;
    for (const Light& l : scene.lights) light += irradiance(l, point, normalized(normal));
    if (!(light > 0) || !std::isfinite(light) || !std::isfinite(weight)) return;

    // A white surface of this irradiance has the radiance irradiance / pi.
    sum += weight * std::log(light / std::numbers::pi);
    area += weight;
  });
  return area > 0 ? std::exp(sum / area) : 0;
}

}  // namespace whit
