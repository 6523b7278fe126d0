#include "io/gltf_model.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "io/gltf_mesh.h"

namespace whit {
namespace {

// What `to` still has of `from` becomes what `fresh` has: what a scene file has changed stays.
void renew(Material& to, const Material& from, const Material& fresh) {
  const auto field = [&](auto Material::*f) {
    if (to.*f == from.*f) to.*f = fresh.*f;
  };
  field(&Material::diffuse);
  field(&Material::specular);
  field(&Material::roughness);
  field(&Material::glossyReflection);
  field(&Material::mirror);
  field(&Material::mirrorGrazing);
  field(&Material::transmission);
  field(&Material::ior);
  field(&Material::absorption);
  field(&Material::castsShadow);
}

}  // namespace

GltfModel::GltfModel(const std::filesystem::path& path, const PathRules& rules,
                     MemoryBudget& budget, Warnings& warnings)
    : document_(path, rules, budget, warnings),
      sources_(readGltfMaterials(document_)),
      maps_(document_),
      stage_(readGltfNodes(document_)) {
  for (const GltfMaterial& source : sources_) materials_.push_back(shadedAs(source, {}));
}

TexturedMaterial GltfModel::withMaps(std::size_t i, Material material, const GivenMaps& given,
                                     TextureLoader& textures) {
  const GltfMaps maps = maps_.ask(sources_[i], textures);
  if (!given.diffuse) material.diffuseMap = maps.diffuse;
  if (!given.specular) material.specularMap = maps.specular;
  if (!given.normal) material.normalMap = maps.normal;
  if (!given.alpha) material.alphaMap = maps.alpha;
  const auto renewed = [source = sources_[i], from = materials_[i], means = maps.means](
                           Material& m) { renew(m, from, shadedAs(source, *means)); };
  return {std::move(material), renewed};
}

Body GltfModel::content(SceneLayout& layout, const std::vector<std::uint32_t>& materials) {
  std::map<std::size_t, std::uint32_t> bodies;
  Body all;
  for (const GltfPlacedMesh& placed : stage_.meshes) {
    const auto [known, isNew] = bodies.try_emplace(placed.mesh);
    if (isNew) {
      known->second = layout.add(document_.model().meshes[placed.mesh].name);
      addParts(readGltfMesh(document_, placed.mesh, sources_), materials, document_.name(),
               document_.budget(), layout.body(known->second));
    }
    all.children.push_back({known->second, placed.toScene});
  }
  return all;
}

void GltfModel::addView(SceneDescription& scene) {
  constexpr double kNarrowest = 0.1, kWidest = 10;
  if (stage_.aspect > 0) {
    const double aspect = std::clamp(stage_.aspect, kNarrowest, kWidest);
    scene.width = static_cast<int>(std::lround(aspect * scene.height));
  }
  scene.cameras = stage_.cameras;
  scene.lights = stage_.lights;
}

}  // namespace whit
