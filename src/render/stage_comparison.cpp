// whit compare --stages: each vector stage against its scalar twin, on the very same input.
#include <cmath>
#include <limits>
#include <optional>

#include "core/display.h"
#include "core/pixel.h"
#include "reference/generate_ray.h"
#include "reference/glossy.h"
#include "reference/impulses.h"
#include "reference/media.h"
#include "reference/shading.h"
#include "reference/surfel.h"
#include "reference/triangle.h"
#include "render/pixel_tracker.h"
#include "render/renderer_parts.h"
#include "render/stage_limits.h"
#include "render/widen.h"

namespace whit {

namespace {

constexpr std::size_t kSlotsPerStage = 200000;  // a sample of the frame is plenty, and much faster

class StageComparer : public StageObserver {
 public:
  StageComparer(const Scene& scene, const Plan& plan, const FrameJob& job)
      : scene_(scene), plan_(plan), shading_(job.tables->shading), job_(job) {
    if (plan.groups.cones) maps_.emplace(scene);
  }

  void after(Stage stage, const ChunkView& chunk) override {
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

  std::vector<StageDifference> rows;

  void compareImage(const Film& film) {
    for (int y = film.image.window.y0; y < film.image.window.y1; ++y) {
      for (int x = film.image.window.x0; x < film.image.window.x1; ++x) {
        const auto pixel = static_cast<std::size_t>(y - film.image.window.y0) *
                               static_cast<std::size_t>(film.image.windowWidth()) +
                           static_cast<std::size_t>(x - film.image.window.x0);
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

 private:
  bool enough(Stage stage) const {
    for (const StageDifference& row : rows) {
      if (row.stage == stage && row.slots > kSlotsPerStage) return true;
    }
    return false;
  }

  void note(Stage stage, const char* column, double ulp, double limit, std::uint32_t pixel,
            int depth) {
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

  // `scale`: the magnitude whose ulp counts, at least the larger of the two vectors' components.
  void compare(Stage stage, const char* column, const Vec3d& got, const Vec3d& wanted, double scale,
               double limit, const ChunkView& chunk, std::size_t slot) {
    const double ulp = ulpOf(std::max({scale, maxComponent(abs(got)), maxComponent(abs(wanted))}));
    const double worst = maxComponent(abs(got - wanted)) / ulp;
    const bool bad = !isFinite(got);
    note(stage, column, bad ? std::numeric_limits<double>::infinity() : worst, limit,
         tracker_.pixel(chunk, slot), chunk.depth);
  }

  void compareRays(const ChunkView& c) {
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

  void compareSurfels(const ChunkView& c) {
    if (enough(Stage::findIntersections)) return;
    for (std::size_t i = 0; i < c.n; ++i) {
      if (c.hits.triangle[i] == kMiss) continue;
      const reference::Candidate candidate = candidateOf(c.hits, i);
      const reference::TriangleHit hit{static_cast<double>(c.hits.t[i]), candidate.u, candidate.v};
      const reference::Surfel got = surfelOf(c, i);
      const reference::TextureLookup lookup{shading_.textureFilter, maps_ ? &*maps_ : nullptr,
                                            got.cone};
      const reference::Surfel twin = reference::makeSurfel(scene_, plan_.effects, candidate, hit,
                                                           directionOf(c.rays, i), lookup);
      // The offset is 32 units in the last place of all that went into the position.
      const double magnitude = twin.offset * 0x1p19;
      constexpr Stage stage = Stage::findIntersections;
      compare(stage, "position", got.position, twin.position, magnitude, kPositionLimit, c, i);
      // A surface seen edge on may be entered in one precision and left in the other.
      const double cosine = std::fabs(dot(twin.geometricNormal, twin.view));
      if (cosine < 1e-5) continue;
      const double sliver = sliverFactor(candidate);
      compare(stage, "geometricNormal", got.geometricNormal, twin.geometricNormal, sliver,
              kNormalLimit, c, i);
      const bool mapped = plan_.effects.has(Effect::normalMaps);
      compare(stage, "shadingNormal", got.shadingNormal, twin.shadingNormal, sliver,
              mapped ? kTexturedLimit : kNormalLimit, c, i);
      // The footprint is as uncertain as area and cosine, which it is divided by.
      const double footprint = maps_ ? kFootprintLimit / kTexturedLimit * sliver / cosine : 0;
      const double colour = std::max(1.0, footprint);
      compare(stage, "diffuse", got.diffuse, twin.diffuse, colour, kTexturedLimit, c, i);
      if (maps_) {
        const RayCone cone{static_cast<double>(c.rays.cone[i]), job_.coneSpread};
        compare(stage, "cone", Vec3d(got.cone.width), Vec3d(cone.widthAt(hit.t)), 0, kConeLimit, c,
                i);
      }
      if (plan_.groups.lift) {
        compare(stage, "lift", got.lift, twin.lift, magnitude, kLiftLimit, c, i);
      }
      if (plan_.groups.emission) {
        compare(stage, "emission", got.emission, twin.emission, colour, kTexturedLimit, c, i);
      }
      if (plan_.groups.glossy) {
        compare(stage, "specular", got.specular, twin.specular, colour, kTexturedLimit, c, i);
      }
    }
  }

  // How much the cross product of the edges amplifies their rounding.
  double sliverFactor(const reference::Candidate& candidate) const {
    const reference::Corners p =
        reference::worldCorners(scene_, candidate.triangle, candidate.instance);
    const Vec3d a = p[1] - p[0], b = p[2] - p[0];
    return length(a) * length(b) / std::max(length(cross(a, b)), 1e-300);
  }

  bool hidden(const ChunkView& c, std::size_t i) const {
    return c.surfels.flags && (c.surfels.flags[i] & kHidden) != 0;
  }

  void compareAmbient(const ChunkView& c) {
    if (enough(Stage::writeEmittedAndReflectiveAmbient)) return;
    for (std::size_t i = 0; i < c.n; ++i) {
      RgbD twin;
      double limit = kRadianceLimit;
      if (c.surfels.material[i] == kMiss) {
        twin = reference::skyAlong(scene_, plan_.effects, directionOf(c.rays, i));
        limit = kSkyLimit;
      } else if (!hidden(c, i)) {
        twin = reference::emittedAndAmbient(scene_, plan_.effects, surfelOf(c, i));
      }
      const bool miss = c.surfels.material[i] == kMiss;
      compare(Stage::writeEmittedAndReflectiveAmbient, miss ? "sky" : "radiance",
              radianceOf(c.radiance, i), twin, 0, limit, c, i);
    }
  }

  void compareLight(const ChunkView& c) {
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
  double grazingScale(const ChunkView& c, std::size_t i, const RgbD& radiance) const {
    const reference::Surfel s = surfelOf(c, i);
    const Vec3d l = normalized(towards(*c.light, s.position));
    const double width = maxComponent(s.specular) > 0 ? s.alpha : 1;
    const double scale = maxComponent(radiance) / (std::max(dot(l, s.shadingNormal), 1e-4) * width);
    if (c.light->kind != Light::Kind::spot) return scale;
    // Likewise the cosine to the cone's axis, over the width of its edge.
    const SpotCone cone = coneOf(*c.light);
    return scale * std::max(1.0, 2 * cone.scale / std::max(std::sqrt(cone.falloff(l)), 1e-4));
  }

  void compareVisibility(const ChunkView& c) {
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

  void keepRadiance(const ChunkView& c) {
    before_.clear();
    for (std::size_t i = 0; i < c.n; ++i) before_.push_back(radianceOf(c.radiance, i));
  }

  void compareSums(const ChunkView& c) {
    if (enough(Stage::addShading)) return;
    for (std::size_t i = 0; i < c.n; ++i) {
      RgbD twin = before_[i];
      if (c.unshadowed.visible[i] > 0) {
        twin += RgbD{c.unshadowed.r[i], c.unshadowed.g[i], c.unshadowed.b[i]};
      }
      compare(Stage::addShading, "radiance", radianceOf(c.radiance, i), twin, 0, kSumLimit, c, i);
    }
  }

  void compareChildren(const ChunkView& c) {
    if (enough(Stage::addImpulses)) return;
    for (std::size_t k = 0; k < c.reflections + c.refractions; ++k) {
      const std::size_t i = c.children.parent[k];
      const reference::Surfel surfel = surfelOf(c, i);
      const std::uint32_t stack = c.rays.media ? c.rays.media[i] : 0;
      const reference::Crossing crossing =
          reference::crossMedia(scene_, plan_.effects, surfel.material, surfel.entering, stack);
      const reference::Impulses twins =
          reference::findImpulses(scene_, plan_.effects, surfel, crossing, stack, shading_);
      reference::Impulse twin = k < c.reflections ? twins.reflected : twins.refracted;
      if (k < c.reflections && c.children.path) {
        const std::uint32_t mirrored = childPath(c.rays.path[i], kMirroredBranch);
        if (c.children.path[k] != mirrored) twin = sampledTwin(c, k, surfel, stack);
      }
      constexpr Stage stage = Stage::addImpulses;
      const Vec3d weight{c.children.weightR[k], c.children.weightG[k], c.children.weightB[k]};
      compare(stage, "weight", weight, twin.weight, 1, kWeightLimit, c, i);
      // Near the critical angle the root amplifies rounding without bound; there the weight of the
      // refracted ray goes to zero with it.
      if (maxComponent(twin.weight) < 0.05) continue;
      compare(stage, "direction", directionOf(c.children, k), twin.ray.direction, 1, kChildLimit, c,
              i);
      compare(stage, "origin", originOf(c.children, k), twin.ray.origin, 0, kPositionLimit, c, i);
      if (c.children.cone) {
        note(stage, "cone", c.children.cone[k] == c.surfels.cone[i] ? 0 : 1, kExact,
             tracker_.pixel(c, i), c.depth);
      }
      if (c.children.media) {
        note(stage, "media", c.children.media[k] == twin.media ? 0 : 1, kExact,
             tracker_.pixel(c, i), c.depth);
      }
    }
  }

  // Of the sample of the lobe that the child's path says it is. None: no weight.
  reference::Impulse sampledTwin(const ChunkView& c, std::size_t child,
                                 const reference::Surfel& surfel, std::uint32_t stack) const {
    const std::uint32_t path = c.rays.path[c.children.parent[child]];
    const LobeSampling sampling = lobeSampling(c.depth, plan_.glossySamples, c.sampleNumber);
    const int rays = reference::lobeRays(surfel, sampling);
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(rays); ++k) {
      if (c.children.path[child] != childPath(path, kFirstGlossyBranch + k)) continue;
      const UnitPoint at = lobePoint(path, sampling, k);
      reference::Impulse twin = reference::glossyImpulse(surfel, stack, at, shading_);
      twin.weight = twin.weight / rays;
      return twin;
    }
    return {};
  }

  reference::Surfel surfelOf(const ChunkView& c, std::size_t i) const {
    return widenSurfel(c.surfels, directionOf(c.rays, i), i);
  }

  const Scene& scene_;
  const Plan& plan_;
  const ShadingChoices& shading_;
  const FrameJob& job_;
  std::optional<MipMaps> maps_;  // where lookups are trilinear
  PixelTracker tracker_;
  std::vector<RgbD> before_;
};

}  // namespace

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
