// The tree of a pixel's rays as lines in space, and what a camera sees of them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "render/ray_tree.h"

namespace whit {

// What a line stands for: a ray of that kind, a shadow ray that reaches its light or does not, or a
// ray that finds ambient light open or occluded.
enum class RayLook { primary, reflection, refraction, indirect, lit, blocked, open, occluded };
inline constexpr std::size_t kRayLookCount = 8;
inline constexpr std::array<std::string_view, kRayLookCount> kRayLookNames{
    "primary", "reflection", "refraction", "indirect", "lit", "in shadow", "open", "occluded"};
inline constexpr std::array<std::array<std::uint8_t, 3>, kRayLookCount> kRayColors{{{255, 255, 255},
                                                                                    {255, 64, 64},
                                                                                    {64, 160, 255},
                                                                                    {64, 224, 96},
                                                                                    {255, 224, 64},
                                                                                    {0, 0, 0},
                                                                                    {240, 128, 255},
                                                                                    {112, 0, 144}}};
RayLook lookOf(RayKind kind);
// Of rays that only ask whether something is in between; they are drawn dashed.
constexpr bool isShadowLook(RayLook look) { return look >= RayLook::lit; }

struct RayLine {
  Vec3d from, to;
  RayLook look = RayLook::primary;
  std::size_t node = 0;  // of the tree; of a shadow ray that which sent it
  double width = 0;      // pixels; thinner for what weighs less at the eye
};

// Rays that leave the scene end after a fifth of the tree's extent. What weighs most comes last.
std::vector<RayLine> linesOf(const RayTree& tree);

// Where the rays are seen from unless the user says so: from aside and above, with all that they
// met in view.
Camera cameraAside(const RayTree& tree, const Camera& camera);

// Pixels from the top left.
struct ScreenLine {
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0;
};

class LineView {
 public:
  LineView(const Camera& camera, int width, int height);

  // The part before the camera, which may reach beyond the picture; nothing if all of it lies
  // behind.
  std::optional<ScreenLine> see(Vec3d from, Vec3d to) const;

 private:
  std::array<double, 2> project(const Vec3d& point) const;

  CameraFrame frame_;
  double near_;
};

}  // namespace whit
