#include "surfaces/initial_media.h"

#include <array>
#include <vector>

#include "bake/facet.h"
#include "surfaces/choose_surface.h"
#include "surfaces/surface_point.h"

namespace whit {

namespace {

// The direction lies in no plane and passes through no edge that a model is likely to have.
const Vec3d kProbe = normalized(Vec3d{0.3217, 0.8431, 0.4309});

// Upper bound on the hits along a straight line: one with each triangle, two with each sphere, and
// twice that, so that rounding cannot keep the search going.
std::uint64_t mostSurfaces(const Scene& scene) {
  return 2 * scene.instancedTriangles + 4 * scene.instancedSpheres + 16;
}

// Returns the media whose surfaces a ray from the point leaves without having entered them first,
// the one left first in the low byte; at most four (hard case H47). Opaque surfaces in between
// bound no medium and are passed. 0 without Effect::transmission.
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
    candidate = chooseSphere(scene, effects, candidate);
    const TriangleHit hit = refineHit(scene, ray, candidate);
    const SurfacePoint at = surfacePoint(scene, candidate, hit, ray);
    std::vector<SurfaceHit> crossed = coplanarHits(scene, effects, ray, candidate);

    // The ray goes on from the other side of the surface.
    ray.origin = at.position - at.geometricNormal * at.offset;
    if (crossed.empty()) {
      const std::uint32_t material = scene.triangles[candidate.triangle].material;
      crossed = {{candidate, hit, scene.mediumOfMaterial[material], at.entering}};
    }

    // A medium that the ray leaves without having entered it surrounds the point.
    for (const SurfaceHit& surface : crossed) {
      if (surface.medium == 0) continue;
      if (surface.entering) {
        ++entered[surface.medium];
      } else if (entered[surface.medium] > 0) {
        --entered[surface.medium];
      } else if (found < 4) {
        around |= static_cast<MediaStack>(surface.medium) << (8 * found++);
      }
    }
  }

  return around;
}

// True if the point lies in the surface of a dielectric: the directions of rays that start there
// decide which medium they are in.
bool liesOnDielectric(const Scene& scene, EffectSet effects, const Intersector& intersector,
                      const Vec3d& point) {
  if (!effects.has(Effect::transmission)) return false;

  const auto startsOnOne = [&](const Vec3d& direction) {
    Candidate found;
    return intersector.closest({point, direction}, found) &&
           scene.mediumOfMaterial[scene.triangles[found.triangle].material] != 0 &&
           liesInSurface(scene, point, found.triangle, found.instance);
  };

  return startsOnOne(kProbe) || startsOnOne(-kProbe);
}

}  // namespace

CameraFrame frameWithMedia(const Scene& scene, EffectSet effects, const Intersector& intersector,
                           const Camera& camera, int width, int height, int samples) {
  Camera seen = camera;
  if (!effects.has(Effect::depthOfField)) seen.aperture = 0;
  CameraFrame frame = makeCameraFrame(seen, width, height);

  // Averaging the samples of a pixel filters textures as well: with 1 / sqrt(samples) pictures are
  // more blurred than those of many samples.
  frame.footprint = 1.0 / samples;

  frame.media = initialMediumStack(scene, effects, intersector, frame.eye);
  frame.mediaVary =
      frame.reach != Vec3d() || liesOnDielectric(scene, effects, intersector, frame.eye);

  return frame;
}

MediaStack mediaAtStart(const Scene& scene, EffectSet effects, const Intersector& intersector,
                        const CameraFrame& camera, const Ray& ray) {
  // This is far enough for the rounding of the sum where a ray leaves the surface at a hundredth of
  // a right angle.
  constexpr int kAttempt = 6;
  if (!camera.mediaVary) return camera.media;

  const Vec3d start = ray.origin + ray.direction * distancePastEye(ray.origin, kAttempt);
  return initialMediumStack(scene, effects, intersector, start);
}

}  // namespace whit
