#include "oracle/geometry.h"

#include <algorithm>
#include <numbers>

namespace oracle {

namespace {

// A ray does not meet what it starts on: its start is exact to some 1e-15 of the coordinates, and
// no scene has gaps as narrow as this.
constexpr double kSelf = 1e-9;

// Triangles that are no farther behind another one than this, in parts of 1 and the way, lie in one
// place: in scenes that have such, their corners are whole numbers of some power of two.
constexpr double kSamePlace = 1e-9;

// Where so little is there rays pass, as through a hole.
constexpr double kClear = 1.0 / 1024;

Vec turned(const Vec& v, const Transform& transform) {
  const Vec k = normalized(transform.axis);
  const double angle = transform.degrees * std::numbers::pi / 180;
  const double c = std::cos(angle), s = std::sin(angle);
  return v * c + cross(k, v) * s + k * (dot(k, v) * (1 - c));  // Rodrigues
}

// By the last of the transforms first.
Vec placed(Vec point, std::span<const Transform> transforms) {
  for (std::size_t i = transforms.size(); i-- > 0;) {
    point = turned(point * transforms[i].scale, transforms[i]) + transforms[i].translate;
  }
  return point;
}

// Normals go with the inverse transpose, which keeps them outside of what is mirrored.
Vec placedNormal(Vec n, std::span<const Transform> transforms) {
  for (std::size_t i = transforms.size(); i-- > 0;) {
    const Vec& s = transforms[i].scale;
    n = normalized(turned({n.x / s.x, n.y / s.y, n.z / s.z}, transforms[i]));
  }
  return n;
}

bool areMirroring(std::span<const Transform> transforms) {
  bool mirroring = false;
  for (const auto& [scale, axis, degrees, translate] : transforms) {
    mirroring = mirroring != (scale.x * scale.y * scale.z < 0);
  }
  return mirroring;
}

Triangle placedTriangle(const Mesh& mesh, const std::array<int, 3>& indices, int material,
                        std::span<const Transform> transforms) {
  Triangle triangle;
  triangle.material = material;
  triangle.smooth = !mesh.normals.empty();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto index = static_cast<std::size_t>(indices[i]);
    Corner& corner = triangle.corners[i];
    corner.position = placed(mesh.positions[index], transforms);
    if (triangle.smooth) corner.normal = placedNormal(mesh.normals[index], transforms);
    corner.color = mesh.colors.empty() ? gray(1) : mesh.colors[index];
    if (!mesh.uvs.empty()) corner.uv = mesh.uvs[index];
  }
  const auto& [a, b, c] = triangle.corners;
  const double mirrored = areMirroring(transforms) ? -1 : 1;
  triangle.outward = normalized(cross(b.position - a.position, c.position - a.position)) * mirrored;
  return triangle;
}

// Moeller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection".
std::optional<Hit> meet(const Ray& ray, const Triangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  const Vec e1 = b.position - a.position, e2 = c.position - a.position;
  const Vec p = cross(ray.direction, e2);
  const double determinant = dot(e1, p);
  if (determinant == 0) return std::nullopt;
  const Vec from = ray.origin - a.position;
  const double u = dot(from, p) / determinant;
  if (u < 0 || u > 1) return std::nullopt;
  const Vec q = cross(from, e1);
  const double v = dot(ray.direction, q) / determinant;
  if (v < 0 || u + v > 1) return std::nullopt;
  return Hit{dot(e2, q) / determinant, &triangle, {1 - u - v, u, v}};
}

bool comesFirst(const Triangle& a, const Triangle& b) {
  if (a.opaque != b.opaque) return a.opaque;
  if (a.sheet != b.sheet) return a.sheet;
  if (!a.opaque && !a.sheet && a.priority != b.priority) return a.priority > b.priority;
  return a.order > b.order;
}

bool passes(const Ray& ray, const Vec& center, double radius) {
  const Vec from = center - ray.origin;
  const double along = dot(from, ray.direction);
  return dot(from, from) - along * along / dot(ray.direction, ray.direction) <= radius * radius;
}

}  // namespace

Geometry::Geometry(const Scene& scene, const std::vector<MipChain>& textures)
    : textures_(textures) {
  std::vector<Transform> transforms;
  addList(scene, scene.bodies, transforms);
}

void Geometry::addList(const Scene& scene, std::span<const Body> bodies,
                       std::vector<Transform>& transforms) {
  for (const Body& body : bodies) {
    const Object& object = scene.objects[static_cast<std::size_t>(body.object)];
    transforms.push_back(body.transform);
    addList(scene, object.before, transforms);
    addShape(scene, object, transforms);
    addList(scene, object.after, transforms);
    transforms.pop_back();
  }
}

