#include "inspect/stage_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bake/sphere.h"
#include "core/image.h"
#include "core/index.h"
#include "reference/add_impulses.h"
#include "reference/add_shading.h"
#include "reference/check_shadows.h"
#include "reference/find_intersections.h"
#include "reference/find_radiance_and_shadow_rays.h"
#include "reference/generate_rays.h"
#include "reference/update_image.h"
#include "reference/world.h"
#include "reference/write_emitted_and_reflective_ambient.h"
#include "render/embree_intersector.h"
#include "render/frame.h"
#include "scene/light.h"
#include "surfaces/intersect.h"

namespace whit {

namespace {

// The quantities of each stage that are compared, and the largest allowed difference between a
// vector step and the scalar reference. The tables quantitiesOf() contain all knowledge about
// columns. A column without an entry is compared by itself: whole numbers have to be equal, others
// within kRoundedLimit.

// Limits, in ulps of the largest component, with the reasons for their sizes.
constexpr double kRoundedLimit = 4;    // a few products and sums
constexpr double kDirectionLimit = 4;  // a normalized sum of three products
constexpr double kPositionLimit = 4;   // three products, against the largest corner
// The offset (surfaces/surface_point.cpp) is 16 ulps of the edges along the normal plus 2^-6 ulp of
// everything, and more. One ulp of the normal moves the first term by as much as 16 / 2^-6 = 1024
// ulps of the second; the rounding of normal and edges doubles that.
constexpr double kOffsetLimit = 2048;
constexpr double kShadowOffsetLimit = 8;  // three products of two positions' difference
constexpr double kNormalLimit = 4;        // cross product by differences of products, normalized
// An ulp of a texture coordinate u is 2^-23 u of a repeat; times the texture's size in texels and
// the contrast between two of them it is a visible number of ulps of the color (hard case H68).
constexpr double kTexturedLimit = 4096;
constexpr double kSkyLimit = 512;  // likewise, for azimuth and elevation
// Largest error of a footprint on a compact triangle that is seen head on. The footprint moves the
// lookup between mip levels, whose contrast may be that of the color.
constexpr double kFootprintLimit = 16;
constexpr double kConeLimit = 2;       // one product and one sum
constexpr double kRadianceLimit = 32;  // a dozen factors, some of them squared
constexpr double kWeightLimit = 4096;  // Fresnel's root at the critical angle: 4e-4 (H37)
constexpr double kChildLimit = 512;    // the refracted direction there: 3e-5 (H37)
constexpr double kSumLimit = 1;        // one addition
constexpr double kExact = 0;

double ulpOf(double magnitude) {
  const float m = static_cast<float>(std::fabs(magnitude));
  // Far below anything visible, and far enough above the least normal float for its ulp to be one
  // too: workers flush what is smaller to zero.
  constexpr float least = 1e-25f;
  const float at = std::max(m, least);
  return double{std::nextafter(at, std::numeric_limits<float>::infinity()) - at};
}

// The place of a row, and the row of the scalar reference.
template <typename Row>
struct RowContext {
  const reference::World& world;
  const Chunk& chunk;
  std::size_t slot;
  const Row& scalar;
};

// Columns that are compared together. Differences are counted in ulps of the values' own magnitude
// or of scale(), whichever is larger; kNotHere means that the row is not compared.
constexpr double kNotHere = -1;
template <typename Row>
struct Quantity {
  std::optional<Stage> stage;  // null: every stage that writes such rows
  std::string name;
  std::vector<std::string> columns;
  double limit;
  double (*scale)(const RowContext<Row>&) = nullptr;  // null: 0 everywhere
};

template <typename Row>
double byOne(const RowContext<Row>&) {
  return 1;
}

// The shadow slot is an index and is not compared.
double byNothing(const RowContext<ShadowRow>&) { return kNotHere; }

double byEye(const RowContext<RayRow>& p) { return maxComponent(abs(p.world.camera.eye)); }

// Near the critical angle the root amplifies rounding without bound; there the weight of the
// refracted ray goes to zero with it.
template <double (*kScale)(const RowContext<RayRow>&)>
double whereItCounts(const RowContext<RayRow>& p) {
  const double largest = maxComponent(p.scalar.weight);
  return largest < 0.05 ? kNotHere : kScale(p);
}
double byItself(const RowContext<RayRow>&) { return 0; }

double cosineOf(const RowContext<SurfelRow>& p) {
  const SurfelRow& s = p.scalar;
  return std::fabs(dot(s.ng, rayOf(p.chunk, p.slot).direction));
}
// A surface seen edge on may be entered in one precision and left in the other.
template <double (*kScale)(const RowContext<SurfelRow>&)>
double notEdgeOn(const RowContext<SurfelRow>& p) {
  return cosineOf(p) < 1e-5 ? kNotHere : kScale(p);
}
double byItself(const RowContext<SurfelRow>&) { return 0; }
Corners cornersAt(const RowContext<SurfelRow>& p) {
  const Candidate candidate = candidateOf(p.chunk, p.slot);
  const Scene& scene = p.world.scene;
  if (!scene.isSphere(candidate.triangle)) {
    return worldCorners(scene, candidate.triangle, candidate.instance);
  }
  return cornersOf(touchingTriangle(scene.triangles[candidate.triangle], candidate.u, candidate.v),
                   toWorldOf(scene, candidate.instance));
}
// The factor by which the cross product of the edges amplifies their rounding.
double bySliver(const RowContext<SurfelRow>& p) {
  const Corners c = cornersAt(p);
  const Vec3d a = c[1] - c[0], b = c[2] - c[0];
  return length(a) * length(b) / std::max(length(cross(a, b)), 1e-300);
}
// The map that makes the sphere of the unit sphere, in the world; none on triangles.
std::optional<Affine> sphereAt(const RowContext<SurfelRow>& p) {
  const Candidate candidate = candidateOf(p.chunk, p.slot);
  if (!p.world.scene.isSphere(candidate.triangle)) return {};
  return sphereInWorld(p.world.scene, {candidate.triangle, candidate.instance});
}
Vec3d axesOf(const Affine& map) { return abs(map.x) + abs(map.y) + abs(map.z); }
// The magnitude of a position that surfacePoint() found along the ray; none where it follows from
// the corners.
std::optional<double> alongRay(const RowContext<SurfelRow>& p) {
  const double t = double{p.chunk.hits.t[p.slot]};
  const Corners c = cornersAt(p);
  const auto sphere = sphereAt(p);
  const Vec3d edges =
      sphere ? axesOf(*sphere) * double{kSphereSpan} : abs(c[1] - c[0]) + abs(c[2] - c[0]);
  const bool placed = candidateOf(p.chunk, p.slot).instance != kNoInstance;
  const bool shared = reference::alsoCrossedAt(p.chunk, p.slot) >= kSharesPlace;
  if (placed || shared || (!sphere && bySliver(p) > 0x1p11) ||
      !(8 * t < edges.x + edges.y + edges.z))
    return {};
  const SurfelRow& s = p.scalar;
  const double across = dot(abs(s.ng), edges);
  const Vec3d place = abs(s.pos);
  return place.x + place.y + place.z + 4 * t + across;
}
// By the corners, which may be far larger than the place that a ray found. Of an instance the
// offset is 32 units in the last place of all that went into the position, and 16 of its edges,
// whose products with the weights are rounded too.
double byMagnitude(const RowContext<SurfelRow>& p) {
  if (const auto found = alongRay(p)) return *found;
  if (const auto sphere = sphereAt(p)) {
    const Vec3d size = axesOf(*sphere) + abs(sphere->p);
    return size.x + size.y + size.z;
  }
  Vec3d largest;
  for (const Vec3d& corner : cornersAt(p)) largest = max(largest, abs(corner));
  return std::max(largest.x + largest.y + largest.z, p.scalar.offset * 0x1p19);
}
// From slivers of 2^14 on another offset counts; rounding decides what is one.
double byOffset(const RowContext<SurfelRow>& p) {
  const double sliver = bySliver(p);
  return sliver > 0x1p11 ? kNotHere : sliver * p.scalar.offset;
}
double bySliverIfMapped(const RowContext<SurfelRow>& p) {
  return p.world.effects.has(Effect::normalMaps) ? bySliver(p) : kNotHere;
}
double bySliverIfNotMapped(const RowContext<SurfelRow>& p) {
  return p.world.effects.has(Effect::normalMaps) ? kNotHere : bySliver(p);
}
// The footprint is as uncertain as area and cosine, which it is divided by.
double byFootprint(const RowContext<SurfelRow>& p) {
  if (!p.world.maps) return 1;
  return std::max(1.0, kFootprintLimit / kTexturedLimit * bySliver(p) / cosineOf(p));
}

double ofMisses(const RowContext<RadianceRow>& p) {
  return p.chunk.surfels.material[p.slot] == kMiss ? 0 : kNotHere;
}
double ofSurfels(const RowContext<RadianceRow>& p) {
  return p.chunk.surfels.material[p.slot] == kMiss ? kNotHere : 0;
}

// A point on a light is found from its center by a sine, a cosine, three roots and a change of
// frame: its direction is off by up to four ulps more than that of the center, which is one
// difference.
double byPointOfLight(const Chunk& chunk) { return chunk.lightSamples > 1 ? 4 : 1; }

// The radiance without the cosine at the light's point, because the rounding error of the cosine is
// absolute. A highlight moves by an ulp of the half vector over the width of the lobe.
double byGrazing(const RowContext<UnshadowedRow>& p) {
  if (p.chunk.lightIsAmbient()) return 0;
  const Light& light = *p.chunk.light;
  const reference::Surfel s = reference::surfelOf(p.chunk, p.slot);
  const Vec3d l = normalized(reference::arrivalAt(p.world, p.chunk, p.slot).shadowRay.direction);
  const double width = maxComponent(s.specular) > 0 ? s.alpha : 1;
  const double scale = byPointOfLight(p.chunk) * maxComponent(p.scalar.rgb) /
                       (std::max(dot(l, s.shadingNormal), 1e-4) * width);
  if (light.kind != Light::Kind::spot) return scale;
  // The cosine to the cone's axis has an absolute error too, relative to the width of its edge.
  const SpotCone cone = coneOf(light);
  return scale * std::max(1.0, 2 * cone.scale / std::max(std::sqrt(cone.falloff(l)), 1e-4));
}
// A difference of two positions; or of ambient light by a sine, a cosine and a change of frame.
double byBothEnds(const RowContext<ShadowRow>& p) {
  if (p.chunk.lightIsAmbient()) return 4;
  const Light& light = *p.chunk.light;
  if (light.kind == Light::Kind::directional) return 1;
  return byPointOfLight(p.chunk) *
         (maxComponent(abs(Vec3d(light.position))) + maxComponent(abs(p.scalar.org)));
}

std::vector<std::string> xyz(const std::string& s) { return {s + "X", s + "Y", s + "Z"}; }
std::vector<std::string> rgb(const std::string& s) { return {s + "R", s + "G", s + "B"}; }

// The quantities of each kind of row.
std::vector<Quantity<RayRow>> quantitiesOf(const RayRow*) {
  using enum Stage;
  // The throughput is the weight as the cutoff counts it.
  const std::vector<std::string> weight{"weightR", "weightG", "weightB", "throughput"};
  return {
      {generateRays, "origin", xyz("org"), kPositionLimit, byEye},
      {generateRays, "dir", xyz("dir"), kDirectionLimit, byOne},
      {generateRays, "weight", weight, kExact},
      {generateRays, "parent", {"parent"}, kExact},
      {generateRays, "media", {"media"}, kExact},
      {generateRays, "cone", {"cone"}, kConeLimit},
      {addImpulses, "weight", weight, kWeightLimit, byOne},
      {addImpulses, "direction", xyz("dir"), kChildLimit, whereItCounts<byOne>},
      {addImpulses, "origin", xyz("org"), kPositionLimit, whereItCounts<byItself>},
      {addImpulses, "cone", {"cone"}, kExact, whereItCounts<byItself>},
      {addImpulses, "media", {"media"}, kExact, whereItCounts<byItself>},
  };
}
std::vector<Quantity<SurfelRow>> quantitiesOf(const SurfelRow*) {
  constexpr Stage stage = Stage::findIntersections;
  return {
      {stage, "position", xyz("pos"), kPositionLimit, byMagnitude},
      {stage, "offset", {"offset"}, kOffsetLimit, byOffset},
      {stage, "viewOffset", {"viewOffset"}, kOffsetLimit, byOffset},
      {stage, "geometricNormal", xyz("ng"), kNormalLimit, notEdgeOn<bySliver>},
      {stage, "shadingNormal", xyz("ns"), kNormalLimit, notEdgeOn<bySliverIfNotMapped>},
      {stage, "shadingNormal", xyz("ns"), kTexturedLimit, notEdgeOn<bySliverIfMapped>},
      {stage, "diffuse", rgb("diffuse"), kTexturedLimit, notEdgeOn<byFootprint>},
      {stage, "specular", rgb("specular"), kTexturedLimit, notEdgeOn<byFootprint>},
      {stage, "alpha", {"alpha"}, kTexturedLimit, notEdgeOn<byFootprint>},
      {stage, "lobe", rgb("lobe"), kTexturedLimit, notEdgeOn<byFootprint>},
      {stage, "emission", rgb("emission"), kTexturedLimit, notEdgeOn<byFootprint>},
      {stage, "coverage", {"coverage"}, kTexturedLimit, notEdgeOn<byFootprint>},
      {stage, "occlusion", {"occlusion"}, kTexturedLimit, notEdgeOn<byFootprint>},
      {stage, "mirror", rgb("mirror"), kTexturedLimit, notEdgeOn<byFootprint>},
      {stage, "transmission", rgb("transmission"), kTexturedLimit, notEdgeOn<byFootprint>},
      {stage, "shadowOffset", xyz("shadowOffset"), kShadowOffsetLimit, notEdgeOn<byMagnitude>},
      {stage, "cone", {"cone"}, kConeLimit},
      {stage, "flags", {"flags"}, kExact, notEdgeOn<byItself>},
      {stage, "mediaBehind", {"mediaBehind"}, kExact, notEdgeOn<byItself>},
  };
}
std::vector<Quantity<RadianceRow>> quantitiesOf(const RadianceRow*) {
  using enum Stage;
  return {
      {writeEmittedAndReflectiveAmbient, "sky", {"r", "g", "b"}, kSkyLimit, ofMisses},
      {writeEmittedAndReflectiveAmbient, "radiance", {"r", "g", "b"}, kRadianceLimit, ofSurfels},
      {addShading, "radiance", {"r", "g", "b"}, kSumLimit},
  };
}
std::vector<Quantity<UnshadowedRow>> quantitiesOf(const UnshadowedRow*) {
  using enum Stage;
  return {
      {findRadianceAndShadowRays, "unshadowed", {"r", "g", "b"}, kRadianceLimit, byGrazing},
      {checkShadows, "visible", {"visible"}, kExact},
  };
}
std::vector<Quantity<ShadowRow>> quantitiesOf(const ShadowRow*) {
  constexpr Stage stage = Stage::findRadianceAndShadowRays;
  return {
      {stage, "shadowOrigin", xyz("org"), kPositionLimit},
      {stage, "shadowDirection", xyz("dir"), kPositionLimit, byBothEnds},
      {stage, "shadowEnd", {"tFar"}, kRoundedLimit, byOne},
      {stage, "slot", {"slot"}, kExact, byNothing},
  };
}

constexpr std::size_t kSlotsPerStage = 200000;  // a sample of the frame is plenty, and much faster

// A quantity and the places of its columns in the row.
template <typename Row>
struct Compared {
  Quantity<Row> what;
  std::vector<std::size_t> columns{};
  Feature feature = Feature::always;
};

// Returns the quantities of the tables, and the columns that the tables do not list.
template <typename Row>
std::vector<Compared<Row>> comparedOf() {
  std::vector<Compared<Row>> result;
  for (const Quantity<Row>& q : quantitiesOf(static_cast<const Row*>(nullptr))) {
    result.push_back({q});
  }
  const Row row;
  std::size_t place = 0;
  Row::forEachColumn(row, [&](const std::string& column, auto value, Feature feature) {
    bool listed = false;
    for (Compared<Row>& compared : result) {
      if (!contains(compared.what.columns, column)) continue;
      compared.columns.push_back(place);
      compared.feature = feature;
      listed = true;
    }
    if (!listed) {
      const double limit = std::is_integral_v<decltype(value)> ? kExact : kRoundedLimit;
      result.push_back({{std::nullopt, column, {column}, limit}, {place}, feature});
    }
    ++place;
  });
  return result;
}

// In ulps of the largest component, at least of `scale`. Written so that a NaN stays.
template <typename Values>
double distance(const Values& got, const Values& wanted, const std::vector<std::size_t>& columns,
                double scale) {
  double largest = 0, magnitude = scale;
  for (const std::size_t i : columns) {
    magnitude = std::max({magnitude, std::fabs(got[i]), std::fabs(wanted[i])});
    if (got[i] == wanted[i]) continue;
    if (!std::isfinite(got[i])) return kInfinity;
    const double difference = std::fabs(got[i] - wanted[i]);
    if (!(difference <= largest)) largest = difference;
  }
  return largest == 0 ? 0 : largest / ulpOf(magnitude);
}

// Returns the slots whose light was found: those of shadow rays, or without shadows the visible
// ones.
std::vector<std::size_t> litSlots(const Chunk& c) {
  if (c.tracesShadows()) return {c.shadows.slot, c.shadows.slot + c.shadowCount};
  std::vector<std::size_t> slots;
  for (const auto i : indices(c.n)) {
    if (c.unshadowed.visible[i] > 0) slots.push_back(i);
  }
  return slots;
}

bool trilinear(const Renderer& renderer) { return renderer.plan().features.has(Feature::cones); }

class StageComparer : public StageObserver {
 public:
  StageComparer(Renderer& renderer, const Camera& camera, const Film& film)
      : options_(renderer.options()),
        intersector_(renderer.accel()),
        maps_(trilinear(renderer) ? MipMaps(renderer.scene()) : MipMaps()),
        world_{renderer.scene(), renderer.plan().effects, trilinear(renderer) ? &maps_ : nullptr,
               renderer.prepareView(camera, film), intersector_} {}

