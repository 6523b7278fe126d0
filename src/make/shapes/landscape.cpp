// Terrain, rocks, trees alone and in forests, and potted plants.
#include <numbers>

#include "core/index.h"
#include "make/patterns/noise.h"
#include "make/shapes/mesh_builder.h"
#include "scene/generation_limit.h"

namespace whit::procedural {
namespace {

// Hills that rise towards ridges away from a basin at the origin, longest along z. The same seed,
// size, height, valley and floor give the same ground at any resolution.
class Ground {
 public:
  explicit Ground(ShapeParameters& parameters)
      : seed_(parameters.seed()),
        size_(parameters.number("size", 400, 1e-3, 1e7)),
        height_(parameters.number("height", 0.15 * size_, 0, 1e7)),
        valley_(parameters.number("valley", 0.12, 0, 1)),  // half width, in parts of the size
        floor_(parameters.number("floor", 0.04 * height_, 0, 1e7)) {}  // depth below zero

  double size() const { return size_; }

  // Returns the height of the ground at (x, z); below zero in the valley's floor.
  double height(double x, double z) const {
    const double u = x / size_, v = z / size_;
    const double bend =
        0.35 * valley_ * std::sin(7 * v) + 0.12 * gradientNoise(seed_ + 70, 0.5, 3 * v);

    // The ground is half as steep along z, which makes a long basin that closes at both ends.
    const double away = std::hypot(u - bend * smoothStep(0, 0.2, std::fabs(v)), 0.5 * v);
    const double slope = smoothStep(0.55 * valley_, 2.6 * valley_ + 0.08, away);

    // The ridges run along noise whose coordinates are themselves displaced by noise.
    const double warpU = u + 0.08 * fractalNoise(seed_ + 40, 3 * u, 3 * v, 2);
    const double warpV = v + 0.08 * fractalNoise(seed_ + 50, 3 * u + 9, 3 * v, 2);
    const double ridges = ridgedNoise(seed_, 3.2 * warpU + 5, 3.2 * warpV, 7);

    const double hills = 0.5 + 0.5 * fractalNoise(seed_ + 20, 6 * u, 6 * v, 6);
    const double meadow = 0.05 * fractalNoise(seed_ + 30, 14 * u, 14 * v, 4);

    // The hills make the line of the shore ragged.
    const double shore =
        smoothStep(0.35 * valley_, 0.9 * valley_, away + 0.3 * valley_ * (hills - 0.5));

    return -floor_ * (1 - shore) +
           height_ * (0.03 * shore + meadow * shore + slope * (0.75 * ridges + 0.25 * hills));
  }

  // Returns the upward unit normal, from differences over `step`.
  Vec3d normal(double x, double z, double step) const {
    const double dx = height(x + step, z) - height(x - step, z);
    const double dz = height(x, z + step) - height(x, z - step);
    return normalized(Vec3d{-dx, 2 * step, -dz}, Vec3d{0, 1, 0});
  }

 private:
  std::uint32_t seed_;
  double size_, height_, valley_, floor_;
};

struct Twig {
  Vec3d position, direction;
};

class TreeBuilder {
 public:
  TreeBuilder(ShapeParameters& parameters, const std::string& heightKey, std::uint32_t seed)
      : conifer_(parameters.word("kind", "broadleaf", {"broadleaf", "conifer"}) == "conifer"),
        leafStyle_(parameters.word("leafStyle", "quads", {"quads", "diamonds", "blobs"})),
        height_(parameters.length(heightKey, 8)),
        levels_(parameters.integer("levels", 4, 2, 6)),
        leafCount_(parameters.integer("leaves", 1500, 0, 2'000'000)),
        leafSize_(parameters.number("leafSize", 0.04 * height_, 1e-6, 1e6)),
        random_(seed * 977u + 13u) {}

  Shape build() {
    if (conifer_) {
      growConifer();
    } else {
      grow({0, 0, 0}, {0, 1, 0}, 0.34 * height_, 0.035 * height_, 0);
    }

    addLeaves();
    return Shape(bark_.part("bark"), leaves_.part("leaves"));
  }

