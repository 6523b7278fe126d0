#include "render/build_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "core/worker_pool.h"
#include "stages/lobes.h"

namespace whit {

namespace {

void copy3(const Rgb& from, float* to) {
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}

std::array<std::int32_t, 9> mapsOf(const MaterialRecord& r) {
  return {r.diffuseMap,  r.specularMap,  r.roughnessMap, r.emissionMap,    r.normalMap,
          r.coverageMap, r.occlusionMap, r.mirrorMap,    r.transmissionMap};
}

// `onOthers`: a sheet may lie on a dielectric's face, which reflects through it.
std::uint32_t flagsOf(const Material& m, bool onOthers, EffectSet effects) {
  const bool transmits = m.passesLight() && effects.has(Effect::transmission);
  const bool reflects =
      m.hasMirror() || m.mirrorsByLobe(effects) || (transmits && (onOthers || m.boundsMedium()));

  std::uint32_t flags = 0;
  if (effects.has(Effect::mirror) && reflects) flags |= kMaterialReflects;
  if (transmits) flags |= kMaterialTransmits;
  if (maxComponent(m.emission) > 0) flags |= kMaterialEmits;

  if (m.hasGlossy()) flags |= kMaterialGlossy;
  if (m.reflectsBlurredSky(effects)) flags |= kMaterialBlursSky;
  if (m.isLayered(effects)) flags |= kMaterialLayered;
  if (m.dimsBelow(effects)) flags |= kMaterialDimsBelow;
  if (m.mirrorsByLobe(effects)) flags |= kMaterialMirrorsByLobe;
  if (m.coat) flags |= kMaterialCoated;
  if (m.isUnderCoat(effects)) flags |= kMaterialIsUnderCoat;
  if (m.hasFrostedInterface(effects)) flags |= kMaterialFrostedInterface;

  if (effects.has(Effect::textures) && m.variesRoughness()) flags |= kMaterialVariesRoughness;
  if (effects.has(Effect::coverage) && m.isPartlyThere()) flags |= kMaterialIsPartlyThere;

  for (const Lobe& lobe : kLobes) {
    if (lobe.isSampled(m, effects)) flags |= lobe.flag;
  }

  if (m.vertexTint == VertexTint::diffuseAndSpecular) flags |= kMaterialTintsSpecular;
  if (m.vertexTint == VertexTint::emission) flags |= kMaterialTintsEmission;
  if (m.emissionBySecondUvs) flags |= kMaterialEmissionBySecondUvs;
  if (m.normalBySecondUvs) flags |= kMaterialNormalBySecondUvs;
  if (m.occlusionBySecondUvs) flags |= kMaterialOcclusionBySecondUvs;
  if (m.alphaByVertex) flags |= kMaterialAlphaByVertex;

  return flags;
}

// Numbers the maps of materials in the order in which they come.
class MapNumbers {
 public:
  explicit MapNumbers(std::vector<ShownMap>& maps) : maps_(maps) { maps_.clear(); }

  // kNoTexture where the material has no such map, or frames show none.
  std::int32_t of(const Material& m, std::int32_t Material::*map, bool isShown) {
    if (!isShown || m.*map == kNoTexture) return kNoTexture;
    const ShownMap shown = shownMap(m, map);
    const auto [known, isNew] =
        numbers_.try_emplace(shown, static_cast<std::int32_t>(maps_.size()));
    if (isNew) maps_.push_back(shown);
    return known->second;
  }

