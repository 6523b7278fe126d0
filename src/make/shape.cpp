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

}  // namespace whit
