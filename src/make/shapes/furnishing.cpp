#include <numbers>

#include "core/index.h"
#include "make/patterns/noise.h"
#include "make/shapes/mesh_builder.h"

namespace whit::procedural {

namespace {

struct ClothGrid {
  ClothGrid(ShapeParameters& parameters, int columns, int rows)
      : nx(parameters.integer("nx", columns, 1, 4096)),
        ny(parameters.integer("ny", rows, 1, 4096)),
        repeat(parameters.number("uvRepeat", 0, 0, 1e9)),
        seed(parameters.seed()) {}

  Uv uv(int i, int j, double width, double height) const {
    const double s = static_cast<double>(i) / nx, t = static_cast<double>(j) / ny;
    return repeat > 0 ? Uv{s * width / repeat, t * height / repeat} : Uv{s, t};
  }

  int nx, ny;
  double repeat;  // units of length that a texture covers; 0: it is stretched over the cloth
  std::uint32_t seed;
};

using Outline = std::vector<std::array<double, 2>>;

// Returns the outer contour from the foot to the upper edge. Radius and height are in parts of the
// vessel's own.
Outline contour(const std::string& profile) {
  if (profile == "urn") {
    return {{0.50, 0.00}, {0.50, 0.06}, {0.30, 0.10}, {0.22, 0.18}, {0.30, 0.24}, {0.62, 0.34},
            {0.88, 0.50}, {0.96, 0.64}, {0.86, 0.76}, {0.70, 0.84}, {0.74, 0.90}, {1.00, 1.00}};
  }

  if (profile == "pot") {
    return {{0.62, 0.00}, {0.68, 0.10}, {0.76, 0.35}, {0.84, 0.62},
            {0.90, 0.82}, {0.90, 0.83}, {1.00, 0.84}, {1.00, 1.00}};
  }

  return {{0.45, 0.00}, {0.60, 0.08}, {0.85, 0.25}, {0.98, 0.42}, {0.92, 0.58},
          {0.68, 0.72}, {0.46, 0.82}, {0.42, 0.90}, {0.52, 1.00}};
}

// Returns a Catmull-Rom spline through the contour, with `pieces` points for each span.
Outline smoothed(const Outline& points, int pieces) {
  Outline fine;
  const int last = static_cast<int>(points.size()) - 1;
  const auto at = [&](int k) { return entryOf(points, std::clamp(k, 0, last)); };

  for (int k = 0; k < last; ++k) {
    for (int s = 0; s < pieces; ++s) {
      const double t = static_cast<double>(s) / pieces;
      std::array<double, 2> q{};
      for (const auto c : indices(2)) {
        const double a = at(k - 1)[c], b = at(k)[c], d = at(k + 1)[c], e = at(k + 2)[c];
        q[c] = b + 0.5 * t * (d - a + t * (2 * a - 5 * b + 4 * d - e + t * (3 * (b - d) + e - a)));
      }
      fine.push_back(q);
    }
  }

  fine.push_back(points.back());
  return fine;
}

}  // namespace

// A curtain that hangs from y = 0 down to -height in the x-y plane, seen from +z. Its folds deepen
// downwards and wander a little; `gather` pulls its sides together at the given part of the height.
Shape makeCurtain(ShapeParameters& parameters) {
  const double width = parameters.length("width", 2);
  const double height = parameters.length("height", 3);
  const int folds = parameters.integer("folds", 7, 0, 1000);
  const double foldDepth = parameters.number("foldDepth", 0.08, 0, 1e6);
  const double gather = parameters.number("gather", 0, 0, 0.9);
  const double gatherAt = parameters.number("gatherAt", 0.6, 0.05, 0.95);
  const double sag = parameters.number("sag", 0, 0, 1e6);
  const ClothGrid n(parameters, 64, 48);

  MeshBuilder builder;
  builder.smoothSheet(
      n.nx, n.ny, false,
      [&](int i, int j) {
        const double s = static_cast<double>(i) / n.nx, t = 1 - static_cast<double>(j) / n.ny;

        // The cloth is narrowest at the height where it is gathered.
        const double d = (t - gatherAt) / (t < gatherAt ? gatherAt : 2 * (1 - gatherAt));
        const double waist = 1 - gather * (1 - smoothStep(0, 1, std::fabs(d)));

        // Noise makes the folds wander sideways, and the whole cloth swing out.
        const double wander = 0.35 * fractalNoise(n.seed, 2.5 * s + 7, 1.7 * t + 3, 3);
        const double wave = std::cos(2 * std::numbers::pi * (folds * s + wander));
        const double swing = foldDepth * fractalNoise(n.seed + 9, 1.3 * s, 1.5 * t + 0.5, 2);

        // Gathered cloth has nowhere to go but into deeper folds.
        const double deep = foldDepth * (0.35 + 0.65 * t) * (0.6 + 0.4 / waist);

        // The cloth sags most in the middle of its upper edge.
        const double dip = sag * (4 * s * (1 - s)) * (1 - 0.5 * t);
        return Vec3d{(s - 0.5) * width * waist, -height * t - dip, deep * wave + t * swing};
      },
      [&](int i, int j) { return n.uv(i, j, width, height); });
  return singlePart(builder.take("curtain"));
}

// A cloth that spans along x between two bars at y = 0 and sags in between, with creases across the
// span; width is along x, depth along z. It faces down, because it is seen from below.
Shape makeCanopy(ShapeParameters& parameters) {
  const double width = parameters.length("width", 6);
  const double depth = parameters.length("depth", 2);
  const double sag = parameters.number("sag", 0.8, 0, 1e6);
  const double ripple = parameters.number("ripple", 0.06, 0, 1e6);
  const int ripples = parameters.integer("ripples", 5, 0, 1000);
  const ClothGrid n(parameters, 96, 32);

  MeshBuilder builder;
  builder.smoothSheet(
      n.nx, n.ny, false,
      [&](int i, int j) {
        const double s = static_cast<double>(i) / n.nx, t = static_cast<double>(j) / n.ny;

        // The sag follows a parabola between the bars.
        const double belly = 4 * s * (1 - s);
        const double wave =
            std::cos(2 * std::numbers::pi * ripples * t + 3 * gradientNoise(n.seed, 2 * s, 3 * t));

        // Only the bars hold the cloth, so the middle of each free edge hangs in a little.
        const double inward = 1 - 0.18 * belly;

        return Vec3d{(s - 0.5) * width,
                     -sag * belly + ripple * wave * std::sqrt(belly) -
                         0.15 * sag * belly * fractalNoise(n.seed + 5, 2 * s, 2 * t, 2),
                     (t - 0.5) * depth * inward};
      },
      [&](int i, int j) { return n.uv(i, j, width, depth); });
  return singlePart(builder.take("canopy"));
}

// An open vessel with a wall and an inside: profile vase, urn or pot.
Shape makeVase(ShapeParameters& parameters) {
  const std::string profile = parameters.word("profile", "vase", {"vase", "urn", "pot"});
  const double radius = parameters.number("radius", 0.3, 1e-6, 1e9);
  const double height = parameters.number("height", 0.8, 1e-6, 1e9);
  const double wall = parameters.number("wall", 0.06, 0.005, 0.15);  // share of the radius
  const int segments = parameters.integer("segments", 48, 3, 4096);
  const int pieces = parameters.integer("pieces", 4, 1, 256);

  // Pots keep their straight pieces.
  const Outline contourPoints = contour(profile);
  const Outline outer = profile == "pot" ? contourPoints : smoothed(contourPoints, pieces);

  Outline outline{{0, 0}};
  for (const auto& p : outer) outline.push_back({p[0] * radius, p[1] * height});

  // The inside follows the outside down to the floor of the vessel.
  constexpr double kFloor = 0.12;
  for (auto p = outer.rbegin(); p != outer.rend() && (*p)[1] > kFloor; ++p) {
    outline.push_back({std::max((*p)[0] - wall, 0.05) * radius, (*p)[1] * height});
  }
  outline.push_back({0, kFloor * height});

  MeshBuilder builder;
  builder.revolve(creasedProfile(outline, 40, height), segments);
  return singlePart(builder.take("vase"));
}

// A straight drinking glass: a closed solid of glass with a thick base. A liquid in it is a
// cylinder of its own that overlaps the inner wall (nested dielectrics: the higher priority wins).
Shape makeTumbler(ShapeParameters& parameters) {
  const double radius = parameters.number("radius", 0.4, 1e-6, 1e9);
  const double height = parameters.number("height", 1.2, 1e-6, 1e9);
  const double wall = parameters.number("wall", 0.05 * radius, 1e-9, 0.5 * radius);
  const double base = parameters.number("base", 2 * wall, 1e-9, 0.9 * height);
  const double taper = parameters.number("taper", 0.9, 0.5, 1);  // bottom radius over top radius
  const int segments = parameters.integer("segments", 96, 3, 4096);

  // The inner radius at the base follows the slanting outside.
  const double bottom = radius * taper;
  const double inside = bottom + (radius - bottom) * base / height - wall;
  const double round = 0.45 * wall;

  // The lower edge is a quarter circle.
  Outline outline{{0, 0}, {bottom - round, 0}};
  constexpr int kCorner = 6;
  for (int k = 1; k < kCorner; ++k) {
    const double a = std::numbers::pi / 2 * k / kCorner;
    outline.push_back({bottom - round + round * std::sin(a), round - round * std::cos(a)});
  }
  outline.push_back({bottom, round});

  // The upper edge is a half circle across the wall.
  const double middle = radius - wall / 2, y = height - wall / 2;
  for (int k = 0; k <= 2 * kCorner; ++k) {
    const double a = std::numbers::pi * k / (2 * kCorner);
    outline.push_back({middle + wall / 2 * std::cos(a), y + wall / 2 * std::sin(a)});
  }

  outline.push_back({inside, base});
  outline.push_back({0, base});

  MeshBuilder builder;
  builder.revolve(creasedProfile(outline, 40, height), segments);
  return singlePart(builder.take("tumbler"));
}

}  // namespace whit::procedural
