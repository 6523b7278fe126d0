// The generators by family. What each parameter means stands beside the call that reads it.
#pragma once

#include "make/shape.h"

namespace whit::procedural {

using MakeShape = Shape(ShapeParameters& parameters);

// solids.cpp: turned and tessellated solids about the y axis, centered on the origin.
MakeShape makeSphere, makeIcosphere, makeCylinder, makeCone, makeTorus, makeDisc;

// Replaces exact spheres by triangles: `segments` around, half as many from pole to pole.
void tessellateSpheres(Mesh& mesh, int segments);

// solids.cpp: plane faces, no normals.
MakeShape makeQuad, makeBox, makeRoundedBox, makeStairs;

// vessels.cpp: standing on y = 0.
MakeShape makeVase, makeTumbler;

// architecture.cpp, vault.cpp: in units of metres, on y = 0.
MakeShape makeColumn, makeWall, makeArch, makeColonnade, makeBalustrade, makeVault, makeCornice;

// cloth.cpp: sheets without thickness.
MakeShape makeCurtain, makeCanopy;

// terrain.cpp, plants.cpp
MakeShape makeTerrain, makeTree, makeForest, makePlant, makeRock;

}  // namespace whit::procedural
