#include "make/shapes/architecture.h"
#include "make/shapes/generators.h"
#include "make/shapes/mesh_builder.h"

namespace whit::procedural {
namespace {

struct ColonnadePlan {
  ColumnPlan column;
  int columns = 5;
  double spacing = 3;
  bool engaged = false;  // an arch more at each end, from the last column to a pier or wall
  bool arches = true;
  double wallAbove = 0.5;  // above the crown of the arches
  double wallDepth = 0.6;
};

void addWall(Shape& shape, const ColonnadePlan& plan) {
  const double width = plan.spacing - 2 * kAbacusHalf * plan.column.radius;
  WallPlan wall;
  wall.spacing = plan.spacing;
  wall.bays = plan.columns + (plan.engaged ? 1 : -1);
  wall.openingWidth = width;
  wall.rise = width / 2;
  // The arches begin a little above the abacus: a stilt that also keeps the wall in one piece.
  wall.spring = 0.1 * plan.spacing;
  wall.height = wall.spring + wall.rise + plan.wallAbove;
  wall.depth = plan.wallDepth;
  wall.margin = plan.engaged ? 0 : kAbacusHalf * plan.column.radius;
  wall.segments = 24;
  wall.uvRepeat = plan.column.uvRepeat;
  MeshBuilder walls, arches;
  const Affine up = Affine::translation({0, plan.column.height, 0});
  walls.append(buildWall(wall), up);
  const double thickness = 0.09 * width, lip = 0.012 * width;
  const Mesh ring = extrude(halfRing({0, wall.spring}, {width / 2 - lip, width / 2 - lip},
                                     {width / 2 + thickness, width / 2 + thickness}, wall.segments),
                            -wall.depth / 2 - 2 * lip, wall.depth / 2 + 2 * lip, wall.uvRepeat);
  for (int bay = 0; bay < wall.bays; ++bay) {
    const double x = (bay - 0.5 * (wall.bays - 1)) * plan.spacing;
    arches.append(ring, Affine::translation({x, plan.column.height, 0}));
  }
  shape.parts.push_back({"wall", walls.take("wall")});
  shape.parts.push_back({"arch", arches.take("arch")});
}

}  // namespace

// Columns in a row along x, in the middle of it at the origin; slots shaft, trim, wall, arch.
Shape makeColonnade(ShapeParameters& parameters) {
  ColonnadePlan plan;
  plan.columns = parameters.integer("columns", plan.columns, 1, 10000);
  plan.spacing = parameters.number("spacing", plan.spacing, 1e-3, 1e6);
  ColumnPlan& c = plan.column;
  c.radius = parameters.number("radius", 0.1 * plan.spacing, 1e-5, 0.3 * plan.spacing);
  c.height = parameters.number("height", 1.3 * plan.spacing, 4.5 * c.radius, 1e6);
  c.flutes = parameters.integer("flutes", c.flutes, 0, 256);
  c.segments = parameters.integer("segments", c.segments, 8, 4096);
  c.rings = parameters.integer("rings", c.rings, 1, 4096);
  c.leaves = parameters.integer("leaves", c.leaves, 0, 64);
  c.uvRepeat = parameters.number("uvRepeat", c.uvRepeat, 1e-6, 1e9);
  plan.engaged = parameters.flag("engaged", plan.engaged);
  plan.arches = parameters.flag("arches", plan.arches);
  plan.wallAbove = parameters.number("wallAbove", plan.wallAbove, 1e-3, 1e6);
  plan.wallDepth = parameters.number("wallDepth", 2 * c.radius, 1e-3, 1e6);
  const ColumnMeshes one = buildColumn(c);
  MeshBuilder shafts, trims;
  for (int k = 0; k < plan.columns; ++k) {
    const Affine place = Affine::translation({(k - 0.5 * (plan.columns - 1)) * plan.spacing, 0, 0});
    shafts.append(one.shaft, place);
    trims.append(one.trim, place);
  }
  Shape shape;
  shape.parts.push_back({"shaft", shafts.take("shaft")});
  shape.parts.push_back({"trim", trims.take("trim")});
  if (plan.arches && plan.columns + (plan.engaged ? 1 : -1) > 0) addWall(shape, plan);
  return shape;
}

// Turned posts between two rails along x, standing on y = 0: slots post, rail.
Shape makeBalustrade(ShapeParameters& parameters) {
  const int posts = parameters.integer("posts", 12, 1, 100000);
  const double length = parameters.number("length", 3, 1e-3, 1e6);
  const double height = parameters.number("height", 1, 1e-3, 1e6);
  const int segments = parameters.integer("segments", 12, 3, 4096);
  const double repeat = parameters.number("uvRepeat", 1, 1e-6, 1e9);
  const double low = 0.12 * height, high = 0.88 * height, depth = 0.11 * height;
  const double r = std::min(0.075 * height, 0.45 * length / posts);
  const std::vector<std::array<double, 2>> contour{
      {0.90, 0.00}, {0.90, 0.10}, {0.45, 0.14}, {0.55, 0.22}, {1.00, 0.34}, {0.92, 0.45},
      {0.55, 0.62}, {0.38, 0.78}, {0.55, 0.84}, {0.90, 0.88}, {0.90, 1.00}};
  std::vector<std::array<double, 2>> outline{{0, low}};
  for (const auto& p : contour) outline.push_back({p[0] * r, low + p[1] * (high - low)});
  outline.push_back({0, high});
  MeshBuilder one, all, rails;
  one.revolve(creasedProfile(outline, 50, repeat), segments);
  const Mesh post = one.take("post");
  for (int k = 0; k < posts; ++k) {
    all.append(post, Affine::translation({(k + 0.5) * length / posts - length / 2, 0, 0}));
  }
  rails.box({-length / 2, 0, -depth}, {length / 2, low, depth}, repeat);
  rails.box({-length / 2, high, -1.15 * depth}, {length / 2, height, 1.15 * depth}, repeat);
  Shape shape;
  shape.parts.push_back({"post", all.take("post")});
  shape.parts.push_back({"rail", rails.take("rail")});
  return shape;
}

}  // namespace whit::procedural