 private:
  // Adds a tapering closed limb through `points` from foot to tip, with a radius for each.
  void limb(const std::vector<Vec3d>& points, const std::vector<double>& radii, int sides) {
    // `side` and `other` span the plane across the limb.
    const Vec3d course = normalized(points.back() - points.front(), Vec3d{0, 1, 0});
    const Vec3d side =
        normalized(cross(course, std::fabs(course.x) < 0.8 ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1}));
    const Vec3d other = cross(side, course);

    const int last = static_cast<int>(points.size()) - 1;
    const double around = std::max(1.0, std::round(4 * radii[0]));

    // The sheet has two more rows than points, so that both ends close in a point.
    const auto node = [&](int j) { return static_cast<std::size_t>(std::clamp(j - 1, 0, last)); };

    bark_.sheet(sides, last + 2, [&](int i, int j) {
      const TurnPoint t = turn(i, sides);
      const bool foot = j == 0, tip = j == last + 2;
      const Vec3d out = side * t.cosine - other * t.sine;
      const Vec3d& middle = points[node(j)];
      Vec3d normal = out;
      if (foot) normal = -course;
      if (tip) normal = course;
      return SurfacePoint{middle + out * (foot || tip ? 0 : radii[node(j)]),
                          normal,
                          {around * i / sides, length(middle - points[0])}};
    });
  }

  Vec3d anyDirection() {
    // The heights of points that are uniform on a sphere are uniform (Archimedes).
    const double y = random_.between(-1, 1), a = random_.between(0, 2 * std::numbers::pi);
    const double r = std::sqrt(std::max(0.0, 1 - y * y));
    return {r * std::cos(a), y, r * std::sin(a)};
  }

  void grow(const Vec3d& foot, const Vec3d& course, double size, double radius, int level) {
    // The limb varies its direction at random and bends upwards, the trunk with less variation.
    constexpr int kPieces[] = {6, 4, 3}, kSides[] = {10, 7, 5, 3};  // by level; the last go on
    const int pieces = kPieces[std::min(level, 2)];
    std::vector<Vec3d> points{foot};
    std::vector<double> radii{level == 0 ? radius * 1.5 : radius};

    Vec3d direction = course;
    for (int k = 1; k <= pieces; ++k) {
      const Vec3d up{0, level == 0 ? 0.4 : 0.12, 0};
      direction = normalized(direction + anyDirection() * (level == 0 ? 0.10 : 0.24) + up * 0.5);
      points.push_back(points.back() + direction * (size / pieces));
      radii.push_back(radius * (1 - 0.45 * k / pieces));
    }
    limb(points, radii, kSides[std::min(level, 3)]);

    // Leaves grow on the last two levels of branching.
    if (level >= levels_ - 2) {
      for (std::size_t k = 1; k < points.size(); ++k) {
        twigs_.push_back({points[k], normalized(points[k] - points[k - 1])});
      }
    }
    if (level + 1 >= levels_) return;

    // The first child continues the limb at its tip. The others leave it sideways, each turned by
    // the golden angle.
    const int children = level == 0 ? 6 : 4;
    const double turnStart = random_.between(0, 2 * std::numbers::pi);
    for (int c = 0; c < children; ++c) {
      const double lowest = level == 0 ? 0.55 : 0.35;
      const double t = c == 0 ? 1.0 : lerp(lowest, 1.0, random_.next());
      const double at = t * pieces;
      const std::size_t k = std::min(pieces - 1, static_cast<int>(at));
      const Vec3d origin = points[k] + (points[k + 1] - points[k]) * (at - static_cast<double>(k));

      const double a = turnStart + 2.39996 * c;
      const double spread = c == 0 ? 0.25 : random_.between(0.7, 1.1);
      const Vec3d side = normalized(cross(direction, Vec3d{std::cos(a), 0.3, std::sin(a)}));
      const Vec3d way = normalized(direction * std::cos(spread) + side * std::sin(spread));
      grow(origin, way, size * random_.between(0.62, 0.82), radius * 0.5, level + 1);
    }
  }