 private:
  std::vector<ShownMap>& maps_;
  std::map<ShownMap, std::int32_t> numbers_;
};

MaterialRecord recordOf(const Material& m, std::uint32_t medium, bool onOthers, EffectSet effects,
                        MapNumbers& maps) {
  MaterialRecord r{};
  const bool textured = effects.has(Effect::textures);
  copy3(m.diffuse, r.diffuse);
  r.diffuseMap = maps.of(m, &Material::diffuseMap, textured);
  copy3(m.specular, r.specular);
  r.specularMap = maps.of(m, &Material::specularMap, textured && m.hasGlossy());
  r.roughnessMap = maps.of(m, &Material::roughnessMap, textured && m.hasFacets());
  r.roughness = m.roughness;
  r.coverage = m.coverage;
  r.coverageMap = maps.of(m, &Material::coverageMap, effects.has(Effect::coverage));
  copy3(m.emission, r.emission);
  r.emissionMap = maps.of(m, &Material::emissionMap, effects.has(Effect::emissionMaps));
  r.normalMap = maps.of(m, &Material::normalMap, effects.has(Effect::normalMaps));
  r.occlusionMap = maps.of(m, &Material::occlusionMap, textured);
  const float roughness = std::max(m.roughness, kMinRoughness);
  r.alpha = roughness * roughness;
  r.flags = flagsOf(m, onOthers, effects);
  if (r.occlusionMap != kNoTexture) r.flags |= kMaterialIsOccluded;
  if (m.variesMirror(effects)) r.flags |= kMaterialVariesMirror;
  if (m.variesTransmission(effects)) r.flags |= kMaterialVariesTransmission;
  r.mirrorMap = maps.of(m, &Material::mirrorMap, textured && m.hasMirror());
  r.transmissionMap = maps.of(m, &Material::transmissionMap, textured && m.hasTransmission());
  for (const std::int32_t map : mapsOf(r)) {
    if (map != kNoTexture) r.flags |= kMaterialMapped;
  }
  r.medium = (r.flags & kMaterialTransmits) != 0 ? medium : 0;
  if (effects.has(Effect::mirror)) {
    copy3(m.mirror, r.mirror);
    copy3(m.mirrorGrazing, r.mirrorGrazing);
  }
  copy3(m.transmission, r.transmission);
  return r;
}

bool isRadiance(const Scene& scene, std::int32_t texture) {
  return scene.textures[texture].format == TexelFormat::radiance;
}

void addMaterials(const Scene& scene, EffectSet effects, ShadingTables& tables) {
  tables.materials.clear();
  tables.radianceMaps = false;
  const bool onOthers = scene.media.size() > 1 && !scene.coplanar.empty();
  MapNumbers maps(tables.maps);
  for (const auto i : indices(scene.materials)) {
    const Material& m = scene.materials[i];
    MaterialRecord r = recordOf(m, scene.mediumOfMaterial[i], onOthers, effects, maps);
    if (r.emissionMap != kNoTexture && isRadiance(scene, m.emissionMap)) {
      r.flags |= kMaterialEmissionIsRadiance;
      tables.radianceMaps = true;
    }
    tables.materials.push_back(r);
  }
  tables.grazingRatios.clear();
  const auto isSpecial = [](const Material& m) { return m.grazingRatio != kGrazingRatio; };
  if (std::ranges::any_of(scene.materials, isSpecial)) {
    for (const Material& m : scene.materials) tables.grazingRatios.push_back(m.grazingRatio);
  }
  if (tables.materials.empty()) {
    tables.materials.push_back(recordOf(Material{}, 0, false, effects, maps));
  }
}

void addMedia(const Scene& scene, ShadingTables& tables) {
  tables.media.clear();
  tables.samePriority = true;
  for (const Medium& m : scene.media) {
    MediumRecord record{};
    record.ior = m.ior;
    copy3(m.absorption, record.absorption);
    record.priority = static_cast<float>(m.priority);
    tables.media.push_back(record);
    tables.samePriority = tables.samePriority && m.priority == scene.media[0].priority;
  }
}

constexpr TextureRecord kUnused{0, 1, 1, 0};

TextureRecord recordOf(const Texture& t, std::size_t firstTexel) {
  return {static_cast<std::uint32_t>(firstTexel), t.width, t.height,
          static_cast<std::uint32_t>(t.wrapU) | static_cast<std::uint32_t>(t.wrapV) << 8 |
              (t.nearest ? kNearestTexel : 0)};
}

// Returns the textures of the scene, and makes the texels that frames look up and nobody keeps.
std::vector<Texture> madeTextures(const Scene& scene, const std::vector<ShownMap>& maps,
                                  int threads) {
  std::vector<Texture> textures = scene.textures;
  std::set<Texture*> unmade;
  for (const ShownMap& map : maps) {
    Texture& texture = textures[map.texture];
    if (texture.shared && texture.shared->keptBytes() == 0) unmade.insert(&texture);
  }

  // The largest texture is begun first, so that no thread ends long after the others.
  std::vector<Texture*> inOrder(unmade.begin(), unmade.end());
  std::ranges::stable_sort(inOrder, std::greater(), &Texture::texelCount);
  parallelFor(threads, inOrder.size(), [&](std::size_t i, int) {
    inOrder[i]->texels = inOrder[i]->shared->make();
    inOrder[i]->shared = nullptr;
  });
  return textures;
}

// Adds copies of the textures that the materials of `tables` use, with their mip levels where
// lookups are trilinear.
void addTextures(const Scene& scene, TextureFilter filter, int threads, ShadingTables& tables) {
  static const TexelStrips none(new std::uint32_t[1]{});
  const bool trilinear = filter == TextureFilter::trilinear;
  std::vector<Texture> textures = madeTextures(scene, tables.maps, threads);
  MipMaps mips(textures, trilinear ? tables.maps : std::vector<ShownMap>(), threads);

  // Maps of one texture share its full size.
  std::vector<Texture> levels;
  std::map<std::int32_t, std::size_t> fullSizes;
  std::vector<std::vector<std::size_t>> levelsOfMaps;
  for (const ShownMap& map : tables.maps) {
    std::vector<std::size_t>& own = levelsOfMaps.emplace_back();
    const auto [full, isNew] = fullSizes.try_emplace(map.texture, levels.size());
    if (isNew) levels.push_back(std::move(textures[map.texture]));
    own.push_back(full->second);
    for (int level = 1; level < mips.levels(map); ++level) {
      own.push_back(levels.size());
      levels.push_back(mips.take(map, level));
    }
  }

  const PackedTexels packed = packTextures(levels, threads);
  tables.copiedTexels = packed.count;
  tables.texels = packed.strips ? packed.strips : none;
  const auto record = [&](std::size_t i) { return recordOf(levels[i], packed.begins[i]); };
  for (const std::vector<std::size_t>& own : levelsOfMaps) {
    tables.textures.push_back(record(own.front()));
    if (!trilinear) continue;

    for (const auto level : indices(kMipStride)) {
      tables.mipLevels.push_back(record(own[std::min(level, own.size() - 1)]));
    }
  }
  if (tables.textures.empty()) tables.textures.push_back(kUnused);
}

void setImage(const EnvironmentImage& image, int height, SkyTable& table) {
  table.r = image.r.data();
  table.g = image.g.data();
  table.b = image.b.data();
  table.width = image.width;
  table.height = height;
}

SkyTable skyTable(const Sky& sky, EffectSet effects) {
  SkyTable table;
  const bool image = sky.kind == Sky::Kind::image;
  if (!effects.has(Effect::sky) || (image && !effects.has(Effect::skyImage))) return table;
  table.kind = sky.kind;
  table.zenith = sky.zenith * sky.scale;
  table.horizon = sky.horizon * sky.scale;
  table.ground = sky.ground * sky.scale;
  setImage(sky.image, sky.image.height, table);
  table.scale = sky.scale;
  table.turn = sky.rotation / 360.0f;
  return table;
}

void addLighting(const Scene& scene, EffectSet effects, ShadingTables& tables) {
  addMedia(scene, tables);
  if (effects.has(Effect::lights)) tables.lights = scene.lights;
  // Rays find the albedo of lobes that they sample, and the table takes time to make.
  const bool looksUp = std::ranges::any_of(scene.materials, [&](const Material& m) {
    return m.dimsBelow(effects) && !m.scatters(effects);
  });
  if (looksUp) tables.lobes = &lobeTable();
  tables.sky = skyTable(scene.sky, effects);
  tables.blurredSky = tables.sky;
  setImage(scene.blurredSky, kBlurRows, tables.blurredSky);
  tables.blurredSky.scale *= scene.ambient.reflection;
  tables.ambient = scene.ambient;
  tables.fog = scene.fog;
  if (!effects.has(Effect::ambient)) tables.ambient.up = tables.ambient.down = Rgb(0.0f);
}

}  // namespace

ShadingTables buildTables(const Scene& scene, EffectSet effects, const ShadingChoices& shading,
                          int threads) {
  // Records that masked lanes read for rays that miss; a scene may be empty.
  static const TriangleRecord nowhere{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {}, 0};
  static const NormalRecord flat{};
  static const ColorRecord white{{1, 1, 1, 1, 1, 1, 1, 1, 1}};
  ShadingTables tables;
  tables.triangles = scene.triangles.empty() ? &nowhere : scene.triangles.data();
  tables.triangleCount = std::max<std::size_t>(1, scene.triangles.size());
  tables.firstSphere = scene.firstSphere;
  tables.normals = scene.normals.empty() ? &flat : scene.normals.data();
  tables.normalStride = scene.normals.empty() ? 0 : sizeof(NormalRecord) / sizeof(float);
  tables.colors = scene.colors.empty() ? &white : scene.colors.data();
  tables.colorStride = scene.colors.empty() ? 0 : sizeof(ColorRecord) / sizeof(float);
  tables.secondUvs = scene.secondUvs.empty() ? nullptr : scene.secondUvs.data();
  addMaterials(scene, effects, tables);
  addTextures(scene, shading.textureFilter, threads, tables);
  refreshInstances(scene, tables);
  addLighting(scene, effects, tables);
  return tables;
}

void refreshInstances(const Scene& scene, ShadingTables& tables) {
  tables.instances.clear();
  for (const InstanceRecord& instance : scene.instances) {
    InstanceTransform t{};
    const Affine& m = instance.toWorld;
    t.setToWorld(m);
    const Vec3d normals[3] = {m.normal({1, 0, 0}), m.normal({0, 1, 0}), m.normal({0, 0, 1})};
    int exponent = 0;
    std::frexp(maxComponent(max(abs(normals[0]), max(abs(normals[1]), abs(normals[2])))),
               &exponent);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        t.normal[row * 4 + column] =
            static_cast<float>(std::ldexp(normals[column][row], -exponent));
      }
    }
    t.handedness = m.determinant() < 0 ? -1.0f : 1.0f;
    tables.instances.push_back(t);
  }
  if (tables.instances.empty()) tables.instances.push_back({});
}

void refreshShading(const Scene& scene, EffectSet effects, const ShadingChoices& shading,
                    int threads, ShadingTables& tables) {
  const std::vector<ShownMap> before = tables.maps;
  addMaterials(scene, effects, tables);
  const bool lacksMips = shading.textureFilter == TextureFilter::trilinear &&
                         tables.mipLevels.empty() && !scene.textures.empty();
  if (before == tables.maps && !lacksMips) {
    addLighting(scene, effects, tables);
  } else {
    tables = buildTables(scene, effects, shading, threads);
  }
}

}  // namespace whit
