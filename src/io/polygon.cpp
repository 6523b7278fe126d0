#include "io/polygon.h"

#include <numeric>

#include "core/index.h"

namespace whit {
namespace {

using Triangles = std::vector<CornerTriple>;

struct Point {
  double x = 0, y = 0;
};

// Returns twice the signed area of the triangle.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool samePoint(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }

// Returns the normal of the polygon's plane; its length is twice the polygon's area.
Vec3d newellNormal(const std::vector<Vec3d>& corners) {
  Vec3d normal;
  const Vec3d origin = corners[0];  // far from the world's origin, differences keep their digits
  for (const auto i : indices(corners)) {
    normal += cross(corners[i] - origin, corners[(i + 1) % corners.size()] - origin);
  }
  return normal;
}

// Projects along the largest axis of the normal, in the order of axes that makes the polygon
// counter-clockwise.
std::vector<Point> project(const std::vector<Vec3d>& corners, const Vec3d& normal) {
  const int axis = largestAxis(abs(normal));
  int first = (axis + 1) % 3, second = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(first, second);

  std::vector<Point> points;
  points.reserve(corners.size());
  for (const Vec3d& c : corners) points.push_back({c[first], c[second]});
  return points;
}

void fan(std::uint32_t count, Triangles& triangles) {
  for (std::uint32_t i = 1; i + 1 < count; ++i) triangles.push_back({0, i, i + 1});
}

void quad(const std::vector<Vec3d>& p, Triangles& triangles) {
  const auto bothFaceAlike = [&](int a, int b, int c, int d) {  // diagonal a-c
    return dot(cross(p[b] - p[a], p[c] - p[a]), cross(p[c] - p[a], p[d] - p[a])) > 0;
  };
  const bool even = bothFaceAlike(0, 1, 2, 3), odd = bothFaceAlike(1, 2, 3, 0);
  const Vec3d d02 = p[2] - p[0], d13 = p[3] - p[1];

  // A diagonal outside of a concave quad makes triangles that face opposite sides. If both
  // diagonals are alike, the shorter one is taken.
  if (even == odd ? dot(d02, d02) <= dot(d13, d13) : even) {
    triangles.insert(triangles.end(), {{0, 1, 2}, {0, 2, 3}});
  } else {
    triangles.insert(triangles.end(), {{1, 2, 3}, {1, 3, 0}});
  }
}

bool isConvex(const std::vector<Point>& points) {
  const std::size_t n = points.size();
  for (const auto i : indices(n)) {
    if (turn(points[i], points[(i + 1) % n], points[(i + 2) % n]) < 0) return false;
  }
  return true;
}

class EarClipper {
 public:
  explicit EarClipper(const std::vector<Point>& points) : points_(points), left_(points.size()) {
    std::iota(left_.begin(), left_.end(), 0u);
  }

  // `area` is twice that of the polygon.
  bool clip(Triangles& triangles, double area) {
    while (left_.size() > 3) {
      std::size_t ear = findEar();
      if (ear == left_.size()) ear = findFlat();
      if (ear == left_.size()) return false;

      triangles.push_back({at(ear + left_.size() - 1), at(ear), at(ear + 1)});
      left_.erase(left_.begin() + ear);
      start_ = ear;  // goes round, so that a long polygon does not become a fan of slivers
    }

    triangles.push_back({left_[0], left_[1], left_[2]});

    // Ears are counter-clockwise. The last triangle is not if the outline crosses itself, or if it
    // is a sliver that the rounding of its corners has turned over, which is far thinner.
    constexpr double kSliver = 1e-3;
    return turn(points_[left_[0]], points_[left_[1]], points_[left_[2]]) > -kSliver * area;
  }

 private:
  std::uint32_t at(std::size_t i) const { return left_[i % left_.size()]; }

  std::size_t findEar() const {
    const std::size_t n = left_.size();
    for (const auto k : indices(n)) {
      const std::size_t i = (start_ + k) % n;
      if (isEar(i)) return i;
    }
    return n;
  }

  bool isEar(std::size_t i) const {
    const std::size_t n = left_.size();
    const Point &a = points_[at(i + n - 1)], &b = points_[at(i)], &c = points_[at(i + 1)];
    if (!(turn(a, b, c) > 0)) return false;

    // An ear contains no other corner of the polygon.
    for (std::size_t k = 2; k + 1 < n; ++k) {
      const Point& p = points_[at(i + k)];
      // Corners that coincide with the ear's own are the seam of a polygon with a hole.
      if (samePoint(p, a) || samePoint(p, b) || samePoint(p, c)) continue;
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  }

  // Finds a corner on the line between its neighbors: its triangle is degenerate, the rest is not.
  std::size_t findFlat() const {
    const std::size_t n = left_.size();
    for (const auto i : indices(n)) {
      if (turn(points_[at(i + n - 1)], points_[at(i)], points_[at(i + 1)]) == 0) return i;
    }
    return n;
  }

  const std::vector<Point>& points_;
  std::vector<std::uint32_t> left_;
  std::size_t start_ = 1;
};

}  // namespace

bool triangulate(const std::vector<Vec3d>& corners, Triangles& triangles) {
  const std::uint32_t count = size32(corners);
  if (count == 3) {
    triangles.push_back({0, 1, 2});
    return true;
  }
  if (count == 4) {
    quad(corners, triangles);
    return true;
  }

  const Vec3d normal = newellNormal(corners);
  const double area = maxComponent(abs(normal));  // twice that of the projection
  const std::size_t before = triangles.size();
  if (isFinite(normal) && area > 0) {
    const std::vector<Point> points = project(corners, normal);
    if (corners.size() <= kEarCornerLimit) {
      if (EarClipper(points).clip(triangles, area)) return true;
    } else if (isConvex(points)) {
      fan(count, triangles);
      return true;
    }
  }

  // A fan replaces the triangles that were added before clipping failed.
  triangles.resize(before);
  fan(count, triangles);
  return false;
}

}  // namespace whit
