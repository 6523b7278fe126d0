#include "scene/generation_limit.h"
#include "scene/patterns/noise.h"
#include "scene/shapes/generators.h"
#include "scene/shapes/terrain.h"
#include "scene/shapes/tree.h"

namespace whit::procedural {
namespace {

// Groves: trees gather where this noise is high.
double densityAt(std::uint32_t seed, double x, double z, double size) {
  return 0.5 + 0.5 * fractalNoise(seed, 7 * x / size, 7 * z / size, 3);
}

struct Habitat {
  double lowest, highest, steepest, clearing;
  Vec3d clearingAt;
};

Habitat readHabitat(ShapeParameters& parameters, double size) {
  Habitat h{};
  h.lowest = parameters.number("lowest", 0.004 * size, -1e7, 1e7);
  h.highest = parameters.number("highest", 0.09 * size, -1e7, 1e7);
  h.steepest = parameters.number("steepest", 0.75, 0, 1);  // least y of the normal
  h.clearing = parameters.number("clearing", 0, 0, 1e7);   // radius without trees
  h.clearingAt = parameters.vector("clearingAt", {0, 0, 0});
  return h;
}

}  // namespace

// One tree and the places of its copies on the ground of a `terrain` with the same seed, size,
// height, valley and floor. As many as make up `triangles` when multiplied out, or `trees`.
// `forestSeed` tells forests on the same ground apart. Slots bark, leaves.
Shape makeForest(ShapeParameters& parameters) {
  const Ground ground(parameters);
  const auto seed = static_cast<std::uint32_t>(parameters.integer("forestSeed", 1, 0, 1 << 30));
  TreeMeshes tree = buildTree(readTree(parameters, "treeHeight", seed));
  const double triangles = parameters.number("triangles", 0, 0, 1e10);
  const double perTree =
      static_cast<double>(tree.bark.triangles.size() + tree.leaves.triangles.size());
  const double asked = parameters.number("trees", 200, 1, 1e7);
  const double wanted =
      triangles > 0 ? std::clamp(std::floor(triangles / perTree), 1.0, 1e7) : asked;
  const double size = ground.size();
  const Habitat habitat = readHabitat(parameters, size);
  Shape shape;
  shape.parts.push_back({"bark", std::move(tree.bark)});
  shape.parts.push_back({"leaves", std::move(tree.leaves)});
  RandomStream random(seed * 7919u + 3u);
  // Candidates that the ground refuses cost nothing but a few hashes; the bound ends the search on
  // ground that refuses nearly all of them, where the last resort is anywhere.
  const double tries = 60 * wanted;
  double tried = 0;
  while (static_cast<double>(shape.placements.size()) < wanted) {
    const double x = random.between(-0.49, 0.49) * size, z = random.between(-0.49, 0.49) * size;
    const double chance = random.next(), turnBy = random.between(0, 360);
    const double scale = random.between(0.75, 1.25), y = ground.height(x, z);
    if (++tried < tries) {
      const double away = std::hypot(x - habitat.clearingAt.x, z - habitat.clearingAt.z);
      if (away < habitat.clearing || y < habitat.lowest || y > habitat.highest) continue;
      if (ground.normal(x, z, 0.004 * size).y < habitat.steepest) continue;
      if (chance > smoothStep(0.35, 0.65, densityAt(seed + 3, x, z, size)) + 0.04) continue;
    }
    // A little below the ground, which is coarser as a mesh than as a function.
    const double sink = 0.02 * scale;
    GenerationLimit::charge(1, sizeof(Affine));
    shape.placements.push_back(Affine::translation({x, y - sink, z}) *
                               Affine::rotation({0, 1, 0}, turnBy) *
                               Affine::scaling({scale, scale, scale}));
  }
  return shape;
}

}  // namespace whit::procedural
