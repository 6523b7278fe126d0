// whit compare --stages: each vector stage against its scalar twin, on the very same input. Twins
// are functions of the chunk (src/reference/<stage>); to compare one is a loop over the columns of
// its row.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/pixel.h"
#include "reference/add_impulses.h"
#include "reference/add_shading.h"
#include "reference/check_shadows.h"
#include "reference/find_intersections.h"
#include "reference/find_radiance_and_shadow_rays.h"
#include "reference/generate_rays.h"
#include "reference/update_image.h"
#include "reference/write_emitted_and_reflective_ambient.h"
#include "render/embree_intersector.h"
#include "render/observer.h"
#include "render/pixel_tracker.h"
#include "render/stage_comparison.h"
#include "render/stage_limits.h"

namespace whit {

namespace {

constexpr std::size_t kSlotsPerStage = 200000;  // a sample of the frame is plenty, and much faster

// A quantity as the loop over a row's values takes it.
template <typename Row>
struct Compared {
  Quantity<Row> what;
  std::vector<std::size_t> columns{};  // their places in the row
  Feature feature = Feature::always;
};

// Those of the stage, and the columns that the tables do not know.
template <typename Row>
std::vector<Compared<Row>> comparedAt(Stage stage) {
  const std::vector<Quantity<Row>> known = quantitiesOf(static_cast<const Row*>(nullptr));
  std::vector<Compared<Row>> result;
  for (const Quantity<Row>& q : known) {
    if (q.stage == stage) result.push_back({q});
  }
  std::size_t place = 0;
  Row row;
  Row::forEachColumn(row, [&](std::string_view column, auto value, Feature feature) {
    const auto isOf = [&](const Quantity<Row>& q) {
      return std::find(q.columns.begin(), q.columns.end(), column) != q.columns.end();
    };
    if (std::none_of(known.begin(), known.end(), isOf)) {
      const double limit = std::is_integral_v<decltype(value)> ? kExact : kRoundedLimit;
      result.push_back({{stage, column, {column}, limit}});
    }
    for (Compared<Row>& compared : result) {
      if (!isOf(compared.what)) continue;
      compared.columns.push_back(place);
      compared.feature = feature;
    }
    ++place;
  });
  return result;
}

template <typename Row>
using Values = std::array<double, Row::kColumns>;

template <typename Row>
Values<Row> valuesOf(const Row& row) {
  Values<Row> values;
  std::size_t place = 0;
  Row::forEachColumn(
      row, [&](const char*, auto value, Feature) { values[place++] = static_cast<double>(value); });
  return values;
}

// In ulps of the largest component, at least of `scale`.
template <typename Row>
double distance(const Values<Row>& got, const Values<Row>& wanted,
                const std::vector<std::size_t>& columns, double scale) {
  double largest = 0, magnitude = scale;
  for (const std::size_t i : columns) {
    if (got[i] == wanted[i]) continue;
    if (!std::isfinite(got[i])) return std::numeric_limits<double>::infinity();
    // Written so that a NaN stays.
    const double difference = std::fabs(got[i] - wanted[i]);
    if (!(difference <= largest)) largest = difference;
  }
  for (const std::size_t i : columns) {
    magnitude = std::max({magnitude, std::fabs(got[i]), std::fabs(wanted[i])});
  }
  return largest / ulpOf(magnitude);
}

class StageComparer : public StageObserver {
 public:
  StageComparer(Renderer& renderer, const Camera& camera, const Film& film)
      : options_(renderer.options()), intersector_(renderer.accel()) {
    const Plan& plan = renderer.plan();
    if (plan.features.has(Feature::cones)) maps_.emplace(renderer.scene());
    world_.emplace(reference::World{renderer.scene(), plan.effects, maps_ ? &*maps_ : nullptr,
                                    renderer.lookFrom(camera, film), intersector_});
  }

  void after(Stage stage, const Chunk& chunk) override;
  void compareImage(const Film& film);

  std::vector<StageDifference> rows;

 private:
  void compareStage(Stage stage, const Chunk& c);
  // `slot` is that of the surfel that the row is about. Twins know nothing of some rows.
  template <typename Row>
  void compareRow(Stage stage, const Chunk& c, std::size_t slot, const Row& got,
                  const std::type_identity_t<std::optional<Row>>& twin);
  bool enough(Stage stage) const;
  void note(Stage stage, std::string_view name, double ulp, double limit, std::uint32_t pixel,
            int depth);

