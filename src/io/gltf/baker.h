// Textures of reflectance and of holes from the images of a glTF material, which share its factors.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "io/gltf/shading.h"
#include "io/image/image_file.h"

namespace whit {

enum GltfBakedMap { kGltfDiffuse, kGltfSpecular, kGltfAlpha, kGltfBakedMaps };

// Decoded; null where there is none or it cannot be read, which counts as white.
struct GltfBakeImages {
  const RawImage* base = nullptr;
  const RawImage* metallicRoughness = nullptr;
  const RawImage* specular = nullptr;
  const RawImage* specularColor = nullptr;
};

// One for each GltfBakedMap that there is; the largest image's size, the others stretched to it.
using GltfBaked = std::vector<std::optional<Texture>>;

// Tests the maps of diffuse and specular. The need for an alpha map follows from the image.
bool wantsBaked(const GltfMaterial& material, GltfBakedMap map);

// Fills `means` in as well. Throws Error(limit) where the textures are larger than `limits` allow.
GltfBaked bake(const GltfMaterial& material, const GltfBakeImages& images,
               const ImageLimits& limits, GltfMeans& means);

// Means of codes, scaled to 0 to 1. A gray image has one mean for r, g and b; a missing alpha is 1.
struct ChannelMean {
  float mean = 0;
  bool varies = false;
};
ChannelMean meanOf(const RawImage& raw, std::size_t channel);

}  // namespace whit
