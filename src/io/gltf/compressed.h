// Compressed parts of a glTF file: KHR_draco_mesh_compression, EXT_meshopt_compression and
// KHR_meshopt_compression. A build without their libraries does not know these extensions.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "io/gltf/document.h"

namespace whit {

// The content of a buffer view that is compressed by meshoptimizer; none where it is not. Throws as
// GltfDocument::view() does, and badScene where the data are damaged.
std::optional<std::string> decodeMeshopt(const GltfDocument& document, const JsonValue& view);

// The elements of all accessors without a buffer view that primitives compressed by Draco stand
// for, by the accessors' pointers, tightly packed and of the accessors' own types. Draco's decoder
// runs in a process of its own (runConfined), because damaged data can break it. Throws badScene
// "file#/meshes/i/primitives/k/..." where that decoder fails.
std::map<std::string, std::string> decodeDraco(const GltfDocument& document);

}  // namespace whit
