// Trees, alone and in forests.
#pragma once

#include <cstdint>
#include <string>

#include "scene/mesh.h"
#include "scene/shape.h"

namespace whit::procedural {

struct TreePlan {
  std::string kind = "broadleaf";   // or "conifer"
  std::string leafStyle = "quads";  // "quads" for an alpha mask, "diamonds" solid, "blobs" solid
  double height = 8;
  int levels = 4;          // of branching
  int leaves = 1500;       // leaves, or blobs
  double leafSize = 0.35;  // of a leaf; blobs are eight times as big
  std::uint32_t seed = 1;
};

// Reads kind, leafStyle, treeHeight (or height), levels, leaves, leafSize and seed.
TreePlan readTree(ShapeParameters& parameters, const std::string& heightKey, std::uint32_t seed);

struct TreeMeshes {
  Mesh bark, leaves;
};

TreeMeshes buildTree(const TreePlan& plan);

}  // namespace whit::procedural
