#include "shadow_cache/shadow_tables.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "core/stopwatch.h"
#include "shadow_cache/decide_part.h"

namespace whit {

namespace {

// As many parts as a word of ShadowCacheView::first can number would take a gigabyte.
constexpr std::size_t kMostParts = std::size_t{1} << 21;
constexpr int kMostPartsASide = 256;
// Beyond it squares of squares leave the range of a float, or fall below it.
constexpr float kLargest = 0x1p24f;
// Triangles are divided into parts whose cells are no finer than this part of the scene's size,
// which is about a pixel's where a view shows all of it. Parts of small triangles have finer ones,
// down to this share of it.
constexpr double kFinestCell = 0x1p-13, kFinestInParts = 0x1p-3;

// Rays between two such points are taken by Embree, in an instance's space as well (their
// coordinates and directions sum up to less).
constexpr float kNeededReach = 16 * kLargest;

bool isNear(const Vec3f& lower, const Vec3f& upper) {
  return maxComponent(max(abs(lower), abs(upper))) < kLargest;
}

// True if the proofs hold for the scene's coordinates.
bool inRange(const Scene& scene) {
  return isNear(scene.lower, scene.upper) &&
         std::ranges::all_of(scene.instances, [](const auto& instance) {
           return instanceReach(instance.toWorld) > kNeededReach;
         });
}

bool inRange(const LightPoint& light) {
  const Vec3f point(light.position);
  return isNear(point, point);
}

int partsASide(double edge, double cell) {
  const double parts = edge / (cell * kCellsASide);
  if (!(parts > 1)) return 1;
  const double power = std::exp2(std::ceil(std::log2(parts)));
  return static_cast<int>(std::min<double>(power, kMostPartsASide));
}

}  // namespace

ShadowParts ShadowParts::of(const Scene& scene) {
  ShadowParts parts;
  const Geometry& world = scene.geometries[0];
  const std::size_t count = world.classBegin[kTriangleClasses];
  if (count == 0 || count > kMostParts || scene.triangles.size() >= CasterRef::kBox) return parts;
  if (!inRange(scene)) return parts;
  std::vector<double> edges(count);
  for (std::size_t i = 0; i < count; ++i) {
    edges[i] = ReceivingTriangle(scene.triangles[world.firstTriangle + i], 1).longest();
  }
  double cell = length(Vec3d(scene.upper) - Vec3d(scene.lower)) * kFinestCell;
  std::size_t total = 0;
  do {
    total = 0;
    for (const double edge : edges) {
      const auto side = static_cast<std::size_t>(partsASide(edge, cell));
      total += side * side;
    }
    cell *= 2;
  } while (total > kMostParts);
  cell /= 2;
  parts.finest = cell * kFinestInParts;
  parts.first.assign(scene.triangles.size(), kNoParts);
  parts.owner.reserve(total);
  for (std::size_t i = 0; i < count; ++i) {
    const auto side = static_cast<unsigned>(partsASide(edges[i], cell));
    const std::uint32_t triangle = world.firstTriangle + static_cast<std::uint32_t>(i);
    parts.first[triangle] = static_cast<std::uint32_t>(parts.owner.size() << kPartBits) |
                            static_cast<std::uint32_t>(std::countr_zero(side));
    parts.owner.insert(parts.owner.end(), std::size_t{side} * side, triangle);
  }
  return parts;
}

// The table of one light.
struct ShadowTables::OfLight {
  OfLight(const Light& light, std::size_t n, std::size_t partCount, std::size_t most)
      : number(n), point(LightPoint::of(light)), parts(partCount), wanted(partCount) {
    // Kernels may look up where nothing is yet.
    cells.resize(kWordsAPlace);
    mostCells = most;
  }

  // Memory of the tables without the cells.
  static std::uint64_t fixedBytes(std::size_t partCount, std::size_t casters) {
    return partCount * (sizeof(std::uint32_t) + 1) + CasterTree::bytesFor(casters);
  }
  std::uint64_t bytes() const {
    return (parts.size() + cells.capacity()) * sizeof(std::uint32_t) + wanted.size() +
           (tree ? tree->bytes() : 0);
  }
  void forget() {
    tree.reset();
    cells.resize(kWordsAPlace);
    std::ranges::fill(parts, 0);
    std::ranges::fill(wanted, std::uint8_t{0});
    seen = mixed = 0;
  }
  // The last answer of each part that was asked for.
  void keep(std::uint32_t part, const PartShadow& state) {
    wanted[part] = 0;
    ++seen;
    const std::size_t place = cells.size() / kWordsAPlace;
    if (state.divided && place < mostCells) {
      cells.insert(cells.end(), state.cells.begin(), state.cells.end());
      parts[part] = static_cast<std::uint32_t>(place + 1) << 2;
      return;
    }
    const ShadowState whole = state.divided ? ShadowState::mixed : state.whole;
    if (whole == ShadowState::mixed) ++mixed;
    parts[part] = static_cast<std::uint32_t>(whole);
  }
  // True if so few parts are decided that filling the cache costs more than it saves.
  bool idle() const { return seen >= kTried && mixed > seen - seen / kLeastUse; }

