// One tile of a scene, taken through the stages of depth 0 once, so that each kernel can be run
// again and again on the input that it has in a frame.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "core/random_streams.h"
#include "io/load_scene.h"
#include "reference/generate_rays.h"
#include "render/renderer.h"
#include "render/renderer_parts.h"
#include "render/tiles.h"
#include "simd/kernels.h"

namespace whit::bench {

inline constexpr ImageSize kSize{480, 300};
inline constexpr std::size_t kTileRays = 32 * 32;
inline constexpr float kCutoff = 3.0e-4f;
inline constexpr float kReach = 1e10f;  // of all rays
inline constexpr std::size_t kPacket = 16, kPacketWords = 20 * kPacket;

// A scene with its tables, and the columns of the tile.
class BenchTile {
 public:
  explicit BenchTile(const std::string& name, const RenderOptions& choices = {})
      : scene_(load(name)), options_(timed(choices)), renderer_(scene_, options_) {
    const Groups& groups = plan().groups;
    rays.allocate(kTileRays, groups);
    hits.allocate(kTileRays, groups);
    surfels.allocate(kTileRays, groups);
    radiance.allocate(kTileRays, groups);
    unshadowed.allocate(kTileRays, groups);
    shadows.allocate(kTileRays, groups);
    children.allocate(std::max<std::size_t>(2, sampling().count) * kTileRays, groups);
    unpacked.allocate(kTileRays, groups);
    codes.resize(kTileRays + kBlock);
    pixels = pickTile(kSize);
    run();
  }

  // All stages of depth 0, from the beginning.
  void run() {
    generate();
    TraceMeter meter{&tally_, 0, nullptr};
    accel().findHits(*rays, n(), true, *hits, meter);
    interpolate();
    lift();
    writeEmitted();
    findShadowRays();
    accel().checkShadows(*shadows, shadowCount, true, unshadowed->visible, meter);
    simd::addShading(*unshadowed, n(), *radiance);
    scattered = scatter();
    reflections = reflect();
    refractions = refract(reflections);
    simd::encodeDisplay(1, ToneCurve::none, SrgbEncoding::exact, *radiance, n(), codes.data());
  }

  void generate() { simd::generateRays(camera_, pixels.data(), n(), *rays); }
  void interpolate() {
    simd::interpolateSurfels(tables(), plan().effects, *rays, *hits, n(), *surfels);
  }
  void lift() {
    if (!plan().groups.lift) return;
    simd::liftShadowOrigins(tables(), plan().effects, *hits, n(), *surfels);
  }
  void writeEmitted() {
    simd::writeEmittedAndReflectiveAmbient(tables(), plan().effects, *rays, *surfels, n(),
                                           *radiance);
  }
  void findShadowRays() {
    shadowCount = simd::findRadianceAndShadowRays(tables(), plan().effects, tables().lights.front(),
                                                  *rays, *surfels, n(), *unshadowed, *shadows);
  }
  std::size_t reflect() {
    if (!plan().traceReflections) return 0;
    return simd::addReflections(tables(), plan().effects, kCutoff, *rays, *surfels, n(), *children,
                                0);
  }
  std::size_t refract(std::size_t first) {
    if (!plan().traceRefractions) return 0;
    return simd::addRefractions(tables(), plan().effects, kCutoff, *rays, *surfels, n(), *children,
                                first);
  }

  LobeSampling sampling() const { return lobeSampling(0, plan().glossySamples, 0); }
  std::size_t scatter() {
    if (plan().glossySamples == 0) return 0;
    return simd::addGlossyReflections(tables(), plan().effects, kCutoff, sampling(), *rays,
                                      *surfels, n(), *children, 0);
  }

  // The bits of everything that the kernels write.
  std::vector<std::uint32_t> bits() const {
    std::vector<std::uint32_t> all;
    append(all, *rays, n());
    append(all, *surfels, n());
    append(all, *radiance, n());
    append(all, *unshadowed, n());
    append(all, *shadows, shadowCount);
    append(all, *children, reflections + refractions);
    all.insert(all.end(), codes.begin(), codes.begin() + static_cast<std::ptrdiff_t>(n()));
    return all;
  }

  std::size_t n() const { return pixels.size(); }
  PacketWords packets() { return {words.data(), kPacketWords, kPacket}; }
  float* unpackedVisible() { return unpacked->t; }
  const Plan& plan() const { return renderer_.plan(); }
  const ShadingTables& tables() { return renderer_.parts().tables; }
  const Accel& accel() { return *renderer_.parts().accel; }
  Renderer& renderer() { return renderer_; }
  Camera camera() const { return chooseCamera(scene_, options_); }
  Film film() const { return makeFilm(scene_, options_); }

  std::vector<std::uint32_t> pixels;
  ColumnStore<RayColumns> rays, children;
  ColumnStore<HitColumns> hits, unpacked;
  // Of packets of 16, as many as the tile has.
  alignas(64) std::array<float, kTileRays / kPacket * kPacketWords> words{};
  const std::uint32_t triangleBase[kTriangleClasses] = {0, 1, 2, 3};
  ColumnStore<SurfelColumns> surfels;
  ColumnStore<RadianceColumns> radiance;
  ColumnStore<UnshadowedColumns> unshadowed;
  ColumnStore<ShadowColumns> shadows;
  std::vector<std::uint32_t> codes;
  std::size_t shadowCount = 0, scattered = 0, reflections = 0, refractions = 0;

 private:
  static Scene load(const std::string& name) {
    Warnings warnings;
    return Scene::finalize(loadScene(name, LoadOptions{}, warnings), warnings);
  }
  static RenderOptions timed(RenderOptions o) {
    o.size = kSize;
    o.threads = 1;
    return o;
  }

  // The tile whose surfels have the most children: there every kernel has work.
  std::vector<std::uint32_t> pickTile(ImageSize size) {
    const CameraFrame frame = makeCameraFrame(camera(), size.width, size.height);
    camera_ = {Vec3f(frame.eye),
               Vec3f(frame.forward),
               Vec3f(frame.right),
               Vec3f(frame.up),
               static_cast<float>(size.width) / 2,
               static_cast<float>(size.height) / 2,
               0.5f,
               0.5f};
    std::vector<std::uint32_t> best;
    std::size_t most = 0;
    for (auto& tile : makeTiles(Crop{0, 0, size.width, size.height}, 32)) {
      if (tile.size() != kTileRays) continue;
      pixels = tile;
      run();
      if (best.empty() || scattered + reflections + refractions > most) {
        best = tile;
        most = scattered + reflections + refractions;
      }
    }
    return best;
  }

  template <typename Columns>
  static void append(std::vector<std::uint32_t>& all, const Columns& columns, std::size_t count) {
    Columns::forEachColumn(columns, [&](const char*, const auto* column, Group) {
      if (!column) return;
      const std::size_t old = all.size();
      all.resize(old + count);
      if (count > 0) std::memcpy(all.data() + old, column, count * sizeof(std::uint32_t));
    });
  }

  Scene scene_;
  RenderOptions options_;
  Renderer renderer_;
  simd::CameraRays camera_;
  RayTally tally_;
};

}  // namespace whit::bench
