// Trees, alone and in forests, and potted plants.
#include <numbers>

#include "make/patterns/noise.h"
#include "make/shapes/generators.h"
#include "make/shapes/mesh_builder.h"
#include "make/shapes/terrain.h"
#include "scene/generation_limit.h"

namespace whit::procedural {
namespace {

struct TreePlan {
  std::string kind = "broadleaf";   // or "conifer"
  std::string leafStyle = "quads";  // "quads" for an alpha mask, "diamonds" solid, "blobs" solid
  double height = 8;
  int levels = 4;          // of branching
  int leaves = 1500;       // leaves, or blobs
  double leafSize = 0.35;  // of a leaf; blobs are eight times as big
  std::uint32_t seed = 1;
};

struct Twig {
  Vec3d position, direction;
};

class TreeBuilder {
 public:
  explicit TreeBuilder(const TreePlan& plan) : plan_(plan), random_(plan.seed * 977u + 13u) {}

  Shape build() {
    if (plan_.kind == "conifer") {
      growConifer();
    } else {
      grow({0, 0, 0}, {0, 1, 0}, 0.34 * plan_.height, 0.035 * plan_.height, 0);
    }
    addLeaves();
    return Shape(bark_.part("bark"), leaves_.part("leaves"));
  }

 private:
  // A tapering limb, closed by its tip: `points` from foot to tip, one radius each.
  void limb(const std::vector<Vec3d>& points, const std::vector<double>& radii, int sides) {
    const Vec3d course = normalized(points.back() - points.front(), Vec3d{0, 1, 0});
    const Vec3d side =
        normalized(cross(course, std::fabs(course.x) < 0.8 ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1}));
    const Vec3d other = cross(side, course);
    const int last = static_cast<int>(points.size()) - 1;
    const double around = std::max(1.0, std::round(4 * radii[0]));
    // Two more rows than points: both ends close in a point.
    const auto node = [&](int j) { return static_cast<std::size_t>(std::clamp(j - 1, 0, last)); };
    bark_.sheet(sides, last + 2, [&](int i, int j) {
      const TurnPoint t = turn(i, sides);
      const bool foot = j == 0, tip = j == last + 2;
      const Vec3d out = side * t.cosine - other * t.sine;
      const Vec3d& middle = points[node(j)];
      return SurfacePoint{middle + out * (foot || tip ? 0 : radii[node(j)]),
                          foot  ? -course
                          : tip ? course
                                : out,
                          {around * i / sides, length(middle - points[0])}};
    });
  }

  Vec3d anyDirection() {
    const double y = random_.between(-1, 1), a = random_.between(0, 2 * std::numbers::pi);
    const double r = std::sqrt(std::max(0.0, 1 - y * y));
    return {r * std::cos(a), y, r * std::sin(a)};
  }

  void grow(const Vec3d& foot, const Vec3d& course, double size, double radius, int level) {
    const int pieces = level == 0 ? 6 : level == 1 ? 4 : 3;
    std::vector<Vec3d> points{foot};
    std::vector<double> radii{level == 0 ? radius * 1.5 : radius};
    Vec3d direction = course;
    for (int k = 1; k <= pieces; ++k) {
      const Vec3d up{0, level == 0 ? 0.4 : 0.12, 0};
      direction = normalized(direction + anyDirection() * (level == 0 ? 0.10 : 0.24) + up * 0.5);
      points.push_back(points.back() + direction * (size / pieces));
      radii.push_back(radius * (1 - 0.45 * k / pieces));
    }
    limb(points, radii, level == 0 ? 10 : level == 1 ? 7 : level == 2 ? 5 : 3);
    if (level >= plan_.levels - 2) {
      for (std::size_t k = 1; k < points.size(); ++k) {
        twigs_.push_back({points[k], normalized(points[k] - points[k - 1])});
      }
    }
    if (level + 1 >= plan_.levels) return;
    const int children = level == 0 ? 6 : 4;
    const double turnStart = random_.between(0, 2 * std::numbers::pi);
    for (int c = 0; c < children; ++c) {
      const double t = c == 0 ? 1.0 : lerp(level == 0 ? 0.55 : 0.35, 1.0, random_.next());
      const double at = t * pieces;
      const auto k = static_cast<std::size_t>(std::min(pieces - 1, static_cast<int>(at)));
      const Vec3d origin = points[k] + (points[k + 1] - points[k]) * (at - static_cast<double>(k));
      const double a = turnStart + 2.39996 * c, spread = c == 0 ? 0.25 : random_.between(0.7, 1.1);
      const Vec3d side = normalized(cross(direction, Vec3d{std::cos(a), 0.3, std::sin(a)}));
      const Vec3d way = normalized(direction * std::cos(spread) + side * std::sin(spread));
      grow(origin, way, size * random_.between(0.62, 0.82), radius * 0.5, level + 1);
    }
  }

