// The scalar reference of one vector step: one row of what the step has written into its chunk,
// computed again in double from what the step has read. The function has the name of its stage and
// is in its file.
#pragma once

#include "bake/mip_maps.h"
#include "reference/intersector.h"
#include "reference/surfel.h"
#include "stages/chunk.h"
#include "stages/rows.h"

namespace whit::reference {

// The inputs of reference functions besides their chunk: the scene, of which kernels have float
// tables.
struct World {
  const Scene& scene;
  EffectSet effects;              // of the plan
  const MipMaps* maps = nullptr;  // of the scene, where lookups are trilinear
  CameraFrame camera;
  const Intersector& intersector;  // for shadow rays and what surrounds the eye
};

// Slots of the chunk's columns in the reference's own terms.
Ray rayOf(const Chunk& chunk, std::size_t slot);
Candidate candidateOf(const Chunk& chunk, std::size_t slot);
Surfel surfelOf(const Chunk& chunk, std::size_t slot);
std::uint32_t mediaOf(const Chunk& chunk, std::size_t slot);  // around the ray
std::uint32_t alsoCrossedAt(const Chunk& chunk, std::size_t slot);
bool isHidden(const Chunk& chunk, std::size_t slot);

// Into three columns of a row.
inline void put(const Vec3d& v, double& x, double& y, double& z) { x = v.x, y = v.y, z = v.z; }

}  // namespace whit::reference
