#include "reference/media.h"

#include <array>
#include <cmath>

#include "bake/facet.h"
#include "reference/find_intersections.h"
#include "reference/intersect.h"
#include "reference/settle_coplanar.h"

namespace whit::reference {

namespace {

constexpr int kStackBits = 32, kEntryBits = 8;

std::uint32_t entryAt(MediaStack stack, int shift) { return stack >> shift & 0xff; }

MediaStack crossed(MediaStack stack, std::uint32_t medium, bool entering) {
  if (entering) return pushMedium(stack, medium);
  return removeMedium(stack, medium);
}

constexpr int kOtherBits = 10, kMostOthers = 3;

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
    candidate = settleSpheres(scene, effects, candidate);
    const TriangleHit hit = refineHit(scene, ray, candidate);
    const Surfel surfel = makeSurfel(scene, EffectSet(), candidate, hit, ray);
    std::vector<Place> places = placesAt(scene, effects, ray, candidate);

    // The ray goes on from the other side of the surface.
    ray.origin = surfel.position - surfel.geometricNormal * surfel.offset;
    if (places.empty()) {
      places = {{candidate, hit, scene.mediumOfMaterial[surfel.material], surfel.entering}};
    }

    // A medium that the ray leaves without having entered it surrounds the point.
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

// True if the point lies in the surface of a dielectric: the directions of rays that start there
// decide which medium they are in.
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

MediaStack pushMedium(MediaStack stack, std::uint32_t medium) {
  return stack << kEntryBits | medium;
}

MediaStack removeMedium(MediaStack stack, std::uint32_t medium) {
  for (int shift = 0; shift < kStackBits; shift += kEntryBits) {
    if (entryAt(stack, shift) != medium) continue;

    const std::uint32_t newerEntries = stack & ((1u << shift) - 1);
    // In 64 bits, because a shift by all 32 bits of a word is not defined.
    const std::uint64_t olderEntries = std::uint64_t{stack} >> (shift + kEntryBits) << shift;
    return static_cast<MediaStack>(olderEntries) | newerEntries;
  }
  return stack;
}

std::uint32_t currentMedium(const Scene& scene, MediaStack stack) {
  std::uint32_t best = 0;
  for (int shift = 0; shift < kStackBits; shift += kEntryBits) {
    const std::uint32_t medium = entryAt(stack, shift);
    if (medium == 0) continue;
    if (best == 0 || scene.media[medium].priority > scene.media[best].priority) best = medium;
  }
  return best;
}

std::uint32_t withCrossing(std::uint32_t others, std::uint32_t medium, bool entering) {
  if (others >> (kOtherBits * (kMostOthers - 1)) != 0) return others;
  return others << kOtherBits | medium << 1 | (entering ? 1 : 0);
}

Crossing crossMedia(const Scene& scene, EffectSet effects, std::uint32_t material, bool entering,
                    MediaStack stack, std::uint32_t others) {
  Crossing crossing;
  crossing.stackBehind = stack;
  if (!effects.has(Effect::transmission) || !scene.materials[material].passesLight()) {
    return crossing;
  }

  // The ray crosses the hit surface and all dielectrics whose faces share its place.
  const std::uint32_t medium = scene.mediumOfMaterial[material];
  crossing.dielectric = true;
  if (medium != 0) crossing.stackBehind = crossed(stack, medium, entering);
  for (; others != 0; others >>= kOtherBits) {
    const std::uint32_t other = others & ((1u << kOtherBits) - 1);
    if (other >> 1 == 0) continue;  // kSharesPlace
    crossing.stackBehind = crossed(crossing.stackBehind, other >> 1, (other & 1) != 0);
  }

  // The media of highest priority on both sides refract; where they are the same there is no
  // interface.
  const std::uint32_t before = currentMedium(scene, stack);
  const std::uint32_t behind = currentMedium(scene, crossing.stackBehind);
  crossing.hidden = medium != 0 && before == behind;
  crossing.n1 = scene.media[before].ior;
  crossing.n2 = scene.media[behind].ior;

  return crossing;
}

RgbD transmittance(const Scene& scene, MediaStack stack, double distance) {
  const Rgb& absorption = scene.media[currentMedium(scene, stack)].absorption;
  const auto channel = [&](double sigma) {
    const double opticalDepth = sigma * distance;
    // Zero times infinity: the channel is not absorbed, however far the ray goes.
    return std::isnan(opticalDepth) ? 1.0 : std::exp(-opticalDepth);
  };
  return {channel(absorption.x), channel(absorption.y), channel(absorption.z)};
}

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

  const Vec3d start = ray.origin + ray.direction * wayPastEye(ray.origin, kAttempt);
  return initialMediumStack(scene, effects, intersector, start);
}

}  // namespace whit::reference