void Geometry::addShape(const Scene& scene, const Object& object,
                        std::span<const Transform> transforms) {
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(object.mesh)];
  const Material& material = scene.materials[static_cast<std::size_t>(object.material)];
  Part part;
  for (const auto& indices : mesh.triangles) {
    Triangle triangle = placedTriangle(mesh, indices, object.material, transforms);
    triangle.opaque = !material.passesLight();
    triangle.sheet = material.passesLight() && !material.isDielectric();
    triangle.priority = material.priority;
    triangle.order = triangles_++;
    triangle.alphaMap = material.alphaMap;
    triangle.alphaCutoff = material.alphaCutoff;
    triangle.coverageMap = material.coverageMap;
    triangle.coverage = material.coverage;
    part.triangles.push_back(triangle);
  }
  for (const Vec& p : mesh.positions) part.center += placed(p, transforms);
  part.center = part.center / static_cast<double>(mesh.positions.size());
  for (const Vec& p : mesh.positions) {
    part.radius = std::max(part.radius, length(placed(p, transforms) - part.center));
  }
  part.radius *= 1 + kSelf;
  part.castsShadow = material.castsShadow;
  parts_.push_back(std::move(part));
}

Color Geometry::texel(int map, const Hit& hit) const {
  double u = 0, v = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& uv = hit.triangle->corners[i].uv;
    u += uv[0] * hit.weights[i], v += uv[1] * hit.weights[i];
  }
  return textures_[static_cast<std::size_t>(map)].at(u, v, Filter::bilinear, 1);
}

bool Geometry::isCutAway(const Hit& hit) const {
  const Triangle& triangle = *hit.triangle;
  if (triangle.alphaMap != kNone) return texel(triangle.alphaMap, hit).x < triangle.alphaCutoff;
  return triangle.coverageMap != kNone && texel(triangle.coverageMap, hit).x < kClear;
}

// All or nothing, where a map says how much is there.
bool Geometry::castsShadow(const Hit& hit) const {
  const Triangle& triangle = *hit.triangle;
  if (triangle.coverageMap == kNone) return true;
  return triangle.coverage * texel(triangle.coverageMap, hit).x >= 0.5;
}

// visit(part, hit) for every hit in front, until it answers false.
template <typename Visit>
void Geometry::visit(const Ray& ray, const Visit& visit) const {
  for (const Part& part : parts_) {
    if (!passes(ray, part.center, part.radius)) continue;
    for (const Triangle& triangle : part.triangles) {
      const std::optional<Hit> hit = meet(ray, triangle);
      if (!hit || !(hit->t * length(ray.direction) > kSelf * (1 + length(ray.origin)))) continue;
      if (isCutAway(*hit)) continue;
      if (!visit(part, *hit)) return;
    }
  }
}

std::optional<Meeting> Geometry::nearest(const Ray& ray) const {
  std::vector<Hit> hits;  // in the nearest place
  double end = INFINITY;
  visit(ray, [&](const Part&, const Hit& hit) {
    const double same = kSamePlace * (1 + hit.t);
    if (hit.t > end + same) return true;
    if (hit.t < end - same) hits.clear(), end = hit.t;
    hits.push_back(hit);
    return true;
  });
  if (hits.empty()) return std::nullopt;
  Meeting meeting{hits[0], {}};
  for (const Hit& hit : hits) {
    if (comesFirst(*hit.triangle, *meeting.hit.triangle)) meeting.hit = hit;
  }
  if (meeting.hit.triangle->opaque) return meeting;
  for (const Hit& hit : hits) {
    if (hit.triangle == meeting.hit.triangle || hit.triangle->sheet) continue;
    meeting.alsoCrossed.push_back(hit.triangle);
  }
  return meeting;
}

bool Geometry::blocked(const Ray& ray, double end) const {
  bool found = false;
  visit(ray, [&](const Part& part, const Hit& hit) {
    found = part.castsShadow && hit.t < end && castsShadow(hit);
    return !found;
  });
  return found;
}

std::vector<Hit> Geometry::all(const Ray& ray) const {
  std::vector<Hit> hits;
  visit(ray, [&](const Part&, const Hit& hit) {
    hits.push_back(hit);
    return true;
  });
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.t < b.t; });
  return hits;
}

}  // namespace oracle
