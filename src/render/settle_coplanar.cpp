#include "render/settle_coplanar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "bake/facet.h"
#include "bake/sphere.h"
#include "reference/find_intersections.h"

namespace whit {

namespace {

struct Line {
  Vec3d origin, direction;
};

struct LineHit {
  double t = 0, u = 0, v = 0;
};

// A triangle that the ray hits, and what it is to the rule.
struct Face {
  PlacedTriangleId id;
  LineHit hit;
  double nearest = 0, farthest = 0;  // bounds of the distance t, which was computed from floats
  std::uint32_t rank = 0, medium = 0;
  bool opaque = true, entering = false;
};

// Intersects as Woop, Benthin and Wald 2013, "Watertight ray/triangle intersection", in double. A
// hit on the border counts. Returns false for a miss.
bool intersect(const Line& ray, const Corners& corners, LineHit& hit) {
  const Vec3d size = abs(ray.direction);
  const int z = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int x = (z + 1) % 3, y = (z + 2) % 3;
  const double speed = ray.direction[z], slopeX = ray.direction[x] / speed,
               slopeY = ray.direction[y] / speed;
  std::array<Vec3d, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d from = corners[i] - ray.origin;
    p[i] = {from[x] - slopeX * from[z], from[y] - slopeY * from[z], from[z] / speed};
  }
  const auto side = [](const Vec3d& a, const Vec3d& b) { return a.x * b.y - a.y * b.x; };
  const double w0 = side(p[1], p[2]), w1 = side(p[2], p[0]), w2 = side(p[0], p[1]);
  if (std::min({w0, w1, w2}) < 0 && std::max({w0, w1, w2}) > 0) return false;
  const double sum = w0 + w1 + w2;
  hit = {(w0 * p[0].z + w1 * p[1].z + w2 * p[2].z) / sum, w1 / sum, w2 / sum};
  return std::isfinite(hit.t) && std::isfinite(hit.u) && std::isfinite(hit.v) && hit.t > 0;
}

// The corners that two triangles share, if the hit on `a` lies between them; 0 if it does not.
int sharedCorners(const Corners& a, const LineHit& hit, const Corners& b) {
  constexpr double kRounding = 1e-9;
  const std::array<double, 3> weights{1 - hit.u - hit.v, hit.u, hit.v};
  int shared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::find(b.begin(), b.end(), a[i]) != b.end()) {
      ++shared;
    } else if (weights[i] > kRounding) {
      return 0;
    }
  }
  return shared;
}

class FacesOfRay {
 public:
  FacesOfRay(const Chunk& c, std::size_t i)
      : scene_(*c.frame->scene),
        effects_(c.frame->effects),
        ray_{Vec3d{c.rays.orgX[i], c.rays.orgY[i], c.rays.orgZ[i]},
             Vec3d{c.rays.dirX[i], c.rays.dirY[i], c.rays.dirZ[i]}} {}

  // Fills in the faces at the place of a hit, in the order of the scene.
  void find(PlacedTriangleId found, double u, double v) {
    scene_.coplanar.forEachPartnerAt(
        found, u, v, [&](PlacedTriangleId id, std::uint32_t rank) { add(id, rank, false); });
    if (faces_.empty()) return;
    add(found, scene_.coplanar.rankOf(found), true);
    dropFarther();
    std::sort(faces_.begin(), faces_.end(),
              [](const Face& a, const Face& b) { return a.rank < b.rank; });
    dropNeighbors();
  }
  bool empty() const { return faces_.empty(); }

  const Face& chosen() const {
    const auto preference = [&](const Face& face) {
      return std::tuple(face.opaque, face.medium == 0, scene_.media[face.medium].priority,
                        face.rank);
    };
    return *std::max_element(faces_.begin(), faces_.end(), [&](const Face& a, const Face& b) {
      return preference(a) < preference(b);
    });
  }

  // HitColumns::alsoCrossed.
  std::uint32_t crossedWith(const Face& chosen) const {
    std::uint32_t others = 0;
    for (const Face& face : faces_) {
      if (&face == &chosen || chosen.opaque || face.medium == 0 || others >> 20 != 0) continue;
      others = others << 10 | face.medium << 1 | (face.entering ? 1 : 0);
    }
    return faces_.size() > 1 ? others | kSharesPlace : others;
  }

 private:
  // `isFound`: Embree has reported this triangle, so it counts from either side, although rounding
  // may have it that an edge-on triangle is seen from behind.
  void add(PlacedTriangleId id, std::uint32_t rank, bool isFound) {
    const bool instanced = id.instance != kNoInstance;
    if (instanced && !effects_.has(Effect::instances)) return;
    Face face{id, {}, 0, 0, rank, 0, true, false};
    const Corners corners = worldCorners(scene_, id.triangle, id.instance);
    if (!intersect(ray_, corners, face.hit)) return;
    const reference::TriangleHit hit{face.hit.t, face.hit.u, face.hit.v};
    if (effects_.has(Effect::alphaMasks) && reference::cutAway(scene_, id.triangle, hit)) return;
    const auto& [a, b, c] = worldCorners(scene_, id.triangle, kNoInstance);
    Vec3d outward = cross(b - a, c - a);
    if (instanced) outward = scene_.instances[id.instance].toWorld.normal(outward);
    const double facing = dot(ray_.direction, outward);
    const std::uint32_t number = scene_.triangles[id.triangle].material;
    const Material& material = scene_.materials[number];
    if (!isFound && !material.doubleSided && facing > 0) return;
    face.entering = facing < 0;
    if (effects_.has(Effect::transmission)) {
      face.medium = scene_.mediumOfMaterial[number];
      face.opaque = !material.passesLight();
    }
    const double error = distanceError(corners);
    face.nearest = face.hit.t - error;
    face.farthest = face.hit.t + error;
    faces_.push_back(face);
  }

