// What a ray meets of the scene: every triangle and every sphere is tried.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "oracle/faces.h"
#include "oracle/mip_chain.h"
#include "oracle/placement.h"
#include "oracle/scene.h"

namespace oracle {

// What a ray meets: of the faces that lie in one place the opaque one, else the sheet, of several
// the last in the file; of dielectrics alone the one of the highest priority, of these the last.
// Spheres in one place, of which no other is crossed, no scene of the oracle has.
struct Meeting {
  Hit hit;
  std::vector<Hit> alsoCrossed;  // the other dielectrics, where it is not opaque
};

// A ray does not meet what it starts on: its start is exact to some 1e-15 of the coordinates, and
// no scene has gaps as narrow as this.
inline constexpr double kSelf = 1e-9;

// Faces that are no farther behind another one than this, in parts of 1 and the way, lie in one
// place: in scenes that have such, their corners are whole numbers of some power of two.
inline constexpr double kSamePlace = 1e-9;

inline bool comesFirst(const Face& a, const Face& b) {
  const auto rank = [](const Face& face) {
    const int priority = !face.isOpaque() && !face.isSheet() ? face.material->priority : 0;
    return std::tuple(face.isOpaque(), face.isSheet(), priority, face.order);
  };
  return rank(a) > rank(b);
}

inline bool passes(const Ray& ray, const Vec& center, double radius) {
  const Vec from = center - ray.origin;
  const double along = dot(from, ray.direction);
  return dot(from, from) - along * along / dot(ray.direction, ray.direction) <= radius * radius;
}

class Geometry {
 public:
  // The textures, of masks, outlive it.
  Geometry(const Scene& scene, const std::vector<MipChain>& textures) : textures_(textures) {
    std::vector<Transform> transforms;
    addList(scene, scene.bodies, transforms);
  }

  std::optional<Meeting> nearest(const Ray& ray) const {
    std::vector<Hit> hits;  // in the nearest place
    double end = INFINITY;
    visit(ray, [&](const Hit& hit) {
      const double same = kSamePlace * (1 + hit.t);
      if (hit.t > end + same) return true;
      if (hit.t < end - same) {
        hits.clear();
        end = hit.t;
      }
      hits.push_back(hit);
      return true;
    });

    if (hits.empty()) return std::nullopt;
    Meeting meeting{hits[0], {}};
    for (const Hit& hit : hits) {
      if (comesFirst(*hit.face, *meeting.hit.face)) meeting.hit = hit;
    }

    if (meeting.hit.face->isOpaque()) return meeting;
    for (const Hit& hit : hits) {
      if (hit.face == meeting.hit.face || hit.face->isSheet()) continue;
      meeting.alsoCrossed.push_back(hit);
    }
    return meeting;
  }

  // Whether something that casts shadows lies at 0 < t < end.

  bool blocked(const Ray& ray, double end) const {
    bool found = false;
    visit(ray, [&](const Hit& hit) {
      found = hit.t < end && castsShadow(hit);
      return !found;
    });
    return found;
  }

  // All hits at 0 < t, nearest first.

  std::vector<Hit> all(const Ray& ray) const {
    std::vector<Hit> hits;
    visit(ray, [&](const Hit& hit) {
      hits.push_back(hit);
      return true;
    });
    std::ranges::sort(hits, {}, &Hit::t);
    return hits;
  }

 private:
  struct Part {
    std::vector<Triangle> triangles;
    std::vector<Sphere> spheres;
    Vec center;  // of a ball around all of it
    double radius = 0;
  };

  // What a list of the file holds, moved by the last of the transforms first.

  void addList(const Scene& scene, std::span<const Body> bodies,
               std::vector<Transform>& transforms) {
    for (const Body& body : bodies) {
      const Object& object = scene.objects[body.object];
      const std::size_t outer = transforms.size();
      if (!body.motion.keys.empty()) transforms.push_back(placeAt(body.motion, scene.time));
      transforms.push_back(body.transform);
      addList(scene, object.before, transforms);
      addShape(scene, object, transforms);
      addList(scene, object.after, transforms);
      transforms.resize(outer);
    }
  }

  void addShape(const Scene& scene, const Object& object, std::span<const Transform> transforms) {
    Part part = object.radius > 0 ? spherePart(scene, object, transforms)
                                  : meshPart(scene, object, transforms);
    part.radius *= 1 + kSelf;
    parts_.push_back(std::move(part));
  }

  Part meshPart(const Scene& scene, const Object& object, std::span<const Transform> transforms) {
    const Mesh& mesh = scene.meshes[object.mesh];
    Part part;
    for (const auto& indices : mesh.triangles) {
      part.triangles.push_back(placedTriangle(mesh, indices, transforms));
      addFace(part.triangles.back(), scene, object);
    }

    // A sphere about the corners, which most rays miss.
    for (const Vec& p : mesh.positions) part.center += placed(p, transforms);
    part.center = part.center / double(mesh.positions.size());
    for (const Vec& p : mesh.positions) {
      part.radius = std::max(part.radius, length(placed(p, transforms) - part.center));
    }
    return part;
  }

  Part spherePart(const Scene& scene, const Object& object, std::span<const Transform> transforms) {
    const Sphere sphere = placedSphere(object.radius, transforms);
    const auto& [x, y, z] = sphere.axes;
    Part part;
    part.center = sphere.center;
    part.radius = std::sqrt(dot(x, x) + dot(y, y) + dot(z, z));  // no point is farther away
    part.spheres.push_back(sphere);
    addFace(part.spheres.back(), scene, object);
    return part;
  }

  void addFace(Face& face, const Scene& scene, const Object& object) {
    face.material = &scene.materials[object.material];
    face.order = faces_++;
  }

  Color texel(int map, const Hit& hit) const {
    const auto& [u, v] = hit.uv;
    return textures_[map].at(u, v, Filter::bilinear, 1);
  }

  bool isCutAway(const Hit& hit) const {
    const Material& m = *hit.face->material;
    if (m.alphaMap != kNone) return texel(m.alphaMap, hit).x < m.alphaCutoff;
    return m.coverageMap != kNone && texel(m.coverageMap, hit).x < kClear;
  }

  // All or nothing, where a map says how much is there.
  bool castsShadow(const Hit& hit) const {
    const Material& m = *hit.face->material;
    if (!m.castsShadow) return false;
    return m.coverageMap == kNone || m.coverage * texel(m.coverageMap, hit).x >= 0.5;
  }

  bool counts(const Ray& ray, const Hit& hit) const {
    if (!(hit.t * length(ray.direction) > kSelf * (1 + length(ray.origin)))) return false;
    return !isCutAway(hit);
  }

  // visit(hit) for every hit in front, until it answers false.
  template <typename Visit>
  void visit(const Ray& ray, const Visit& visit) const {
    for (const Part& part : parts_) {
      if (!passes(ray, part.center, part.radius)) continue;
      for (const Triangle& triangle : part.triangles) {
        const std::optional<Hit> hit = meet(ray, triangle);
        if (hit && counts(ray, *hit) && !visit(*hit)) return;
      }
      for (const Sphere& sphere : part.spheres) {
        for (const Hit& hit : meet(ray, sphere)) {
          if (counts(ray, hit) && !visit(hit)) return;
        }
      }
    }
  }

  std::vector<Part> parts_;
  int faces_ = 0;
  const std::vector<MipChain>& textures_;
};

}  // namespace oracle