  void after(Stage stage, const Chunk& chunk) override {
    tracker_.follow(stage, chunk);
    // Children of narrowed trees count for others, too.
    if (!enough(stage) && !chunk.narrowings) compareStage(stage, chunk);
    if (stage != Stage::writeEmittedAndReflectiveAmbient && stage != Stage::addShading) return;
    before_.clear();
    for (const auto i : indices(chunk.n)) before_.push_back(RadianceRow::at(chunk.radiance, i));
  }

  // updateImage, of what the film keeps.
  void compareImage(const Film& film) {
    const Crop& window = film.image.window;
    for (int y = window.y0; y < window.y1; ++y) {
      for (int x = window.x0; x < window.x1; ++x) {
        const std::size_t pixel = film.image.index(x, y);
        const std::uint32_t scalar = reference::updateImage(options_, film.image.pixels[pixel]);
        int worst = 0;
        for (const auto channel : indices(3)) {
          const int code = static_cast<int>(scalar >> (8 * channel) & 0xFFu);
          worst = std::max(worst, std::abs(code - int{film.display.rgba[4 * pixel + channel]}));
        }
        note(Stage::updateImage, "code", worst, kExact, packedPixel(x, y), 0);
      }
    }
  }

  std::vector<StageDifference> rows;

 private:
  // True if the rows of the stage have as many slots as they need.
  bool enough(Stage stage) const {
    return std::ranges::any_of(rows, [&](const StageDifference& row) {
      return row.stage == stage && row.slots > kSlotsPerStage;
    });
  }

