// Buildings: walls, arches, columns, vaults.
#include <array>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "core/index.h"
#include "make/patterns/noise.h"
#include "make/shapes/mesh_builder.h"

namespace whit::procedural {

namespace {

// A solid is a plan in the x-y plane that is extruded along z.
using PlanPoint = std::array<double, 2>;
// Four corners, counter-clockwise. Cells meet edge to edge with equal coordinates; an edge that
// only one cell has belongs to the outline.
using PlanCell = std::array<PlanPoint, 4>;

using Edge = std::pair<PlanPoint, PlanPoint>;
constexpr double kCreaseCosine = 0.81915204428899178968;  // 35 degrees

// Returns the edges of cells that no other cell has in the opposite direction.
std::set<Edge> outlineOf(const std::vector<PlanCell>& plan) {
  std::set<Edge> edges;
  for (const PlanCell& cell : plan) {
    for (const auto k : indices(4)) {
      const PlanPoint &a = cell[k], &b = cell[(k + 1) % 4];
      if (a == b) continue;
      if (edges.erase({b, a}) == 0) edges.insert({a, b});
    }
  }
  return edges;
}

Vec3d outward(const Edge& e) {
  return normalized(Vec3d{e.second[1] - e.first[1], e.first[0] - e.second[0], 0});
}

void addSides(MeshBuilder& builder, const std::vector<PlanCell>& plan, double z0, double z1,
              double repeat) {
  const std::set<Edge> outline = outlineOf(plan);

  // At each corner of the outline one edge arrives and one leaves.
  std::map<PlanPoint, Vec3d> arriving, leaving;
  for (const Edge& edge : outline) {
    leaving[edge.first] = outward(edge);
    arriving[edge.second] = outward(edge);
  }

  // Normals are averaged at those corners of the outline that are not creases.
  const auto smoothed = [](const Vec3d& own, const Vec3d& neighbor) {
    return dot(own, neighbor) > kCreaseCosine ? own + neighbor : own;
  };

  for (const Edge& edge : outline) {
    const auto& [a, b] = edge;
    const Vec3d own = outward(edge);
    const Vec3d atA = smoothed(own, arriving[a]), atB = smoothed(own, leaving[b]);

    // Steep sides run their texture up, level ones along x.
    const bool steep = std::fabs(own.x) > std::fabs(own.y);
    const double facing = own.x > 0 ? -1 : 1;
    const auto uv = [&](const PlanPoint& p, double z) {
      return steep ? Uv{facing * z / repeat, p[1] / repeat} : Uv{p[0] / repeat, -z / repeat};
    };

    const auto corner = [&](const PlanPoint& p, double z, const Vec3d& normal) {
      return builder.vertex({{p[0], p[1], z}, normal, uv(p, z)});
    };

    const std::uint32_t q0 = corner(a, z1, atA), q1 = corner(a, z0, atA);
    const std::uint32_t q2 = corner(b, z0, atB), q3 = corner(b, z1, atB);
    builder.quad(q0, q1, q2, q3);
  }
}

// Returns the closed solid from z0 to z1. Side faces whose directions differ by less than 35
// degrees are smooth. A texture covers `repeat` units of length.
Mesh extrude(const std::vector<PlanCell>& plan, double z0, double z1, double repeat) {
  MeshBuilder builder;
  // The front lid is the plan itself; the back lid turns its cells around to face the other way.
  for (const bool front : {true, false}) {
    for (const PlanCell& cell : plan) {
      std::array<Vec3d, 4> corners;
      for (const auto k : indices(4)) corners[k] = {cell[k][0], cell[k][1], front ? z1 : z0};
      if (!front) std::swap(corners[1], corners[3]);
      builder.plate(corners, repeat);
    }
  }

  addSides(builder, plan, z0, z1, repeat);
  return builder.take("extrusion");
}

PlanCell rectangle(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
}

// Returns the cells of the half ring between two half ellipses over `center`.
std::vector<PlanCell> halfRing(PlanPoint center, PlanPoint inner, PlanPoint outer, int segments) {
  const auto at = [&](const PlanPoint& radii, int k) {
    const TurnPoint t = turn(k, 2 * segments);
    return PlanPoint{center[0] + radii[0] * t.cosine, center[1] + radii[1] * t.sine};
  };

  std::vector<PlanCell> cells;
  cells.reserve(segments);
  for (int k = 0; k < segments; ++k) {
    cells.push_back({at(inner, k), at(outer, k), at(outer, k + 1), at(inner, k + 1)});
  }
  return cells;
}

// A wall with a row of openings, in the x-y plane, centered on x = 0 and z = 0, standing on y = 0.
// makeWall() says what the members mean.
struct WallPlan {
  double spacing, height, depth, margin, openingWidth, spring, sill, rise, uvRepeat;
  int bays, segments;
};

// Adds a pier from floor to top, cut at the levels at which its neighbors have corners.
void addPier(std::vector<PlanCell>& cells, const std::vector<double>& levels, double x0,
             double x1) {
  if (!(x1 > x0)) return;
  for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
    if (levels[k + 1] > levels[k]) cells.push_back(rectangle(x0, levels[k], x1, levels[k + 1]));
  }
}

void addOpening(std::vector<PlanCell>& cells, const WallPlan& plan, double a, double b) {
  if (plan.sill > 0) cells.push_back(rectangle(a, 0, b, plan.sill));

  // The opening ends in half an ellipse, or in a straight lintel of one piece.
  const int n = plan.rise > 0 ? plan.segments : 1;
  const double half = (b - a) / 2;

  // Both ends are exact, so that they coincide with corners of the piers.
  const auto arc = [&](int k) {
    if (k == 0) return PlanPoint{a, plan.spring};
    if (k == n) return PlanPoint{b, plan.spring};

    const TurnPoint t = turn(k, 2 * n);
    return PlanPoint{a + half * (1 - t.cosine), plan.spring + plan.rise * t.sine};
  };

  // The wall above the opening stands on the arch and reaches up to the top.
  for (int k = 0; k < n; ++k) {
    const PlanPoint p = arc(k), q = arc(k + 1);
    cells.push_back({{p, q, {q[0], plan.height}, {p[0], plan.height}}});
  }
}

Mesh buildWall(const WallPlan& plan) {
  std::vector<PlanCell> cells;

  // Piers have corners at all heights at which openings have some.
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

// A classical column standing on y = 0: square plinth, moulded base, shaft with entasis and flutes,
// leafed bell and square abacus.
struct ColumnPlan {
  double radius, height, taper, uvRepeat;
  int flutes, segments, rings, leaves;
};

// Half the side of the abacus in parts of the radius. A wall above may rest on the abacus.
constexpr double kAbacusHalf = 1.5;
constexpr double kTaper = 0.14;

// Heights in parts of the radius.
constexpr double kPlinth = 0.35, kBase = 1.0, kCapital = 2.4, kAbacus = 0.35, kNeck = 0.16;

void addHalfRound(std::vector<std::array<double, 2>>& outline, double r, double y0, double y1) {
  constexpr int kSteps = 6;
  const double half = (y1 - y0) / 2;
  for (int k = 0; k <= kSteps; ++k) {
    const double a = std::numbers::pi * k / kSteps;
    outline.push_back({r + half * std::sin(a), y0 + half - half * std::cos(a)});
  }
}

void addBase(MeshBuilder& builder, const ColumnPlan& plan) {
  const double r = plan.radius;
  builder.box({-1.42 * r, 0, -1.42 * r}, {1.42 * r, kPlinth * r, 1.42 * r}, plan.uvRepeat);

  // The attic base: torus, hollow, torus. It starts inside the plinth.
  std::vector<std::array<double, 2>> outline{{0, 0.3 * r}, {1.22 * r, 0.3 * r}};
  addHalfRound(outline, 1.22 * r, kPlinth * r, 0.66 * r);
  outline.push_back({1.14 * r, 0.66 * r});
  outline.push_back({1.07 * r, 0.74 * r});
  outline.push_back({1.10 * r, 0.82 * r});
  addHalfRound(outline, 1.08 * r, 0.82 * r, kBase * r);
  outline.push_back({0, kBase * r});
  builder.revolve(creasedProfile(outline, 45, plan.uvRepeat), plan.segments, 4);
}

// Returns the radius of the capital's bell at t in [0, 1] from neck to abacus.
double bellRadius(const ColumnPlan& plan, double t) {
  return plan.radius * (0.86 + 0.10 * t + 0.34 * t * t * t);
}

void addLeaf(MeshBuilder& builder, const ColumnPlan& plan, double angle, double y0, double height,
             double bell, double halfWidth) {
  constexpr int kAcross = 4, kUp = 7;
  const double r = plan.radius;
  builder.smoothSheet(
      kAcross, kUp, false,
      [&](int i, int j) {
        const double s = 2.0 * i / kAcross - 1, t = static_cast<double>(j) / kUp;

        // The upper part of the leaf curls outwards and bends down.
        const double curl = std::max(0.0, t - 0.55) / 0.45;
        const double narrow =
            (1 - 0.55 * t * t * t) * (0.9 + 0.1 * std::cos(4 * std::numbers::pi * t));

        const double out =
            bellRadius(plan, bell * t) + r * (0.05 + 0.24 * curl * curl + 0.05 * std::fabs(s));
        const double a = angle + s * halfWidth * narrow;
        const double y = y0 + height * (t - 0.32 * curl * curl * curl);
        return Vec3d{out * std::cos(a), y, -out * std::sin(a)};
      },
      [&](int i, int j) {
        return Uv{0.3 * i / kAcross, 0.5 * static_cast<double>(j) / kUp};
      });
}

void addCapital(MeshBuilder& builder, const ColumnPlan& plan) {
  const double r = plan.radius, bottom = plan.height - kCapital * r;
  const double bellTop = plan.height - kAbacus * r, neckTop = bottom + kNeck * r;

  // The bell is turned about the axis, with a half round at its neck.
  std::vector<std::array<double, 2>> outline{{0, bottom}};
  addHalfRound(outline, 0.90 * r, bottom, neckTop);

  constexpr int kSteps = 10;
  for (int k = 0; k <= kSteps; ++k) {
    const double t = static_cast<double>(k) / kSteps;
    outline.push_back({bellRadius(plan, t), lerp(neckTop, bellTop, t)});
  }

  outline.push_back({0, bellTop});
  builder.revolve(creasedProfile(outline, 45, plan.uvRepeat), plan.segments, 4);

  // The abacus is a square slab that overlaps the top of the bell.
  const double a = kAbacusHalf * r;
  builder.box({-a, bellTop - 0.01 * r, -a}, {a, plan.height, a}, plan.uvRepeat);

  // Tall leaves rise in the gaps of a lower row of short leaves.
  const double bell = bellTop - neckTop;
  for (int k = 0; k < plan.leaves; ++k) {
    const double step = 2 * std::numbers::pi / plan.leaves;
    addLeaf(builder, plan, step * (k + 0.5), neckTop, 0.92 * bell, 0.92, 0.42 * step);
    addLeaf(builder, plan, step * k, neckTop, 0.55 * bell, 0.55, 0.46 * step);
  }
}

void addShaft(MeshBuilder& builder, const ColumnPlan& plan, int segments) {
  const double r = plan.radius, y0 = (kBase - 0.02) * r, y1 = plan.height - (kCapital - 0.02) * r;
  const auto radiusAt = [&](int i, int j) {
    const double t = static_cast<double>(j) / plan.rings;
    // Entasis: the shaft tapers slowly at its foot and faster above.
    double radius = r * (1 - plan.taper * std::pow(t, 1.7));

    if (plan.flutes > 0) {
      const double phase = static_cast<double>(i) * plan.flutes / segments;
      const double hollow = std::fabs(std::sin(std::numbers::pi * phase));

      // Flutes end round, short of base and capital.
      const double fade = std::min(1.0, 14 * std::min(t, 1 - t));
      radius -= 0.085 * r * hollow * fade;
    }
    return radius;
  };
  const auto height = [&](int j) { return lerp(y0, y1, static_cast<double>(j) / plan.rings); };

  // A whole number of repeats around the shaft leaves no seam in the texture.
  const double around = std::max(1.0, std::round(2 * std::numbers::pi * r / plan.uvRepeat));

  builder.smoothSheet(
      segments, plan.rings, true,
      [&](int i, int j) {
        const TurnPoint t = turn(i, segments);
        const double radius = radiusAt(i, j);
        return Vec3d{radius * t.cosine, height(j), -radius * t.sine};
      },
      [&](int i, int j) {
        return Uv{around * i / segments, height(j) / plan.uvRepeat};
      });

  // Lids inside base and capital close the shaft.
  for (const bool top : {false, true}) {
    const int j = top ? plan.rings : 0;
    const Vec3d normal{0, top ? 1.0 : -1.0, 0};

    const std::uint32_t center = builder.vertex({{0, height(j), 0}, normal, {}});
    std::vector<std::uint32_t> rim;
    for (int i = 0; i < segments; ++i) {
      const TurnPoint t = turn(i, segments);
      const double radius = radiusAt(i, j);
      rim.push_back(builder.vertex({{radius * t.cosine, height(j), -radius * t.sine}, normal, {}}));
    }

    for (const auto i : indices(rim)) {
      std::uint32_t a = rim[i], b = rim[(i + 1) % rim.size()];
      if (!top) std::swap(a, b);
      builder.triangle(center, a, b);
    }
  }
}

Shape buildColumn(const ColumnPlan& plan) {
  int segments = plan.segments;
  // Each flute gets the same number of segments, a multiple of 4.
  if (plan.flutes > 0) {
    const int unit = 4 * plan.flutes;
    segments = std::max(unit, (plan.segments + unit - 1) / unit * unit);
  }

  MeshBuilder shaft, trim;
  addShaft(shaft, plan, segments);
  addBase(trim, plan);
  addCapital(trim, plan);
  return Shape(shaft.part("shaft"), trim.part("trim"));
}

// Reads the parameters that columns and colonnades share.
void readDetails(ShapeParameters& parameters, ColumnPlan& plan) {
  plan.flutes = parameters.integer("flutes", 0, 0, 256);  // 0: a smooth shaft
  // `segments` around the column are rounded up to a multiple of 4 for each flute.
  plan.segments = parameters.integer("segments", 48, 8, 4096);
  plan.rings = parameters.integer("rings", 16, 1, 4096);  // rings along the shaft
  // `leaves` is the number in each of the capital's two rows; 0: a plain bell.
  plan.leaves = parameters.integer("leaves", 8, 0, 64);
  plan.uvRepeat = parameters.repeat();
}

// One bay of a groin vault over [-a, a] x [-b, b]: two half barrels cross, the higher one shows.
// The grid follows both arcs in equal angles, so that the groins run along its diagonals; n even.
void addGroinBay(MeshBuilder& builder, const Vec3d& center, double a, double b, double rise, int n,
                 double repeat) {
  const auto corner = [&](int i, int j, bool arcOverX) {
    const TurnPoint s = turn(i, 2 * n), t = turn(j, 2 * n);
    const Vec3d p{center.x - a * s.cosine, center.y + rise * std::max(s.sine, t.sine),
                  center.z - b * t.cosine};

    // On a groin both barrels meet, and a facet takes the normal of its own barrel.
    const Vec3d normal =
        arcOverX ? Vec3d{rise * s.cosine, -a * s.sine, 0} : Vec3d{0, -b * t.sine, rise * t.cosine};
    return builder.vertex({p, normal, {p.x / repeat, p.z / repeat}});
  };

  // The facet belongs to the barrel whose crown is nearer to its centroid.
  using Node = std::array<int, 2>;
  const auto facet = [&](const Node& p, const Node& q, const Node& r) {
    const int x = std::abs(2 * (p[0] + q[0] + r[0]) - 3 * n);
    const int z = std::abs(2 * (p[1] + q[1] + r[1]) - 3 * n);

    const std::uint32_t i0 = corner(p[0], p[1], x < z);
    const std::uint32_t i1 = corner(q[0], q[1], x < z);
    const std::uint32_t i2 = corner(r[0], r[1], x < z);
    builder.triangle(i0, i1, i2);
  };

  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const Node p{i, j}, q{i + 1, j}, r{i + 1, j + 1}, s{i, j + 1};
      // Groins are edges of facets: cells on the second diagonal are split along it.
      if (i + j == n - 1) {
        facet(p, q, s);
        facet(q, r, s);
      } else {
        facet(p, q, r);
        facet(p, r, s);
      }
    }
  }
}

}  // namespace