  const RenderOptions& options_;
  EmbreeIntersector intersector_;
  std::optional<MipMaps> maps_;  // where lookups are trilinear
  std::optional<reference::World> world_;
  PixelTracker tracker_;
  std::vector<RadianceRow> before_;  // radiance of the chunk before the light that is being added
};

// Whether the stage's rows have as many slots as they need.
bool StageComparer::enough(Stage stage) const {
  return std::any_of(rows.begin(), rows.end(), [&](const StageDifference& row) {
    return row.stage == stage && row.slots > kSlotsPerStage;
  });
}

void StageComparer::note(Stage stage, std::string_view name, double ulp, double limit,
                         std::uint32_t pixel, int depth) {
  auto row = std::find_if(rows.begin(), rows.end(), [&](const StageDifference& r) {
    return r.stage == stage && r.column == name;
  });
  if (row == rows.end()) {
    row = rows.insert(row, {stage, std::string(name), 0, 0, limit, 0, 0, 0});
  }
  ++row->slots;
  // Written so that a NaN counts as worse than anything.
  if (ulp <= row->worstUlp) return;
  row->worstUlp = std::isnan(ulp) ? std::numeric_limits<double>::infinity() : ulp;
  row->pixelX = pixelX(pixel);
  row->pixelY = pixelY(pixel);
  row->depth = depth;
}

template <typename Row>
void StageComparer::compareRow(Stage stage, const Chunk& c, std::size_t slot, const Row& got,
                               const std::type_identity_t<std::optional<Row>>& twin) {
  if (!twin) return;
  static const auto compared = [] {
    std::array<std::vector<Compared<Row>>, kStageCount> all;
    for (std::size_t i = 0; i < kStageCount; ++i) all[i] = comparedAt<Row>(static_cast<Stage>(i));
    return all;
  }();
  const Values<Row> values = valuesOf(got), wanted = valuesOf(*twin);
  const Place<Row> place{*world_, c, slot, *twin};
  for (const auto& [what, columns, feature] : compared[static_cast<std::size_t>(stage)]) {
    if (!c.has(feature)) continue;
    const double scale = what.scale ? what.scale(place) : 0;
    if (scale == kNotHere) continue;
    note(stage, what.name, distance<Row>(values, wanted, columns, scale), what.limit,
         tracker_.pixel(c, slot), c.depth);
  }
}

void StageComparer::compareStage(Stage stage, const Chunk& c) {
  const reference::World& w = *world_;
  const auto eachSlot = [&](auto&& compareSlot) {
    for (std::size_t i = 0; i < c.n; ++i) compareSlot(i);
  };
  switch (stage) {
    case Stage::generateRays:
      return eachSlot([&](std::size_t i) {
        compareRow(stage, c, i, RayRow::at(c.rays, i), reference::generateRays(w, c, i));
      });
    case Stage::findIntersections:
      return eachSlot([&](std::size_t i) {
        compareRow(stage, c, i, SurfelRow::at(c.surfels, i), reference::findIntersections(w, c, i));
      });
    case Stage::writeEmittedAndReflectiveAmbient:
      return eachSlot([&](std::size_t i) {
        compareRow(stage, c, i, RadianceRow::at(c.radiance, i),
                   reference::writeEmittedAndReflectiveAmbient(w, c, i));
      });
    case Stage::findRadianceAndShadowRays:
      // Where light falls there is a shadow ray, or without shadows all is visible.
      eachSlot([&](std::size_t i) {
        if (c.has(Feature::shadows) || !(c.unshadowed.visible[i] > 0)) return;
        compareRow(stage, c, i, UnshadowedRow::at(c.unshadowed, i),
                   reference::findRadiance(w, c, i));
      });
      for (std::size_t k = 0; k < c.shadowCount; ++k) {
        const std::size_t i = c.shadows.slot[k];
        compareRow(stage, c, i, UnshadowedRow::at(c.unshadowed, i),
                   reference::findRadiance(w, c, i));
        compareRow(stage, c, i, ShadowRow::at(c.shadows, k), reference::findShadowRay(w, c, k));
      }
      return;
    case Stage::checkShadows:
      for (std::size_t k = 0; k < c.shadowCount; ++k) {
        const std::size_t i = c.shadows.slot[k];
        compareRow(stage, c, i, UnshadowedRow::at(c.unshadowed, i),
                   reference::checkShadows(w, c, k));
      }
      return;
    case Stage::addShading:
      return eachSlot([&](std::size_t i) {
        compareRow(stage, c, i, RadianceRow::at(c.radiance, i),
                   reference::addShading(before_[i], c, i));
      });
    case Stage::addImpulses:
      for (std::size_t k = 0; k < c.childCount; ++k) {
        compareRow(stage, c, c.children.parent[k], RayRow::at(c.children, k),
                   reference::addImpulses(w, c, k));
      }
      return;
    case Stage::updateImage:
      return;  // compareImage
  }
}

void StageComparer::after(Stage stage, const Chunk& chunk) {
  tracker_.follow(stage, chunk);
  if (!enough(stage)) compareStage(stage, chunk);
  if (stage != Stage::writeEmittedAndReflectiveAmbient && stage != Stage::addShading) return;
  before_.clear();
  for (std::size_t i = 0; i < chunk.n; ++i) before_.push_back(RadianceRow::at(chunk.radiance, i));
}

void StageComparer::compareImage(const Film& film) {
  const Crop& window = film.image.window;
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x) {
      const std::size_t pixel = film.image.index(x, y);
      const std::uint32_t twin = reference::updateImage(options_, film.image.pixels[pixel]);
      int worst = 0;
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const int code = static_cast<int>(twin >> (8 * channel) & 0xFFu);
        worst = std::max(worst, std::abs(code - int{film.display.rgba[4 * pixel + channel]}));
      }
      note(Stage::updateImage, "code", worst, kExact, packedPixel(x, y), 0);
    }
  }
}

}  // namespace

std::vector<StageDifference> compareStages(Renderer& renderer, const Camera& camera,
                                           const Film& film) {
  Film scratch = film;
  scratch.wantDisplay = true;
  StageComparer comparer(renderer, camera, scratch);
  StageObserver* const observers[] = {&comparer};
  renderer.observe(camera, scratch, observers);
  comparer.compareImage(scratch);
  return comparer.rows;
}

}  // namespace whit