  void note(Stage stage, const std::string& name, double ulp, double limit, std::uint32_t pixel,
            int depth) {
    auto row = std::ranges::find_if(
        rows, [&](const StageDifference& r) { return r.stage == stage && r.column == name; });
    if (row == rows.end()) row = rows.insert(row, {stage, name, 0, 0, limit, 0, 0, 0});
    ++row->slots;
    // Written so that a NaN counts as worse than anything.
    if (ulp <= row->worstUlp) return;
    row->worstUlp = std::isnan(ulp) ? kInfinity : ulp;
    row->pixelX = pixelX(pixel);
    row->pixelY = pixelY(pixel);
    row->depth = depth;
  }

  // `slot` is that of the surfel that the row is about; some rows have no reference.
  template <typename Row>
  void compareRow(Stage stage, const Chunk& c, std::size_t slot, const Row& got,
                  const std::type_identity_t<std::optional<Row>>& scalar) {
    static const std::vector<Compared<Row>> compared = comparedOf<Row>();
    if (!scalar) return;
    const auto values = got.values(), wanted = scalar->values();
    const RowContext<Row> place{world_, c, slot, *scalar};
    for (const auto& [what, columns, feature] : compared) {
      if (what.stage && what.stage != stage) continue;
      const double scale = what.scale ? what.scale(place) : 0;
      if (scale == kNotHere || !c.has(feature)) continue;
      note(stage, what.name, distance(values, wanted, columns, scale), what.limit,
           tracker_.pixel(c, slot), c.depth);
    }
  }

