#include "make/shapes/architecture.h"

#include <numbers>

#include "make/patterns/noise.h"
#include "make/shapes/generators.h"
#include "make/shapes/mesh_builder.h"

namespace whit::procedural {
namespace {

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

void addBase(MeshBuilder& builder, const ColumnPlan& plan, int segments) {
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
  builder.revolve(creasedProfile(outline, 45, plan.uvRepeat), segments, 4);
}

// Radius of the bell of the capital at t in [0, 1] from neck to abacus.
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

void addCapital(MeshBuilder& builder, const ColumnPlan& plan, int segments) {
  const double r = plan.radius, bottom = plan.height - kCapital * r;
  const double bellTop = plan.height - kAbacus * r, neckTop = bottom + kNeck * r;
  std::vector<std::array<double, 2>> outline{{0, bottom}};
  addHalfRound(outline, 0.90 * r, bottom, neckTop);
  constexpr int kSteps = 10;
  for (int k = 0; k <= kSteps; ++k) {
    const double t = static_cast<double>(k) / kSteps;
    outline.push_back({bellRadius(plan, t), lerp(neckTop, bellTop, t)});
  }
  outline.push_back({0, bellTop});
  builder.revolve(creasedProfile(outline, 45, plan.uvRepeat), segments, 4);
  const double a = kAbacusHalf * r;
  builder.box({-a, bellTop - 0.01 * r, -a}, {a, plan.height, a}, plan.uvRepeat);
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
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const std::uint32_t a = rim[i], b = rim[(i + 1) % rim.size()];
      builder.triangle(center, top ? a : b, top ? b : a);
    }
  }
}

}  // namespace

ColumnMeshes buildColumn(const ColumnPlan& plan) {
  int segments = plan.segments;
  if (plan.flutes > 0) {
    const int unit = 4 * plan.flutes;
    segments = std::max(unit, (plan.segments + unit - 1) / unit * unit);
  }
  ColumnMeshes meshes;
  MeshBuilder shaft, trim;
  addShaft(shaft, plan, segments);
  addBase(trim, plan, plan.segments);
  addCapital(trim, plan, plan.segments);
  meshes.shaft = shaft.take("shaft");
  meshes.trim = trim.take("trim");
  return meshes;
}

Shape makeColumn(ShapeParameters& parameters) {
  ColumnPlan plan;
  plan.radius = parameters.number("radius", plan.radius, 1e-4, 1e6);
  plan.height = parameters.number("height", plan.height, 4.5 * plan.radius, 1e6);
  plan.flutes = parameters.integer("flutes", plan.flutes, 0, 256);
  plan.segments = parameters.integer("segments", plan.segments, 8, 4096);
  plan.rings = parameters.integer("rings", plan.rings, 1, 4096);
  plan.taper = parameters.number("taper", plan.taper, 0, 0.14);
  plan.leaves = parameters.integer("leaves", plan.leaves, 0, 64);
  plan.uvRepeat = parameters.number("uvRepeat", plan.uvRepeat, 1e-6, 1e9);
  ColumnMeshes meshes = buildColumn(plan);
  Shape shape;
  shape.parts.push_back({"shaft", std::move(meshes.shaft)});
  shape.parts.push_back({"trim", std::move(meshes.trim)});
  return shape;
}

}  // namespace whit::procedural
