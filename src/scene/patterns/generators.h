// The patterns by family. What a parameter means stands beside the call that reads it.
#pragma once

#include "scene/shape.h"

namespace whit::procedural {

// simple.cpp
Texture makeChecker(ShapeParameters& parameters);
Texture makeStripes(ShapeParameters& parameters);
Texture makeFabric(ShapeParameters& parameters);
Texture makeLeafMask(ShapeParameters& parameters);
Texture makeFrondMask(ShapeParameters& parameters);
Texture makeLeaf(ShapeParameters& parameters);

// masonry.cpp: the normals take the same layout parameters as the colors.
Texture makeBricks(ShapeParameters& parameters);
Texture makeBrickNormals(ShapeParameters& parameters);
Texture makeTiles(ShapeParameters& parameters);
Texture makeTileNormals(ShapeParameters& parameters);
Texture makeRoof(ShapeParameters& parameters);
Texture makeRoofNormals(ShapeParameters& parameters);

// stone.cpp
Texture makeNoise(ShapeParameters& parameters);
Texture makePlaster(ShapeParameters& parameters);
Texture makePlasterNormals(ShapeParameters& parameters);
Texture makeMarble(ShapeParameters& parameters);
Texture makeWood(ShapeParameters& parameters);

}  // namespace whit::procedural
