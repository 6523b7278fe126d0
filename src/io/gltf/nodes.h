// The node tree of a glTF document, its animations, and the places of its meshes with their skins.
// glTF 2.0 specification, sections 3.5, 3.7.2, 3.7.3, 3.11 and 5.24; KHR_lights_punctual,
// EXT_mesh_gpu_instancing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/affine.h"
#include "io/gltf/document.h"
#include "scene/description.h"

namespace whit {

inline constexpr int kGltfDepthLimit = 256;

// Radiometric units: KHR_lights_punctual gives candela, and a watt is taken for 683 lumens, as
// Blender's exporter does, so that an exported lamp of P watts has P / (4 pi) W/sr again. Likewise
// lux and W/m^2 of directional lights.
inline constexpr double kLumensPerWatt = 683;

// A mesh of the file and the node that shows it.
struct GltfPlacedMesh {
  std::size_t mesh = 0;
  Affine toMover;  // identity for a skinned mesh: its joints place it
  std::uint32_t mover = kNoNode;
  Deformation deformation;  // only weights, skeleton and joints are set; the mesh has the rest
  std::size_t node = 0;     // node that shows it

  bool isDeformed() const;
};

// A camera or a light, which looks along the -z axis of its own space. GltfModel::addView() places
// it, because the origin of the scene has to be known then.
template <typename Thing>
struct GltfPlaced {
  Thing thing;
  Affine toMover;
  std::uint32_t mover = kNoNode;
};

// Holds everything that the nodes of a file place in the scene.
struct GltfContent {
  // The nodes that move, a parent before its children. Meshes, cameras and lights refer to their
  // node by index; kNoNode stands for the scene.
  Rig movers;
  std::vector<GltfPlacedMesh> meshes;  // meshes in the order of the tree
  std::vector<GltfPlaced<Camera>> cameras;
  double aspect = 0;  // aspect ratio of the first camera; 0: none is given
  std::vector<GltfPlaced<Light>> lights;
};

// Returns the animations of the file, under distinct names.
std::vector<Animation> listGltfAnimations(const GltfDocument& document);

// Places the nodes of the default scene, else of the first one, else all nodes. Nodes that flatten
// space are left out with their content, and so are the ranges of lights: each is counted in the
// document's warnings. Rotations are normalized. Cameras have distinct names. The tracks
// of the animation that `instant` plays replace the properties of their nodes; the nodes
// `instant.movable` ("/nodes/i") always move. Throws badScene "file#/nodes/i" where the nodes are
// no tree or deeper than kGltfDepthLimit, and "file#/animations/i/..." where the animation is
// broken.
GltfContent readGltfNodes(const GltfDocument& document, const Instant& instant);

}  // namespace whit
