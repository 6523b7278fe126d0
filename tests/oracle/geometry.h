// Triangles in the world, and what a ray meets of them: every triangle is tried.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "oracle/mip_chain.h"
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
  bool opaque = true, sheet = false;  // neither: a dielectric
  int priority = 0;                   // of a dielectric
  int order = 0;                      // in the file
  int alphaMap = kNone, coverageMap = kNone;
  double alphaCutoff = 0.5, coverage = 1;
};

struct Ray {
  Vec origin, direction;
};

struct Hit {
  double t = 0;  // in lengths of the direction
  const Triangle* triangle = nullptr;
  std::array<double, 3> weights{};  // of the corners
};

// What a ray meets: of the triangles that lie in one place the opaque one, else the sheet, of
// several the last in the file; of dielectrics alone the one of the highest priority, of these the
// last.
struct Meeting {
  Hit hit;
  std::vector<const Triangle*> alsoCrossed;  // the other dielectrics, where it is not opaque
};

class Geometry {
 public:
  // The textures, of masks, outlive it.
  Geometry(const Scene& scene, const std::vector<MipChain>& textures);

  std::optional<Meeting> nearest(const Ray& ray) const;
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

  // What a list of the file holds, moved by the last of the transforms first.
  void addList(const Scene& scene, std::span<const Body> bodies,
               std::vector<Transform>& transforms);
  void addShape(const Scene& scene, const Object& object, std::span<const Transform> transforms);
  Color texel(int map, const Hit& hit) const;
  bool isCutAway(const Hit& hit) const;
  bool castsShadow(const Hit& hit) const;

  std::vector<Part> parts_;
  int triangles_ = 0;
  const std::vector<MipChain>& textures_;
};

}  // namespace oracle
