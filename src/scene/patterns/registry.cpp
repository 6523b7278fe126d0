#include "scene/patterns/generators.h"
#include "scene/shape.h"

namespace whit {

const std::map<std::string, PatternGenerator>& patternGenerators() {
  using namespace procedural;
  static const std::map<std::string, PatternGenerator> generators{
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
