// Kernels whose lanes hold any bits: numbers that are not finite, denormal numbers and garbage, in
// slots behind the last one and in slots that are in use. They must neither lead a kernel out of
// its tables nor change the result of another slot.
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "make/studio_sky.h"
#include "render/shipped_scene.h"
#include "sanitized.h"
#include "simd/kernels.h"

namespace whit::test {
namespace {

// Makes columns point to memory of its own with the values of their first `count` slots.
template <typename Columns>
class OwnColumns {
 public:
  OwnColumns(Columns& columns, std::size_t capacity, std::size_t count, FeatureSet features)
      : store_(capacity, features) {
    std::vector<const void*> sources;
    Columns::forEachColumn(columns,
                           [&](const char*, auto* column, Feature) { sources.push_back(column); });

    columns = *store_;
    std::size_t next = 0;
    Columns::forEachColumn(columns, [&](const char*, auto* column, Feature) {
      const void* const source = sources[next++];
      if (column && source && count > 0) std::memcpy(column, source, count * sizeof(float));
    });
  }

 private:
  ColumnStore<Columns> store_;
};

// Holds the columns of a chunk in memory of its own.
class OwnChunk {
 public:
  OwnChunk(const Chunk& from, std::size_t children)
      : chunk(from), children_(chunk.children, children, 0, features_) {
    chunk.childCount = 0;
    for (const auto i : indices(from.n)) chunk.rays.parent[i] %= kParents;
  }

  static constexpr std::size_t kParents = 64;
  Chunk chunk;

 private:
  const FeatureSet features_ = chunk.frame->features;
  OwnColumns<RayColumns> rays_{chunk.rays, chunk.n, chunk.n, features_}, children_;
  OwnColumns<HitColumns> hits_{chunk.hits, chunk.n, chunk.n, features_};
  OwnColumns<SurfelColumns> surfels_{chunk.surfels, chunk.n, chunk.n, features_};
  OwnColumns<UnshadowedColumns> unshadowed_{chunk.unshadowed, chunk.n, chunk.n, features_};
  OwnColumns<ShadowColumns> shadows_{chunk.shadows, chunk.n, chunk.shadowCount, features_};
  OwnColumns<RadianceColumns> radiance_{chunk.radiance, chunk.n, chunk.n, features_};
  OwnColumns<RadianceColumns> parentRadiance_{chunk.parentRadiance, kParents, 0, features_};
};

// Draws any bits, often those of numbers that code may not expect.
class AnyBits {
 public:
  std::uint32_t next() {
    using Limits = std::numeric_limits<float>;
    constexpr float kFloats[] = {Limits::quiet_NaN(),
                                 Limits::infinity(),
                                 -Limits::infinity(),
                                 Limits::denorm_min(),
                                 -1e-40f,
                                 0.0f,
                                 3e38f,
                                 -3e9f,
                                 -1e-3f,
                                 1e6f};
    constexpr std::uint32_t kWords[] = {0x80000000u, 0x7FFFFFFFu, 0xFFFFFFFEu, 0xFFF00001u,
                                        1u << 20};

    const auto drawn = static_cast<std::uint32_t>(random_());
    const std::uint32_t kind = drawn % 20;
    if (kind >= 15) return static_cast<std::uint32_t>(random_());
    if (kind >= 10) return kWords[kind - 10];
    return std::bit_cast<std::uint32_t>(kFloats[kind]);
  }

