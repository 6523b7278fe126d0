#include "bake/bake_triangles.h"

namespace whit {

namespace {

struct Dropped {
  Tally badIndex, badCorner, degenerate;
};

bool isUsable(const Vec3f& p) { return isFinite(p) && maxComponent(abs(p)) <= kLargestCoordinate; }

// Returns whether the triangle is to be dropped, and counts it. A triangle that bends may have an
// area at another time.
bool drop(const std::array<std::uint32_t, 3>& corners, const Vec3f* position, std::size_t vertices,
          std::size_t triangle, bool bends, Dropped& dropped) {
  const auto& [i, j, k] = corners;
  if (i >= vertices || j >= vertices || k >= vertices) {
    dropped.badIndex.add(triangle);
    return true;
  }
  const Vec3f &a = position[i], &b = position[j], &c = position[k];
  if (!isUsable(a) || !isUsable(b) || !isUsable(c)) {
    dropped.badCorner.add(triangle);
    return true;
  }
  if (!bends && areaVector(a, b, c) == Vec3d{}) {
    dropped.degenerate.add(triangle);
    return true;
  }
  return false;
}

}  // namespace

TriangleClassification classifyTriangles(const Mesh& mesh, const Vec3f* position,
                                         std::size_t vertices, const std::vector<MaterialUse>& uses,
                                         Warnings& warnings) {
  Dropped dropped;
  TriangleClassification result;
  result.classes.resize(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const bool out =
        drop(mesh.triangles[i], position, vertices, i, mesh.deformation != nullptr, dropped);
    result.classes[i] = out ? kDroppedClass : uses[mesh.material(i)].triangleClass;
    ++result.count[result.classes[i]];
  }
  dropped.badIndex.report(warnings, "triangle with a vertex index out of range dropped", mesh);
  dropped.badCorner.report(warnings, "triangle with a non-finite or enormous corner dropped", mesh);
  dropped.degenerate.report(warnings, "degenerate triangle dropped", mesh);
  const bool nothingLeft =
      !mesh.triangles.empty() && result.count[kDroppedClass] == mesh.triangles.size();
  if (nothingLeft) {
    warnings.add("mesh with nothing to draw: all its triangles were dropped",
                 "mesh '" + mesh.name + "'");
  }
  for (std::uint8_t c = 0; c <= kDroppedClass; ++c) {
    if (result.count[c] != mesh.triangles.size()) continue;
    result.only = c;
    result.classes = {};
    break;
  }
  return result;
}

}  // namespace whit