  // Grows a straight trunk with whorls of drooping boughs that shorten upwards.
  void growConifer() {
    const double h = height_;
    limb({{0, 0, 0}, {0, 0.5 * h, 0}, {0, h, 0}}, {0.022 * h, 0.014 * h, 0.002 * h}, 8);

    const int whorls = 5 + 5 * levels_;
    for (int w = 0; w < whorls; ++w) {
      const double t = lerp(0.10, 0.97, static_cast<double>(w) / whorls);
      const double reach = 0.24 * h * std::pow(1 - t, 0.85) + 0.015 * h;

      const int boughs = 6;
      for (int b = 0; b < boughs; ++b) {
        // Every other whorl is turned by half of the angle between its boughs.
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

    for (int k = 0; k < leafCount_; ++k) {
      const auto pick =
          static_cast<std::size_t>(random_.next() * static_cast<double>(twigs_.size()));
      const Twig& twig = twigs_[std::min(pick, twigs_.size() - 1)];

      // The distance is drawn in a statement of its own, because compilers differ in which operand
      // of a product they evaluate first.
      const double distance = leafSize_ * random_.between(0.2, 1.2);
      const Vec3d p = twig.position + anyDirection() * distance;

      if (leafStyle_ == "blobs") {
        addBlob(p);
      } else {
        addLeaf(p, twig.direction);
      }
    }
  }

  void addLeaf(const Vec3d& p, const Vec3d& course) {
    const Vec3d way = normalized(course * (conifer_ ? 1.6 : 0.7) + anyDirection() +
                                 Vec3d{0, conifer_ ? -0.2 : -0.3, 0});
    const Vec3d side = normalized(cross(way, anyDirection()), Vec3d{1, 0, 0});
    const double size = leafSize_ * random_.between(0.7, 1.2);
    const Vec3d half = side * (size * (conifer_ ? 0.16 : 0.36)), tip = p + way * size;

    // Leaves are lit as parts of the crown, not as single cards.
    const Vec3d crown{0, 0.55 * height_, 0};
    const Vec3d face = cross(half, way);
    const Vec3d normal = normalized(normalized(p - crown) + normalized(face) * 0.6);
    const bool flip = dot(face, normal) < 0;
    const auto corner = [&](const Vec3d& q, double u, double v) {
      return leaves_.vertex({q, normal, {u, v}});
    };

    const bool diamond = leafStyle_ == "diamonds";
    const Vec3d middle = p + way * (0.45 * size);
    const std::uint32_t a = diamond ? corner(p, 0.5, 0) : corner(p - half, 0, 0);
    const std::uint32_t b = diamond ? corner(middle + half, 1, 0.45) : corner(p + half, 1, 0);
    const std::uint32_t c = diamond ? corner(tip, 0.5, 1) : corner(tip + half, 1, 1);
    const std::uint32_t d = diamond ? corner(middle - half, 0, 0.45) : corner(tip - half, 0, 1);

    // The front of the leaf is on the side of its normal.
    if (flip) {
      leaves_.quad(a, d, c, b);
    } else {
      leaves_.quad(a, b, c, d);
    }
  }

  void addBlob(const Vec3d& p) {
    static const auto kBall = icosphereMesh(1);
    const double size = 4 * leafSize_ * random_.between(0.7, 1.2);
    const auto noiseSeed = static_cast<std::uint32_t>(random_.next() * 1e6);

    // Noise pushes the points of a ball in and out.
    std::vector<std::uint32_t> index;
    for (const Vec3d& q : kBall.first) {
      const double push = 1 + 0.25 * gradientNoise3(noiseSeed, 2 * q.x, 2 * q.y, 2 * q.z);
      index.push_back(
          leaves_.vertex({p + q * Vec3d{size, 0.8 * size, size} * push, q, {q.x, q.y}}));
    }
    for (const auto& [a, b, c] : kBall.second) leaves_.triangle(index[a], index[b], index[c]);
  }

  bool conifer_;
  std::string leafStyle_;  // quads are for an alpha mask, diamonds and blobs are solid
  double height_;
  int levels_;       // number of levels of branching
  int leafCount_;    // leaves or blobs
  double leafSize_;  // size of a leaf; blobs are eight times as big
  RandomStream random_;
  std::vector<Twig> twigs_;
  MeshBuilder bark_, leaves_;
};

}  // namespace

// A square of `triangles` triangles (rounded down to 2 n^2), centered on the origin.
Shape makeTerrain(ShapeParameters& parameters) {
  const Ground ground(parameters);
  const double triangles = parameters.number("triangles", 131072, 2, 2e8);
  const double repeat = parameters.repeat(0.01 * ground.size());

  // Each of the n x n cells has two triangles.
  const int n = std::max(1, static_cast<int>(std::sqrt(triangles / 2)));
  const double size = ground.size();

  MeshBuilder builder;
  builder.smoothSheet(
      n, n, false,
      [&](int i, int j) {
        const double x = (static_cast<double>(i) / n - 0.5) * size;
        const double z = (0.5 - static_cast<double>(j) / n) * size;
        return Vec3d{x, ground.height(x, z), z};
      },
      [&](int i, int j) {
        return Uv{size / repeat * i / n, size / repeat * j / n};
      });
  return singlePart(builder.take("terrain"));
}

// A boulder or a lump of ice: a sphere pushed in and out by noise, one closed surface.
Shape makeRock(ShapeParameters& parameters) {
  const double radius = parameters.number("radius", 1, 1e-6, 1e9);
  const double roughness = parameters.number("roughness", 0.3, 0, 0.9);
  const double frequency = parameters.number("frequency", 1.3, 0, 100);
  const Vec3d stretch = parameters.vector("stretch", {1, 1, 1});
  const std::uint32_t seed = parameters.seed();

  auto [points, triangles] = icosphereMesh(parameters.integer("level", 4, 0, 8));
  const bool smooth = parameters.flag("smooth", true);

  std::vector<Vec3d> normals(points.size());
  std::vector<Uv> uvs;
  for (Vec3d& p : points) {
    uvs.push_back({0.5 + std::atan2(-p.z, p.x) / (2 * std::numbers::pi), 0.5 + p.y / 2});

    // The displacement is a sum of four octaves of noise.
    double push = 0, amplitude = 1;
    Vec3d q = p * frequency + Vec3d(0.37);
    for (std::uint32_t octave = 0; octave < 4; ++octave) {
      push += amplitude * gradientNoise3(seed + octave, q.x, q.y, q.z);
      amplitude *= 0.45;
      q = q * 2.1;
    }

    // The bound keeps deep hollows from reaching the center.
    p = p * stretch * (radius * std::max(0.1, 1 + roughness * push));
  }

  // The cross product weights the normal of each face by its area.
  for (const auto& [a, b, c] : triangles) {
    const Vec3d n = cross(points[b] - points[a], points[c] - points[a]);
    for (const std::uint32_t k : {a, b, c}) normals[k] += n;
  }

  MeshBuilder builder(smooth ? MeshBuilder::Shading::smooth : MeshBuilder::Shading::flat);
  for (const auto k : indices(points)) builder.vertex({points[k], normals[k], uvs[k]});
  for (const auto& [a, b, c] : triangles) builder.triangle(a, b, c);
  return singlePart(builder.take("rock"));
}

// A tree that stands on y = 0: slots bark, leaves.
Shape makeTree(ShapeParameters& parameters) {
  return TreeBuilder(parameters, "height", parameters.seed()).build();
}

// One tree and the places of its copies on the ground of a `terrain` with the same seed, size,
// height, valley and floor. There are `trees` copies, or as many as have `triangles` triangles
// together. `forestSeed` tells forests on the same ground apart. Slots bark, leaves.
Shape makeForest(ShapeParameters& parameters) {
  const Ground ground(parameters);
  const std::uint32_t seed = parameters.seed("forestSeed");
  Shape shape = TreeBuilder(parameters, "treeHeight", seed).build();

  // The number of trees is given, or follows from the number of triangles.
  const double triangles = parameters.number("triangles", 0, 0, 1e10);
  const auto perTree = static_cast<double>(shape.parts[0].mesh.triangles.size() +
                                           shape.parts[1].mesh.triangles.size());
  const double asked = parameters.number("trees", 200, 1, 1e7);
  const double wanted =
      triangles > 0 ? std::clamp(std::floor(triangles / perTree), 1.0, 1e7) : asked;

  const double size = ground.size();
  const double lowest = parameters.number("lowest", 0.004 * size, -1e7, 1e7);
  const double highest = parameters.number("highest", 0.09 * size, -1e7, 1e7);
  const double steepest = parameters.number("steepest", 0.75, 0, 1);  // least y of the normal
  const double clearing = parameters.number("clearing", 0, 0, 1e7);   // radius without trees
  const Vec3d clearingAt = parameters.vector("clearingAt", {0, 0, 0});
  RandomStream random(seed * 7919u + 3u);

  // A rejected candidate costs only a few hashes. The bound on their number ends the search on
  // ground that rejects nearly all of them; further trees stand anywhere.
  const double tries = 60 * wanted;
  double tried = 0;
  while (static_cast<double>(shape.placements.size()) < wanted) {
    const double x = random.between(-0.49, 0.49) * size, z = random.between(-0.49, 0.49) * size;
    const double chance = random.next(), turnBy = random.between(0, 360);
    const double scale = random.between(0.75, 1.25), y = ground.height(x, z);

    if (++tried < tries) {
      const double away = std::hypot(x - clearingAt.x, z - clearingAt.z);
      if (away < clearing || y < lowest || y > highest) continue;
      if (ground.normal(x, z, 0.004 * size).y < steepest) continue;

      // Trees gather in groves, where this noise is high.
      const double density = 0.5 + 0.5 * fractalNoise(seed + 3, 7 * x / size, 7 * z / size, 3);
      if (chance > smoothStep(0.35, 0.65, density) + 0.04) continue;
    }

    // Trees sink in a little, because the mesh of the ground is coarser than this function.
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
  const double height = parameters.length("height", 1);
  const double width = parameters.number("leafWidth", 0.16 * height, 1e-6, 1e6) / 2;
  const double trunk = parameters.number("trunk", 0.1 * height, 0, 1e6);
  constexpr int kAcross = 4, kAlong = 14;
  RandomStream random(parameters.seed() * 31u + 5u);
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
    const double t = (k + 0.5) / leaves;  // the first leaves are the outer ones, which lie lower
    const double angle = 2.39996 * k + random.between(-0.2, 0.2);
    const double lift = lerp(0.55, 1.5, t) + random.between(-0.1, 0.1);
    const double size = height * lerp(0.85, 1.1, random.next());
    const double half = width * random.between(0.8, 1.15);
    const double droop = lerp(1.7, 0.7, t) * random.between(0.8, 1.2);

    // A long leaf rises from the foot and bends over.
    const Vec3d out{std::cos(angle), 0, -std::sin(angle)};
    const Vec3d side{-std::sin(angle), 0, -std::cos(angle)};

    std::vector<Vec3d> spine{Vec3d{0, trunk * lerp(0.6, 1, t), 0}};
    for (int i = 0; i < kAlong; ++i) {
      const double a = lift - droop * i / (kAlong - 1.0);
      const Vec3d way = out * std::cos(a) + Vec3d{0, std::sin(a), 0};
      spine.push_back(spine.back() + way * (size / kAlong));
    }

    // The blade is folded along its spine, and both of its halves rise towards their edges.
    cards.smoothSheet(
        kAcross, kAlong, false,
        [&](int i, int j) {
          const double s = 2.0 * i / kAcross - 1, keel = 0.35 * half * std::fabs(s);
          return entryOf(spine, j) + side * (s * half) + Vec3d{0, keel, 0};
        },
        [](int i, int j) {
          return Uv{1.0 * i / kAcross, 1.0 * j / kAlong};
        });
  }
  return Shape(stem.part("stem"), cards.part("leaves"));
}

}  // namespace whit::procedural
