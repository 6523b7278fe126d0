// The generators by family. What each parameter means stands beside the call that reads it.
#pragma once

#include "scene/shape.h"

namespace whit::procedural {

// round.cpp: turned and tessellated solids about the y axis, centered on the origin.
Shape makeSphere(ShapeParameters& parameters);
Shape makeIcosphere(ShapeParameters& parameters);
Shape makeCylinder(ShapeParameters& parameters);
Shape makeCone(ShapeParameters& parameters);
Shape makeTorus(ShapeParameters& parameters);
Shape makeTube(ShapeParameters& parameters);
Shape makeDisc(ShapeParameters& parameters);

// flat.cpp: plane faces, no normals.
Shape makeQuad(ShapeParameters& parameters);
Shape makeGrid(ShapeParameters& parameters);
Shape makeBox(ShapeParameters& parameters);
Shape makeRoundedBox(ShapeParameters& parameters);
Shape makeStairs(ShapeParameters& parameters);

// vessels.cpp: standing on y = 0.
Shape makeVase(ShapeParameters& parameters);
Shape makeTumbler(ShapeParameters& parameters);

// column.cpp, wall.cpp, colonnade.cpp, vault.cpp: architecture, in units of metres, on y = 0.
Shape makeColumn(ShapeParameters& parameters);
Shape makeWall(ShapeParameters& parameters);
Shape makeArch(ShapeParameters& parameters);
Shape makeColonnade(ShapeParameters& parameters);
Shape makeBalustrade(ShapeParameters& parameters);
Shape makeVault(ShapeParameters& parameters);
Shape makeCornice(ShapeParameters& parameters);

// cloth.cpp: sheets without thickness.
Shape makeCurtain(ShapeParameters& parameters);
Shape makeCanopy(ShapeParameters& parameters);

// terrain.cpp, tree.cpp, plant.cpp
Shape makeTerrain(ShapeParameters& parameters);
Shape makeTree(ShapeParameters& parameters);
Shape makeForest(ShapeParameters& parameters);
Shape makePlant(ShapeParameters& parameters);
Shape makeRock(ShapeParameters& parameters);

}  // namespace whit::procedural
