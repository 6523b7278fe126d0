// Compressed meshes of a glTF file: KHR_draco_mesh_compression. A build without libdraco does not
// know this extension.
#pragma once

#include <map>
#include <string>

#include "io/gltf/document.h"

namespace whit {

// The elements of all accessors without a buffer view that primitives compressed by Draco stand
// for, by the accessors' pointers, tightly packed and of the accessors' own types. Draco's decoder
// runs in a process of its own (runConfined), because damaged data can break it. Throws badScene
// "file#/meshes/i/primitives/k/..." where that decoder fails.
std::map<std::string, std::string> decodeDraco(const GltfDocument& document);

}  // namespace whit
