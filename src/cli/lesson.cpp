#include "cli/lesson.h"

#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "core/index.h"
#include "output/explained_rays.h"
#include "output/report_page.h"

namespace whit::cli {

namespace {

constexpr std::size_t kMostLights = 4;  // number of lights whose stages have their columns recorded

Json columnJson(const std::string& name, bool whole, const std::vector<float>& values) {
  const auto* bytes = reinterpret_cast<const char*>(values.data());
  return {
      {"name", name}, {"whole", whole}, {"values", base64({bytes, values.size() * sizeof(float)})}};
}

class StageRecorder : public StageObserver {
 public:
  StageRecorder(const Scene& scene, const Image& image, std::uint32_t pixel)
      : scene_(scene),
        image_(image),
        pixel_(pixel),
        depths_(Json::array()),
        steps_(Json::array()) {}

  void after(Stage stage, const Chunk& c) override {
    if (c.sampleNumber != 0) return;
    tracker_.follow(stage, c);

    // Each chunk of a depth passes this stage once, so its rays are counted here.
    if (stage == Stage::findIntersections) {
      const std::size_t depth = c.depth;
      while (depths_.size() <= depth) depths_.push_back(0);
      depths_[depth] = depths_[depth].get<std::size_t>() + c.n;
    }

    if (c.depth == 0 && holdsPixel(c)) recordStep(stage, c);
  }

  // Observers do not see updateImage, whose result is in the picture.
  Json recorded() {
    columns_ = Json::array();
    for (int channel = 0; channel < 3; ++channel) {
      std::vector<float> values(image_.pixels.size());
      std::ranges::transform(image_.pixels, values.begin(),
                             [&](const Rgb& pixel) { return pixel[channel]; });
      columns_.push_back(columnJson(std::string("film ") + "rgb"[channel], false, values));
    }

    endStep(Stage::updateImage);
    return {{"depths", std::move(depths_)}, {"steps", std::move(steps_)}};
  }

 private:
  // The tile is spread over several chunks where queues are small.
  bool holdsPixel(const Chunk& c) const {
    std::size_t slot = 0;
    while (slot < c.n && tracker_.pixel(c, slot) != pixel_) ++slot;
    return slot < c.n;
  }

  void recordStep(Stage stage, const Chunk& c) {
    // Stages of lights are recorded for the first sample of the first lights only.
    const bool ofLight = stage == Stage::findRadianceAndShadowRays ||
                         stage == Stage::checkShadows || stage == Stage::addShading;
    if (ofLight && c.lightSample > 0) return;
    if (ofLight && stage == Stage::findRadianceAndShadowRays) ++lights_;
    if (ofLight && lights_ > kMostLights) return;

    // Only the columns that the stage writes are recorded.
    columns_ = Json::array();
    switch (stage) {
      case Stage::generateRays:
        keepAll("", c, c.rays);
        break;
      case Stage::findIntersections:
        keepAll("", c, c.hits);
        keepAll("", c, c.surfels);
        break;
      case Stage::findRadianceAndShadowRays:
        keepAll("unshadowed ", c, c.unshadowed);
        keepRows("shadow ray ", c, c.shadows, {0, c.shadowCount}, c.shadows.slot);
        break;
      case Stage::checkShadows:
        keepAll("unshadowed ", c, c.unshadowed);
        break;
      case Stage::addImpulses:
        for (const auto i : indices(c.childSegmentCount)) {
          const Segment& kind = c.childSegments[i];
          keepRows(std::string(rowOf(kind.kind).name) + " ", c, c.children, {kind.begin, kind.end},
                   c.children.parent);
        }
        break;
      case Stage::writeEmittedAndReflectiveAmbient:
      case Stage::addShading:
        keepAll("radiance ", c, c.radiance);
        break;
      case Stage::updateImage:
        break;
    }

    endStep(stage);
    if (ofLight) steps_.back()["light"] = lightName(scene_, c.lightNumber);
  }

  void endStep(Stage stage) {
    steps_.push_back({{"stage", entryOf(kStageNames, stage)}, {"columns", std::move(columns_)}});
  }

  template <typename Columns>
  void keepAll(const std::string& set, const Chunk& c, const Columns& columns) {
    keepRows(set, c, columns, {0, c.n}, nullptr);
  }

  struct Rows {
    std::size_t begin, end;
  };
  // `slots` has the chunk's slot of each row, or is null if rows and slots are the same. Surfels of
  // rays that left the scene and radiance of lights behind the surface hold no values and are left
  // out.
  template <typename Columns>
  void keepRows(const std::string& set, const Chunk& c, const Columns& columns, Rows rows,
                const std::uint32_t* slots) {
    constexpr bool kOfHits =
        std::is_same_v<Columns, SurfelColumns> || std::is_same_v<Columns, HitColumns>;
    constexpr bool kOfLight = std::is_same_v<Columns, UnshadowedColumns>;

    // Unshadowed radiance has a value where the light is visible or a shadow ray was made.
    std::vector<bool> lit(c.n, !kOfLight);
    if constexpr (kOfLight) {
      for (const auto i : indices(c.n)) lit[i] = c.unshadowed.visible[i] > 0;
      for (const auto i : indices(c.shadowCount)) lit[c.shadows.slot[i]] = true;
    }

    Columns::forEachColumn(columns, [&](const char* name, const auto* column, Feature) {
      if (!column) return;

      // Pixels without a value stay NaN.
      std::vector<float> values(image_.pixels.size(), std::numeric_limits<float>::quiet_NaN());
      for (std::size_t row = rows.begin; row < rows.end; ++row) {
        const std::size_t slot = slots ? slots[row] : row;
        if ((kOfHits && c.surfels.material[slot] == kMiss) || !lit[slot]) continue;
        const std::uint32_t at = tracker_.pixel(c, slot);
        values[image_.index(pixelX(at), pixelY(at))] = static_cast<float>(column[row]);
      }

      using Value = std::remove_cvref_t<decltype(*column)>;
      columns_.push_back(columnJson(set + name, std::is_integral_v<Value>, values));
    });
  }

  const Scene& scene_;
  const Image& image_;
  const std::uint32_t pixel_;
  PixelTracker tracker_;
  Json depths_, steps_, columns_;
  std::size_t lights_ = 0;
};

}  // namespace

Json recordStages(Renderer& renderer, const Camera& camera, const Film& film, const Crop& tile,
                  int x, int y) {
  RenderOptions options = renderer.options();
  options.size = ImageSize{film.image.width, film.image.height};
  options.crop = tile;

  // The tile is rendered again while the recorder observes its stages.
  Film small = makeFilm(renderer.scene(), options);
  StageRecorder recorder(renderer.scene(), small.image, packedPixel(x, y));
  StageObserver* const observers[] = {&recorder};
  renderer.render({.camera = camera, .film = small, .observers = observers, .uniform = true});

  return recorder.recorded();
}

}  // namespace whit::cli
