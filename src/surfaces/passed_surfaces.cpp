#include "surfaces/passed_surfaces.h"

#include "core/index.h"
#include "surfaces/texture_sampling.h"

namespace whit {

bool cutAway(const Scene& scene, std::uint32_t triangle, const TriangleHit& hit, bool forShadows) {
  const TriangleRecord& record = scene.triangles[triangle];
  const Material& material = scene.materials[record.material];
  if (material.alphaMap == kNoTexture) return false;
  const Textured textured = texturedAt(scene, triangle, hit);
  const TexturePoint at = texturePoint(textured.triangle.uv, textured.hit);
  const double alpha = vertexAlpha(material, textured);
  const auto isBelow = [&](std::int32_t map, float cutoff) {
    const Texture& mask = entryOf(scene.textures, map);
    return sampleTexture(mask, at.u, at.v).x * alpha < double{cutoff};
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
  return dot(direction, outwardNormal(scene, triangle, instance)) > 0;
}

}  // namespace whit