Shape makeWall(ShapeParameters& parameters) {
  WallPlan plan{};
  plan.spacing = parameters.length("spacing", 3);       // width of a bay
  plan.bays = parameters.integer("bays", 1, 1, 10000);  // one opening in the middle of each
  plan.height = parameters.length("height", 4);
  plan.depth = parameters.length("depth", 0.3);
  plan.margin = parameters.number("margin", 0, 0, 1e6);  // more wall at both ends
  plan.openingWidth =
      parameters.number("openingWidth", 0.4 * plan.spacing, 1e-3, 0.999 * plan.spacing);

  // `spring` is the height at which the arch begins, `sill` the lower edge of the opening (0: a
  // door), and `rise` the height of the arch above its spring (0: a straight lintel).
  plan.spring = parameters.number("spring", 0.5 * plan.height, 1e-3, 0.999 * plan.height);
  plan.sill = parameters.number("sill", 0, 0, 0.999 * plan.spring);
  // Some wall remains above the opening.
  const double room = 0.999 * (plan.height - plan.spring);
  plan.rise = parameters.number("rise", std::min(plan.openingWidth / 2, room), 0, room);

  plan.segments = parameters.integer("segments", 24, 2, 4096);  // segments of an arch
  plan.uvRepeat = parameters.repeat();
  return singlePart(buildWall(plan));
}

