// What each stage of whit compare --stages is held against, and how the rows come about. Internal
// to the comparison.
#pragma once

#include <optional>
#include <vector>

#include "reference/impulses.h"
#include "reference/surfel.h"
#include "render/pixel_tracker.h"
#include "render/renderer_parts.h"

namespace whit {

class StageComparer : public StageObserver {
 public:
  StageComparer(const Scene& scene, const Plan& plan, const FrameJob& job);

  void after(Stage stage, const ChunkView& chunk) override;
  void compareImage(const Film& film);

  std::vector<StageDifference> rows;

 private:
  // Whether the stage's rows have as many slots as they need.
  bool enough(Stage stage) const;
  void note(Stage stage, const char* column, double ulp, double limit, std::uint32_t pixel,
            int depth);
  // `scale`: the magnitude whose ulp counts, at least the larger of the two vectors' components.
  void compare(Stage stage, const char* column, const Vec3d& got, const Vec3d& wanted, double scale,
               double limit, const ChunkView& chunk, std::size_t slot);

  void compareRays(const ChunkView& c);
  void compareSurfels(const ChunkView& c);
  void compareSurfel(const ChunkView& c, std::size_t i);
  void compareAmbient(const ChunkView& c);
  void compareLight(const ChunkView& c);
  void compareVisibility(const ChunkView& c);
  void compareSums(const ChunkView& c);
  void compareChildren(const ChunkView& c);

  double sliverFactor(const reference::Candidate& candidate) const;
  double grazingScale(const ChunkView& c, std::size_t i, const RgbD& radiance) const;
  void keepRadiance(const ChunkView& c);
  reference::Impulse childTwin(const ChunkView& c, std::size_t child) const;
  reference::Impulse sampledTwin(const ChunkView& c, std::size_t child,
                                 const reference::Surfel& surfel, std::uint32_t stack) const;
  reference::Surfel surfelOf(const ChunkView& c, std::size_t i) const;

  const Scene& scene_;
  const Plan& plan_;
  const ShadingChoices& shading_;
  const FrameJob& job_;
  std::optional<MipMaps> maps_;  // where lookups are trilinear
  PixelTracker tracker_;
  std::vector<RgbD> before_;  // radiance of the chunk before the light that is being added
};

}  // namespace whit
