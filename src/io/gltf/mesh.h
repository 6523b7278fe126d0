// Meshes of a glTF document. glTF 2.0 specification, sections 3.7.2 and 5.24.
#pragma once

#include <cstddef>
#include <vector>

#include "io/gltf/deformation.h"
#include "io/gltf/document.h"
#include "io/gltf/material.h"
#include "scene/mesh.h"

namespace whit {

// One Mesh for each of its primitives that are triangles, strips or fans, with its only material:
// an index into `materials`, whose last entry is that of primitives without one. Texture
// coordinates are those of the material, with its transforms applied, v pointing up. Points, lines,
// the alpha of vertex colors are counted in the document's warnings. Comes bent as `deformation`
// says. Throws as the accessors do, and badScene where the attributes of a primitive differ in
// length.
std::vector<Mesh> readGltfMesh(const GltfDocument& document, std::size_t mesh,
                               const std::vector<GltfMaterial>& materials,
                               const GltfDeformation& deformation = {});

}  // namespace whit
