#include "make/shapes/architecture.h"

#include <map>
#include <utility>

#include "make/shapes/mesh_builder.h"

namespace whit::procedural {
namespace {

using Edge = std::pair<PlanPoint, PlanPoint>;
constexpr double kCreaseCosine = 0.81915204428899178968;  // 35 degrees

// Edges of cells without a partner of opposite direction.
std::map<Edge, bool> outlineOf(const std::vector<PlanCell>& plan) {
  std::map<Edge, bool> edges;
  for (const PlanCell& cell : plan) {
    for (std::size_t k = 0; k < 4; ++k) {
      const PlanPoint &a = cell[k], &b = cell[(k + 1) % 4];
      if (a == b) continue;
      const auto partner = edges.find({b, a});
      if (partner != edges.end()) {
        edges.erase(partner);
      } else {
        edges[{a, b}] = true;
      }
    }
  }
  return edges;
}

Vec3d outward(const Edge& e) {
  return normalized(Vec3d{e.second[1] - e.first[1], e.first[0] - e.second[0], 0});
}

void addFaces(MeshBuilder& builder, const std::vector<PlanCell>& plan, double z, double repeat) {
  for (const PlanCell& cell : plan) {
    std::array<Vec3d, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) corners[k] = {cell[k][0], cell[k][1], z};
    builder.plate(corners, repeat);
  }
}

void addSides(MeshBuilder& builder, const std::vector<PlanCell>& plan, double z0, double z1,
              double repeat) {
  const auto outline = outlineOf(plan);
  std::map<PlanPoint, Vec3d> arriving, leaving;
  for (const auto& [edge, present] : outline) {
    leaving[edge.first] = outward(edge);
    arriving[edge.second] = outward(edge);
  }
  const auto smoothed = [](const Vec3d& own, const Vec3d& neighbor) {
    return dot(own, neighbor) > kCreaseCosine ? own + neighbor : own;
  };
  for (const auto& [edge, present] : outline) {
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

}  // namespace

Mesh extrude(const std::vector<PlanCell>& plan, double z0, double z1, double repeat) {
  MeshBuilder builder;
  addFaces(builder, plan, z1, repeat);
  std::vector<PlanCell> behind = plan;
  for (PlanCell& cell : behind) std::swap(cell[1], cell[3]);
  addFaces(builder, behind, z0, repeat);
  addSides(builder, plan, z0, z1, repeat);
  return builder.take("extrusion");
}

PlanCell rectangle(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
}

std::vector<PlanCell> halfRing(PlanPoint center, PlanPoint inner, PlanPoint outer, int segments) {
  const auto at = [&](const PlanPoint& radii, int k) {
    const TurnPoint t = turn(k, 2 * segments);
    return PlanPoint{center[0] + radii[0] * t.cosine, center[1] + radii[1] * t.sine};
  };
  std::vector<PlanCell> cells;
  cells.reserve(static_cast<std::size_t>(segments));
  for (int k = 0; k < segments; ++k) {
    cells.push_back({at(inner, k), at(outer, k), at(outer, k + 1), at(inner, k + 1)});
  }
  return cells;
}

}  // namespace whit::procedural