 private:
  std::mt19937 random_{1};
};

bool isSpoilt(std::size_t slot) { return slot % 5 == 1 || slot % 7 == 3; }

// These columns name the slot of a result. No kernel computes with them.
bool saysWhere(const std::string& column) { return column == "parent" || column == "slot"; }
bool saysWhetherThereIsAny(const std::string& column) {
  return column == "triangle" || column == "material";
}

// Overwrites the slots from `count` on, which kernels may read, and some of the slots before it.
// Slots from `count` on remain misses, as their contract says.
template <typename Columns>
void spoil(Columns columns, std::size_t count, bool spoilsSlots, AnyBits& any) {
  Columns::forEachColumn(columns, [&](const char* name, auto* column, Feature) {
    for (std::size_t i = 0; column && i < roundUpToBlock(count); ++i) {
      const bool isFree = i >= count;
      if (isFree ? saysWhetherThereIsAny(name) : !spoilsSlots || !isSpoilt(i) || saysWhere(name)) {
        // Bytes of 0xFF make kMiss.
        if (isFree) std::memset(column + i, 0xFF, sizeof *column);
        continue;
      }

      const std::uint32_t bits = any.next();
      std::memcpy(column + i, &bits, sizeof bits);
    }
  });
}

void spoilAll(const Chunk& c, AnyBits& any) {
  spoil(c.rays, c.n, true, any);
  spoil(c.hits, c.n, true, any);
  spoil(c.surfels, c.n, true, any);
  spoil(c.radiance, c.n, true, any);
  spoil(c.unshadowed, c.n, true, any);
  spoil(c.shadows, c.shadowCount, false, any);
}

// Appends the bits of those of the first `count` rows for which isWanted(row) holds.
template <typename Columns, typename IsWanted>
void appendRows(Columns columns, std::size_t count, const IsWanted& isWanted,
                std::vector<std::uint32_t>& bits) {
  Columns::forEachColumn(columns, [&](const char*, auto* column, Feature) {
    for (std::size_t i = 0; column && i < count; ++i) {
      std::uint32_t word = 0;
      std::memcpy(&word, column + i, sizeof word);
      if (isWanted(i)) bits.push_back(word);
    }
  });
}

// Collects the results that a kernel may have written for the slots that are not spoilt: surfels
// where there is one, and light where it may arrive.
std::vector<std::uint32_t> resultsOf(const Chunk& c) {
  std::vector<std::uint32_t> bits;
  const auto isSound = [](std::size_t slot) { return !isSpoilt(slot); };
  const auto isSurfel = [&](std::size_t i) { return isSound(i) && c.surfels.material[i] != kMiss; };
  std::vector<bool> lit(c.n);
  for (const auto i : indices(c.n)) lit[i] = isSound(i) && c.unshadowed.visible[i] != 0;
  for (const auto i : indices(c.shadowCount)) {
    lit[c.shadows.slot[i]] = isSound(c.shadows.slot[i]);
  }

  appendRows(c.rays, c.n, isSound, bits);
  appendRows(c.hits, c.n, isSound, bits);
  appendRows(c.surfels, c.n, isSurfel, bits);
  appendRows(c.radiance, c.n, isSound, bits);
  appendRows(
      c.unshadowed, c.n, [&](std::size_t i) { return lit[i]; }, bits);
  appendRows(
      c.shadows, c.shadowCount, [&](std::size_t i) { return isSound(c.shadows.slot[i]); }, bits);
  appendRows(
      c.children, c.childCount, [&](std::size_t i) { return isSound(c.children.parent[i]); }, bits);

  // A parent's radiance counts only if no spoilt slot adds to it.
  std::vector<bool> spoilt(OwnChunk::kParents);
  for (const auto i : indices(c.n)) {
    if (isSpoilt(i)) spoilt[c.rays.parent[i]] = true;
  }
  appendRows(
      c.parentRadiance, OwnChunk::kParents, [&](std::size_t i) { return !spoilt[i]; }, bits);
  return bits;
}

// Runs each kernel of the plan on copies of a chunk that has gone through all stages.
class KernelRunner : public StageObserver {
 public:
  explicit KernelRunner(const Plan& plan) : plan_(plan) {}

