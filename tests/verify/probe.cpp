#include "verify/probe.h"

#include <array>
#include <bit>
#include <cstring>
#include <tuple>

#include "inspect/reference_frame.h"
#include "render/steps.h"
#include "set_columns.h"
#include "simd/kernels.h"

namespace whit::verify {

RenderOptions optionsOf(const Setup& setup) {
  RenderOptions options;
  options.simd = setup.simd;
  options.packet = setup.packet;
  options.threads = 1;
  return options;
}

RenderOptions optionsOf(const Setup& setup, const ImageSize& size) {
  RenderOptions options = optionsOf(setup);
  options.size = size;
  return options;
}

namespace {

RenderOptions probeOptions(const Setup& setup) {
  RenderOptions options = optionsOf(setup);
  options.effects = EffectChoice::all;
  return options;
}

}  // namespace

Probe::Probe(const Scene& scene, const Setup& setup)
    : renderer_(scene, probeOptions(setup)),
      constants_{&scene,
                 &renderer_.tables(),
                 &renderer_.accel(),
                 renderer_.plan().effects,
                 renderer_.plan().features,
                 renderer_.options(),
                 {},
                 {},
                 0} {
  chunk_.frame = &constants_;
  chunk_.meter = &meter_;
}

Probe::Probe(const Scene& scene, const Setup& setup, const std::vector<ProbeRay>& rays)
    : Probe(scene, setup) {
  cast(rays);
}

void Probe::reserve(std::size_t count) {
  count_ = count;
  if (rays_.capacity() >= count && rays_.capacity() > 0) return;

  const FeatureSet features = constants_.features;
  rays_.allocate(count, features);
  children_.allocate(count, features);
  hits_.allocate(count, features);
  surfels_.allocate(count, features);
  unshadowed_.allocate(count, features);
  shadows_.allocate(count, features);
}

void Probe::load(const std::vector<ProbeRay>& rays) {
  reserve(rays.size());
  chunk_.n = count_;
  chunk_.rays = *rays_;
  chunk_.hits = *hits_;
  chunk_.surfels = *surfels_;
  chunk_.unshadowed = *unshadowed_;
  chunk_.shadows = *shadows_;
  chunk_.children = *children_;

  const RayColumns& c = *rays_;
  for (const auto i : indices(rays)) {
    const auto& [o, d, media] = rays[i];
    test::setRay(c, i, o, d);
    c.weight.set(i, Rgb(1.0f));
    c.throughput[i] = 1;
    c.parent[i] = std::uint32_t(i);
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

void Probe::run(const simd::Kernel& kernel) { kernel.find()(chunk_); }

void Probe::interpolate() {
  // Kernels read whole blocks, so that the last block is filled up with misses.
  std::fill(hits_->triangle + count_, hits_->triangle + roundUpToBlock(count_), kMiss);
  run(simd::kInterpolateSurfels);
  if (chunk_.has(Feature::coverage)) run(simd::kLookUpCoverage);
  if (chunk_.has(Feature::occlusionMaps)) run(simd::kLookUpOcclusion);
  if (chunk_.has(Feature::mirrorMaps)) run(simd::kLookUpMirror);
  if (chunk_.has(Feature::transmissionMaps)) run(simd::kLookUpTransmission);
}

void Probe::hitEach(std::uint32_t count) {
  load(std::vector<ProbeRay>(count, {{0, 0, 0}, {0, 0, -1}}));
  for (std::uint32_t i = 0; i < count; ++i) hit(i, i, 1, 0.25f, 0.25f);
  interpolate();
}

bool Probe::sameHit(const Probe& other, std::size_t i) const {
  const auto hit = [i](const HitColumns& h) {
    return std::tuple(h.triangle[i], h.instance[i], h.t[i], h.u[i], h.v[i]);
  };
  return isHit(i) ? hit(*hits_) == hit(*other.hits_) : !other.isHit(i);
}

void Probe::cast(const std::vector<ProbeRay>& rays) {
  load(rays);
  chunk_.coherent = false;
  chunk_.segments[0] = {RayKind::primary, 0, count_};
  chunk_.segmentCount = 1;

  // At depth 0 the eye would not see the surfaces in whose plane it lies.
  chunk_.depth = 1;
  findHits(chunk_);
  if (chunk_.has(Feature::coplanar)) chooseCoplanar(chunk_);
  chooseSpheres(chunk_);

  chunk_.depth = 0;
  interpolate();
}

void Probe::surfel(std::size_t i, std::uint32_t material, const Vec3f& ng, const Vec3f& ns) {
  const SurfelColumns& s = *surfels_;
  s.pos.set(i, {});
  s.ng.set(i, ng);
  s.ns.set(i, ns);
  s.offset[i] = 0x1p-19f;
  s.viewOffset[i] = 0x1p-20f;

  s.diffuse.set(i, Rgb(1.0f));
  s.specular.set(i, {});
  s.alpha[i] = 1;
  s.coverage[i] = 1;

  if (chunk_.has(Feature::occlusionMaps)) s.occlusion[i] = 1;
  if (chunk_.has(Feature::mirrorMaps)) s.mirror.set(i, Rgb(1.0f));
  if (chunk_.has(Feature::transmissionMaps)) s.transmission.set(i, Rgb(1.0f));

  s.material[i] = material;
  s.flags[i] = kEntering;
  s.mediaBehind[i] = rays_->media[i] << 8 | tables().materials[material].medium;
}

// Kernels read whole vectors of surfels.
void Probe::endSurfels() {
  std::fill(surfels_->material + count_, surfels_->material + roundUpToBlock(count_), kMiss);
}

std::vector<ProbeChild> Probe::childrenBy(const simd::Kernel& kernel) {
  endSurfels();
  constants_.options.cutoff = 0;
  chunk_.childCount = 0;
  run(kernel);

  std::vector<ProbeChild> result;
  const RayColumns& c = *children_;
  for (const auto i : indices(chunk_.childCount)) {
    result.push_back({{c.org.at(i), c.dir.at(i), c.media[i]}, c.weight.at(i), c.parent[i]});
  }
  return result;
}

std::vector<ProbeChild> Probe::reflections() { return childrenBy(simd::kAddReflections); }

std::vector<ProbeChild> Probe::refractions() { return childrenBy(simd::kAddRefractions); }

std::size_t Probe::light(const Light& light) {
  endSurfels();
  chunk_.light = &light;
  run(simd::kFindRadianceAndShadowRays);
  chunk_.coherent = true;
  checkShadows(chunk_);
  chunk_.light = nullptr;
  return chunk_.shadowCount;
}

void Probe::poison(std::uint32_t bits) {
  const auto fill = [&](const auto& store) {
    auto columns = *store;
    decltype(columns)::forEachColumn(columns, [&](const char*, auto* column, Feature) {
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
  return {c.org.at(i), c.dir.at(i), c.media[i]};
}

std::vector<ProbeRay> raysOf(const std::vector<ProbeChild>& children) {
  std::vector<ProbeRay> rays;
  rays.reserve(children.size());
  for (const ProbeChild& child : children) rays.push_back(child.ray);
  return rays;
}

ColumnStore<RayColumns> raysThrough(const std::vector<std::uint32_t>& pixels,
                                    const CameraFrame& camera) {
  std::vector<std::uint32_t> padded = pixels;
  padded.resize(roundUpToBlock(pixels.size()));  // kernels read whole vectors
  ColumnStore<RayColumns> rays(pixels.size(), FeatureSet());

  FrameConstants constants;
  constants.camera = camera;
  Chunk chunk;
  chunk.frame = &constants;
  chunk.pixels = {padded.data(), pixels.size()};
  chunk.n = pixels.size();
  chunk.rays = *rays;

  simd::kGenerateRays.find()(chunk);
  return rays;
}

Image pictureOf(const Scene& scene, const Camera& camera, const RenderOptions& options,
                FrameStats* stats) {
  Renderer renderer(scene, options);
  Film film = makeFilm(scene, options);
  const FrameStats frame = renderer.render(camera, film);
  if (stats) *stats = frame;
  return film.image;
}

std::array<Image, 2> picturesOf(const Scene& scene, const Camera& camera,
                                const RenderOptions& options) {
  Renderer renderer(scene, options);
  Film packets = makeFilm(scene, options), reference = packets;
  renderer.render(camera, packets);
  renderReference(renderer, camera, reference);
  return {packets.image, reference.image};
}

void countHits(Finding& finding, const Probe& probe, bool mustHit) {
  for (const auto i : indices(probe)) finding.count(probe.isHit(i) != mustHit, probe.ray(i));
}

void countOtherPixels(Finding& finding, const Image& a, const Image& b, const std::string& what,
                      bool mirrored) {
  using Bits = std::array<std::uint32_t, 3>;
  for (int y = a.window.y0; y < a.window.y1; ++y) {
    for (int x = a.window.x0; x < a.window.x1; ++x) {
      const Rgb &p = a.at(x, y), &q = b.at(mirrored ? b.width - 1 - x : x, y);
      finding.count(std::bit_cast<Bits>(p) != std::bit_cast<Bits>(q), what, ", pixel ", x, ",", y,
                    ": ", p, " against ", q);
    }
  }
}

}  // namespace whit::verify
