// The node tree of a glTF document: what stands where. glTF 2.0 specification, section 3.5;
// KHR_lights_punctual, EXT_mesh_gpu_instancing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "core/affine.h"
#include "io/gltf/animation.h"
#include "io/gltf/deformation.h"
#include "io/gltf/document.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/rig.h"

namespace whit {

inline constexpr int kGltfDepthLimit = 256;

// Radiometric units: KHR_lights_punctual gives candela, and a watt is taken for 683 lumens, as
// Blender's exporter does, so that an exported lamp of P watts has P / (4 pi) W/sr again. Likewise
// lux and W/m^2 of directional lights.
inline constexpr double kLumensPerWatt = 683;

// The nodes that move, a parent before its children. Meshes, cameras and lights refer to their node
// by index; kNoNode stands for the scene.
struct GltfPlacedMesh {
  std::size_t mesh = 0;
  Affine toMover;  // of a skinned mesh the identity: its joints place it
  std::uint32_t mover = kNoNode;
  GltfDeformation deformation;
  std::size_t node = 0;  // that shows it
};

struct GltfStage {
  Rig movers;
  std::vector<GltfPlacedMesh> meshes;  // in the order of the tree
  std::vector<Camera> cameras;
  std::vector<std::uint32_t> cameraMovers;
  double aspect = 0;  // of the first camera; 0: none is given
  std::vector<Light> lights;
  std::vector<std::uint32_t> lightMovers;
};

// Places the nodes of the default scene, else of the first one, else all nodes. Nodes that flatten
// space are left out with what they hold; the ranges of lights are left out; rotations are
// normalized; skins that cannot be read are not applied: each is counted in the document's
// warnings. Cameras have names of their own. `tracks`, one a node, go before what nodes say
// themselves; nodes that are `movable`
// ("/nodes/i") move always. Throws badScene "file#/nodes/i" where the nodes are no tree or deeper
// than kGltfDepthLimit.
GltfStage readGltfNodes(const GltfDocument& document, const std::vector<GltfTracks>& tracks,
                        const std::set<std::string>& movable);

}  // namespace whit
