// Animations of a glTF document: where they put its nodes. glTF 2.0 specification, section 3.11.
#pragma once

#include <optional>
#include <vector>

#include "io/gltf/document.h"
#include "scene/animation.h"
#include "scene/track.h"

namespace whit {

// What an animation moves of a node; none: it stays as the node itself has it.
struct GltfTracks {
  std::optional<Track> translation, rotation, scale;  // 3, 4 (x, y, z, w) and 3 components
  std::optional<Track> weights;                       // of its mesh's morph targets

  bool place() const { return translation || rotation || scale; }
};

// By distinct names.
std::vector<Animation> listGltfAnimations(const GltfDocument& document);

// Of each node; none where nothing is to move or the document has no such animation. Throws
// badScene "file#/animations/i/..." where the animation that is asked for is broken: times that do
// not increase or are none, another number of values than of times.
std::vector<GltfTracks> readGltfTracks(const GltfDocument& document, const Instant& instant);

}  // namespace whit
