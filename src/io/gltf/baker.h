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

// Of diffuse and specular; whether there is one of alpha is seen from the image.
bool wantsBaked(const GltfMaterial& material, GltfBakedMap map);

// Fills `means` in as well. Throws Error(limit) where the textures are larger than `limits` allow.
GltfBaked bake(const GltfMaterial& material, const GltfBakeImages& images,
               const ImageLimits& limits, GltfMeans& means);

// Of codes 0 to 1; a gray image has one for r, g and b, a missing alpha is 1.
struct ChannelMean {
  float mean = 0;
  bool varies = false;
};
ChannelMean meanOf(const RawImage& raw, std::size_t channel);

}  // namespace whit
