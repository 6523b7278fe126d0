#include <numbers>

#include "make/shapes/mesh_builder.h"

namespace whit::procedural {
namespace {

// One bay of a groin vault over [-a, a] x [-b, b]: two half barrels cross, the higher one shows.
// The grid follows both arcs in equal angles, so that the groins run along its diagonals; n even.
void addGroinBay(MeshBuilder& builder, const Vec3d& center, double a, double b, double rise, int n,
                 double repeat) {
  const auto corner = [&](int i, int j, bool arcOverX) {
    const TurnPoint s = turn(i, 2 * n), t = turn(j, 2 * n);
    const Vec3d p{center.x - a * s.cosine, center.y + rise * std::max(s.sine, t.sine),
                  center.z - b * t.cosine};
    const Vec3d normal =
        arcOverX ? Vec3d{rise * s.cosine, -a * s.sine, 0} : Vec3d{0, -b * t.sine, rise * t.cosine};
    return builder.vertex({p, normal, {p.x / repeat, p.z / repeat}});
  };
  using Node = std::array<int, 2>;
  const auto facet = [&](const Node& p, const Node& q, const Node& r) {
    const int x = std::abs(2 * (p[0] + q[0] + r[0]) - 3 * n);
    const int z = std::abs(2 * (p[1] + q[1] + r[1]) - 3 * n);
    const std::uint32_t i0 = corner(p[0], p[1], x < z), i1 = corner(q[0], q[1], x < z),
                        i2 = corner(r[0], r[1], x < z);
    builder.triangle(i0, i1, i2);
  };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const Node p{i, j}, q{i + 1, j}, r{i + 1, j + 1}, s{i, j + 1};
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

// Ceilings seen from below, springing from y = 0, centered on the origin: `groin` has baysX x baysZ
// crossed barrels, `barrel` one tunnel along z.
Shape makeVault(ShapeParameters& parameters) {
  const std::string kind = parameters.word("kind", "groin", {"groin", "barrel"});
  const double width = parameters.number("width", 3, 1e-3, 1e6);
  const double depth = parameters.number("depth", 3, 1e-3, 1e6);
  const int baysX = parameters.integer("baysX", 1, 1, 1000);
  const int baysZ = parameters.integer("baysZ", 1, 1, 1000);
  const double a = width / baysX / 2, b = depth / baysZ / 2;
  const double rise = parameters.number("rise", std::min(a, b), 1e-3, 1e6);
  const int n = 2 * ((parameters.integer("segments", 24, 2, 2048) + 1) / 2);
  const double repeat = parameters.number("uvRepeat", 1, 1e-6, 1e9);
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
  const double width = parameters.number("width", 10, 1e-3, 1e6);
  const double depth = parameters.number("depth", 6, 1e-3, 1e6);
  const double height = parameters.number("height", 0.4, 1e-4, 1e6);
  const double reach = parameters.number("projection", 0.3, 1e-4, 0.49 * std::min(width, depth));
  const double back = parameters.number("back", 0.2, 1e-4, 1e6);
  const bool inward = parameters.flag("inward", true);
  const double repeat = parameters.number("uvRepeat", 1, 1e-6, 1e9);
  // The section, distance from the rectangle's line and height, counter-clockwise.
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
  const double sign = inward ? 1 : -1;
  const auto corner = [&](int k, const std::array<double, 2>& s) {
    const double x = width / 2 - sign * s[0], z = depth / 2 - sign * s[0];
    return Vec3d{k == 0 || k == 3 ? -x : x, s[1], k < 2 ? z : -z};
  };
  MeshBuilder builder(MeshBuilder::Shading::flat);
  for (int side = 0; side < 4; ++side) {
    for (std::size_t m = 0; m < section.size(); ++m) {
      const auto &s = section[m], &t = section[(m + 1) % section.size()];
      const int k0 = inward ? side : (side + 1) % 4, k1 = inward ? (side + 1) % 4 : side;
      builder.plate({corner(k0, s), corner(k0, t), corner(k1, t), corner(k1, s)}, repeat);
    }
  }
  return singlePart(builder.take("cornice"));
}

}  // namespace whit::procedural
