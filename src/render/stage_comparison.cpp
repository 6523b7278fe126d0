// whit compare --stages: each vector stage against its scalar twin, on the very same input.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/display.h"
#include "core/pixel.h"
#include "reference/generate_ray.h"
#include "reference/shading.h"
#include "render/stage_comparer.h"
#include "render/stage_limits.h"
#include "render/widen.h"

namespace whit {

namespace {

constexpr std::size_t kSlotsPerStage = 200000;  // a sample of the frame is plenty, and much faster

bool isHidden(const ChunkView& c, std::size_t i) {
  return c.surfels.flags && (c.surfels.flags[i] & kHidden) != 0;
}

}  // namespace

StageComparer::StageComparer(const Scene& scene, const Plan& plan, const FrameJob& job)
    : scene_(scene), plan_(plan), shading_(job.tables->shading), job_(job) {
  if (plan.groups.cones) maps_.emplace(scene);
}

void StageComparer::after(Stage stage, const ChunkView& chunk) {
  tracker_.follow(stage, chunk);
  switch (stage) {
    case Stage::generateRays:
      return compareRays(chunk);
    case Stage::findIntersections:
      return compareSurfels(chunk);
    case Stage::writeEmittedAndReflectiveAmbient:
      compareAmbient(chunk);
      return keepRadiance(chunk);
    case Stage::findRadianceAndShadowRays:
      return compareLight(chunk);
    case Stage::checkShadows:
      return compareVisibility(chunk);
    case Stage::addShading:
      compareSums(chunk);
      return keepRadiance(chunk);
    case Stage::addImpulses:
      return compareChildren(chunk);
    case Stage::updateImage:
      return;
  }
}

bool StageComparer::enough(Stage stage) const {
  for (const StageDifference& row : rows) {
    if (row.stage == stage && row.slots > kSlotsPerStage) return true;
  }
  return false;
}

void StageComparer::note(Stage stage, const char* column, double ulp, double limit,
                         std::uint32_t pixel, int depth) {
  StageDifference* row = nullptr;
  for (StageDifference& r : rows) {
    if (r.stage == stage && r.column == column) row = &r;
  }
  if (!row) {
    rows.push_back({stage, column, 0, 0, limit, 0, 0, 0});
    row = &rows.back();
  }
  ++row->slots;
  // Written so that a NaN counts as worse than anything.
  if (ulp <= row->worstUlp) return;
  row->worstUlp = std::isnan(ulp) ? std::numeric_limits<double>::infinity() : ulp;
  row->pixelX = pixelX(pixel);
  row->pixelY = pixelY(pixel);
  row->depth = depth;
}

void StageComparer::compare(Stage stage, const char* column, const Vec3d& got, const Vec3d& wanted,
                            double scale, double limit, const ChunkView& chunk, std::size_t slot) {
  const double ulp = ulpOf(std::max({scale, maxComponent(abs(got)), maxComponent(abs(wanted))}));
  const double worst = maxComponent(abs(got - wanted)) / ulp;
  const bool bad = !isFinite(got);
  note(stage, column, bad ? std::numeric_limits<double>::infinity() : worst, limit,
       tracker_.pixel(chunk, slot), chunk.depth);
}

void StageComparer::compareRays(const ChunkView& c) {
  if (enough(Stage::generateRays)) return;
  for (std::size_t i = 0; i < c.n; ++i) {
    const double x = pixelX(c.pixels[c.first + i]) + static_cast<double>(c.sample.x);
    const double y = pixelY(c.pixels[c.first + i]) + static_cast<double>(c.sample.y);
    const reference::Ray ray = reference::generateRay(job_.camera, x, y);
    compare(Stage::generateRays, "origin", originOf(c.rays, i), ray.origin,
            maxComponent(abs(job_.camera.eye)), kPositionLimit, c, i);
    compare(Stage::generateRays, "dir", directionOf(c.rays, i), ray.direction, 1, kDirectionLimit,
            c, i);
  }
}

void StageComparer::compareAmbient(const ChunkView& c) {
  if (enough(Stage::writeEmittedAndReflectiveAmbient)) return;
  for (std::size_t i = 0; i < c.n; ++i) {
    RgbD twin;
    double limit = kRadianceLimit;
    if (c.surfels.material[i] == kMiss) {
      twin = reference::skyAlong(scene_, plan_.effects, directionOf(c.rays, i));
      limit = kSkyLimit;
    } else if (!isHidden(c, i)) {
      twin = reference::emittedAndAmbient(scene_, plan_.effects, surfelOf(c, i));
    }
    const bool miss = c.surfels.material[i] == kMiss;
    compare(Stage::writeEmittedAndReflectiveAmbient, miss ? "sky" : "radiance",
            radianceOf(c.radiance, i), twin, 0, limit, c, i);
  }
}

void StageComparer::compareLight(const ChunkView& c) {
  if (enough(Stage::findRadianceAndShadowRays)) return;
  for (std::size_t k = 0; k < c.shadowCount; ++k) {
    const std::size_t i = c.shadows.slot[k];
    const reference::LightArrival twin =
        reference::radianceFromLight(plan_.effects, surfelOf(c, i), *c.light, shading_);
    const RgbD got{c.unshadowed.r[i], c.unshadowed.g[i], c.unshadowed.b[i]};
    constexpr Stage stage = Stage::findRadianceAndShadowRays;
    if (maxComponent(abs(twin.radiance)) == 0) continue;  // the light lies in the surface's plane
    compare(stage, "unshadowed", got, twin.radiance, grazingScale(c, i, twin.radiance),
            kRadianceLimit, c, i);
    const Vec3d origin{c.shadows.orgX[k], c.shadows.orgY[k], c.shadows.orgZ[k]};
    const Vec3d direction{c.shadows.dirX[k], c.shadows.dirY[k], c.shadows.dirZ[k]};
    const bool directional = c.light->kind == Light::Kind::directional;
    const double end = directional ? 1 : maxComponent(abs(Vec3d(c.light->position)));
    const double far = end + (directional ? 0 : maxComponent(abs(origin)));
    compare(stage, "shadowOrigin", origin, twin.shadowRay.origin, 0, kPositionLimit, c, i);
    compare(stage, "shadowDirection", direction, twin.shadowRay.direction, far, kPositionLimit, c,
            i);
  }
}

// What the radiance would be without the cosine, whose rounding error is absolute. An ulp of the
// half vector, over the width of the lobe, is how much a highlight moves.
double StageComparer::grazingScale(const ChunkView& c, std::size_t i, const RgbD& radiance) const {
  const reference::Surfel s = surfelOf(c, i);
  const Vec3d l = normalized(towards(*c.light, s.position));
  const double width = maxComponent(s.specular) > 0 ? s.alpha : 1;
  const double scale = maxComponent(radiance) / (std::max(dot(l, s.shadingNormal), 1e-4) * width);
  if (c.light->kind != Light::Kind::spot) return scale;
  // Likewise the cosine to the cone's axis, over the width of its edge.
  const SpotCone cone = coneOf(*c.light);
  return scale * std::max(1.0, 2 * cone.scale / std::max(std::sqrt(cone.falloff(l)), 1e-4));
}

void StageComparer::compareVisibility(const ChunkView& c) {
  if (enough(Stage::checkShadows)) return;
  for (std::size_t k = 0; k < c.shadowCount; ++k) {
    const Vec3f origin{c.shadows.orgX[k], c.shadows.orgY[k], c.shadows.orgZ[k]};
    const Vec3f direction{c.shadows.dirX[k], c.shadows.dirY[k], c.shadows.dirZ[k]};
    const bool blocked = job_.accel->occluded(origin, direction, c.shadows.tFar[k]);
    const bool visible = c.unshadowed.visible[c.shadows.slot[k]] > 0;
    note(Stage::checkShadows, "visible", blocked == visible ? 1 : 0, kExact,
         tracker_.pixel(c, c.shadows.slot[k]), c.depth);
  }
}

void StageComparer::keepRadiance(const ChunkView& c) {
  before_.clear();
  for (std::size_t i = 0; i < c.n; ++i) before_.push_back(radianceOf(c.radiance, i));
}

void StageComparer::compareSums(const ChunkView& c) {
  if (enough(Stage::addShading)) return;
  for (std::size_t i = 0; i < c.n; ++i) {
    RgbD twin = before_[i];
    if (c.unshadowed.visible[i] > 0) {
      twin += RgbD{c.unshadowed.r[i], c.unshadowed.g[i], c.unshadowed.b[i]};
    }
    compare(Stage::addShading, "radiance", radianceOf(c.radiance, i), twin, 0, kSumLimit, c, i);
  }
}

void StageComparer::compareImage(const Film& film) {
  for (int y = film.image.window.y0; y < film.image.window.y1; ++y) {
    for (int x = film.image.window.x0; x < film.image.window.x1; ++x) {
      const std::size_t pixel = film.image.index(x, y);
      const DisplayImage twin = [&] {
        Image one(1, 1);
        one.pixels[0] = film.image.pixels[pixel];
        return toDisplay(one, 0, job_.toneCurve, job_.srgb);
      }();
      int worst = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        worst =
            std::max(worst, std::abs(int{twin.rgba[c]} - int{film.display.rgba[4 * pixel + c]}));
      }
      note(Stage::updateImage, "code", worst, kExact, packedPixel(x, y), 0);
    }
  }
}

std::vector<StageDifference> compareStages(Renderer& renderer, const Camera& camera,
                                           const Film& film) {
  Renderer::Parts& p = renderer.parts();
  Film scratch = film;
  scratch.wantDisplay = true;
  FrameJob job = p.makeJob(camera, scratch, scratch.image.window);
  job.exposureScale = 1;
  StageComparer comparer(p.scene, p.plan, job);
  p.renderObserved(job, comparer);
  comparer.compareImage(scratch);
  return comparer.rows;
}

}  // namespace whit
