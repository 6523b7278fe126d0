#include "reference/find_intersections.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/sphere.h"
#include "reference/add_impulses.h"
#include "reference/intersect.h"
#include "reference/media.h"
#include "reference/texture_sampling.h"

namespace whit::reference {

namespace {

// The nearest weights that belong to a point of the triangle.
void moveOntoTriangle(TriangleHit& hit) {
  const double w = std::max(0.0, 1 - hit.u - hit.v);
  const double u = std::max(0.0, hit.u), v = std::max(0.0, hit.v);
  const double sum = w + u + v;
  hit.u = sum > 0 ? u / sum : 1.0 / 3;
  hit.v = sum > 0 ? v / sum : 1.0 / 3;
}

Vec3d triple(const float* values) { return {values[0], values[1], values[2]}; }

// A value given at the corners, at the hit.
Vec3d interpolate(const float* corners, const TriangleHit& hit) {
  return triple(corners) * (1 - hit.u - hit.v) + triple(corners + 3) * hit.u +
         triple(corners + 6) * hit.v;
}

// From corner 0 to corners 1 and 2.
struct Edges {
  Vec3d e1, e2;
};

Edges edgesOf(const TriangleRecord& t) {
  const Vec3d p0 = triple(t.position);
  return {triple(t.position + 3) - p0, triple(t.position + 6) - p0};
}

// The edges in texture space.
struct TextureEdges {
  double du1, dv1, du2, dv2;
  double determinant() const { return du1 * dv2 - du2 * dv1; }
};

TextureEdges textureEdgesOf(const float* uvs) {
  const double u0 = uvs[0], v0 = uvs[1];
  return {uvs[2] - u0, uvs[3] - v0, uvs[4] - u0, uvs[5] - v0};
}

// The magnitudes that the hit point is added up from, per axis.
Vec3d magnitudeOnTriangle(const TriangleRecord& t, const TriangleHit& hit) {
  const double w = std::max(0.0, 1 - hit.u - hit.v);
  return abs(triple(t.position)) * w + abs(triple(t.position + 3)) * hit.u +
         abs(triple(t.position + 6)) * hit.v;
}
Vec3d magnitudeOnSphere(const Affine& map, const Vec3d& unit) {
  const Vec3d q = abs(unit);
  return abs(map.x) * q.x + abs(map.y) * q.y + abs(map.z) * q.z + abs(map.p);
}

// The magnitudes in the world.
Vec3d magnitudeInWorld(const Vec3d& sum, const Affine* toWorld) {
  if (!toWorld) return sum;
  return abs(toWorld->x) * sum.x + abs(toWorld->y) * sum.y + abs(toWorld->z) * sum.z +
         abs(toWorld->p);
}

Vec3d spansInWorld(const Vec3d& spans, const Affine* toWorld) {
  if (!toWorld) return spans;
  return abs(toWorld->x) * spans.x + abs(toWorld->y) * spans.y + abs(toWorld->z) * spans.z;
}

double sumOf(const Vec3d& v) { return v.x + v.y + v.z; }

// True if the triangle is so narrow that its normal may be turned by rounding to float.
bool isNarrow(const Edges& e) {
  const Vec3d area = abs(cross(e.e1, e.e2));
  return sumOf(area) <= 0x1p-14 * sumOf(abs(e.e1)) * sumOf(abs(e.e2));
}

// The inputs of a position, in the space of the geometry.
struct Placement {
  Vec3d position, magnitude;
  Vec3d spans;    // along the edges, or of a sphere kSphereSpan of its axes
  Vec3d inPlane;  // some point of the triangle's plane, or of the one that touches the sphere
  bool isNarrow = false;
};

// Where the ray meets the plane, if that is more than the weights say: of a triangle that is larger
// than its distance from the ray's start the weights of a hit found in floats say less.
std::optional<Vec3d> pointOnRay(const Placement& place, double t, const Ray& ray,
                                const Vec3d& normal) {
  if (!(8 * t < sumOf(place.spans))) return std::nullopt;
  const Vec3d point = ray.origin + ray.direction * t;
  return point - normal * dot(point - place.inPlane, normal);
}

// The position, and how far from it rays start, in the arithmetic of floats. The bound on the
// distance between the plane as Embree computes it and the start has three parts. The products that
// a point is added up from are rounded by an ulp or two of themselves along each axis (pbrt-v4,
// section 6.8.5). Embree subtracts a ray's origin from the corners and takes t from products of
// those differences, so its plane is off by some ulps of the edges. Only what these errors
// contribute along the normal counts, plus 2^-6 of an ulp of everything, because a start must not
// lie in the plane and the normal is rounded as well. Near the origin of a large triangle the
// second part is the largest by far, so no bound may rest on the point's coordinates alone.
// Across the normal the point is off as well; the retreat makes that good, because half of the way
// that the ray has come is known to be clear. Where the errors of several axes mix, which is so in
// an instance's space and where other surfaces lie in the same place (`inDoubt`), all of them
// count.
void placeSurfel(const Placement& place, double t, const Ray& ray, const Affine* toWorld,
                 bool inDoubt, Surfel& s) {
  const Vec3d point = magnitudeInWorld(place.magnitude, toWorld);
  s.position = place.position;
  if (toWorld) s.position = toWorld->point(s.position);
  const Vec3d edges = spansInWorld(place.spans, toWorld), n = abs(s.geometricNormal);
  s.offset = kUnitRoundOff * (32 * sumOf(point) + 16 * sumOf(edges));
  s.retreat = std::min(s.offset, t) / 2;
  if (inDoubt || toWorld || place.isNarrow) return;
  double across = sumOf(point * 2.0 + edges);
  if (const auto onRay = pointOnRay(place, t, ray, s.geometricNormal)) {
    s.position = *onRay;
    across = 2 * sumOf(abs(s.position)) + 8 * t + 2 * dot(n, edges);
  }
  const double along = 4 * dot(n, point) + 16 * dot(n, edges) + sumOf(point + edges) / 64;
  s.offset = kUnitRoundOff * along;
  s.retreat = std::min(s.retreat, kUnitRoundOff * across);
}

// The triangle and weights by which textures are looked up: those of the hit, or of a triangle that
// touches the sphere.
struct Textured {
  TriangleRecord triangle;
  TriangleHit hit;
  const float* secondUvs = nullptr;

