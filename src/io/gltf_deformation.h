// Meshes that bend: morph targets and skins of a glTF document. glTF 2.0 specification, sections
// 3.7.2.2 and 3.7.3.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/affine.h"
#include "io/gltf_document.h"
#include "scene/mesh.h"

namespace whit {

// How a node bends its mesh.
struct GltfDeformation {
  std::vector<double> weights;  // of morph targets; those that are missing are zero
  std::vector<Affine> joints;   // from the mesh as it was modelled to the scene; none: no skin

  // Whether the mesh stays as it was modelled.
  bool none() const;
};

// Moves positions and normals of the primitive's mesh: by its morph targets, then by its joints,
// rounded once at the end. Normals come out as unit vectors. Tangents are left out: the directions
// of normal maps follow from texture coordinates. Counted in the document's warnings: targets that
// cannot be read, which are left out; vertices that no joint holds, which stay where they were
// modelled. Weights of joints are scaled to the sum 1. Throws as the accessors do, and badScene
// where attributes differ in length.
void deform(const GltfDocument& document, const tinygltf::Primitive& primitive,
            const GltfDeformation& deformation, const std::string& where, Mesh& mesh);

}  // namespace whit
