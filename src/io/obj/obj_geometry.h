// OBJ files: the faces.
#pragma once

#include <vector>

#include "core/warnings.h"
#include "io/memory_budget.h"
#include "io/obj/obj_text.h"
#include "scene/mesh.h"

namespace whit {

// Parses the text into at most two meshes, of the faces with normals at every corner and of those
// without; corners that agree in position, texture coordinates and normal share a vertex.
// Mesh::materials are indices into the summary's materials; the number behind the last stands for
// faces without any. Faces with fewer than three corners or an index out of range are left out and
// counted, texture coordinates and normals out of range are ignored and counted. Throws
// Error(limit) beyond `budget`.
std::vector<Mesh> readObjGeometry(ObjText& text, MemoryBudget& budget, Warnings& warnings);

}  // namespace whit
