// Meshes of a glTF document, with their morph targets and skins. glTF 2.0 specification, sections
// 3.7.2, 3.7.3 and 5.24.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "io/gltf/document.h"
#include "io/gltf/material.h"
#include "scene/deformation.h"
#include "scene/mesh.h"

namespace whit {

// How a node bends its mesh.
struct GltfDeformation {
  std::vector<double> weights;  // of morph targets; those that are missing are zero
  std::optional<Track> movingWeights;
  std::shared_ptr<const Rig> skeleton;  // in the space of the document; none: no skin
  std::vector<Deformation::Joint> joints;

  // True if the mesh is not deformed.
  bool none() const;
};

// One Mesh for each primitive that consists of triangles, strips or fans, with one material: an
// index into `materials`, whose last entry is that of primitives without one. Texture coordinates
// are those of the material, with its transforms applied, v pointing up. Points, lines, the alpha
// of vertex colors and vertices without joints are counted in the document's warnings. The mesh is
// deformed as at the start; tangents are left out, because the directions of normal maps follow
// from texture coordinates. Throws as the accessors do, and badScene where attributes differ in
// length.
std::vector<Mesh> readGltfMesh(const GltfDocument& document, std::size_t mesh,
                               const std::vector<GltfMaterial>& materials,
                               const GltfDeformation& deformation = {});

}  // namespace whit