  void after(Stage stage, const Chunk& chunk) override {
    if (stage != Stage::addImpulses || chunk.n < 40 || chunks_ == kChunks) return;
    ++chunks_;
    for (const simd::Kernel& kernel : simd::kKernels) {
      // Primary rays are generated from pixels, so only the first depth has them.
      const bool isOfEye = kernel.name == simd::kGenerateRays.name;
      if (!kernel.find || !plan_.find(kernel.name) || (isOfEye && chunk.depth > 0)) continue;
      const StepFunction run = kernel.find();
      compare(kernel.name, chunk, [&](Chunk& c) { run(c); });
    }

    const ShadingTables& t = chunk.tables();
    const simd::HitTables tables{t.triangles, t.triangleCount, t.firstSphere, t.instances.data(),
                                 t.instances.size()};
    compare("refineHits", chunk,
            [&](Chunk& c) { simd::findPacketKernels().refineHits(tables, c.rays, c.n, c.hits); });
  }

  int kernels = 0;

 private:
  static constexpr int kChunks = 4;

  // No multiple of any vector's lanes, and fewer than OwnChunk::kParents.
  static constexpr std::size_t kSlots = 39;

  template <typename Run>
  void compare(std::string_view kernel, Chunk chunk, const Run& run) {
    chunk.n = kSlots;
    std::size_t rays = 0;
    while (rays < chunk.shadowCount && chunk.shadows.slot[rays] < kSlots) ++rays;
    chunk.shadowCount = rays;

    const std::size_t children = 64 * roundUpToBlock(kSlots);
    const bool ofAmbientLight = kernel == simd::kFindAmbientAndOcclusionRays.name;
    OwnChunk sound(chunk, children), spoilt(chunk, children);
    for (Chunk* c : {&sound.chunk, &spoilt.chunk}) {
      c->turnTo(ofAmbientLight ? kAmbientLight : 0, 0, 2);
    }

    // Slots that are not in use are misses in both chunks.
    AnyBits any, other;
    spoil(sound.chunk.hits, kSlots, false, other);
    spoil(sound.chunk.surfels, kSlots, false, other);
    spoilAll(spoilt.chunk, any);

    run(sound.chunk);
    run(spoilt.chunk);
    EXPECT_TRUE(resultsOf(sound.chunk) == resultsOf(spoilt.chunk)) << kernel;
    ++kernels;
  }

  const Plan& plan_;
  int chunks_ = 0;
};

// A shipped scene gets an image for a sky, and ambient light with occlusion.
Scene withImageSky(const std::string& name) {
  SceneDescription description = described(name);
  description.sky = studioSky();
  description.ambient.occlusion = 1;
  description.ambient.up = description.ambient.down = Rgb(0.5f);
  return repaired(std::move(description));
}

TEST(AnyBits, LeadNoKernelAstray) {
  for (const std::string name : {"glass", "whitted", "landscape?triangles=2000"}) {
    const Scene scene = withImageSky(name);
    std::vector<std::string> targets = simd::availableTargets();

    // Two targets are enough for a sanitizer: that of the widest vectors, and scalar code.
    if (kSanitized) targets = {targets.front(), targets.back()};

    for (const std::string& target : targets) {
      for (const bool samples : {false, true}) {
        SCOPED_TRACE(name + " on " + target + (samples ? ", with samples" : ""));
        RenderOptions o = smallOptions({40, 30});
        o.threads = 1;
        o.simd = target;
        o.effects = EffectChoice::all;
        o.shading.terminator = true;
        o.glossy = o.indirect = samples ? 2 : 0;
        o.lightSamples = o.ambientSamples = samples ? 2 : 1;

        Renderer renderer(scene, o);
        Film film = makeFilm(scene, o);
        KernelRunner runner(renderer.plan());
        StageObserver* const observers[] = {&runner};
        const Camera camera = chooseCamera(scene, o);
        renderer.render({.camera = camera, .film = film, .observers = observers, .uniform = true});
        EXPECT_GT(runner.kernels, 30);
      }
    }
  }
  simd::chooseTarget("auto");
}

}  // namespace
}  // namespace whit::test