  const float* uvs(bool second) const { return second && secondUvs ? secondUvs : triangle.uv; }
};

Textured texturedAt(const Scene& scene, std::uint32_t number, const TriangleHit& hit) {
  const TriangleRecord& record = scene.triangles[number];
  if (scene.isSphere(number)) {
    return {touchingTriangle(record, hit.u, hit.v), {hit.t, 0, 0}, nullptr};
  }
  return {record, hit, scene.secondUvs.empty() ? nullptr : scene.secondUvs[number].uv};
}

// The textures at a hit. `cosine` is that between ray and geometric normal.
class Lookups {
 public:
  Lookups(const Scene& scene, const TextureLookup& how, const Textured& at, const Affine* toWorld,
          double cosine)
      : scene_(scene), how_(how), at_(at), toWorld_(toWorld), cosine_(cosine) {}

  const float* uvs(bool second) const { return at_.uvs(second); }

  RgbD sample(std::int32_t Material::*map, bool second = false) const {
    const Material& material = scene_.materials[at_.triangle.material];
    const Texture& texture = scene_.textures[static_cast<std::size_t>(material.*map)];
    const auto [u, v] = texturePoint(uvs(second), at_.hit);
    if (how_.filter != TextureFilter::trilinear) return sampleTexture(texture, u, v, how_.filter);
    const double footprint =
        textureFootprint(at_.triangle, uvs(second), toWorld_, how_.cone.width, cosine_);
    return sampleTexture(*how_.maps, shownMap(material, map), u, v,
                         mipLevel(footprint * texture.width * texture.height));
  }

