#include "oracle/geometry.h"

#include <algorithm>

#include "oracle/placement.h"

namespace oracle {

namespace {

// A ray does not meet what it starts on: its start is exact to some 1e-15 of the coordinates, and
// no scene has gaps as narrow as this.
constexpr double kSelf = 1e-9;

// Faces that are no farther behind another one than this, in parts of 1 and the way, lie in one
// place: in scenes that have such, their corners are whole numbers of some power of two.
constexpr double kSamePlace = 1e-9;

// The face as the material has it.
template <typename Shape>
void addFace(std::vector<Shape>& faces, Shape face, const Material& material, int number,
             int order) {
  face.material = number;
  face.opaque = !material.passesLight();
  face.sheet = material.passesLight() && !material.isDielectric();
  face.priority = material.priority;
  face.order = order;
  face.alphaMap = material.alphaMap;
  face.alphaCutoff = material.alphaCutoff;
  face.coverageMap = material.coverageMap;
  face.coverage = material.coverage;
  faces.push_back(std::move(face));
}

bool comesFirst(const Face& a, const Face& b) {
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
    const std::size_t outer = transforms.size();
    if (!body.motion.keys.empty()) transforms.push_back(placeAt(body.motion, scene.time));
    transforms.push_back(body.transform);
    addList(scene, object.before, transforms);
    addShape(scene, object, transforms);
    addList(scene, object.after, transforms);
    transforms.resize(outer);
  }
}

void Geometry::addShape(const Scene& scene, const Object& object,
                        std::span<const Transform> transforms) {
  Part part = object.radius > 0 ? spherePart(scene, object, transforms)
                                : meshPart(scene, object, transforms);
  part.radius *= 1 + kSelf;
  part.castsShadow = scene.materials[static_cast<std::size_t>(object.material)].castsShadow;
  parts_.push_back(std::move(part));
}

Geometry::Part Geometry::meshPart(const Scene& scene, const Object& object,
                                  std::span<const Transform> transforms) {
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(object.mesh)];
  const Material& material = scene.materials[static_cast<std::size_t>(object.material)];
  Part part;
  for (const auto& indices : mesh.triangles) {
    addFace(part.triangles, placedTriangle(mesh, indices, transforms), material, object.material,
            faces_++);
  }

  // A sphere about the corners, which most rays miss.
  for (const Vec& p : mesh.positions) part.center += placed(p, transforms);
  part.center = part.center / static_cast<double>(mesh.positions.size());
  for (const Vec& p : mesh.positions) {
    part.radius = std::max(part.radius, length(placed(p, transforms) - part.center));
  }
  return part;
}

Geometry::Part Geometry::spherePart(const Scene& scene, const Object& object,
                                    std::span<const Transform> transforms) {
  const Sphere sphere = placedSphere(object.radius, transforms);
  const auto& [x, y, z] = sphere.axes;
  Part part;
  part.center = sphere.center;
  part.radius = std::sqrt(dot(x, x) + dot(y, y) + dot(z, z));  // no point is farther away
  addFace(part.spheres, sphere, scene.materials[static_cast<std::size_t>(object.material)],
          object.material, faces_++);
  return part;
}

Color Geometry::texel(int map, const Hit& hit) const {
  const auto& [u, v] = hit.uv;
  return textures_[static_cast<std::size_t>(map)].at(u, v, Filter::bilinear, 1);
}

bool Geometry::isCutAway(const Hit& hit) const {
  const Face& face = *hit.face;
  if (face.alphaMap != kNone) return texel(face.alphaMap, hit).x < face.alphaCutoff;
  return face.coverageMap != kNone && texel(face.coverageMap, hit).x < kClear;
}

// All or nothing, where a map says how much is there.
bool Geometry::castsShadow(const Hit& hit) const {
  const Face& face = *hit.face;
  if (face.coverageMap == kNone) return true;
  return face.coverage * texel(face.coverageMap, hit).x >= 0.5;
}

bool Geometry::counts(const Ray& ray, const Hit& hit) const {
  if (!(hit.t * length(ray.direction) > kSelf * (1 + length(ray.origin)))) return false;
  return !isCutAway(hit);
}

// visit(part, hit) for every hit in front, until it answers false.
template <typename Visit>
void Geometry::visit(const Ray& ray, const Visit& visit) const {
  for (const Part& part : parts_) {
    if (!passes(ray, part.center, part.radius)) continue;
    for (const Triangle& triangle : part.triangles) {
      const std::optional<Hit> hit = meet(ray, triangle);
      if (hit && counts(ray, *hit) && !visit(part, *hit)) return;
    }
    for (const Sphere& sphere : part.spheres) {
      for (const Hit& hit : meet(ray, sphere)) {
        if (counts(ray, hit) && !visit(part, hit)) return;
      }
    }
  }
}

std::optional<Meeting> Geometry::nearest(const Ray& ray) const {
  std::vector<Hit> hits;  // in the nearest place
  double end = INFINITY;
  visit(ray, [&](const Part&, const Hit& hit) {
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

  if (meeting.hit.face->opaque) return meeting;
  for (const Hit& hit : hits) {
    if (hit.face == meeting.hit.face || hit.face->sheet) continue;
    meeting.alsoCrossed.push_back(hit);
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
