#include "render/tile_pass.h"

#include <algorithm>
#include <cmath>

#include "core/pixel.h"

namespace whit {

namespace {

RayTally& tallyOf(FrameStats& stats, RayKind kind) {
  return stats.tally[static_cast<std::size_t>(kind)];
}

// Primary rays and the impulses of flat mirrors are coherent; Embree then traverses packets as
// frustums. Paths that have met more than two surfaces no longer are, and samples of lobes never
// were: told so, frames with 8 of them took 0.7 of the time, to the same bits.
bool isCoherent(const Plan& plan, std::size_t depth) {
  return depth == 0 || (depth <= 2 && plan.glossySamples == 0);
}

// A chunk whose surfels do not emit, or do not shine, needs less code for the same bits.
EffectSet neededBy(std::uint32_t materialFlags, EffectSet effects) {
  if ((materialFlags & kMaterialEmits) == 0) effects = effects.without(Effect::emission);
  if ((materialFlags & kMaterialGlossy) == 0) effects = effects.without(Effect::glossy);
  return effects;
}

// A light needs the code of its own kind only.
EffectSet neededBy(const Light& light, EffectSet effects) {
  if (light.kind != Light::Kind::spot) effects = effects.without(Effect::spotLights);
  if (light.kind != Light::Kind::directional) effects = effects.without(Effect::directionalLights);
  return effects;
}

bool isLeftOut(const Light& light, EffectSet effects) {
  return light.kind == Light::Kind::directional && !effects.has(Effect::directionalLights);
}

simd::CameraRays cameraRays(const CameraFrame& camera, Vec2f sample, std::uint32_t sampleNumber) {
  return {Vec3f(camera.eye),
          Vec3f(camera.forward),
          Vec3f(camera.right),
          Vec3f(camera.up),
          static_cast<float>(camera.width) / 2,
          static_cast<float>(camera.height) / 2,
          sample.x,
          sample.y,
          sampleNumber,
          camera.media,
          camera.orthographic,
          static_cast<float>(pixelCone(camera).width)};
}

}  // namespace

TileTracer::TileTracer(const Plan& plan, std::size_t capacity)
    : plan_(plan),
      capacity_(roundUpToBlock(capacity)),
      levels_(static_cast<std::size_t>(plan.depth) + 1),
      hits_(capacity_, plan.groups),
      surfels_(capacity_, plan.groups) {
  if (plan.effects.has(Effect::lights)) unshadowed_.allocate(capacity_, plan.groups);
  if (plan.traceShadows) shadows_.allocate(capacity_, plan.groups);
  reserveLevel(0, capacity_);
}

void TileTracer::reserveLevel(std::size_t depth, std::size_t rays) {
  Level& level = levels_[depth];
  if (level.rays.capacity() >= rays) return;
  level.rays.allocate(rays, plan_.groups);
  if (level.radiance.capacity() == 0) level.radiance.allocate(capacity_, plan_.groups);
}

BufferBytes TileTracer::bufferBytes() const {
  BufferBytes bytes;
  for (const Level& level : levels_) {
    bytes.rays += level.rays.bytes();
    bytes.radiance += level.radiance.bytes();
  }
  bytes.hits = hits_.bytes();
  bytes.surfels = surfels_.bytes();
  bytes.unshadowed = unshadowed_.bytes();
  bytes.shadows = shadows_.bytes();
  return bytes;
}

std::size_t TileTracer::bytes() const {
  return bufferBytes().sum() + sums_.capacity() * sizeof(RgbD) +
         codes_.capacity() * sizeof(std::uint32_t);
}

void TileTracer::traceSample(Pass& pass) {
  Level& first = levels_[0];
  first.count = first.reflections = pass.pixels.size();
  first.cursor = 0;
  simd::generateRays(cameraRays(pass.job.camera, pass.sample, pass.sampleNumber),
                     pass.pixels.data(), first.count, *first.rays);
  first.chunk = first.count;
  endStage(pass, Stage::generateRays, 0);
  std::size_t depth = 0;
  for (;;) {
    Level& level = levels_[depth];
    if (level.cursor < level.count) {
      level.chunk = std::min(capacity_, level.count - level.cursor);
      shadeChunk(pass, depth);
      if (pass.children > 0) {
        ++depth;
        levels_[depth].cursor = 0;
      } else {
        finishChunk(pass, depth);
      }
      continue;
    }
    if (depth == 0) return;
    // The queue is drained: the chunk that it came from is complete.
    --depth;
    finishChunk(pass, depth);
  }
}

void TileTracer::shadeChunk(Pass& pass, std::size_t depth) {
  Level& level = levels_[depth];
  const RayColumns rays = advanced(*level.rays, level.cursor);
  findIntersections(pass, depth, rays);
  simd::writeEmittedAndReflectiveAmbient(*pass.job.tables, neededBy(materialFlags_, plan_.effects),
                                         rays, *surfels_, level.chunk, *level.radiance);
  endStage(pass, Stage::writeEmittedAndReflectiveAmbient, depth);
  if (plan_.effects.has(Effect::lights)) shadeLights(pass, depth, rays);
  pass.children = 0;
  if (depth < static_cast<std::size_t>(plan_.depth)) addImpulses(pass, depth, rays);
}

void TileTracer::findIntersections(Pass& pass, std::size_t depth, const RayColumns& rays) {
  const Level& level = levels_[depth];
  const bool coherent = isCoherent(plan_, depth);
  TraceMeter meter{nullptr, 0, pass.log};
  // Reflections come first in a queue, refractions follow; a chunk may hold some of both.
  const std::size_t reflected =
      std::clamp(level.reflections, level.cursor, level.cursor + level.chunk) - level.cursor;
  if (reflected > 0) {
    meter.tally = &tallyOf(pass.stats, depth == 0 ? RayKind::primary : RayKind::reflection);
    pass.job.accel->findHits(rays, reflected, coherent, *hits_, meter);
  }
  if (reflected < level.chunk) {
    meter.tally = &tallyOf(pass.stats, RayKind::refraction);
    pass.job.accel->findHits(advanced(rays, reflected), level.chunk - reflected, coherent,
                             advanced(*hits_, reflected), meter);
  }
  pass.stats.embreeWorkerMs += meter.embreeMs;
  std::fill(hits_->triangle + level.chunk, hits_->triangle + roundUpToBlock(level.chunk), kMiss);
  materialFlags_ = simd::interpolateSurfels(*pass.job.tables, plan_.effects, rays, *hits_,
                                            level.chunk, *surfels_, pass.job.coneSpread);
  if (plan_.groups.lift) {
    simd::liftShadowOrigins(*pass.job.tables, plan_.effects, *hits_, level.chunk, *surfels_);
  }
  if (depth == 0 && pass.job.surfaces) recordSurfaces(pass);
  endStage(pass, Stage::findIntersections, depth);
}

void TileTracer::recordSurfaces(const Pass& pass) {
  const SurfelColumns& s = *surfels_;
  for (std::size_t i = 0; i < pass.pixels.size(); ++i) {
    const std::uint32_t pixel = pass.pixels[i];
    PixelSurface& surface =
        (*pass.job.surfaces)[pass.job.film->image.index(pixelX(pixel), pixelY(pixel))];
    surface = {};
    if (s.material[i] == kMiss) continue;
    surface.material = s.material[i];
    if (hits_->instance) surface.instance = hits_->instance[i];
    surface.position = {s.posX[i], s.posY[i], s.posZ[i]};
    surface.normal = {s.ngX[i], s.ngY[i], s.ngZ[i]};
  }
}

void TileTracer::shadeLights(Pass& pass, std::size_t depth, const RayColumns& rays) {
  const Level& level = levels_[depth];
  const EffectSet effects = neededBy(materialFlags_, plan_.effects);
  for (const Light& light : pass.job.tables->lights) {
    if (isLeftOut(light, effects)) continue;
    shadowCount_ =
        simd::findRadianceAndShadowRays(*pass.job.tables, neededBy(light, effects), light, rays,
                                        *surfels_, level.chunk, *unshadowed_, *shadows_);
    endStage(pass, Stage::findRadianceAndShadowRays, depth, &light);
    if (plan_.traceShadows) {
      TraceMeter meter{&tallyOf(pass.stats, RayKind::shadow), 0, pass.log};
      pass.job.accel->checkShadows(*shadows_, shadowCount_, isCoherent(plan_, depth),
                                   unshadowed_->visible, meter);
      pass.stats.embreeWorkerMs += meter.embreeMs;
      endStage(pass, Stage::checkShadows, depth, &light);
    }
    simd::addShading(*unshadowed_, level.chunk, *level.radiance);
    endStage(pass, Stage::addShading, depth, &light);
  }
}

void TileTracer::addImpulses(Pass& pass, std::size_t depth, const RayColumns& rays) {
  const Level& level = levels_[depth];
  const bool scatters = plan_.glossySamples > 0 && (materialFlags_ & kMaterialScatters) != 0;
  const LobeSampling sampling =
      lobeSampling(static_cast<int>(depth), plan_.glossySamples, pass.sampleNumber);
  const std::size_t children = static_cast<std::size_t>(plan_.traceReflections) +
                               static_cast<std::size_t>(plan_.traceRefractions) +
                               (scatters ? sampling.count : 0);
  reserveLevel(depth + 1, children * roundUpToBlock(level.chunk));
  Level& next = levels_[depth + 1];
  next.count = 0;
  const float cutoff = pass.job.cutoff;
  if (plan_.traceReflections && (materialFlags_ & kMaterialReflects) != 0) {
    next.count = simd::addReflections(*pass.job.tables, plan_.effects, cutoff, rays, *surfels_,
                                      level.chunk, *next.rays, 0);
    ++pass.stats.reflectionCalls;
  }
  if (scatters) {
    next.count += simd::addGlossyReflections(*pass.job.tables, plan_.effects, cutoff, sampling,
                                             rays, *surfels_, level.chunk, *next.rays, next.count);
    ++pass.stats.glossyCalls;
  }
  next.reflections = next.count;
  if (plan_.traceRefractions && (materialFlags_ & kMaterialTransmits) != 0) {
    next.count += simd::addRefractions(*pass.job.tables, plan_.effects, cutoff, rays, *surfels_,
                                       level.chunk, *next.rays, next.count);
    ++pass.stats.refractionCalls;
  }
  pass.children = next.count;
  endStage(pass, Stage::addImpulses, depth);
}

void TileTracer::finishChunk(Pass& pass, std::size_t depth) {
  Level& level = levels_[depth];
  if (depth > 0) {
    simd::returnImpulses(advanced(*level.rays, level.cursor), *level.radiance, level.chunk,
                         *levels_[depth - 1].radiance);
    pass.clock.lap(Stage::addImpulses, static_cast<int>(depth));
  }
  level.cursor += level.chunk;
}

void TileTracer::endStage(Pass& pass, Stage stage, std::size_t depth, const Light* light) {
  pass.clock.lap(stage, static_cast<int>(depth));
  if (pass.job.stageBarrier) {
    pass.job.stageBarrier->arrive_and_wait();
    pass.clock.skip();
  }
  if (!pass.job.observer) return;
  const Level& level = levels_[depth];
  ChunkView view;
  view.depth = static_cast<int>(depth);
  view.first = level.cursor;
  view.n = level.chunk;
  view.rays = advanced(*level.rays, level.cursor);
  view.hits = *hits_;
  view.surfels = *surfels_;
  view.radiance = *level.radiance;
  view.unshadowed = *unshadowed_;
  view.shadows = *shadows_;
  view.shadowCount = shadowCount_;
  view.light = light;
  view.pixels = pass.pixels;
  view.sample = pass.sample;
  view.sampleNumber = pass.sampleNumber;
  if (stage == Stage::addImpulses) {
    const Level& next = levels_[depth + 1];
    view.children = *next.rays;
    view.reflections = next.reflections;
    view.refractions = next.count - next.reflections;
  }
  pass.job.observer->after(stage, view);
  pass.clock.skip();
}

}  // namespace whit
