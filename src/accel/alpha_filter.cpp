#include "accel/alpha_filter.h"

#include <algorithm>
#include <iterator>

namespace whit {

AlphaMaps makeAlphaMaps(const Scene& scene) {
  AlphaMaps maps(scene.textures.size());
  const auto add = [&](std::int32_t map) {
    const auto texture = static_cast<std::size_t>(map);
    if (!maps[texture]) maps[texture] = std::make_unique<AlphaMap>(scene.textures[texture]);
  };
  for (const Material& material : scene.materials) {
    if (material.alphaMap != kNoTexture) add(material.alphaMap);
    if (material.isCutBesidesCoverage()) add(material.coverageMap);
  }
  return maps;
}

Mask maskOf(const Material& material, const AlphaMaps& maps) {
  Mask mask;
  mask.doubleSided = material.doubleSided;
  if (material.alphaMap == kNoTexture || maps.empty()) return mask;
  mask.map = maps[static_cast<std::size_t>(material.alphaMap)].get();
  mask.cutoff = material.alphaCutoff;
  mask.shadowCutoff = material.shadowCutoff();
  if (!material.isCutBesidesCoverage()) return mask;
  mask.coverage = maps[static_cast<std::size_t>(material.coverageMap)].get();
  mask.coverageCutoff = material.coverageCutoff();
  return mask;
}

MaskedGeometry::MaskedGeometry(const Scene& scene, const AlphaMaps& maps, std::uint32_t first,
                               std::uint32_t end) {
  masks.reserve(scene.materials.size());
  for (const Material& material : scene.materials) masks.push_back(maskOf(material, maps));
  triangles.reserve(end - first);
  for (std::uint32_t i = first; i < end; ++i) {
    const TriangleRecord& t = scene.triangles[i];
    MaskedTriangle& masked = triangles.emplace_back();
    std::copy(std::begin(t.uv), std::end(t.uv), masked.uv);
    masked.mask = t.material;
    anyMask = anyMask || masks[t.material].map != nullptr;
    anySingleSided = anySingleSided || !masks[t.material].doubleSided;
  }
}

}  // namespace whit
