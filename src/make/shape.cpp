#include "make/shape.h"

namespace whit {

const std::map<std::string, ShapeGenerator*>& shapeGenerators() {
  using namespace procedural;
  static const std::map<std::string, ShapeGenerator*> generators{
      {"arch", makeArch},
      {"balustrade", makeBalustrade},
      {"box", makeBox},
      {"canopy", makeCanopy},
      {"colonnade", makeColonnade},
      {"column", makeColumn},
      {"cone", makeCone},
      {"cornice", makeCornice},
      {"curtain", makeCurtain},
      {"cylinder", makeCylinder},
      {"disc", makeDisc},
      {"forest", makeForest},
      {"icosphere", makeIcosphere},
      {"plant", makePlant},
      {"quad", makeQuad},
      {"rock", makeRock},
      {"roundedBox", makeRoundedBox},
      {"sphere", makeSphere},
      {"stairs", makeStairs},
      {"terrain", makeTerrain},
      {"torus", makeTorus},
      {"tree", makeTree},
      {"tumbler", makeTumbler},
      {"vase", makeVase},
      {"vault", makeVault},
      {"wall", makeWall},
  };
  return generators;
}

const std::map<std::string, PatternGenerator*>& patternGenerators() {
  using namespace procedural;
  static const std::map<std::string, PatternGenerator*> generators{
      {"bricks", makeBricks},
      {"bricksNormals", makeBrickNormals},
      {"checker", makeChecker},
      {"fabric", makeFabric},
      {"frondMask", makeFrondMask},
      {"leaf", makeLeaf},
      {"leafMask", makeLeafMask},
      {"marble", makeMarble},
      {"noise", makeNoise},
      {"plaster", makePlaster},
      {"plasterNormals", makePlasterNormals},
      {"roof", makeRoof},
      {"roofNormals", makeRoofNormals},
      {"stripes", makeStripes},
      {"tiles", makeTiles},
      {"tilesNormals", makeTileNormals},
      {"wood", makeWood},
  };
  return generators;
}

}  // namespace whit
