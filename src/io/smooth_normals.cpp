#include "io/smooth_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "core/index.h"

namespace whit {
namespace {

// If more faces meet at a point, about this many of them are used, evenly spread.
constexpr std::size_t kMostAround = 1024;
// Vertices are shared by corners that are no farther apart in the order of a point's corners.
constexpr std::size_t kMostBetween = 64;
// Faces whose normals have a larger cosine lie in one plane, up to rounding.
constexpr float kCoplanar = 1 - 1.0e-6f;

struct FaceCorner {
  std::array<float, 3> place;
  std::uint32_t former;   // the vertex as the file has it
  std::uint32_t* vertex;  // vertex index of the triangle
  Vec3f faceNormal;       // zero where the face has none
  float angle;            // angle of the face at this corner
  Vec3f normal = {};
};

// Returns the corners of all triangles, those at the same place beside each other.
std::vector<FaceCorner> cornersByPlace(Mesh& mesh) {
  std::vector<FaceCorner> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (auto& triangle : mesh.triangles) {
    const auto at = [&](std::size_t i) { return Vec3d(mesh.positions[triangle[i % 3]]); };
    for (const auto i : indices(3)) {
      const Vec3d a = normalized(at(i + 1) - at(i)), b = normalized(at(i + 2) - at(i));
      const double angle = std::atan2(length(cross(a, b)), dot(a, b));

      // Positions are not validated yet, and NaN has no place in an order.
      const Vec3f place = isFinite(at(i)) ? mesh.positions[triangle[i]] : Vec3f();
      corners.push_back({{place.x, place.y, place.z},
                         triangle[i],
                         &triangle[i],
                         Vec3f(normalized(cross(a, b))),
                         static_cast<float>(angle)});
    }
  }
  std::ranges::stable_sort(corners, {}, &FaceCorner::place);
  return corners;
}

// Calls use(corners) with those at each place.
template <typename Use>
void forEachPlace(std::span<FaceCorner> corners, const Use& use) {
  while (!corners.empty()) {
    const auto isHere = [&](const FaceCorner& c) { return c.place == corners[0].place; };
    const auto end = std::ranges::find_if_not(corners, isHere);
    const std::size_t count = end - corners.begin();
    use(corners.first(count));
    corners = corners.subspan(count);
  }
}

// Sets the normals of corners at one place. Returns true if some face is not as flat as before.
bool setNormals(std::span<FaceCorner> corners) {
  const float least = std::cos(kSmoothestDegrees * (std::numbers::pi_v<float> / 180));
  bool isSmooth = false;
  for (FaceCorner& corner : corners) {
    Vec3d sum;
    for (std::size_t i = 0; i < corners.size(); i += 1 + corners.size() / kMostAround) {
      const float cosine = dot(corner.faceNormal, corners[i].faceNormal);
      if (cosine < least) continue;
      sum += Vec3d(corners[i].faceNormal) * double{corners[i].angle};
      isSmooth = isSmooth || cosine < kCoplanar;
    }
    corner.normal = Vec3f(normalized(sum, Vec3d(corner.faceNormal)));
  }
  return isSmooth;
}

template <typename T>
void repeat(std::vector<T>& values, std::size_t i) {
  if (values.empty()) return;
  const T value = values[i];
  values.push_back(value);
}

// Gives the corners at one place vertices with their normals.
void setVertices(std::span<FaceCorner> corners, Mesh& mesh) {
  for (const auto i : indices(corners)) {
    const FaceCorner& own = corners[i];
    const auto before = corners.first(i).last(std::min(i, kMostBetween));
    const auto known = std::ranges::find_if(before, [&](const FaceCorner& c) {
      return c.former == own.former && c.normal == own.normal;
    });

    if (known != before.end()) {
      *own.vertex = *known->vertex;
    } else if (mesh.normals[own.former] == Vec3f()) {
      mesh.normals[own.former] = own.normal;  // the first corner keeps the vertex
    } else {
      *own.vertex = size32(mesh.positions);
      repeat(mesh.positions, own.former);
      repeat(mesh.uvs, own.former);
      repeat(mesh.colors, own.former);
      mesh.normals.push_back(own.normal);
    }
  }
}

}  // namespace

void smoothNormals(Mesh& mesh, const std::string& file, MemoryBudget& budget) {
  // Sorting takes as much memory again. Vertices for all corners fit into that memory later.
  budget.charge(mesh.triangles.size(), 2 * 3 * sizeof(FaceCorner), file);
  std::vector<FaceCorner> corners = cornersByPlace(mesh);

  bool isSmooth = false;
  forEachPlace(corners, [&](std::span<FaceCorner> here) { isSmooth |= setNormals(here); });
  if (!isSmooth) return;

  mesh.normals.assign(mesh.positions.size(), {});
  forEachPlace(corners, [&](std::span<FaceCorner> here) { setVertices(here, mesh); });
  mesh.hasFlatFaces = false;
  mesh.hasMadeNormals = true;
}

}  // namespace whit
