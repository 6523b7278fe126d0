// The scene as kernels read it: flat tables without pointers to follow. Built once a scene by
// render/build_tables.cpp; read-only while a frame is rendered.
#pragma once

#include <cstdint>
#include <vector>

#include "bake/mip_maps.h"
#include "bake/scene.h"
#include "sampling/ggx_lobe.h"

namespace whit {

// Two cache lines a material.
struct alignas(64) MaterialRecord {
  float diffuse[3];
  std::int32_t diffuseMap;  // index into textures, kNoTexture
  float specular[3];
  std::int32_t specularMap;
  float emission[3];
  std::int32_t normalMap;
  float alpha;  // GGX width, roughness squared and bounded below
  std::uint32_t medium;
  std::uint32_t flags;
  std::int32_t emissionMap;
  // impulses
  float mirror[3];
  std::int32_t mirrorMap;
  float mirrorGrazing[3];
  std::int32_t occlusionMap;
  float transmission[3];
  std::int32_t transmissionMap;
  float roughness;  // before it is bounded below; times the map's
  std::int32_t roughnessMap;
  float coverage;
  std::int32_t coverageMap;
};
static_assert(sizeof(MaterialRecord) == 128);
// Flags of MaterialRecord::flags. Those that tell of a function of Material hold its result for the
// effects of the plan.
inline constexpr std::uint32_t kMaterialReflects = 1u << 0;
inline constexpr std::uint32_t kMaterialTransmits = 1u << 1;
inline constexpr std::uint32_t kMaterialEmits = 1u << 2;
inline constexpr std::uint32_t kMaterialGlossy = 1u << 3;
inline constexpr std::uint32_t kMaterialScatters = 1u << 4;
inline constexpr std::uint32_t kMaterialTintsSpecular = 1u << 5;
inline constexpr std::uint32_t kMaterialTintsEmission = 1u << 6;
// Maps that are looked up with the second texture coordinates.
inline constexpr std::uint32_t kMaterialEmissionBySecondUvs = 1u << 7;
inline constexpr std::uint32_t kMaterialNormalBySecondUvs = 1u << 8;
// The emission map's texels are of radiance, not of color.
inline constexpr std::uint32_t kMaterialEmissionIsRadiance = 1u << 9;
inline constexpr std::uint32_t kMaterialVariesRoughness = 1u << 10;
inline constexpr std::uint32_t kMaterialIsPartlyThere = 1u << 11;
// Some map of it is looked up.
inline constexpr std::uint32_t kMaterialMapped = 1u << 12;
// Under --indirect its diffuse color reflects the scene, in place of ambient light.
inline constexpr std::uint32_t kMaterialDiffuses = 1u << 13;
inline constexpr std::uint32_t kMaterialLayered = 1u << 14;   // Material::isLayered()
inline constexpr std::uint32_t kMaterialBlursSky = 1u << 15;  // Material::reflectsBlurredSky()
inline constexpr std::uint32_t kMaterialIsOccluded = 1u << 16;
inline constexpr std::uint32_t kMaterialOcclusionBySecondUvs = 1u << 17;
// Maps or vertex colors multiply the mirror or the transmission.
inline constexpr std::uint32_t kMaterialVariesMirror = 1u << 18;
inline constexpr std::uint32_t kMaterialVariesTransmission = 1u << 19;
inline constexpr std::uint32_t kMaterialDimsBelow = 1u << 20;      // Material::dimsBelow()
inline constexpr std::uint32_t kMaterialMirrorsByLobe = 1u << 21;  // Material::mirrorsByLobe()
inline constexpr std::uint32_t kMaterialCoated = 1u << 22;         // Material::coat
inline constexpr std::uint32_t kMaterialIsUnderCoat = 1u << 23;    // Material::isUnderCoat()
inline constexpr std::uint32_t kMaterialFrosts = 1u << 24;         // Material::frosts()
// Material::hasFrostedInterface()
inline constexpr std::uint32_t kMaterialFrostedInterface = 1u << 25;
inline constexpr std::uint32_t kMaterialAlphaByVertex = 1u << 26;  // Material::alphaByVertex

// This flag marks a texture whose texels are not interpolated.
inline constexpr std::uint32_t kNearestTexel = 1 << 16;
struct TextureRecord {
  std::uint32_t firstTexel;  // index into texels
  std::int32_t width, height;
  std::uint32_t wrap;  // wrapU | wrapV << 8 (Wrap's values) | kNearestTexel
};
// Records of a texture's mip levels. The last level fills what it leaves empty, so that every level
// has one above it.
inline constexpr int kMipStride = kMipLevels + 1;

// Object to world; `normal` holds the cofactors (Affine::normal), times the power of two by which
// the largest is of the order of 1: so that the squares of what they carry are in a float's range.
struct alignas(64) InstanceTransform {
  float toWorld[12];  // row-major 3x4
  float normal[12];   // row-major 3x3, rows padded to four
  float handedness;   // -1 if the transform mirrors
  float spare[7];

  void setToWorld(const Affine& m) {
    const Vec3d columns[4] = {m.x, m.y, m.z, m.p};
    for (int i = 0; i < 12; ++i) toWorld[i] = static_cast<float>(columns[i % 4][i / 4]);
  }
};
static_assert(sizeof(InstanceTransform) == 128);

// Per medium: ior, absorption, priority.
struct MediumRecord {
  float ior, absorption[3], priority, spare[3];
};

struct SkyTable {
  Sky::Kind kind = Sky::Kind::none;
  Rgb zenith, horizon, ground;  // scale applied
  const float *r = nullptr, *g = nullptr, *b = nullptr;
  int width = 0, height = 0;
  float scale = 1;
  float turn = 0;  // rotation as a fraction of a full turn
};

struct ShadingTables {
  const TriangleRecord* triangles = nullptr;  // at least one
  std::size_t triangleCount = 1;              // spheres included
  std::uint32_t firstSphere = 0;              // from here on they are spheres (bake/sphere.h)
  // One record a triangle, or with a stride of 0 a single one of zeros, which stands for flat
  // faces.
  const NormalRecord* normals = nullptr;
  int normalStride = 0;  // floats
  // One record a triangle, or with a stride of 0 a single one of ones, which stands for white.
  const ColorRecord* colors = nullptr;
  int colorStride = 0;                    // floats
  const UvRecord* secondUvs = nullptr;    // none: no material's flags name them
  std::vector<MaterialRecord> materials;  // at least one
  // Material::grazingRatio; empty where all are kGrazingRatio.
  std::vector<float> grazingRatios;
  std::vector<ShownMap> maps;           // the maps of all materials
  std::vector<TextureRecord> textures;  // a record for each of `maps`, at least one
  // kMipStride for each of `maps`, from the full texture on; none unless lookups are trilinear.
  std::vector<TextureRecord> mipLevels;
  TexelStrips texels;                        // at least one
  std::size_t copiedTexels = 0;              // number of texels in the strips
  std::vector<InstanceTransform> instances;  // at least one
  std::vector<MediumRecord> media;           // [0] is vacuum
  std::vector<Light> lights;
  SkyTable sky, blurredSky;  // the latter kSkyBlurs images of this size, one below the other
  const LobeTable* lobes = nullptr;  // where lobes exist that no rays sample
  Ambient ambient;
  Fog fog;
  bool samePriority = true;   // no medium outranks another
  bool radianceMaps = false;  // some material has kMaterialEmissionIsRadiance
};

}  // namespace whit
