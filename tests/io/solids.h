// Bodies that tests write into files of several formats.
#pragma once

#include "scene_files.h"

namespace whit {

struct Solid {
  std::vector<Vec3d> corners;
  std::vector<std::vector<int>> faces;  // counterclockwise as seen from outside
};

// Returns a regular prism about an axis, between -height and height, or a frustum if its radius at
// the upper end is not 1. Its ends are the first two faces.
inline Solid prism(int sides, int axis, double height = 1, double top = 1) {
  Solid made;
  made.faces.resize(2);
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * kPi * (i + 0.5) / sides;
    for (const double end : {-1.0, 1.0}) {
      const double radius = end < 0 ? 1 : top;
      Vec3d& corner = made.corners.emplace_back();
      corner[axis] = end * height;
      corner[(axis + 1) % 3] = radius * std::cos(angle);
      corner[(axis + 2) % 3] = radius * std::sin(angle);
    }

    const int a = 2 * i, b = 2 * ((i + 1) % sides);
    made.faces.push_back({a, b, b + 1, a + 1});
    made.faces[0].insert(made.faces[0].begin(), a);
    made.faces[1].push_back(a + 1);
  }
  return made;
}

inline Solid box(const Vec3d& low, const Vec3d& high) {
  Solid made{{},
             {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (int i = 0; i < 8; ++i) made.corners.push_back(BoxOf<Vec3d>{low, high}.corner(i));
  return made;
}

// Returns lines with the corners, each after `corner`, and then the faces: with their numbers of
// corners, or after `face`. Corners have numbers from `first`.
inline std::string linesOf(const Solid& solid, const std::string& corner = "",
                           const std::string& face = "", int first = 0) {
  std::string text;
  for (const Vec3d& c : solid.corners) {
    text += joined(corner, c.x, " ", c.y, " ", c.z, "\n");
  }
  for (const std::vector<int>& corners : solid.faces) {
    text += face.empty() ? joined(corners.size()) : face;
    for (const int i : corners) text += joined(" ", first + i);
    text += "\n";
  }
  return text;
}

inline std::string objOf(const Solid& solid, int first = 1) {
  return linesOf(solid, "v ", "f", first);
}

}  // namespace whit