// The ring of stones around an arched opening, standing on y = 0.
Shape makeArch(ShapeParameters& parameters) {
  const double width = parameters.length("width", 2);
  const double rise = parameters.length("rise", width / 2);
  const double thickness = parameters.number("thickness", 0.15 * width, 1e-4, 1e6);
  const double depth = parameters.number("depth", 0.4, 1e-4, 1e6);
  const int segments = parameters.integer("segments", 32, 2, 4096);
  const double repeat = parameters.repeat();

  const double half = width / 2;
  return singlePart(
      extrude(halfRing({0, 0}, {half, rise}, {half + thickness, rise + thickness}, segments),
              -depth / 2, depth / 2, repeat));
}

Shape makeColumn(ShapeParameters& parameters) {
  ColumnPlan plan{};
  plan.radius = parameters.number("radius", 0.3, 1e-4, 1e6);  // radius of the shaft at its foot
  plan.height = parameters.number("height", 4, 4.5 * plan.radius, 1e6);
  // `taper` is the loss of radius from the foot of the shaft to its top, in parts of the radius.
  plan.taper = parameters.number("taper", kTaper, 0, kTaper);

  readDetails(parameters, plan);
  return buildColumn(plan);
}

// Columns in a row along x, whose middle is at the origin; slots shaft, trim, wall, arch.
Shape makeColonnade(ShapeParameters& parameters) {
  const int columns = parameters.integer("columns", 5, 1, 10000);
  const double spacing = parameters.length("spacing", 3);

  ColumnPlan column{};
  column.taper = kTaper;
  column.radius = parameters.number("radius", 0.1 * spacing, 1e-5, 0.3 * spacing);
  column.height = parameters.number("height", 1.3 * spacing, 4.5 * column.radius, 1e6);
  readDetails(parameters, column);

  // An engaged colonnade has one more arch at each end, from the last column to a pier or wall.
  const bool engaged = parameters.flag("engaged", false);
  const bool hasArches = parameters.flag("arches", true);

  WallPlan wall{};
  const double above = parameters.length("wallAbove", 0.5);  // the arches' crown
  wall.depth = parameters.length("wallDepth", 2 * column.radius);

  const Shape one = buildColumn(column);
  MeshBuilder shafts, trims, walls, arches;
  for (int k = 0; k < columns; ++k) {
    const Affine place = Affine::translation({(k - 0.5 * (columns - 1)) * spacing, 0, 0});
    shafts.append(one.parts[0].mesh, place);
    trims.append(one.parts[1].mesh, place);
  }

  Shape shape(shafts.part("shaft"), trims.part("trim"));
  wall.bays = columns + (engaged ? 1 : -1);
  if (!hasArches || wall.bays == 0) return shape;

  // The wall rests on the abaci, and its openings span the gaps between them.
  const double width = spacing - 2 * kAbacusHalf * column.radius;
  wall.spacing = spacing;
  wall.openingWidth = width;
  wall.rise = width / 2;

  // The arches begin a little above the abacus: a stilt that also keeps the wall in one piece.
  wall.spring = 0.1 * spacing;
  wall.height = wall.spring + wall.rise + above;
  wall.margin = engaged ? 0 : kAbacusHalf * column.radius;
  wall.segments = 24;
  wall.uvRepeat = column.uvRepeat;
  walls.append(buildWall(wall), Affine::translation({0, column.height, 0}));

  // Rings of stones line the openings, and stand out a little from the wall.
  const double inner = width / 2 - 0.012 * width, outer = width / 2 + 0.09 * width;
  const double front = wall.depth / 2 + 2 * 0.012 * width;
  const Mesh ring =
      extrude(halfRing({0, wall.spring}, {inner, inner}, {outer, outer}, wall.segments), -front,
              front, wall.uvRepeat);

  for (int bay = 0; bay < wall.bays; ++bay) {
    const double x = (bay - 0.5 * (wall.bays - 1)) * spacing;
    arches.append(ring, Affine::translation({x, column.height, 0}));
  }

  shape.parts.push_back(walls.part("wall"));
  shape.parts.push_back(arches.part("arch"));
  return shape;
}

