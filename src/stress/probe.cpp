#include "stress/probe.h"

#include <cstring>

#include "simd/kernels.h"

namespace whit::stress {

RenderOptions optionsOf(const Setup& setup) {
  RenderOptions options;
  options.simd = setup.simd;
  options.packet = setup.packet;
  options.threads = 1;
  return options;
}

namespace {

RenderOptions probeOptions(const Setup& setup, bool robust) {
  RenderOptions options = optionsOf(setup);
  options.effects = EffectChoice::all;
  options.robust = robust;
  return options;
}

}  // namespace

Probe::Probe(const Scene& scene, const Setup& setup, bool robust)
    : renderer_(scene, probeOptions(setup, robust)) {}

void Probe::reserve(std::size_t count) {
  count_ = count;
  if (rays_.capacity() >= count && rays_.capacity() > 0) return;
  const Groups groups;
  rays_.allocate(count, groups);
  children_.allocate(count, groups);
  hits_.allocate(count, groups);
  surfels_.allocate(count, groups);
  unshadowed_.allocate(count, groups);
  shadows_.allocate(count, groups);
}

void Probe::load(const std::vector<ProbeRay>& rays) {
  reserve(rays.size());
  const RayColumns& c = *rays_;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto& [o, d, media] = rays[i];
    c.orgX[i] = o.x, c.orgY[i] = o.y, c.orgZ[i] = o.z;
    c.dirX[i] = d.x, c.dirY[i] = d.y, c.dirZ[i] = d.z;
    c.weightR[i] = c.weightG[i] = c.weightB[i] = c.throughput[i] = 1;
    c.parent[i] = static_cast<std::uint32_t>(i);
    c.media[i] = media;
    hits_->triangle[i] = hits_->instance[i] = kMiss;
  }
}

void Probe::hit(std::size_t i, std::uint32_t triangle, float t, float u, float v) {
  hits_->triangle[i] = triangle;
  hits_->instance[i] = kMiss;
  hits_->t[i] = t;
  hits_->u[i] = u;
  hits_->v[i] = v;
}

void Probe::interpolate() {
  std::fill(hits_->triangle + count_, hits_->triangle + roundUpToBlock(count_), kMiss);
  simd::interpolateSurfels(tables(), effects(), *rays_, *hits_, count_, *surfels_);
}

void Probe::cast(const std::vector<ProbeRay>& rays) {
  load(rays);
  RayTally tally;
  TraceMeter meter{&tally, 0, nullptr};
  accel().findHits(*rays_, count_, false, *hits_, meter);
  interpolate();
}

void Probe::surfel(std::size_t i, std::uint32_t material, const Vec3f& ng, const Vec3f& ns) {
  const SurfelColumns& s = *surfels_;
  s.posX[i] = s.posY[i] = s.posZ[i] = 0;
  s.ngX[i] = ng.x, s.ngY[i] = ng.y, s.ngZ[i] = ng.z;
  s.nsX[i] = ns.x, s.nsY[i] = ns.y, s.nsZ[i] = ns.z;
  s.offset[i] = 0x1p-19f;
  s.diffuseR[i] = s.diffuseG[i] = s.diffuseB[i] = 1;
  s.specularR[i] = s.specularG[i] = s.specularB[i] = 0;
  s.alpha[i] = 1;
  s.material[i] = material;
  s.flags[i] = kEntering;
  s.mediaBehind[i] = rays_->media[i] << 8 | tables().materials[material].medium;
}

std::vector<ProbeChild> Probe::childrenOf(std::size_t n) const {
  std::vector<ProbeChild> result(n);
  const RayColumns& c = *children_;
  for (std::size_t i = 0; i < n; ++i) {
    result[i].ray = {
        {c.orgX[i], c.orgY[i], c.orgZ[i]}, {c.dirX[i], c.dirY[i], c.dirZ[i]}, c.media[i]};
    result[i].weight = {c.weightR[i], c.weightG[i], c.weightB[i]};
    result[i].parent = c.parent[i];
  }
  return result;
}

std::vector<ProbeChild> Probe::reflections(float cutoff) {
  std::fill(surfels_->material + count_, surfels_->material + roundUpToBlock(count_), kMiss);
  return childrenOf(
      simd::addReflections(tables(), effects(), cutoff, *rays_, *surfels_, count_, *children_, 0));
}

std::vector<ProbeChild> Probe::refractions(float cutoff) {
  std::fill(surfels_->material + count_, surfels_->material + roundUpToBlock(count_), kMiss);
  return childrenOf(
      simd::addRefractions(tables(), effects(), cutoff, *rays_, *surfels_, count_, *children_, 0));
}

std::size_t Probe::light(const Light& light) {
  std::fill(surfels_->material + count_, surfels_->material + roundUpToBlock(count_), kMiss);
  const std::size_t n = simd::findRadianceAndShadowRays(tables(), effects(), light, *rays_,
                                                        *surfels_, count_, *unshadowed_, *shadows_);
  RayTally tally;
  TraceMeter meter{&tally, 0, nullptr};
  accel().checkShadows(*shadows_, n, true, unshadowed_->visible, meter);
  return n;
}

void Probe::poison(std::uint32_t bits) {
  const auto fill = [&](const auto& store) {
    auto columns = *store;
    decltype(columns)::forEachColumn(columns, [&](const char*, auto* column, Group) {
      for (std::size_t i = 0; column && i < store.capacity(); ++i) {
        std::memcpy(column + i, &bits, sizeof(bits));
      }
    });
  };
  fill(rays_);
  fill(children_);
  fill(hits_);
  fill(surfels_);
  fill(unshadowed_);
  fill(shadows_);
}

ProbeRay Probe::ray(std::size_t i) const {
  const RayColumns& c = *rays_;
  return {{c.orgX[i], c.orgY[i], c.orgZ[i]}, {c.dirX[i], c.dirY[i], c.dirZ[i]}, c.media[i]};
}

Image pictureOf(const Scene& scene, const Camera& camera, const RenderOptions& options,
                FrameStats* stats) {
  Renderer renderer(scene, options);
  Film film = makeFilm(scene, options);
  const FrameStats frame = renderer.render(camera, film);
  if (stats) *stats = frame;
  return film.image;
}

}  // namespace whit::stress