 private:
  const Scene& scene_;
  const TextureLookup& how_;
  const Textured& at_;
  const Affine* toWorld_;
  double cosine_;
};

// `normal` bent by a tangent-space normal map: x along growing u, y along growing v. Unchanged
// where texture space has collapsed.
Vec3d bentNormal(const RgbD& m, const TriangleRecord& triangle, const float* uvs,
                 const Affine* toWorld, const Vec3d& normal) {
  const Edges e = edgesOf(triangle);
  const TextureEdges t = textureEdgesOf(uvs);
  const double determinant = t.determinant();
  if (determinant == 0) return normal;
  const double sign = determinant < 0 ? -1 : 1;
  Vec3d tangent = (e.e1 * t.dv2 - e.e2 * t.dv1) * sign;
  double handedness = sign;
  if (toWorld) {
    tangent = toWorld->vector(tangent);
    // A mirroring instance turns right-handed frames into left-handed ones.
    if (toWorld->determinant() < 0) handedness = -handedness;
  }
  tangent = normalized(tangent - normal * dot(normal, tangent));
  if (tangent == Vec3d{}) return normal;
  const Vec3d bitangent = cross(normal, tangent) * handedness;
  return normalized(tangent * (2 * m.x - 1) + bitangent * (2 * m.y - 1) + normal * (2 * m.z - 1),
                    normal);
}

// Both normals as modelled, on the outside of the surface, without normal maps.
void findNormals(const Scene& scene, EffectSet effects, const Candidate& candidate,
                 const TriangleHit& hit, const Affine* toWorld, Surfel& s) {
  const TriangleRecord& triangle = scene.triangles[candidate.triangle];
  const auto carried = [&](const Vec3d& n) { return toWorld ? toWorld->normal(n) : n; };
  const Edges e = edgesOf(triangle);
  s.geometricNormal = normalized(carried(cross(e.e1, e.e2)), s.view);
  s.shadingNormal = s.geometricNormal;
  if (effects.has(Effect::smoothNormals) && !scene.normals.empty()) {
    const Vec3d n = interpolate(scene.normals[candidate.triangle].normal, hit);
    s.shadingNormal = normalized(carried(n), s.geometricNormal);
  }
}

// Position and normals of a hit on a sphere.
void placeOnSphere(const TriangleRecord& record, const TriangleHit& hit, const Ray& ray,
                   const Affine* toWorld, bool inDoubt, Surfel& s) {
  const Affine own = sphereMap(record);
  const Vec3d unit = spherePoint(hit.u, hit.v), point = own.point(unit);
  const Vec3d normal = own.normal(unit);
  s.geometricNormal = normalized(toWorld ? toWorld->normal(normal) : normal, s.view);
  s.shadingNormal = s.geometricNormal;
  const Vec3d spans = (abs(own.x) + abs(own.y) + abs(own.z)) * double{kSphereSpan};
  const Placement place{point, magnitudeOnSphere(own, unit), spans, point};
  placeSurfel(place, hit.t, ray, toWorld, inDoubt, s);
}

// Interpolates vertex colors as the first corner's color plus the differences of the others, so
// that one color at all corners is reproduced exactly.
RgbD vertexColor(const ColorRecord& record, const TriangleHit& hit) {
  const RgbD c0 = triple(record.color);
  const RgbD there =
      c0 + (triple(record.color + 3) - c0) * hit.u + (triple(record.color + 6) - c0) * hit.v;
  return max(there, RgbD(0.0));
}

void tint(const RgbD& color, const Material& material, Surfel& s) {
  if (material.vertexTint == VertexTint::emission) {
    s.emission = s.emission * color;
    return;
  }
  s.diffuse = s.diffuse * color;
  if (material.hasTransmission()) s.transmission = s.transmission * color;
  if (material.vertexTint != VertexTint::diffuseAndSpecular) return;
  s.specular = s.specular * color;
  if (material.hasMirror() && !material.coat) s.mirror = s.mirror * color;
}

void findColors(const Scene& scene, EffectSet effects, std::uint32_t number, const TriangleHit& hit,
                const Lookups& lookups, Surfel& s) {
  const TriangleRecord& triangle = scene.triangles[number];
  const Material& material = scene.materials[triangle.material];
  s.material = triangle.material;
  const auto textured = [&](const Rgb& factor, std::int32_t Material::*map, bool second = false) {
    if (!effects.has(Effect::textures) || material.*map == kNoTexture) return RgbD(factor);
    return RgbD(factor) * lookups.sample(map, second);
  };
  s.diffuse = textured(material.diffuse, &Material::diffuseMap);
  s.specular = textured(material.specular, &Material::specularMap);
  s.grazingRatio = double{material.grazingRatio};
  if (material.hasMirror()) s.mirror = textured(Rgb(1.0f), &Material::mirrorMap);
  if (material.hasTransmission()) {
    s.transmission = textured(Rgb(1.0f), &Material::transmissionMap);
  }
  if (effects.has(Effect::emissionMaps)) {
    s.emission = textured(Rgb(1.0f), &Material::emissionMap, material.emissionBySecondUvs);
  }
  if (effects.has(Effect::vertexColors) && !scene.colors.empty()) {
    tint(vertexColor(scene.colors[number], hit), material, s);
  }
  double roughness = material.roughness;
  if (effects.has(Effect::textures) && material.roughnessMap != kNoTexture) {
    roughness *= lookups.sample(&Material::roughnessMap).y;
  }
  roughness = std::max(roughness, double{kMinRoughness});
  s.alpha = roughness * roughness;
  if (effects.has(Effect::textures) && material.occlusionMap != kNoTexture) {
    s.occlusion = lookups.sample(&Material::occlusionMap, material.occlusionBySecondUvs).x;
  }
  if (!effects.has(Effect::coverage)) return;
  s.coverage = material.coverage;
  if (material.coverageMap != kNoTexture) s.coverage *= lookups.sample(&Material::coverageMap).x;
}

}  // namespace

TriangleHit refineHit(const Scene& scene, const Ray& ray, const Candidate& candidate) {
  if (scene.isSphere(candidate.triangle)) return refineSphereHit(scene, ray, candidate);
  const Corners corners = worldCorners(scene, candidate.triangle, candidate.instance);
  if (std::optional<TriangleHit> hit = piercePlane(ray, corners); hit && hit->t > 0) {
    moveOntoTriangle(*hit);
    return *hit;
  }
  TriangleHit hit{0, candidate.u, candidate.v};
  moveOntoTriangle(hit);
  const Vec3d point = corners[0] * (1 - hit.u - hit.v) + corners[1] * hit.u + corners[2] * hit.v;
  const double t = dot(point - ray.origin, ray.direction) / dot(ray.direction, ray.direction);
  hit.t = t > 0 ? t : std::numeric_limits<double>::min();
  return hit;
}

TexturePoint texturePoint(const float* uv, const TriangleHit& hit) {
  const double w = 1 - hit.u - hit.v;
  return {uv[0] * w + uv[2] * hit.u + uv[4] * hit.v, uv[1] * w + uv[3] * hit.u + uv[5] * hit.v};
}

double textureFootprint(const TriangleRecord& triangle, const float* uvs, const Affine* toWorld,
                        double coneWidth, double cosine) {
  const Edges e = edgesOf(triangle);
  const auto carried = [&](const Vec3d& v) { return toWorld ? toWorld->vector(v) : v; };
  const double inTexture = std::abs(textureEdgesOf(uvs).determinant());
  const double inWorld = length(cross(carried(e.e1), carried(e.e2)));
  const double across = coneWidth / std::abs(cosine);
  return inTexture / inWorld * across * across;
}

bool cutAway(const Scene& scene, std::uint32_t triangle, const TriangleHit& hit, bool forShadows) {
  const TriangleRecord& record = scene.triangles[triangle];
  const Material& material = scene.materials[record.material];
  if (material.alphaMap == kNoTexture) return false;
  const Textured textured = texturedAt(scene, triangle, hit);
  const TexturePoint at = texturePoint(textured.triangle.uv, textured.hit);
  const auto isBelow = [&](std::int32_t map, float cutoff) {
    const Texture& mask = scene.textures[static_cast<std::size_t>(map)];
    return sampleTexture(mask, at.u, at.v).x < double{cutoff};
  };
  if (!forShadows) return isBelow(material.alphaMap, material.alphaCutoff);
  return isBelow(material.alphaMap, material.shadowCutoff()) ||
         (material.isCutBesidesCoverage() &&
          isBelow(material.coverageMap, material.coverageCutoff()));
}

bool isPassed(const Scene& scene, std::uint32_t triangle, std::uint32_t instance,
              const Vec3d& direction) {
  const TriangleRecord& record = scene.triangles[triangle];
  if (scene.materials[record.material].doubleSided || scene.isSphere(triangle)) return false;
  const Edges e = edgesOf(record);
  Vec3d normal = cross(e.e1, e.e2);
  if (instance != kNoHit) normal = scene.instances[instance].toWorld.normal(normal);
  return dot(direction, normal) > 0;
}

Vec3d terminatorLift(const Scene& scene, EffectSet effects, const Candidate& candidate,
                     const TriangleHit& hit, const Surfel& s) {
  if (!effects.has(Effect::smoothNormals) || scene.normals.empty()) return {};
  if (scene.isSphere(candidate.triangle)) return {};
  const Corners corners = worldCorners(scene, candidate.triangle, candidate.instance);
  const float* normals = scene.normals[candidate.triangle].normal;
  const double weights[] = {1 - hit.u - hit.v, hit.u, hit.v};
  Vec3d lift;
  for (std::size_t i = 0; i < 3; ++i) {
    Vec3d n = triple(normals + 3 * i);
    if (candidate.instance != kNoHit) {
      n = normalized(scene.instances[candidate.instance].toWorld.normal(n));
    } else if (isStretched(dot(n, n))) {
      n = normalized(n);
    }
    if (dot(n, s.geometricNormal) < 0) n = -n;
    const double below = -dot(s.position - corners[i], n) - s.offset;
    lift += n * (weights[i] * std::max(below, 0.0));
  }
  return lift;
}

Surfel makeSurfel(const Scene& scene, EffectSet effects, const Candidate& candidate,
                  const TriangleHit& hit, const Ray& ray, const TextureLookup& lookup,
                  bool sharesPlace) {
  const TriangleRecord& triangle = scene.triangles[candidate.triangle];
  const Affine* toWorld =
      candidate.instance == kNoHit ? nullptr : &scene.instances[candidate.instance].toWorld;
  Surfel s;
  s.view = -ray.direction;
  s.cone = lookup.cone;
  const Textured textured = texturedAt(scene, candidate.triangle, hit);
  if (scene.isSphere(candidate.triangle)) {
    placeOnSphere(triangle, hit, ray, toWorld, sharesPlace, s);
  } else {
    findNormals(scene, effects, candidate, hit, toWorld, s);
    const Edges e = edgesOf(triangle);
    const Placement place{interpolate(triangle.position, hit), magnitudeOnTriangle(triangle, hit),
                          abs(e.e1) + abs(e.e2), triple(triangle.position), isNarrow(e)};
    placeSurfel(place, hit.t, ray, toWorld, sharesPlace, s);
  }
  const double cosine = dot(ray.direction, s.geometricNormal);
  const Lookups lookups(scene, lookup, textured, toWorld, cosine);
  const Material& material = scene.materials[triangle.material];
  if (effects.has(Effect::normalMaps) && material.normalMap != kNoTexture) {
    const bool second = material.normalBySecondUvs;
    s.shadingNormal = bentNormal(lookups.sample(&Material::normalMap, second), textured.triangle,
                                 lookups.uvs(second), toWorld, s.shadingNormal);
  }
  s.entering = cosine < 0;
  if (!s.entering) {
    s.geometricNormal = -s.geometricNormal;
    s.shadingNormal = -s.shadingNormal;
  }
  s.lift = terminatorLift(scene, effects, candidate, hit, s);
  findColors(scene, effects, candidate.triangle, hit, lookups, s);
  return s;
}

std::optional<SurfelRow> findIntersections(const World& world, const Chunk& chunk,
                                           std::size_t slot) {
  const Candidate candidate = candidateOf(chunk, slot);
  if (candidate.triangle == kNoHit) return std::nullopt;
  const Ray ray = rayOf(chunk, slot);
  const TriangleHit hit{double{chunk.hits.t[slot]}, candidate.u, candidate.v};
  // Looked up at the width that the step has found: what is left of it decides between mip levels.
  const TextureLookup lookup{chunk.options().shading.textureFilter, world.maps,
                             surfelOf(chunk, slot).cone};
  const std::uint32_t others = alsoCrossedAt(chunk, slot);
  Surfel s =
      makeSurfel(world.scene, world.effects, candidate, hit, ray, lookup, others >= kSharesPlace);
  const std::uint32_t media = mediaOf(chunk, slot);
  const Crossing crossing =
      crossMedia(world.scene, world.effects, s.material, s.entering, media, others);
  findLayers(world.scene, world.effects, crossing, chunk.options().shading,
             lobePointsOf(chunk, slot), s);
  const RayCone cone{ray.cone.width, pixelCone(chunk.frame->camera).spread};
  SurfelRow row;
  put(s.position, row.posX, row.posY, row.posZ);
  put(s.geometricNormal, row.ngX, row.ngY, row.ngZ);
  put(s.shadingNormal, row.nsX, row.nsY, row.nsZ);
  row.offset = s.offset;
  row.retreat = s.retreat;
  put(s.diffuse, row.diffuseR, row.diffuseG, row.diffuseB);
  row.material = s.material;
  put(s.specular, row.specularR, row.specularG, row.specularB);
  row.alpha = s.alpha;
  put(s.lobe, row.lobeR, row.lobeG, row.lobeB);
  put(s.emission, row.emissionR, row.emissionG, row.emissionB);
  row.coverage = s.coverage;
  row.occlusion = s.occlusion;
  put(s.mirror, row.mirrorR, row.mirrorG, row.mirrorB);
  put(s.transmission, row.transmissionR, row.transmissionG, row.transmissionB);
  put(s.lift, row.liftX, row.liftY, row.liftZ);
  row.cone = cone.widthAt(hit.t);
  row.flags = (s.entering ? kEntering : 0) | (crossing.hidden ? kHidden : 0);
  row.mediaBehind = crossing.stackBehind;
  return row;
}

}  // namespace whit::reference
