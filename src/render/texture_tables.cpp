#include "render/texture_tables.h"

#include <algorithm>

#include "core/error.h"

namespace whit {

namespace {

constexpr std::size_t kSide = kTexelTile, kTile = kSide * kSide;
constexpr TextureRecord kUnused{0, 1, 1, 0};

// One flag a texture of the scene.
std::vector<bool> usedTextures(const Scene& scene, EffectSet effects, const ShadingTables& tables) {
  std::vector<bool> used(scene.textures.size(), false);
  if (!effects.has(Effect::textures) && !effects.has(Effect::normalMaps) &&
      !effects.has(Effect::coverage)) {
    return used;
  }
  for (const MaterialRecord& m : tables.materials) {
    for (const std::int32_t map :
         {m.diffuseMap, m.specularMap, m.roughnessMap, m.emissionMap, m.normalMap, m.coverageMap}) {
      if (map != kNoTexture) used[static_cast<std::size_t>(map)] = true;
    }
  }
  return used;
}

// One footprint more than there are texels: the border is met from either side.
std::size_t tilesAcross(int texels) { return static_cast<std::size_t>(texels) / kTexelCells + 1; }
std::size_t tiledTexels(const Texture& t) {
  return tilesAcross(t.width) * tilesAcross(t.height) * kTile;
}

// Texels -1 to `size` and beyond, which fills up the last tile; one tile after the other.
std::vector<std::size_t> texelsOfAxis(int size, Wrap wrap) {
  std::vector<std::size_t> texels;
  for (int tile = 0; tile < static_cast<int>(tilesAcross(size)); ++tile) {
    for (int within = 0; within < kTexelTile; ++within) {
      const int texel = tile * kTexelCells + within - 1;
      const int index =
          wrap == Wrap::repeat ? (texel + size) % size : std::clamp(texel, 0, size - 1);
      texels.push_back(static_cast<std::size_t>(index));
    }
  }
  return texels;
}

TextureRecord addTexels(const Texture& t, HugeVector<std::uint32_t>& texels) {
  const std::size_t first = texels.size();
  const std::vector<std::size_t> columns = texelsOfAxis(t.width, t.wrapU);
  const std::vector<std::size_t> rows = texelsOfAxis(t.height, t.wrapV);
  texels.resize(first + rows.size() * columns.size());
  for (std::size_t y = 0; y < rows.size(); ++y) {
    const std::uint32_t* from = t.texels.data() + rows[y] * static_cast<std::size_t>(t.width);
    std::uint32_t* to =
        texels.data() + first + y / kSide * columns.size() * kSide + y % kSide * kSide;
    for (std::size_t x = 0; x < columns.size(); x += kSide, to += kTile) {
      for (std::size_t within = 0; within < kSide; ++within) to[within] = from[columns[x + within]];
    }
  }
  return {static_cast<std::uint32_t>(first), t.width, t.height,
          static_cast<std::uint32_t>(t.wrapU) | static_cast<std::uint32_t>(t.wrapV) << 8};
}

void addMipLevels(const MipMaps& maps, std::size_t texture, ShadingTables& tables) {
  TextureRecord record = tables.textures[texture];
  for (int level = 0; level < kMipStride; ++level) {
    if (level > 0 && level < maps.levels(texture)) {
      record = addTexels(maps.level(texture, level), tables.texels);
    }
    tables.mipLevels.push_back(record);
  }
}

}  // namespace

void addTextures(const Scene& scene, EffectSet effects, TextureFilter filter, int threads,
                 ShadingTables& tables) {
  const std::vector<bool> used = usedTextures(scene, effects, tables);
  const bool trilinear = filter == TextureFilter::trilinear;
  const MipMaps maps(scene.textures, trilinear ? used : std::vector<bool>(used.size()), threads);
  std::size_t total = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    for (int level = 0; used[i] && level < maps.levels(i); ++level) {
      const Texture& t = maps.level(i, level);
      if (std::max(t.width, t.height) > kTextureSideLimit) {
        throwLimit("texture '" + t.name + "' has more than 2^20 texels a side");
      }
      total += tiledTexels(t);
    }
  }
  if (total > 0x7fffffffu) throwLimit("textures hold more than 2^31 texels");
  tables.texels.reserve(total + 1);
  for (std::size_t i = 0; i < used.size(); ++i) {
    tables.textures.push_back(used[i] ? addTexels(scene.textures[i], tables.texels) : kUnused);
    if (trilinear) addMipLevels(maps, i, tables);
  }
  if (tables.texels.empty()) tables.texels.push_back(0);
  if (tables.textures.empty()) tables.textures.push_back(kUnused);
}

}  // namespace whit