  // A straight trunk with whorls of drooping boughs that shorten upwards.
  void growConifer() {
    const double h = plan_.height;
    limb({{0, 0, 0}, {0, 0.5 * h, 0}, {0, h, 0}}, {0.022 * h, 0.014 * h, 0.002 * h}, 8);
    const int whorls = 5 + 5 * plan_.levels;
    for (int w = 0; w < whorls; ++w) {
      const double t = lerp(0.10, 0.97, static_cast<double>(w) / whorls);
      const double reach = 0.24 * h * std::pow(1 - t, 0.85) + 0.015 * h;
      const int boughs = 6;
      for (int b = 0; b < boughs; ++b) {
        const double a = 2 * std::numbers::pi * (b + 0.5 * (w % 2) + 0.3 * random_.next()) / boughs;
        const Vec3d out{std::cos(a), 0, std::sin(a)};
        const double size = reach * random_.between(0.8, 1.1);
        const Vec3d foot{0, t * h, 0};
        const Vec3d tip = foot + (out + Vec3d{0, -0.28, 0}) * size;
        limb({foot, tip}, {0.005 * h, 0.001 * h}, 3);
        for (int k = 1; k <= 5; ++k) {
          const double s = k / 5.0;
          // The twigs hang in a curve below the straight bough.
          const Vec3d hanging = Vec3d{0, -0.2 * size * s * (1 - s), 0};
          twigs_.push_back({foot + (tip - foot) * s + hanging, normalized(tip - foot)});
        }
      }
    }
  }

  void addLeaves() {
    if (twigs_.empty()) return;
    for (int k = 0; k < plan_.leaves; ++k) {
      const auto pick =
          static_cast<std::size_t>(random_.next() * static_cast<double>(twigs_.size()));
      const Twig& twig = twigs_[std::min(pick, twigs_.size() - 1)];
      const Vec3d p = twig.position + anyDirection() * (plan_.leafSize * random_.between(0.2, 1.2));
      if (plan_.leafStyle == "blobs") {
        addBlob(p);
      } else {
        addLeaf(p, twig.direction);
      }
    }
  }

  void addLeaf(const Vec3d& p, const Vec3d& course) {
    const bool conifer = plan_.kind == "conifer";
    const Vec3d way = normalized(course * (conifer ? 1.6 : 0.7) + anyDirection() +
                                 Vec3d{0, conifer ? -0.2 : -0.3, 0});
    const Vec3d side = normalized(cross(way, anyDirection()), Vec3d{1, 0, 0});
    const double size = plan_.leafSize * random_.between(0.7, 1.2);
    const Vec3d half = side * (size * (conifer ? 0.16 : 0.36)), tip = p + way * size;
    // Leaves are lit as parts of the crown, not as single cards.
    const Vec3d crown{0, 0.55 * plan_.height, 0};
    const Vec3d face = cross(half, way);
    const Vec3d normal = normalized(normalized(p - crown) + normalized(face) * 0.6);
    const bool flip = dot(face, normal) < 0;
    const auto corner = [&](const Vec3d& q, double u, double v) {
      return leaves_.vertex({q, normal, {u, v}});
    };
    const bool diamond = plan_.leafStyle == "diamonds";
    const Vec3d middle = p + way * (0.45 * size);
    const std::uint32_t a = diamond ? corner(p, 0.5, 0) : corner(p - half, 0, 0);
    const std::uint32_t b = diamond ? corner(middle + half, 1, 0.45) : corner(p + half, 1, 0);
    const std::uint32_t c = diamond ? corner(tip, 0.5, 1) : corner(tip + half, 1, 1);
    const std::uint32_t d = diamond ? corner(middle - half, 0, 0.45) : corner(tip - half, 0, 1);
    if (flip) {
      leaves_.quad(a, d, c, b);
    } else {
      leaves_.quad(a, b, c, d);
    }
  }

  void addBlob(const Vec3d& p) {
    static const auto kBall = icosphereMesh(1);
    const double size = 4 * plan_.leafSize * random_.between(0.7, 1.2);
    const auto noiseSeed = static_cast<std::uint32_t>(random_.next() * 1e6);
    std::vector<std::uint32_t> index;
    for (const Vec3d& q : kBall.first) {
      const double push = 1 + 0.25 * gradientNoise3(noiseSeed, 2 * q.x, 2 * q.y, 2 * q.z);
      index.push_back(
          leaves_.vertex({p + q * Vec3d{size, 0.8 * size, size} * push, q, {q.x, q.y}}));
    }
    for (const auto& [a, b, c] : kBall.second) leaves_.triangle(index[a], index[b], index[c]);
  }

