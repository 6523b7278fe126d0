// Meshes that bend: morph targets and skins of a glTF document. glTF 2.0 specification, sections
// 3.7.2.2 and 3.7.3.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "io/gltf/document.h"
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

// Deforms the primitive's mesh as it is at the start, and gives it the deformation where that
// depends on time. Tangents are left out: the directions of normal maps follow from texture
// coordinates. Vertices that no joint holds stay where they were modelled and are counted in the
// document's warnings. Throws as the accessors do, and badScene where attributes differ in length.
void deform(const GltfDocument& document, const GltfValue& primitive,
            const GltfDeformation& deformation, Mesh& mesh);

}  // namespace whit
