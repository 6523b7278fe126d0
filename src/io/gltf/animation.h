// Animations of a glTF document: where they put its nodes. glTF 2.0 specification, section 3.11.
#pragma once

#include <optional>
#include <vector>

#include "io/gltf/document.h"
#include "scene/animation.h"
#include "scene/track.h"

namespace whit {

// Animated properties of a node. Properties without a track keep the value of the node itself.
struct GltfTracks {
  std::optional<Track> translation, rotation, scale;  // 3, 4 (x, y, z, w) and 3 components
  std::optional<Track> weights;                       // of its mesh's morph targets

  bool place() const { return translation || rotation || scale; }
};

// The names are distinct.
std::vector<Animation> listGltfAnimations(const GltfDocument& document);

// One element for each node, without tracks unless `instant` plays an animation of the document.
// Throws badScene "file#/animations/i/..." where the animation that is played is broken: times that
// are missing or do not increase, or another number of values than the times demand.
std::vector<GltfTracks> readGltfTracks(const GltfDocument& document, const Instant& instant);

}  // namespace whit