  const TreePlan& plan_;
  RandomStream random_;
  std::vector<Twig> twigs_;
  MeshBuilder bark_, leaves_;
};

// Reads kind, leafStyle, treeHeight (or height), levels, leaves, leafSize and seed.
TreePlan readTree(ShapeParameters& parameters, const std::string& heightKey, std::uint32_t seed) {
  TreePlan plan;
  plan.kind = parameters.word("kind", plan.kind, {"broadleaf", "conifer"});
  plan.leafStyle = parameters.word("leafStyle", plan.leafStyle, {"quads", "diamonds", "blobs"});
  plan.height = parameters.number(heightKey, plan.height, 1e-3, 1e6);
  plan.levels = parameters.integer("levels", plan.levels, 2, 6);
  plan.leaves = parameters.integer("leaves", plan.leaves, 0, 2'000'000);
  plan.leafSize = parameters.number("leafSize", 0.04 * plan.height, 1e-6, 1e6);
  plan.seed = seed;
  return plan;
}

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

struct Frond {
  double angle, lift, size, width, droop, start;
};

// A long leaf that rises from the foot and bends over; u across, v from foot to tip, for a mask.
void addFrond(MeshBuilder& builder, const Frond& f) {
  constexpr int kAcross = 4, kAlong = 14;
  const Vec3d out{std::cos(f.angle), 0, -std::sin(f.angle)};
  const Vec3d side{-std::sin(f.angle), 0, -std::cos(f.angle)};
  std::vector<Vec3d> spine{Vec3d{0, f.start, 0}};
  for (int k = 0; k < kAlong; ++k) {
    const double a = f.lift - f.droop * k / (kAlong - 1.0);
    spine.push_back(spine.back() +
                    (out * std::cos(a) + Vec3d{0, std::sin(a), 0}) * (f.size / kAlong));
  }
  builder.smoothSheet(
      kAcross, kAlong, false,
      [&](int i, int j) {
        const double s = 2.0 * i / kAcross - 1;
        const double keel = 0.35 * f.width * std::fabs(s);
        return spine[static_cast<std::size_t>(j)] + side * (s * f.width) + Vec3d{0, keel, 0};
      },
      [&](int i, int j) {
        return Uv{static_cast<double>(i) / kAcross, static_cast<double>(j) / kAlong};
      });
}

}  // namespace

// Standing on y = 0: slots bark, leaves.
Shape makeTree(ShapeParameters& parameters) {
  const auto seed = static_cast<std::uint32_t>(parameters.integer("seed", 1, 0, 1 << 30));
  return TreeBuilder(readTree(parameters, "height", seed)).build();
}

// One tree and the places of its copies on the ground of a `terrain` with the same seed, size,
// height, valley and floor. As many as make up `triangles` when multiplied out, or `trees`.
// `forestSeed` tells forests on the same ground apart. Slots bark, leaves.
Shape makeForest(ShapeParameters& parameters) {
  const Ground ground(parameters);
  const auto seed = static_cast<std::uint32_t>(parameters.integer("forestSeed", 1, 0, 1 << 30));
  Shape shape = TreeBuilder(readTree(parameters, "treeHeight", seed)).build();
  const double triangles = parameters.number("triangles", 0, 0, 1e10);
  const auto perTree = static_cast<double>(shape.parts[0].mesh.triangles.size() +
                                           shape.parts[1].mesh.triangles.size());
  const double asked = parameters.number("trees", 200, 1, 1e7);
  const double wanted =
      triangles > 0 ? std::clamp(std::floor(triangles / perTree), 1.0, 1e7) : asked;
  const double size = ground.size();
  const Habitat habitat = readHabitat(parameters, size);
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

// A tuft of bending leaves standing on y = 0, for a pot: slots stem, leaves. Leaves are cards for
// an alpha mask of one leaf with its foot at v = 0.
Shape makePlant(ShapeParameters& parameters) {
  const int leaves = parameters.integer("leaves", 28, 1, 10000);
  const double height = parameters.number("height", 1, 1e-3, 1e6);
  const double width = parameters.number("leafWidth", 0.16 * height, 1e-6, 1e6) / 2;
  const double trunk = parameters.number("trunk", 0.1 * height, 0, 1e6);
  const auto seed = static_cast<std::uint32_t>(parameters.integer("seed", 1, 0, 1 << 30));
  RandomStream random(seed * 31u + 5u);
  MeshBuilder stem, cards;
  const double r = 0.05 * height, top = std::max(trunk, 1e-3 * height);
  stem.revolve(creasedProfile({{0, -0.1 * height},
                               {1.2 * r, -0.1 * height},
                               {0.8 * r, top},
                               {0.5 * r, top + 0.04 * height},
                               {0, top + 0.05 * height}},
                              60),
               12);
  for (int k = 0; k < leaves; ++k) {
    const double t = (k + 0.5) / leaves;  // outer leaves first, they lie lower
    Frond f{};
    f.angle = 2.39996 * k + random.between(-0.2, 0.2);
    f.lift = lerp(0.55, 1.5, t) + random.between(-0.1, 0.1);
    f.size = height * lerp(0.85, 1.1, random.next());
    f.width = width * random.between(0.8, 1.15);
    f.droop = lerp(1.7, 0.7, t) * random.between(0.8, 1.2);
    f.start = trunk * lerp(0.6, 1, t);
    addFrond(cards, f);
  }
  return Shape(stem.part("stem"), cards.part("leaves"));
}

}  // namespace whit::procedural