// Turned posts between two rails along x, standing on y = 0: slots post, rail.
Shape makeBalustrade(ShapeParameters& parameters) {
  const int posts = parameters.integer("posts", 12, 1, 100000);
  const double length = parameters.length("length", 3);
  const double height = parameters.length("height", 1);
  const int segments = parameters.integer("segments", 12, 3, 4096);
  const double repeat = parameters.repeat();

  const double low = 0.12 * height, high = 0.88 * height, depth = 0.11 * height;
  const double r = std::min(0.075 * height, 0.45 * length / posts);

  // The contour of a post is given in parts of its radius and of its height.
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
  return Shape(all.part("post"), rails.part("rail"));
}

// Ceilings seen from below, springing from y = 0, centered on the origin: `groin` has baysX x baysZ
// crossed barrels, `barrel` one tunnel along z.
Shape makeVault(ShapeParameters& parameters) {
  const std::string kind = parameters.word("kind", "groin", {"groin", "barrel"});
  const double width = parameters.length("width", 3);
  const double depth = parameters.length("depth", 3);
  const int baysX = parameters.integer("baysX", 1, 1, 1000);
  const int baysZ = parameters.integer("baysZ", 1, 1, 1000);
  const double a = width / baysX / 2, b = depth / baysZ / 2;
  const double rise = parameters.length("rise", std::min(a, b));

  // addGroinBay() needs an even number of segments.
  const int n = 2 * ((parameters.integer("segments", 24, 2, 2048) + 1) / 2);
  const double repeat = parameters.repeat();

  MeshBuilder builder;
  if (kind == "barrel") {
    builder.sheet(n, 1, [&](int i, int j) {
      const TurnPoint s = turn(i, 2 * n);
      const double z = (j - 0.5) * depth;
      return SurfacePoint{{-width / 2 * s.cosine, rise * s.sine, z},
                          {rise * s.cosine, -width / 2 * s.sine, 0},
                          {std::numbers::pi * width / 2 * i / n / repeat, z / repeat}};
    });
    return singlePart(builder.take("vault"));
  }

  for (int k = 0; k < baysZ; ++k) {
    for (int i = 0; i < baysX; ++i) {
      const Vec3d center{(2 * i + 1) * a - width / 2, 0, (2 * k + 1) * b - depth / 2};
      addGroinBay(builder, center, a, b, rise, n, repeat);
    }
  }
  return singlePart(builder.take("vault"));
}

