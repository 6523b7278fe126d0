// Vertex normals for meshes whose files have none.
#pragma once

#include <string>

#include "io/memory_budget.h"
#include "scene/mesh.h"

namespace whit {

// Edges between faces that meet at a larger angle stay hard where a file has no normals.
inline constexpr float kSmoothestDegrees = 35;

// Gives each corner of the triangles the mean of the normals of the faces around it, weighted by
// their angles there, so that it does not depend on how polygons were split (Thürmer and Wüthrich
// 1998). Faces at an angle of more than kSmoothestDegrees to the corner's own are left out.
// Vertices at the same position count as one, and those whose corners have different normals are
// split. A mesh in which no edge becomes smooth stays as it is: flat.
void smoothNormals(Mesh& mesh, const std::string& file, MemoryBudget& budget);

}  // namespace whit
