#include "reference/initial_medium_stack.h"

#include <array>

#include "bake/eye_in_plane.h"
#include "reference/find_intersections.h"
#include "reference/settle_coplanar.h"
#include "reference/sphere.h"

namespace whit::reference {

namespace {

// In no plane, and through no edge, that a model is likely to have.
const Vec3d kProbe = normalized(Vec3d{0.3217, 0.8431, 0.4309});

// A straight line meets a triangle once, a sphere twice. Twice as many end what rounding might keep
// going.
std::uint64_t mostSurfaces(const Scene& scene) {
  return 2 * scene.instancedTriangles + 4 * scene.instancedSpheres + 16;
}

// The media whose surfaces a ray from the point leaves without having entered them first, the one
// left first in the low byte; at most four (hard case H47). However many opaque surfaces lie in
// between: they bound no medium. 0 without Effect::transmission.
MediaStack initialMediumStack(const Scene& scene, EffectSet effects, const Intersector& intersector,
                              const Vec3d& point) {
  if (!effects.has(Effect::transmission)) return 0;
  Ray ray{point, kProbe};
  const std::uint64_t most = mostSurfaces(scene);
  std::array<std::uint64_t, 256> entered{};
  MediaStack around = 0;
  int found = 0;
  for (std::uint64_t i = 0; i < most && found < 4; ++i) {
    Candidate candidate;
    if (!intersector.closest(ray, candidate)) break;
    candidate = settleSpheres(scene, effects, ray, candidate);
    const TriangleHit hit = refineHit(scene, ray, candidate);
    const Surfel surfel = makeSurfel(scene, EffectSet(), candidate, hit, ray);
    std::vector<Place> places = placesAt(scene, effects, ray, candidate);
    ray.origin = surfel.position - surfel.geometricNormal * surfel.offset;
    if (places.empty()) {
      places = {{candidate, hit, scene.mediumOfMaterial[surfel.material], surfel.entering}};
    }
    for (const Place& place : places) {
      if (place.medium == 0) continue;
      if (place.entering) {
        ++entered[place.medium];
      } else if (entered[place.medium] > 0) {
        --entered[place.medium];
      } else if (found < 4) {
        around |= static_cast<MediaStack>(place.medium) << (8 * found++);
      }
    }
  }
  return around;
}

// True if the point lies in the surface of a dielectric: rays that start there are in one medium or
// the other, each by its direction.
bool liesOnDielectric(const Scene& scene, EffectSet effects, const Intersector& intersector,
                      const Vec3d& point) {
  if (!effects.has(Effect::transmission)) return false;
  const auto startsOnOne = [&](const Vec3d& direction) {
    Candidate met;
    return intersector.closest({point, direction}, met) &&
           scene.mediumOfMaterial[scene.triangles[met.triangle].material] != 0 &&
           liesInSurface(scene, point, met.triangle, met.instance);
  };
  return startsOnOne(kProbe) || startsOnOne(-kProbe);
}

}  // namespace

CameraFrame frameWithMedia(const Scene& scene, EffectSet effects, const Intersector& intersector,
                           const Camera& camera, int width, int height) {
  Camera seen = camera;
  if (!effects.has(Effect::depthOfField)) seen.aperture = 0;
  CameraFrame frame = makeCameraFrame(seen, width, height);
  frame.media = initialMediumStack(scene, effects, intersector, frame.eye);
  frame.mediaVary =
      frame.reach != Vec3d() || liesOnDielectric(scene, effects, intersector, frame.eye);
  return frame;
}

MediaStack mediaAtStart(const Scene& scene, EffectSet effects, const Intersector& intersector,
                        const CameraFrame& camera, const Ray& ray) {
  // Far enough for the rounding of the sum where a ray leaves at a hundredth of a right angle.
  constexpr int kAttempt = 6;
  if (!camera.mediaVary) return camera.media;
  const Vec3d start = ray.origin + ray.direction * wayPastEye(ray.origin, kAttempt);
  return initialMediumStack(scene, effects, intersector, start);
}

}  // namespace whit::reference
