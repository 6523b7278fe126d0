// Meshes that bend: morph targets, and skins by linear blending (Magnenat-Thalmann, Laperriere and
// Thalmann 1988; glTF 2.0 specification, sections 3.7.2.2 and 3.7.3).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/affine.h"
#include "core/vec3.h"
#include "scene/motion.h"

namespace whit {

struct MorphTarget {
  std::vector<Vec3f> positions, normals;  // by how much each is moved; empty: not at all
};

// A joint's share in a vertex. The weights of a vertex are scaled to the sum 1.
struct Influence {
  std::uint32_t joint = 0;
  double weight = 0;
};

struct Deformation {
  std::vector<Vec3f> positions, normals;  // as they were modelled; of all or none a normal
  std::vector<MorphTarget> targets;
  std::vector<double> weights;          // of targets; those that are missing are zero
  std::optional<Track> movingWeights;   // in place of them
  std::shared_ptr<const Rig> skeleton;  // none: no skin
  struct Joint {
    std::uint32_t node = 0;  // of the skeleton
    Affine fromMesh;         // from the mesh as it was modelled to the joint's own space
  };
  std::vector<Joint> joints;
  // Vertex i has the influences from firstInfluence[i] to firstInfluence[i + 1], at least one.
  std::vector<std::uint32_t> firstInfluence;
  std::vector<Influence> influences;

  bool hasSkin() const { return skeleton != nullptr; }
  // True if the shape depends on time.
  bool moves() const;
};

struct DeformedVertices {
  std::vector<Vec3f> positions, normals;  // rounded once; normals of unit length, or zero
  // -1 for each vertex that the skin mirrors, 1 for the others; empty without a skin.
  std::vector<double> sides;
};
// True if a skin mirrors more than one corner of a triangle. Its corners then run the other way
// round, and corners 1 and 2 change places.
bool turnsOver(const std::vector<double>& sides, const std::array<std::uint32_t, 3>& corners);

// Weights and joint transforms at one time.
struct DeformationPose {
  std::vector<double> weights;  // of targets
  std::vector<Affine> joints;   // from the mesh as it was modelled
};
DeformationPose poseAt(const Deformation& deformation, double seconds);

// Morph targets first, then joints. The scalar reference of simd/deform_vertices.h.
DeformedVertices deformVertices(const Deformation& deformation, const DeformationPose& pose);
using DeformVertices = DeformedVertices (*)(const Deformation&, const DeformationPose&);

}  // namespace whit
