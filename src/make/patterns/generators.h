// The patterns by family. What a parameter means stands beside the call that reads it.
#pragma once

#include "make/shape.h"

namespace whit::procedural {

using MakePattern = Texture(ShapeParameters& parameters);

// simple.cpp
MakePattern makeChecker, makeStripes, makeFabric, makeLeafMask, makeFrondMask, makeLeaf;

// masonry.cpp: the normals take the same layout parameters as the colors.
MakePattern makeBricks, makeBrickNormals, makeTiles, makeTileNormals, makeRoof, makeRoofNormals;

// stone.cpp
MakePattern makeNoise, makePlaster, makePlasterNormals, makeMarble, makeWood;

}  // namespace whit::procedural
