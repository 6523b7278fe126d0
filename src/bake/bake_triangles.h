// Records of triangles for the tables of a Scene, the classes of triangles, and the rules by which
// triangles are dropped. Internal to finalize().
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bake/scene.h"
#include "core/text.h"
#include "core/warnings.h"

namespace whit {

// Properties of a material that the records and classes of its triangles depend on.
struct MaterialUse {
  std::uint8_t triangleClass = 0;
  bool repeatU = false, repeatV = false;  // textured, and every texture repeats along that axis
};
MaterialUse useOf(const Material& material, const std::vector<Texture>& textures);

// Twice the area along the normal. Differences of floats and their products lose next to nothing in
// double, so that zero means collinear corners (hard cases H23, H24).
inline Vec3d areaVector(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const Vec3d origin(a);
  return cross(Vec3d(b) - origin, Vec3d(c) - origin);
}

// Returns the unit normal that follows from the winding of the corners.
Vec3d faceNormal(const TriangleRecord& record);

// `corners` index `position`, the mesh's triangle indexes its uvs. Coordinates that are not finite
// become 0 and are added to `repaired`. Where all corners lie far from uv 0 along an axis that
// repeats, the same whole number is taken from each, which saves bits without changing the picture.
TriangleRecord makeTriangleRecord(const Mesh& mesh, std::size_t triangle,
                                  const std::vector<Vec3f>& position,
                                  const std::array<std::uint32_t, 3>& corners,
                                  const MaterialUse& use, std::uint64_t& repaired);

// Treats the second texture coordinates in the same way; zeros where the mesh has none.
UvRecord makeSecondUvRecord(const Mesh& mesh, std::size_t triangle, const MaterialUse& use,
                            std::uint64_t& repaired);

// The mesh's normals have unit length, or are zero where they have no direction: these are replaced
// by the face's normal and added to `repaired`. Where Mesh::fromModel has stretched the model, the
// normals get back the lengths that it gave them.
NormalRecord makeNormalRecord(const Mesh& mesh, std::size_t triangle, const TriangleRecord& record,
                              std::uint64_t& repaired);

// Returns white where the mesh has no colors. Values outside of [0, 1] are clamped, NaN becomes 0,
// and both are added to `repaired`.
ColorRecord makeColorRecord(const Mesh& mesh, std::size_t triangle, std::uint64_t& repaired);

inline constexpr std::uint8_t kDroppedClass = kTriangleClasses;

struct TriangleClassification {
  std::vector<std::uint8_t> classes;  // class or kDroppedClass, one a triangle
  std::array<std::uint32_t, kTriangleClasses + 1> count{};

  void drop(std::size_t triangle) {
    --count[classes[triangle]];
    classes[triangle] = kDroppedClass;
    ++count[kDroppedClass];
  }
};

// Counts the repairs of one kind in a mesh, and remembers the first triangle for the warning.
struct Tally {
  std::uint64_t count = 0;
  std::size_t first = 0;
  void add(std::size_t triangle, std::uint64_t times = 1) {
    if (count == 0) first = triangle;
    count += times;
  }
  void report(Warnings& warnings, const char* kind, const Mesh& mesh) const {
    warnings.add(kind, concat("mesh '", mesh.name, "', triangle ", first), count);
  }
};

// `position` are the mesh's `vertices` baked positions; `uses` is indexed by material. Drops and
// counts triangles that have an index out of range, a corner that Embree would not take, or no
// area. At most 2^32 - 1 triangles.
TriangleClassification classifyTriangles(const Mesh& mesh, const Vec3f* position,
                                         std::size_t vertices, const std::vector<MaterialUse>& uses,
                                         Warnings& warnings);

}  // namespace whit