  static constexpr std::size_t kTried = 4096, kLeastUse = 8;
  std::size_t number;
  LightPoint point;
  std::unique_ptr<CasterTree> tree;  // from the first filling on
  HugeVector<std::uint32_t> parts, cells;
  std::vector<std::uint8_t> wanted;
  std::size_t mostCells;  // places of cells
  std::size_t seen = 0, mixed = 0;
};

ShadowTables::ShadowTables(const Scene& scene, const std::vector<std::size_t>& lights,
                           std::uint64_t mostBytes)
    : scene_(scene), numbers_(lights), parts_(ShadowParts::of(scene)), views_(scene.lights.size()) {
  if (parts_.count() == 0 || lights.empty()) return;
  casters_ = std::make_unique<CasterList>(scene);
  const std::uint64_t shared = bytes();
  if (shared > mostBytes) return;
  const std::uint64_t each = std::min((mostBytes - shared) / lights.size(), kMostBytesALight);
  const std::uint64_t fixed = OfLight::fixedBytes(parts_.count(), casters_->casters.size());
  if (fixed > each) return;
  const std::size_t mostCells = (each - fixed) / (kWordsAPlace * sizeof(std::uint32_t));
  for (const std::size_t number : lights) {
    lights_.push_back(
        std::make_unique<OfLight>(scene.lights[number], number, parts_.count(), mostCells));
    serve(*lights_.back());
  }
}

ShadowTables::~ShadowTables() = default;

void ShadowTables::serve(OfLight& light) {
  ShadowCacheView& view = views_[light.number];
  view = ShadowCacheView();
  if (!inRange(light.point) || light.idle()) return;
  view = {parts_.first.data(), light.parts.data(), light.cells.data(), light.wanted.data()};
}

void ShadowTables::forgetMovedLights() {
  for (auto& light : lights_) {
    const LightPoint now = LightPoint::of(scene_.lights[light->number]);
    if (now == light->point) continue;
    light->point = now;
    light->forget();
    serve(*light);
  }
}

FillReport ShadowTables::fill(WorkerPool& pool, const FillLimits& limits) {
  const Stopwatch stopwatch;
  FillReport report;
  for (auto& light : lights_) {
    if (!views_[light->number].serves()) continue;
    report.parts += fillLight(*light, pool, limits);
    serve(*light);
  }
  report.ms = stopwatch.ms();
  return report;
}

void ShadowTables::forgetAsked() {
  for (auto& light : lights_) std::ranges::fill(light->wanted, std::uint8_t{0});
}

// Returns how many parts it looked at.
std::uint64_t ShadowTables::fillLight(OfLight& light, WorkerPool& pool,
                                      const FillLimits& limits) const {
  std::vector<std::uint32_t> asked;
  for (std::size_t i = 0; i < light.wanted.size() && asked.size() < limits.mostParts; ++i) {
    if (light.wanted[i] >= limits.leastRays) asked.push_back(static_cast<std::uint32_t>(i));
  }
  if (asked.empty()) return 0;
  if (!light.tree) light.tree = std::make_unique<CasterTree>(scene_, *casters_, light.point);
  std::vector<PartShadow> shadowCache(asked.size());
  const simd::CasterKernels kernels = simd::findCasterKernels();
  std::atomic<std::size_t> next{0};
  pool.run([&](int) {
    PartScratch scratch;
    for (std::size_t i = next++; i < asked.size(); i = next++) {
      shadowCache[i] = decide(light, asked[i], kernels, scratch);
    }
  });
  for (std::size_t i = 0; i < asked.size(); ++i) light.keep(asked[i], shadowCache[i]);
  return asked.size();
}

PartShadow ShadowTables::decide(const OfLight& light, std::uint32_t part,
                                const simd::CasterKernels& kernels, PartScratch& scratch) const {
  const std::uint32_t triangle = parts_.owner[part], word = parts_.first[triangle];
  const std::uint32_t side = 1u << (word & ((1u << kPartBits) - 1));
  const std::uint32_t at = part - (word >> kPartBits);
  const double width = 1.0 / side;
  const std::uint32_t column = at % side, row = at / side;
  const WeightSquare square{width * column, width * row, width};
  return decidePart({scene_, *casters_, *light.tree, light.point, kernels, parts_.finest}, triangle,
                    square, scratch);
}

std::uint64_t ShadowTables::bytes() const {
  std::uint64_t sum = parts_.first.size() * sizeof(std::uint32_t) +
                      parts_.owner.size() * sizeof(std::uint32_t) +
                      (casters_ ? casters_->bytes() : 0);
  for (const auto& light : lights_) sum += light->bytes();
  return sum;
}

}  // namespace whit
