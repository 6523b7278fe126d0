// A tree of rays as lines in space, and how a camera sees them.
#pragma once

#include <array>
#include <compare>
#include <optional>
#include <vector>

#include "inspect/ray_tree.h"

namespace whit {

// The meaning of a line: its kind of ray, and for rays that only test visibility, blocked or not.
struct RayLook {
  RayKind kind = RayKind::primary;
  bool blocked = false;

  auto operator<=>(const RayLook&) const = default;
};
constexpr const RayStyle& styleOf(RayLook look) {
  return look.blocked ? rowOf(look.kind).blocked : rowOf(look.kind).style;
}
constexpr bool isDashed(RayLook look) { return rowOf(look.kind).testsOcclusion(); }

struct RayLine {
  Vec3d from, to;
  RayLook look;
  std::size_t node = 0;  // node of the tree; of a shadow ray, the node that sent it
  double width = 0;      // pixels; thinner for what weighs less at the eye
};

// The looks that some of the lines have, in the order of a legend: rays that go on before those
// that only ask.
std::vector<RayLook> looksOf(const std::vector<RayLine>& lines);

// Rays that leave the scene end after a fifth of the tree's extent. What weighs most comes last.
// `camera` is the camera that sent the rays.
std::vector<RayLine> linesOf(const RayTree& tree, const Camera& camera);

// Returns a camera that sees the hits of the rays, if possible from aside and above. It is the one
// of a number of places around the hits that sees most of them, by their weight, and far apart.
Camera cameraAside(const RayTree& tree, const Camera& camera, const Accel& accel);

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
  CameraFrame frame_;
  double near_;
};

// Cuts the line to the window, because huge coordinates are drawn wrongly. Returns whether any of
// it is left.
bool clip(ScreenLine& line, double width, double height);

}  // namespace whit
