#include "reference/find_intersections.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "reference/add_impulses.h"
#include "reference/media.h"
#include "surfaces/texture_sampling.h"

namespace whit::reference {

namespace {

// The edges in texture space.
struct TextureEdges {
  double du1, dv1, du2, dv2;
  double determinant() const { return du1 * dv2 - du2 * dv1; }
};

TextureEdges textureEdgesOf(const float* uvs) {
  const double u0 = uvs[0], v0 = uvs[1];
  return {uvs[2] - u0, uvs[3] - v0, uvs[4] - u0, uvs[5] - v0};
}

// The textures at a hit. `cosine` is that between ray and geometric normal.
class Lookups {
 public:
  Lookups(const Scene& scene, const TextureLookup& how, const Textured& at, const Affine* toWorld,
          double cosine)
      : scene_(scene), how_(how), at_(at), toWorld_(toWorld), cosine_(cosine) {}

  const float* uvs(bool second) const { return at_.uvs(second); }
  double alphaOfVertices() const {
    return vertexAlpha(scene_.materials[at_.triangle.material], at_);
  }

  RgbD sample(std::int32_t Material::*map, bool second = false) const {
    const Material& material = scene_.materials[at_.triangle.material];
    const Texture& texture = scene_.textures[material.*map];
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

// The shading normal as modelled, on the outside of the surface as `geometric`.
Vec3d modelledNormal(const Scene& scene, EffectSet effects, const Candidate& candidate,
                     const TriangleHit& hit, const Affine* toWorld, const Vec3d& geometric) {
  if (scene.isSphere(candidate.triangle)) return geometric;
  if (!effects.has(Effect::smoothNormals) || scene.normals.empty()) return geometric;

  const Vec3d n = interpolate(scene.normals[candidate.triangle].normal, hit);
  return normalized(toWorld ? toWorld->normal(n) : n, geometric);
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
  if (material.coverageMap != kNoTexture) {
    s.coverage *= lookups.sample(&Material::coverageMap).x * lookups.alphaOfVertices();
  }
}

}  // namespace

double textureFootprint(const TriangleRecord& triangle, const float* uvs, const Affine* toWorld,
                        double coneWidth, double cosine) {
  const Edges e = edgesOf(triangle);
  const auto carried = [&](const Vec3d& v) { return toWorld ? toWorld->vector(v) : v; };
  const double inTexture = std::abs(textureEdgesOf(uvs).determinant());
  const double inWorld = length(cross(carried(e.e1), carried(e.e2)));
  const double across = coneWidth / std::abs(cosine);
  return inTexture / inWorld * across * across;
}

Vec3d shadowTerminatorOffset(const Scene& scene, EffectSet effects, const Candidate& candidate,
                             const TriangleHit& hit, const Surfel& s) {
  if (!effects.has(Effect::smoothNormals) || scene.normals.empty()) return {};
  if (scene.isSphere(candidate.triangle)) return {};
  const Corners corners = worldCorners(scene, candidate.triangle, candidate.instance);
  const float* normals = scene.normals[candidate.triangle].normal;
  const double weights[] = {1 - hit.u - hit.v, hit.u, hit.v};
  const Affine* toWorld = toWorldOf(scene, candidate.instance);
  Vec3d offset;
  for (const auto i : indices(3)) {
    Vec3d n = triple(normals + 3 * i);
    if (toWorld) {
      n = normalized(toWorld->normal(n));
    } else if (isStretched(dot(n, n))) {
      n = normalized(n);
    }
    if (dot(n, s.geometricNormal) < 0) n = -n;
    const double below = -dot(s.position - corners[i], n) - s.offset;
    offset += n * (weights[i] * std::max(below, 0.0));
  }
  return offset;
}

Surfel makeSurfel(const Scene& scene, EffectSet effects, const Candidate& candidate,
                  const TriangleHit& hit, const Ray& ray, const TextureLookup& lookup,
                  bool sharesPlace) {
  const TriangleRecord& triangle = scene.triangles[candidate.triangle];
  const Affine* toWorld = toWorldOf(scene, candidate.instance);

  Surfel s;
  s.SurfacePoint::operator=(surfacePoint(scene, candidate, hit, ray, sharesPlace));
  s.view = -ray.direction;
  s.cone = lookup.cone;

  const Textured textured = texturedAt(scene, candidate.triangle, hit);
  const Lookups lookups(scene, lookup, textured, toWorld, dot(ray.direction, s.geometricNormal));

  // The shading normal is bent on the outside of the surface.
  const double side = s.entering ? 1 : -1;
  s.shadingNormal =
      modelledNormal(scene, effects, candidate, hit, toWorld, s.geometricNormal * side);
  const Material& material = scene.materials[triangle.material];
  if (effects.has(Effect::normalMaps) && material.normalMap != kNoTexture) {
    const bool second = material.normalBySecondUvs;
    s.shadingNormal = bentNormal(lookups.sample(&Material::normalMap, second), textured.triangle,
                                 lookups.uvs(second), toWorld, s.shadingNormal);
  }
  s.shadingNormal *= side;

  s.shadowOffset = shadowTerminatorOffset(scene, effects, candidate, hit, s);
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
  row.pos = s.position;
  row.ng = s.geometricNormal;
  row.ns = s.shadingNormal;
  row.offset = s.offset;
  row.viewOffset = s.viewOffset;
  row.diffuse = s.diffuse;
  row.material = s.material;
  row.specular = s.specular;
  row.alpha = s.alpha;
  row.lobe = s.lobe;
  row.emission = s.emission;
  row.coverage = s.coverage;
  row.occlusion = s.occlusion;
  row.mirror = s.mirror;
  row.transmission = s.transmission;
  row.shadowOffset = s.shadowOffset;
  row.cone = cone.widthAt(hit.t);
  if (s.entering) row.flags |= kEntering;
  if (crossing.hidden) row.flags |= kHidden;
  row.mediaBehind = crossing.stackBehind;
  return row;
}

}  // namespace whit::reference
