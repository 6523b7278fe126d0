#include "surfaces/channel_values.h"

#include <algorithm>
#include <cmath>

#include "bake/facet.h"
#include "bake/sphere.h"
#include "core/error.h"

namespace whit {

namespace {

Vec3d earlierPosition(const Scene& scene, const EarlierView& earlier, const Candidate& hit,
                      const Vec3d& position) {
  const Affine* const toWorld = toWorldOf(scene, hit.instance);
  const std::uint32_t number = toWorld ? scene.instances[hit.instance].geometry : 0;
  Vec3d own = toWorld ? multiply(inverseRows(*toWorld), position - toWorld->p) : position;

  // Vertices that bend have moved within the geometry.
  const std::vector<Vec3f>& before = earlier.positions[number];
  if (!before.empty() && !scene.isSphere(hit.triangle)) {
    const Geometry& geometry = scene.geometries[number];
    const auto& corners = geometry.index[hit.triangle - geometry.firstTriangle];
    const double weights[] = {1 - hit.u - hit.v, hit.u, hit.v};
    for (std::size_t i = 0; i < 3; ++i) {
      own += (Vec3d(before[corners[i]]) - Vec3d(geometry.position[corners[i]])) * weights[i];
    }
  }

  return toWorld ? earlier.places[scene.instances[hit.instance].written].point(own) : own;
}

}  // namespace

EarlierView rememberView(const Scene& scene, const Camera& camera) {
  if (!makeCameraFrame(camera, 1, 1).isLinear()) {
    throwUsage(
        "--channels motion: expected a perspective or orthographic camera without "
        "distortion, found camera '" +
        camera.name + "'");
  }

  EarlierView view;
  view.camera = camera;
  // Instances that are flattened now are among those of the motion.
  for (const auto* instances : {&scene.motion.instances, &scene.instances}) {
    for (const InstanceRecord& instance : *instances) {
      if (view.places.size() <= instance.written) view.places.resize(instance.written + 1);
      view.places[instance.written] = instance.toWorld;
    }
  }

  view.positions.resize(scene.geometries.size());
  for (const BentVertices& bent : scene.motion.bent) {
    view.positions[bent.geometry] = scene.geometries[bent.geometry].position;
  }
  return view;
}

Vec2f motionOf(const Scene& scene, const EarlierView& earlier, const CameraFrame& camera,
               const Candidate& hit, const Vec3d& position) {
  const Vec3d before = earlierPosition(scene, earlier, hit, position);
  if (!earlier.frame.orthographic && dot(before - earlier.frame.eye, earlier.frame.forward) <= 0) {
    return {};
  }

  const auto [x, y] = imagePlace(camera, position);
  const auto [earlierX, earlierY] = imagePlace(earlier.frame, before);
  return {static_cast<float>(x - earlierX), static_cast<float>(y - earlierY)};
}

void keepFinish(const Material& material, const RgbD& specular, double alpha,
                ChannelValues& values) {
  // Surfaces without a lobe are smooth where they mirror or transmit, and matte elsewhere.
  const bool isSmooth = material.hasMirror() || material.hasTransmission();
  values.roughness = isSmooth ? 0 : 1;
  if (alpha > 0 && material.hasFacets()) values.roughness = static_cast<float>(std::sqrt(alpha));

  // The base color b and the metallic share m that have this diffuse color d = b (1 - m) and this
  // reflectance f = 0.04 (1 - m) + b m, as Khronos converts specular-glossiness. A reflectance of a
  // common dielectric, or of glass, has no metal in it.
  constexpr double kDielectric = 0.04, kRounding = 1e-6;
  const RgbD reflectance = isBlack(Rgb(specular)) ? RgbD(material.mirror) : specular;
  const double f = (reflectance.x + reflectance.y + reflectance.z) / 3;
  const Rgb& d = values.albedo;
  if (f < kDielectric + kRounding || material.hasTransmission()) return;

  const double half = (double{d.x + d.y + d.z} / 3 + f) / 2 - kDielectric;
  const double root = std::sqrt(half * half + kDielectric * (f - kDielectric));
  values.metallic = static_cast<float>(std::min((root - half) / kDielectric, 1.0));
}

}  // namespace whit
