#include "stress/dielectric_surface.h"

#include <algorithm>
#include <cmath>

#include "stress/scene_builder.h"

namespace whit::stress {

Incidence raysAt(const std::vector<double>& cosines) {
  Incidence incidence;
  for (const double c : cosines) {
    // The vertical component is what counts, and is kept as it is.
    const auto down = static_cast<float>(c);
    const double rounded = static_cast<double>(down);
    const auto along = static_cast<float>(std::sqrt(std::max(0.0, (1 - rounded) * (1 + rounded))));
    incidence.rays.push_back({{0, 1, 0}, {along, -down, 0}});
    incidence.cosines.push_back(rounded);
  }
  return incidence;
}

Interfaces throughKernels(float from, float to, const Incidence& incidence, const Setup& setup) {
  SceneBuilder builder;
  const auto front = builder.add(glassMaterial(from)), behind = builder.add(glassMaterial(to));
  builder.add(floorAt(0, 1, front));
  builder.add(floorAt(1, 1, behind));
  const Scene scene = builder.build();
  Probe probe(scene, setup);
  std::vector<ProbeRay> rays = incidence.rays;
  for (ProbeRay& ray : rays) ray.media = probe.tables().materials[front].medium;
  probe.load(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) probe.surfel(i, behind, {0, 1, 0}, {0, 1, 0});
  Interfaces result;
  result.reflected.assign(rays.size(), 0);
  result.refracted.assign(rays.size(), 0);
  result.direction.resize(rays.size());
  for (const ProbeChild& child : probe.reflections()) {
    result.reflected[child.parent] = static_cast<double>(child.weight.x);
  }
  for (const ProbeChild& child : probe.refractions()) {
    result.refracted[child.parent] = static_cast<double>(child.weight.x);
    result.direction[child.parent] = Vec3d(child.ray.direction);
  }
  return result;
}

Real fresnel(Real n1, Real n2, Real c) {
  const Real s2 = (1 - c) * (1 + c) * n1 * n1 / (n2 * n2);
  if (s2 >= 1) return 1;
  const Real t = std::sqrt(1 - s2);
  const Real rs = (n1 * c - n2 * t) / (n1 * c + n2 * t), rp = (n2 * c - n1 * t) / (n2 * c + n1 * t);
  return (rs * rs + rp * rp) / 2;
}

}  // namespace whit::stress
