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
  triangles.resize(end - first);
  update(scene.triangles.data() + first);
  for (const MaskedTriangle& t : triangles) {
    anyMask = anyMask || masks[t.mask].map != nullptr;
    anySingleSided = anySingleSided || !masks[t.mask].doubleSided;
  }
}

void MaskedGeometry::update(const TriangleRecord* records) {
  for (MaskedTriangle& masked : triangles) {
    std::copy(std::begin(records->uv), std::end(records->uv), masked.uv);
    masked.mask = records++->material;
  }
}

}  // namespace whit
