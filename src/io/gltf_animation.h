// Animations of a glTF document: where they put its nodes. glTF 2.0 specification, section 3.11.
#pragma once

#include <vector>

#include "io/gltf_document.h"
#include "scene/animation.h"

namespace whit {

// What an animation sets of a node; empty: what the node itself has.
struct GltfPose {
  std::vector<double> translation, rotation, scale;  // 3, 4 (x, y, z, w) and 3
  std::vector<double> weights;                       // of its mesh's morph targets
};

// By distinct names.
std::vector<Animation> listGltfAnimations(const GltfDocument& document);

// Of each node, at the instant; all empty where no time is given or the document has no such
// animation. Throws badScene "file#/animations/i/..." where the animation that is asked for is
// broken: times that do not increase or are none, another number of values than of times.
std::vector<GltfPose> poseGltf(const GltfDocument& document, const Instant& instant);

}  // namespace whit
