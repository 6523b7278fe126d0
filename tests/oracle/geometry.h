// What a ray meets of the scene: every triangle and every sphere is tried.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "oracle/faces.h"
#include "oracle/mip_chain.h"
#include "oracle/scene.h"

namespace oracle {

// What a ray meets: of the faces that lie in one place the opaque one, else the sheet, of several
// the last in the file; of dielectrics alone the one of the highest priority, of these the last.
// Spheres in one place, of which no other is crossed, no scene of the oracle has.
struct Meeting {
  Hit hit;
  std::vector<Hit> alsoCrossed;  // the other dielectrics, where it is not opaque
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
    std::vector<Sphere> spheres;
    Vec center;  // of a ball around all of it
    double radius = 0;
    bool castsShadow = true;
  };

  template <typename Visit>
  void visit(const Ray& ray, const Visit& visit) const;

  // What a list of the file holds, moved by the last of the transforms first.
  void addList(const Scene& scene, std::span<const Body> bodies,
               std::vector<Transform>& transforms);
  void addShape(const Scene& scene, const Object& object, std::span<const Transform> transforms);
  Part meshPart(const Scene& scene, const Object& object, std::span<const Transform> transforms);
  Part spherePart(const Scene& scene, const Object& object, std::span<const Transform> transforms);
  Color texel(int map, const Hit& hit) const;
  bool counts(const Ray& ray, const Hit& hit) const;
  bool isCutAway(const Hit& hit) const;
  bool castsShadow(const Hit& hit) const;

  std::vector<Part> parts_;
  int faces_ = 0;
  const std::vector<MipChain>& textures_;
};

}  // namespace oracle
