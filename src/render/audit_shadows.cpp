#include <algorithm>
#include <vector>

#include "accel/accel.h"
#include "core/error.h"
#include "core/formatted.h"
#include "render/frame.h"
#include "render/steps.h"
#include "simd/kernels.h"

namespace whit {

namespace {

// A shadow ray, kept before the kernel packs what is left more closely.
struct KeptRay {
  std::uint32_t slot;
  Vec3f origin, direction;
  float tFar;
};

std::vector<KeptRay> raysOf(const Chunk& c) {
  std::vector<KeptRay> rays;
  const ShadowColumns& s = c.shadows;
  for (std::size_t i = 0; i < c.shadowCount; ++i) {
    rays.push_back({s.slot[i],
                    {s.orgX[i], s.orgY[i], s.orgZ[i]},
                    {s.dirX[i], s.dirY[i], s.dirZ[i]},
                    s.tFar[i]});
  }
  return rays;
}

}  // namespace

void auditShadows(Chunk& c) {
  const std::vector<KeptRay> rays = raysOf(c);
  simd::kDecideShadows.find()(c);
  const std::uint32_t *const slots = c.shadows.slot, *const end = slots + c.shadowCount;
  for (const KeptRay& ray : rays) {
    if (std::binary_search(slots, end, ray.slot)) continue;
    const bool lit = c.unshadowed.visible[ray.slot] > 0;
    if (c.frame->accel->occluded(ray.origin, ray.direction, ray.tFar) != lit) continue;
    if (c.meter->wrongShadow) return;
    c.meter->wrongShadow = {true,       lit,          c.lightNumber, c.hits.triangle[ray.slot],
                            ray.origin, ray.direction};
    return;
  }
}

void requireRightShadows(const FrameStats& stats, const Scene& scene) {
  const WrongShadow& wrong = stats.meter.wrongShadow;
  if (!wrong) return;
  const Vec3f &o = wrong.origin, &d = wrong.direction;
  const std::string& name = scene.lights[wrong.light].name;
  throw Error(
      ExitStatus::checkFailed,
      formatted("the shadow cache is wrong: light %u%s%s, triangle %u, the ray from (%.9g, %.9g, "
                "%.9g) along (%.9g, %.9g, %.9g) is %s, and the cache says %s",
                wrong.light, name.empty() ? "" : " ", name.c_str(), wrong.triangle, o.x, o.y, o.z,
                d.x, d.y, d.z, wrong.saidLit ? "blocked" : "not blocked",
                wrong.saidLit ? "lit" : "dark"));
}

}  // namespace whit
