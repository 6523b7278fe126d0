#include "inspect/stage_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/pixel.h"
#include "inspect/stage_limits.h"
#include "reference/add_impulses.h"
#include "reference/add_shading.h"
#include "reference/check_shadows.h"
#include "reference/find_intersections.h"
#include "reference/find_radiance_and_shadow_rays.h"
#include "reference/generate_rays.h"
#include "reference/update_image.h"
#include "reference/write_emitted_and_reflective_ambient.h"
#include "render/embree_intersector.h"
#include "render/frame.h"
#include "render/pixel_tracker.h"

namespace whit {

namespace {

constexpr std::size_t kSlotsPerStage = 200000;  // a sample of the frame is plenty, and much faster

// A quantity and the places of its columns in the row.
template <typename Row>
struct Compared {
  Quantity<Row> what;
  std::vector<std::size_t> columns{};
  Feature feature = Feature::always;
};

// The quantities of the stage from the tables, and the columns that the tables do not list.
template <typename Row>
std::vector<Compared<Row>> comparedAt(Stage stage) {
  const std::vector<Quantity<Row>> known = quantitiesOf(static_cast<const Row*>(nullptr));
  std::vector<Compared<Row>> result;
  for (const Quantity<Row>& q : known) {
    if (q.stage == stage) result.push_back({q});
  }
  const Row row;
  std::size_t place = 0;
  Row::forEachColumn(row, [&](const std::string& column, auto value, Feature feature) {
    const auto isOf = [&](const Quantity<Row>& q) {
      return std::find(q.columns.begin(), q.columns.end(), column) != q.columns.end();
    };
    if (std::none_of(known.begin(), known.end(), isOf)) {
      const bool whole = std::is_integral_v<decltype(value)>;
      result.push_back({{stage, column, {column}, whole ? kExact : kRoundedLimit}});
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

// In ulps of the largest component, at least of `scale`. Written so that a NaN stays.
template <typename Values>
double distance(const Values& got, const Values& wanted, const std::vector<std::size_t>& columns,
                double scale) {
  double largest = 0, magnitude = scale;
  for (const std::size_t i : columns) {
    magnitude = std::max({magnitude, std::fabs(got[i]), std::fabs(wanted[i])});
    if (got[i] == wanted[i]) continue;
    if (!std::isfinite(got[i])) return std::numeric_limits<double>::infinity();
    const double difference = std::fabs(got[i] - wanted[i]);
    if (!(difference <= largest)) largest = difference;
  }
  return largest == 0 ? 0 : largest / ulpOf(magnitude);
}

// Where the step has found light: there is a shadow ray, or without shadows all is visible.
std::vector<std::size_t> litSlots(const Chunk& c) {
  if (c.tracesShadows()) return {c.shadows.slot, c.shadows.slot + c.shadowCount};
  std::vector<std::size_t> slots;
  for (std::size_t i = 0; i < c.n; ++i) {
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
               renderer.referenceFrame(camera, film), intersector_} {}

  void after(Stage stage, const Chunk& chunk) override {
    tracker_.follow(stage, chunk);
    if (!enough(stage)) compareStage(stage, chunk);
    if (stage != Stage::writeEmittedAndReflectiveAmbient && stage != Stage::addShading) return;
    before_.clear();
    for (std::size_t i = 0; i < chunk.n; ++i) before_.push_back(RadianceRow::at(chunk.radiance, i));
  }

  // updateImage, of what the film keeps.
  void compareImage(const Film& film) {
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

  std::vector<StageDifference> rows;

 private:
  // True if the rows of the stage have as many slots as they need.
  bool enough(Stage stage) const {
    return std::any_of(rows.begin(), rows.end(), [&](const StageDifference& row) {
      return row.stage == stage && row.slots > kSlotsPerStage;
    });
  }

  void note(Stage stage, const std::string& name, double ulp, double limit, std::uint32_t pixel,
            int depth) {
    auto row = std::find_if(rows.begin(), rows.end(), [&](const StageDifference& r) {
      return r.stage == stage && r.column == name;
    });
    if (row == rows.end()) row = rows.insert(row, {stage, name, 0, 0, limit, 0, 0, 0});
    ++row->slots;
    // Written so that a NaN counts as worse than anything.
    if (ulp <= row->worstUlp) return;
    row->worstUlp = std::isnan(ulp) ? std::numeric_limits<double>::infinity() : ulp;
    row->pixelX = pixelX(pixel);
    row->pixelY = pixelY(pixel);
    row->depth = depth;
  }

  // `slot` is that of the surfel that the row is about; some rows have no reference.
  template <typename Row>
  void compareRow(Stage stage, const Chunk& c, std::size_t slot, const Row& got,
                  const std::type_identity_t<std::optional<Row>>& twin) {
    static const auto compared = [] {
      std::array<std::vector<Compared<Row>>, kStageCount> all;
      for (std::size_t i = 0; i < kStageCount; ++i) all[i] = comparedAt<Row>(static_cast<Stage>(i));
      return all;
    }();
    if (!twin) return;
    const auto values = got.values(), wanted = twin->values();
    const Place<Row> place{world_, c, slot, *twin};
    for (const auto& [what, columns, feature] : compared[static_cast<std::size_t>(stage)]) {
      const double scale = what.scale ? what.scale(place) : 0;
      if (scale == kNotHere || !c.has(feature)) continue;
      note(stage, what.name, distance(values, wanted, columns, scale), what.limit,
           tracker_.pixel(c, slot), c.depth);
    }
  }

  // All rows of `columns`; `slots` are those of their surfels where they are not the same.
  template <typename Row, typename Twin>
  void compareRows(Stage stage, const Chunk& c, const typename Row::Columns& columns,
                   std::size_t count, Twin&& twin, const std::uint32_t* slots = nullptr) {
    for (std::size_t i = 0; i < count; ++i) {
      compareRow(stage, c, slots ? slots[i] : i, Row::at(columns, i), twin(world_, c, i));
    }
  }

  void compareStage(Stage stage, const Chunk& c) {
    switch (stage) {
      case Stage::generateRays:
        return compareRows<RayRow>(stage, c, c.rays, c.n, reference::generateRays);
      case Stage::findIntersections:
        return compareRows<SurfelRow>(stage, c, c.surfels, c.n, reference::findIntersections);
      case Stage::writeEmittedAndReflectiveAmbient:
        return compareRows<RadianceRow>(stage, c, c.radiance, c.n,
                                        reference::writeEmittedAndReflectiveAmbient);
      case Stage::findRadianceAndShadowRays:
        for (const std::size_t i : litSlots(c)) {
          compareRow(stage, c, i, UnshadowedRow::at(c.unshadowed, i),
                     reference::findRadiance(world_, c, i));
        }
        return compareRows<ShadowRow>(stage, c, c.shadows, c.shadowCount, reference::findShadowRay,
                                      c.shadows.slot);
      case Stage::checkShadows:
        for (std::size_t k = 0; k < c.shadowCount; ++k) {
          const std::uint32_t i = c.shadows.slot[k];
          compareRow(stage, c, i, UnshadowedRow::at(c.unshadowed, i),
                     reference::checkShadows(world_, c, k));
        }
        return;
      case Stage::addShading:
        return compareRows<RadianceRow>(stage, c, c.radiance, c.n,
                                        [&](const reference::World&, const Chunk&, std::size_t i) {
                                          return reference::addShading(before_[i], c, i);
                                        });
      case Stage::addImpulses:
        return compareRows<RayRow>(stage, c, c.children, c.childCount, reference::addImpulses,
                                   c.children.parent);
      case Stage::updateImage:
        return;  // compareImage
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
  renderer.observe(camera, scratch, observers);
  comparer.compareImage(scratch);
  return comparer.rows;
}

}  // namespace whit
