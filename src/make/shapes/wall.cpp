#include "make/shapes/architecture.h"

#include "make/shapes/generators.h"
#include "make/shapes/mesh_builder.h"

namespace whit::procedural {
namespace {

// A pier from floor to top, cut at the levels that its neighbors have corners at.
void addPier(std::vector<PlanCell>& cells, const std::vector<double>& levels, double x0,
             double x1) {
  if (!(x1 > x0)) return;
  for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
    if (levels[k + 1] > levels[k]) cells.push_back(rectangle(x0, levels[k], x1, levels[k + 1]));
  }
}

void addOpening(std::vector<PlanCell>& cells, const WallPlan& plan, double a, double b) {
  if (plan.sill > 0) cells.push_back(rectangle(a, 0, b, plan.sill));
  const int n = plan.rise > 0 ? plan.segments : 1;
  const double half = (b - a) / 2;
  const auto arc = [&](int k) {
    if (k == 0) return PlanPoint{a, plan.spring};
    if (k == n) return PlanPoint{b, plan.spring};
    const TurnPoint t = turn(k, 2 * n);
    return PlanPoint{a + half * (1 - t.cosine), plan.spring + plan.rise * t.sine};
  };
  for (int k = 0; k < n; ++k) {
    const PlanPoint p = arc(k), q = arc(k + 1);
    cells.push_back({{p, q, {q[0], plan.height}, {p[0], plan.height}}});
  }
}

}  // namespace

Mesh buildWall(const WallPlan& plan) {
  std::vector<PlanCell> cells;
  const std::vector<double> levels{0, plan.sill, plan.spring, plan.height};
  const double left = -0.5 * plan.bays * plan.spacing;
  const auto boundary = [&](int bay) { return left + bay * plan.spacing; };
  addPier(cells, levels, boundary(0) - plan.margin, boundary(0));
  for (int bay = 0; bay < plan.bays; ++bay) {
    const double middle = 0.5 * (boundary(bay) + boundary(bay + 1));
    const double a = middle - plan.openingWidth / 2, b = middle + plan.openingWidth / 2;
    addPier(cells, levels, boundary(bay), a);
    addOpening(cells, plan, a, b);
    addPier(cells, levels, b, boundary(bay + 1));
  }
  addPier(cells, levels, boundary(plan.bays), boundary(plan.bays) + plan.margin);
  return extrude(cells, -plan.depth / 2, plan.depth / 2, plan.uvRepeat);
}

Shape makeWall(ShapeParameters& parameters) {
  WallPlan plan;
  plan.spacing = parameters.number("spacing", plan.spacing, 1e-3, 1e6);
  plan.bays = parameters.integer("bays", plan.bays, 1, 10000);
  plan.height = parameters.number("height", plan.height, 1e-3, 1e6);
  plan.depth = parameters.number("depth", plan.depth, 1e-3, 1e6);
  plan.margin = parameters.number("margin", 0, 0, 1e6);
  plan.openingWidth =
      parameters.number("openingWidth", 0.4 * plan.spacing, 1e-3, 0.999 * plan.spacing);
  plan.spring = parameters.number("spring", 0.5 * plan.height, 1e-3, 0.999 * plan.height);
  plan.sill = parameters.number("sill", 0, 0, 0.999 * plan.spring);
  const double room = 0.999 * (plan.height - plan.spring);
  plan.rise = parameters.number("rise", std::min(plan.openingWidth / 2, room), 0, room);
  plan.segments = parameters.integer("segments", plan.segments, 2, 4096);
  plan.uvRepeat = parameters.number("uvRepeat", plan.uvRepeat, 1e-6, 1e9);
  return singlePart(buildWall(plan));
}

// The ring of stones around an arched opening, standing on y = 0.
Shape makeArch(ShapeParameters& parameters) {
  const double width = parameters.number("width", 2, 1e-3, 1e6);
  const double rise = parameters.number("rise", width / 2, 1e-3, 1e6);
  const double thickness = parameters.number("thickness", 0.15 * width, 1e-4, 1e6);
  const double depth = parameters.number("depth", 0.4, 1e-4, 1e6);
  const int segments = parameters.integer("segments", 32, 2, 4096);
  const double repeat = parameters.number("uvRepeat", 1, 1e-6, 1e9);
  const double half = width / 2;
  return singlePart(
      extrude(halfRing({0, 0}, {half, rise}, {half + thickness, rise + thickness}, segments),
              -depth / 2, depth / 2, repeat));
}

}  // namespace whit::procedural
