// Triangles in the world, and what a ray meets of them: every triangle is tried.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "oracle/scene.h"

namespace oracle {

struct Corner {
  Vec position, normal;
  Color color;
  std::array<double, 2> uv{};
};

struct Triangle {
  std::array<Corner, 3> corners;
  Vec outward;  // unit, of its plane
  bool smooth = false;
  int material = 0;
};

struct Ray {
  Vec origin, direction;
};

struct Hit {
  double t = 0;  // in lengths of the direction
  const Triangle* triangle = nullptr;
  std::array<double, 3> weights{};  // of the corners
};

class Geometry {
 public:
  explicit Geometry(const Scene& scene);

  std::optional<Hit> nearest(const Ray& ray) const;
  // Whether something that casts shadows lies at 0 < t < end.
  bool blocked(const Ray& ray, double end) const;
  // All hits at 0 < t, nearest first.
  std::vector<Hit> all(const Ray& ray) const;

 private:
  struct Part {
    std::vector<Triangle> triangles;
    Vec center;
    double radius = 0;
    bool castsShadow = true;
  };

  template <typename Visit>
  void visit(const Ray& ray, const Visit& visit) const;

  std::vector<Part> parts_;
};

}  // namespace oracle
