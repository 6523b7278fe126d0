#include "reference/initial_medium_stack.h"

#include <array>

#include "reference/find_intersections.h"
#include "reference/triangle.h"

namespace whit::reference {

MediaStack initialMediumStack(const Scene& scene, EffectSet effects, const Intersector& intersector,
                              const Vec3d& point) {
  constexpr int kMostSurfaces = 256;
  if (!effects.has(Effect::transmission)) return 0;
  // In no plane, and through no edge, that a model is likely to have.
  Ray ray{point, normalized(Vec3d{0.3217, 0.8431, 0.4309})};
  std::array<int, 256> entered{};
  MediaStack around = 0;
  for (int i = 0, found = 0; i < kMostSurfaces && found < 4; ++i) {
    Candidate candidate;
    if (!intersector.closest(ray, candidate)) break;
    const TriangleHit hit = refineHit(scene, ray, candidate);
    const Surfel surfel = makeSurfel(scene, effects, candidate, hit, ray.direction);
    ray.origin = surfel.position - surfel.geometricNormal * surfel.offset;
    const std::uint8_t medium = scene.mediumOfMaterial[surfel.material];
    if (medium == 0) continue;
    if (surfel.entering) {
      ++entered[medium];
    } else if (entered[medium] > 0) {
      --entered[medium];
    } else {
      around |= static_cast<MediaStack>(medium) << (8 * found++);
    }
  }
  return around;
}

}  // namespace whit::reference
