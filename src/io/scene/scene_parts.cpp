#include "io/scene/scene_parts.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>
#include <vector>

#include "core/error.h"
#include "core/index.h"
#include "core/options.h"
#include "core/text.h"
#include "scene/texture.h"

namespace whit {

namespace {

// Numbers of one kind; `each` is how many of them belong to one vertex or pixel.
struct Column {
  std::span<const float> numbers;
  std::size_t each;
  const char* name;
  float low = std::numeric_limits<float>::lowest();
  float high = std::numeric_limits<float>::max();
};

void requireNumbers(const Column& column, const std::string& where) {
  const auto fits = [&](float x) { return x >= column.low && x <= column.high; };
  const auto bad = std::ranges::find_if_not(column.numbers, fits);
  if (bad == column.numbers.end()) return;

  const bool anyFinite = column.high == std::numeric_limits<float>::max();
  const std::string range = anyFinite ? "finite numbers"
                                      : "numbers from " + formatted("%g", double{column.low}) +
                                            " to " + formatted("%g", double{column.high});

  const std::size_t at = bad - column.numbers.begin();
  throwBadScene(where, concat("expected ", range, " in ", column.name, ", found ",
                              formatted("%g", double{*bad}), " at [", at / column.each, ", ",
                              at % column.each, "]"));
}

template <typename To>
std::vector<To> copied(const Column& column) {
  static_assert(std::is_trivially_copyable_v<To>);
  std::vector<To> to(column.numbers.size() / column.each);
  static_assert(sizeof(To) % sizeof(float) == 0 && std::is_standard_layout_v<To>);
  if (to.empty()) return to;
  std::memcpy(static_cast<void*>(to.data()), column.numbers.data(), to.size() * sizeof(To));
  return to;
}

std::vector<std::array<std::uint32_t, 3>> trianglesOf(const GivenMesh& given, std::size_t vertices,
                                                      const std::string& where) {
  std::vector<std::array<std::uint32_t, 3>> triangles;

  // Without indices, every three vertices form a triangle.
  if (given.triangles.empty()) {
    if (vertices % 3 != 0) {
      throwBadScene(where,
                    concat("expected a multiple of 3 vertices where no triangles are given, found ",
                           vertices));
    }
    for (std::uint32_t i = 0; i < vertices; i += 3) triangles.push_back({i, i + 1, i + 2});
    return triangles;
  }

  if (given.triangles.size() % 3 != 0) {
    throwBadScene(where, concat("expected three vertices a triangle, found ",
                                given.triangles.size(), " numbers"));
  }

  const auto outside = [&](std::uint32_t vertex) { return vertex >= vertices; };
  const auto bad = std::ranges::find_if(given.triangles, outside);
  if (bad != given.triangles.end()) {
    throwBadScene(where, concat("expected vertices below ", vertices, ", found ", *bad,
                                " in triangle ", (bad - given.triangles.begin()) / 3));
  }

  triangles.resize(given.triangles.size() / 3);
  std::memcpy(triangles.data(), given.triangles.data(), given.triangles.size_bytes());
  return triangles;
}

}  // namespace

Mesh meshOf(const GivenMesh& given, const std::string& where) {
  const std::size_t vertices = given.positions.size() / 3;
  if (given.positions.size() % 3 != 0) {
    throwBadScene(where, concat("expected three numbers a position, found ", given.positions.size(),
                                " numbers"));
  }
  if (vertices >= std::numeric_limits<std::uint32_t>::max()) {
    throwLimit(where + ": more than 2^32 - 2 vertices");
  }

  // Normals, UVs and colors may be missing, but are complete if they are given.
  const Column positions{given.positions, 3, "positions"}, normals{given.normals, 3, "normals"},
      uvs{given.uvs, 2, "uvs"}, colors{given.colors, 3, "colors", 0, 1};
  for (const Column& column : {positions, normals, uvs, colors}) {
    const std::size_t expected = column.each * vertices, found = column.numbers.size();
    if (found != 0 && found != expected) {
      throwBadScene(where, concat("expected ", column.name, " for ", vertices, " vertices, ",
                                  column.each, " numbers each, found ", found, " numbers"));
    }
    requireNumbers(column, where);
  }

  Mesh mesh;
  mesh.triangles = trianglesOf(given, vertices, where);
  mesh.positions = copied<Vec3f>(positions);
  mesh.normals = copied<Vec3f>(normals);
  mesh.uvs = copied<Vec2f>(uvs);
  mesh.colors = copied<Rgb>(colors);
  return mesh;
}

RawImage imageOf(const GivenImage& given, const std::string& where) {
  const auto fits = [](int side) { return side >= 1 && side <= kImageSideLimit; };
  if (!fits(given.width) || !fits(given.height)) {
    throwBadScene(where, concat("expected 1 to ", kImageSideLimit, " pixels a side"));
  }
  if (given.channels < 1 || given.channels > 4) throwBadScene(where, "expected 1 to 4 channels");

  const std::size_t count = cellsOf(given.width, given.height) * given.channels;
  if (std::max(given.codes.size(), given.values.size()) != count ||
      std::min(given.codes.size(), given.values.size()) != 0) {
    throwBadScene(where, "expected width * height * channels numbers, all codes or all values");
  }
  requireNumbers({given.values, static_cast<std::size_t>(given.channels), "the image", 0,
                  kLargestRadianceTexel},
                 where);

  RawImage raw;
  raw.width = given.width;
  raw.height = given.height;
  raw.channels = given.channels;
  raw.linear = given.codes.empty();
  raw.codes.assign(given.codes.begin(), given.codes.end());
  raw.values.assign(given.values.begin(), given.values.end());
  return raw;
}

}  // namespace whit
