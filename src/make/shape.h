// Procedural shapes and patterns: what a scene file can ask for without any model or image file.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/affine.h"
#include "scene/mesh.h"
#include "scene/texture.h"

namespace whit {

// The source of a generator's parameters. Each call names a key, its default, and the range that is
// accepted. The implementation reports a value of the wrong kind or range by its place in the scene
// file, and afterwards any key that no generator has asked for.
class ShapeParameters {
 public:
  virtual ~ShapeParameters() = default;
  virtual double number(const std::string& key, double fallback, double low, double high) = 0;
  virtual int integer(const std::string& key, int fallback, int low, int high) = 0;
  virtual bool flag(const std::string& key, bool fallback) = 0;
  virtual Vec3d vector(const std::string& key, const Vec3d& fallback) = 0;
  // Linear RGB; a reader may take one number for a gray.
  virtual Vec3d color(const std::string& key, const Vec3d& fallback) {
    return vector(key, fallback);
  }
  virtual std::string word(const std::string& key, const std::string& fallback,
                           const std::vector<std::string>& choices) = 0;
  double length(const std::string& key, double fallback) {
    return number(key, fallback, 1e-3, 1e6);
  }
  // Reads how many units of length a texture covers.
  double repeat(double fallback = 1) { return number("uvRepeat", fallback, 1e-6, 1e9); }
  std::uint32_t seed(const std::string& key = "seed") {
    return static_cast<std::uint32_t>(integer(key, 1, 0, 1 << 30));
  }
};

// A generated part and the material slot it belongs to. Simple shapes have the single slot
// "surface"; a tree has "bark" and "leaves".
struct ShapePart {
  std::string slot = "surface";
  Mesh mesh;  // Mesh::materials is left empty; the reader fills it in
};

struct Shape {
  Shape() = default;
  template <typename... Parts>
  explicit Shape(ShapePart first, Parts... others) {
    parts.push_back(std::move(first));
    (parts.push_back(std::move(others)), ...);
  }

  std::vector<ShapePart> parts;
  // The places of copies in the shape's own space. Empty: one copy as it is.
  std::vector<Affine> placements;
};

using ShapeGenerator = Shape(ShapeParameters& parameters);
// Reads the parameters; the texels are made when they are needed.
using PatternGenerator = Texture(ShapeParameters& parameters);

// Returns all generators of shapes by the name used in scene files ("sphere", "terrain", ...).
const std::map<std::string, ShapeGenerator*>& shapeGenerators();
// Returns all generators of textures by name (patterns/patterns.cpp: "checker", "bricks", ...). The
// normals of a pattern are a pattern, too. The textures themselves have no names.
const std::map<std::string, PatternGenerator*>& patternGenerators();

namespace procedural {

// The generators by file. A comment beside the call that reads a parameter says what it means.
// shapes/solids.cpp: solids about the y axis and plane faces, centered on the origin.
ShapeGenerator makeSphere, makeIcosphere, makeCylinder, makeCone, makeTorus, makeDisc, makeQuad,
    makeBox, makeRoundedBox, makeStairs;
// shapes/architecture.cpp: standing on y = 0.
ShapeGenerator makeColumn, makeWall, makeArch, makeColonnade, makeBalustrade, makeVault,
    makeCornice;
// shapes/furnishing.cpp: vessels that stand on y = 0, and sheets without thickness.
ShapeGenerator makeVase, makeTumbler, makeCurtain, makeCanopy;
// shapes/landscape.cpp
ShapeGenerator makeTerrain, makeTree, makeForest, makePlant, makeRock;

// Replaces exact spheres by triangles: `segments` around, half as many from pole to pole.
void tessellateSpheres(Mesh& mesh, int segments);

}  // namespace procedural

}  // namespace whit