  // The distance of a hit is off by the rounding of the corners along the normal, as seen from the
  // ray's start.
  double distanceError(const Corners& corners) const {
    Vec3d far;
    for (const Vec3d& corner : corners) far = max(far, abs(corner - ray_.origin));
    const Vec3d n = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
    return kErrorOfMagnitude * dot(abs(n), far) / std::abs(dot(n, ray_.direction));
  }

  // Keeps the nearest face and the ones that floats cannot tell from it.
  void dropFarther() {
    const auto nearest =
        std::min_element(faces_.begin(), faces_.end(),
                         [](const Face& a, const Face& b) { return a.hit.t < b.hit.t; });
    if (nearest == faces_.end()) return;
    std::erase_if(faces_,
                  [most = nearest->farthest](const Face& face) { return face.nearest > most; });
  }

  // Two triangles of one surface that share the edge or corner that is hit are one face.
  bool areNeighbors(const Face& a, const Face& b) const {
    if (a.medium != b.medium || a.entering != b.entering || a.id.instance != b.id.instance) {
      return false;
    }
    const Corners own = worldCorners(scene_, a.id.triangle, kNoInstance),
                  other = worldCorners(scene_, b.id.triangle, kNoInstance);
    const int shared = sharedCorners(own, a.hit, other);
    return (shared == 1 || shared == 2) && sharedCorners(other, b.hit, own) == shared;
  }
  void dropNeighbors() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const auto end = faces_.begin() + static_cast<std::ptrdiff_t>(kept);
      if (std::any_of(faces_.begin(), end,
                      [&](const Face& before) { return areNeighbors(before, faces_[i]); })) {
        continue;
      }
      faces_[kept++] = faces_[i];
    }
    faces_.resize(kept);
  }

  const Scene& scene_;
  EffectSet effects_;
  Line ray_;
  std::vector<Face> faces_;
};

}  // namespace

void settleCoplanar(Chunk& c) {
  const CoplanarTriangles& coplanar = c.frame->scene->coplanar;
  std::fill_n(c.hits.alsoCrossed, c.n, 0u);
  const bool instanced = c.has(Feature::instances);
  for (std::size_t i = 0; i < c.n; ++i) {
    if (!coplanar.any(c.hits.triangle[i])) continue;
    const PlacedTriangleId found{c.hits.triangle[i], instanced ? c.hits.instance[i] : kNoInstance};
    const double u{c.hits.u[i]}, v{c.hits.v[i]};
    if (!coplanar.anyAt(found, u, v)) continue;
    FacesOfRay faces(c, i);
    faces.find(found, u, v);
    if (faces.empty()) continue;
    const Face& chosen = faces.chosen();
    c.hits.triangle[i] = chosen.id.triangle;
    if (instanced) c.hits.instance[i] = chosen.id.instance;
    c.hits.t[i] = static_cast<float>(chosen.hit.t);
    c.hits.u[i] = static_cast<float>(chosen.hit.u);
    c.hits.v[i] = static_cast<float>(chosen.hit.v);
    c.hits.alsoCrossed[i] = faces.crossedWith(chosen);
  }
}

void settleSpheres(Chunk& c) {
  const Scene& scene = *c.frame->scene;
  const bool instanced = c.has(Feature::instances);
  const bool masked = c.frame->effects.has(Effect::alphaMasks);
  for (std::size_t i = 0; i < c.n; ++i) {
    const PlacedTriangleId found{c.hits.triangle[i], instanced ? c.hits.instance[i] : kNoInstance};
    const auto place = scene.coincidentSpheres.find(orderOf(found));
    if (place == scene.coincidentSpheres.end()) continue;
    const Vec3d unit = spherePoint(double{c.hits.u[i]}, double{c.hits.v[i]});
    const Vec3d point = sphereInWorld(scene, found).point(unit);
    PlacedTriangleId chosen = found;
    std::tuple<bool, bool, int> most(false, false, std::numeric_limits<int>::min());
    for (const PlacedTriangleId& id : *place->second) {
      if (id.instance != kNoInstance && !instanced) continue;
      const auto [u, v] = sphereWeights(onUnitSphere(sphereInWorld(scene, id), point));
      if (masked && id != found && reference::cutAway(scene, id.triangle, {0, u, v})) continue;
      const std::uint32_t material = scene.triangles[id.triangle].material;
      const std::uint8_t medium = scene.mediumOfMaterial[material];
      const std::tuple own(!scene.materials[material].passesLight(), medium == 0,
                           scene.media[medium].priority);
      if (own >= most) most = own, chosen = id;
    }
    if (chosen == found) continue;
    const auto [u, v] = sphereWeights(onUnitSphere(sphereInWorld(scene, chosen), point));
    c.hits.triangle[i] = chosen.triangle;
    if (instanced) c.hits.instance[i] = chosen.instance;
    c.hits.u[i] = static_cast<float>(u);
    c.hits.v[i] = static_cast<float>(v);
  }
}

}  // namespace whit