  // All rows of `columns`; `slots` are those of their surfels where they are not the same.
  template <typename Row, typename Scalar>
  void compareRows(Stage stage, const Chunk& c, const typename Row::Columns& columns,
                   std::size_t count, Scalar&& scalar, const std::uint32_t* slots = nullptr) {
    for (const auto i : indices(count)) {
      compareRow(stage, c, slots ? slots[i] : i, Row::at(columns, i), scalar(world_, c, i));
    }
  }

  void compareStage(Stage stage, const Chunk& c) {
    switch (stage) {
      case Stage::generateRays:
        compareRows<RayRow>(stage, c, c.rays, c.n, reference::generateRays);
        break;
      case Stage::findIntersections:
        compareRows<SurfelRow>(stage, c, c.surfels, c.n, reference::findIntersections);
        break;
      case Stage::writeEmittedAndReflectiveAmbient:
        compareRows<RadianceRow>(stage, c, c.radiance, c.n,
                                 reference::writeEmittedAndReflectiveAmbient);
        break;

      // Steps of a light write to the slots of surfels that it reaches.
      case Stage::findRadianceAndShadowRays:
        for (const std::size_t i : litSlots(c)) {
          compareRow(stage, c, i, UnshadowedRow::at(c.unshadowed, i),
                     reference::findRadiance(world_, c, i));
        }
        compareRows<ShadowRow>(stage, c, c.shadows, c.shadowCount, reference::findShadowRay,
                               c.shadows.slot);
        break;
      case Stage::checkShadows:
        for (const auto k : indices(c.shadowCount)) {
          const std::uint32_t i = c.shadows.slot[k];
          compareRow(stage, c, i, UnshadowedRow::at(c.unshadowed, i),
                     reference::checkShadows(world_, c, k));
        }
        break;
      case Stage::addShading:
        compareRows<RadianceRow>(stage, c, c.radiance, c.n,
                                 [&](const reference::World&, const Chunk&, std::size_t i) {
                                   return reference::addShading(before_[i], c, i);
                                 });
        break;

      case Stage::addImpulses:
        compareRows<RayRow>(stage, c, c.children, c.childCount, reference::addImpulses,
                            c.children.parent);
        break;
      case Stage::updateImage:
        break;  // compareImage() compares the picture
    }
  }

  const RenderOptions& options_;
  EmbreeIntersector intersector_;
  MipMaps maps_;
  reference::World world_;
  PixelTracker tracker_;
  std::vector<RadianceRow> before_;  // radiance of the chunk before the light that is being added
};

}  // namespace

std::vector<StageDifference> compareStages(Renderer& renderer, const Camera& camera,
                                           const Film& film) {
  Film scratch = film;
  scratch.wantDisplay = true;
  StageComparer comparer(renderer, camera, scratch);
  StageObserver* const observers[] = {&comparer};
  renderer.render({.camera = camera, .film = scratch, .observers = observers, .uniform = true});
  comparer.compareImage(scratch);
  return comparer.rows;
}

}  // namespace whit
