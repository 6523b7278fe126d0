// Textures made from glTF's images: reflectance, holes, normals, emission.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/gltf/document.h"
#include "io/gltf/material.h"
#include "io/texture_loader.h"

namespace whit {

// An image of the document, decoded when it is asked for and for as long as somebody holds it.
class GltfImage;

struct GltfMaps {
  std::int32_t diffuse = kNoTexture, specular = kNoTexture, emission = kNoTexture;
  std::int32_t roughness = kNoTexture;
  std::int32_t normal = kNoTexture, alpha = kNoTexture, coverage = kNoTexture;
  std::shared_ptr<const GltfMeans> means;  // filled in when the textures are decoded
};

class GltfMapMaker {
 public:
  explicit GltfMapMaker(const GltfDocument& document);
  ~GltfMapMaker();

  // Slots of `textures`; materials with the same maps share them. An image that cannot be read is a
  // warning, and white. Both this and the document outlive the textures' decoding.
  GltfMaps ask(const GltfMaterial& material, TextureLoader& textures);

 private:
  std::shared_ptr<GltfImage> image(const GltfTexture& map) const;

  std::int32_t roughnessOf(const GltfMaterial& material, const std::shared_ptr<GltfMeans>& means,
                           TextureLoader& textures) const;
  void addMeans(const GltfMaterial& material, const std::shared_ptr<GltfMeans>& means,
                TextureLoader& textures) const;

  Warnings& warnings_;
  std::vector<std::shared_ptr<GltfImage>> images_;
  std::map<std::string, GltfMaps> known_;
};

}  // namespace whit
