// Which class each triangle of a mesh belongs to, and which are dropped. Internal to finalize().
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/warnings.h"
#include "scene/triangle_record.h"

namespace whit {

inline constexpr std::uint8_t kDroppedClass = kTriangleClasses;

struct TriangleClassification {
  // Class or kDroppedClass, one a triangle; empty where all triangles are of `only`.
  std::vector<std::uint8_t> classes;
  std::uint8_t only = kDroppedClass;
  std::array<std::uint32_t, kTriangleClasses + 1> count{};

  bool has(std::size_t triangle, std::size_t wanted) const {
    return (classes.empty() ? only : classes[triangle]) == wanted;
  }
  // Of a mesh of so many triangles.
  void drop(std::size_t triangle, std::size_t triangles) {
    if (classes.empty()) classes.assign(triangles, only);
    --count[classes[triangle]];
    classes[triangle] = kDroppedClass;
    ++count[kDroppedClass];
  }
};

// Something repaired in one mesh: how often, and where first.
struct Tally {
  std::uint64_t count = 0;
  std::size_t first = 0;
  void add(std::size_t triangle, std::uint64_t times = 1) {
    if (count == 0) first = triangle;
    count += times;
  }
  void report(Warnings& warnings, const char* kind, const Mesh& mesh) const {
    warnings.add(kind, "mesh '" + mesh.name + "', triangle " + std::to_string(first), count);
  }
};

// `position` are the mesh's `vertices` baked positions; `uses` is indexed by material. Drops and
// counts triangles that have an index out of range, a corner that Embree would not take, or no
// area. At most 2^32 - 1 triangles.
TriangleClassification classifyTriangles(const Mesh& mesh, const Vec3f* position,
                                         std::size_t vertices, const std::vector<MaterialUse>& uses,
                                         Warnings& warnings);

}  // namespace whit