// A moulding that runs around a rectangle with mitred corners, one closed ring. It projects into
// the rectangle (the cornice of a court) or out of it; y = 0 is its lower edge.
Shape makeCornice(ShapeParameters& parameters) {
  const double width = parameters.length("width", 10);
  const double depth = parameters.length("depth", 6);
  const double height = parameters.number("height", 0.4, 1e-4, 1e6);
  const double reach = parameters.number("projection", 0.3, 1e-4, 0.49 * std::min(width, depth));
  const double back = parameters.number("back", 0.2, 1e-4, 1e6);
  const bool inward = parameters.flag("inward", true);
  const double repeat = parameters.repeat();

  // The section runs counter-clockwise; its points are distances from the rectangle, and heights.
  std::vector<std::array<double, 2>> section{
      {-back, 0}, {0.15 * reach, 0}, {0.15 * reach, 0.22 * height}, {0.25 * reach, 0.22 * height}};

  constexpr int kSteps = 6;
  for (int k = 0; k <= kSteps; ++k) {
    const double a = std::numbers::pi / 2 * k / kSteps;  // a quarter hollow
    section.push_back({reach * (0.85 - 0.55 * std::cos(a)), height * (0.28 + 0.42 * std::sin(a))});
  }
  for (const auto& [d, y] : {std::array{1.0, 0.70}, std::array{1.0, 1.0}}) {
    section.push_back({d * reach, y * height});
  }
  section.push_back({-back, height});

  // A point of the section is equally far from both sides of a corner, which mitres the moulding.
  const double sign = inward ? 1 : -1;
  const auto corner = [&](int k, const std::array<double, 2>& s) {
    double x = width / 2 - sign * s[0], z = depth / 2 - sign * s[0];
    if (k == 0 || k == 3) x = -x;
    if (k >= 2) z = -z;
    return Vec3d{x, s[1], z};
  };

  MeshBuilder builder(MeshBuilder::Shading::flat);
  for (int side = 0; side < 4; ++side) {
    for (const auto m : indices(section)) {
      const auto &s = section[m], &t = section[(m + 1) % section.size()];
      // Outside of the rectangle the section is mirrored, so the ends of a side change places to
      // keep the fronts outwards.
      int k0 = side, k1 = (side + 1) % 4;
      if (!inward) std::swap(k0, k1);
      builder.plate({corner(k0, s), corner(k0, t), corner(k1, t), corner(k1, s)}, repeat);
    }
  }
  return singlePart(builder.take("cornice"));
}

}  // namespace whit::procedural
