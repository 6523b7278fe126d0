// Compressed meshes of a glTF file: KHR_draco_mesh_compression, EXT_meshopt_compression. A build
// without the library of an extension does not know it.
#pragma once

#include <map>
#include <string>

#include "io/gltf/document.h"

namespace whit {

// Decodes all buffer views that meshoptimizer has compressed, and all accessors without a buffer
// view that primitives compressed by Draco stand for, tightly packed and of the accessors' own
// types. Returns the bytes by the pointers of views and accessors. Throws badScene
// "file#/bufferViews/i/..." or "file#/meshes/i/primitives/k/..." where that fails.
std::map<std::string, std::string> decodeCompressed(const GltfDocument& document);

}  // namespace whit
