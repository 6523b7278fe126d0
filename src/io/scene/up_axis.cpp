#include "io/scene/up_axis.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/index.h"

namespace whit {
namespace {

// Areas of a model's triangles that face an axis. Those at an end of the box are shares of the
// box's side there.
struct FlatParts {
  double lower = 0, upper = 0, between = 0;
};

template <typename Use>
void forEachMesh(const Body& content, const Use& use) {
  for (const Placement& placed : content.placements) {
    if (placed.isMesh()) use(*placed.mesh);
  }
}

std::array<FlatParts, 3> flatPartsOf(const Body& content, const Box& box) {
  constexpr double kFlat = 0.98, kNear = 0.01;
  const Vec3f size = box.upper - box.lower;
  const double near = kNear * maxComponent(size);
  std::array<FlatParts, 3> all;

  forEachMesh(content, [&](const Mesh& mesh) {
    for (const auto& t : mesh.triangles) {
      if (std::ranges::max(t) >= mesh.positions.size()) continue;
      const std::array p{Vec3d(mesh.positions[t[0]]), Vec3d(mesh.positions[t[1]]),
                         Vec3d(mesh.positions[t[2]])};
      const Vec3d twice = cross(p[1] - p[0], p[2] - p[0]);
      const double area = length(twice) / 2;

      // A triangle faces an axis if nearly all of its area is left when it is projected along the
      // axis.
      for (int axis = 0; axis < 3; ++axis) {
        if (!(std::abs(twice[axis]) / 2 > kFlat * area)) continue;
        const auto liesAt = [&](float end) {
          return std::ranges::all_of(
              p, [&](const Vec3d& q) { return std::abs(q[axis] - end) <= near; });
        };

        const double side = double{size[(axis + 1) % 3]} * size[(axis + 2) % 3];
        FlatParts& flat = all[axis];
        if (liesAt(box.lower[axis])) {
          flat.lower += area / side;
        } else if (liesAt(box.upper[axis])) {
          flat.upper += area / side;
        } else {
          flat.between += area;
        }
      }
    }
  });

  return all;
}

bool standsOnPlane(const Box& box) {
  constexpr float kOnPlane = 0.02f, kAstride = 0.25f, kLeastHeight = 0.5f;
  const Vec3f size = box.upper - box.lower;
  if (size.y == 0) return false;  // it may as well lie on the ground

  return std::abs(box.lower.z) <= kOnPlane * size.z &&
         size.z >= kLeastHeight * std::max(size.x, size.y) &&
         std::min(-box.lower.y, box.upper.y) >= kAstride * size.y;
}

bool hasBase(const Box& box, const std::array<FlatParts, 3>& flat) {
  constexpr float kLongest = 1.05f;
  constexpr double kLeastBase = 0.1, kElsewhere = 0.25;
  const Vec3f size = box.upper - box.lower;
  const double base = flat[2].lower;

  return size.z > kLongest * std::max(size.x, size.y) && base >= kLeastBase &&
         std::max({flat[2].upper, flat[1].lower, flat[1].upper}) <= kElsewhere * base;
}

}  // namespace

bool seemsZUp(const Body& content) {
  constexpr double kBoards = 1.5;
  Box box;
  forEachMesh(content, [&](const Mesh& mesh) {
    for (const Vec3f& p : mesh.positions) box.add(p);
  });
  if (box.empty()) return false;

  const std::array<FlatParts, 3> flat = flatPartsOf(content, box);
  // Where a reader has subtracted the origin of a far model, the placement gives it back.
  const Vec3f origin(content.placements.front().toParent.p);
  const Box inFile{box.lower + origin, box.upper + origin};
  const double others = std::max(flat[0].between, flat[2].between);
  const bool hasBoards = flat[1].between > kBoards * others;
  return !hasBoards && (standsOnPlane(inFile) || hasBase(box, flat));
}

}  // namespace whit
