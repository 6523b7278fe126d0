// Puts meshes together vertex by vertex, in double, rounding once. All shapes keep to the rules of
// scene/mesh.h: counter-clockwise seen from outside, unit normals, v up. Corners that two faces
// share are computed by the same expression, so that their positions are bit-equal and closed
// shapes are watertight even where texture coordinates or normals have a seam.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "make/shape.h"
#include "scene/mesh.h"

namespace whit::procedural {

struct Uv {
  double u = 0, v = 0;
};

struct SurfacePoint {
  Vec3d position, normal;
  Uv uv;
};

// A point of the outline that is turned about the y axis: radius, height, the outward normal in
// that half plane (any length), and the v coordinate.
struct ProfilePoint {
  double r = 0, y = 0, nr = 0, ny = 0, v = 0;
};

class MeshBuilder {
 public:
  enum class Shading { smooth, flat };
  explicit MeshBuilder(Shading shading = Shading::smooth) : shading_(shading) {}

  std::uint32_t vertex(const SurfacePoint& point);
  // Leaves out triangles with two equal corners (the poles of a sphere, say).
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
  // Adds a quad from four corners, counter-clockwise, with the plane's normal. Its uvs are
  // projected along the largest axis of the normal, with `repeat` units of length for a texture.
  void plate(const std::array<Vec3d, 4>& corners, double repeat);

  // Adds a sheet of nu x nv cells with the points at(i, j) for 0 <= i <= nu, 0 <= j <= nv. Outside
  // is where the cross product of the directions of i and j points.
  void sheet(int nu, int nv, const std::function<SurfacePoint(int, int)>& at);
  // Adds a sheet with normals from the differences of neighboring positions. wrapU: column nu is
  // column 0 again (`position` is asked for i < nu only).
  void smoothSheet(int nu, int nv, bool wrapU, const std::function<Vec3d(int, int)>& position,
                   const std::function<Uv(int, int)>& uv);
  // Turns `profile` about the y axis. Outside is to the right of its course (bottom to top outside,
  // from the axis out along a bottom face, back to the axis along a top face). Two points at the
  // same place with different normals make an edge. u runs from 0 to `uRepeat`.
  void revolve(const std::vector<ProfilePoint>& profile, int segments, double uRepeat = 1);
  // Adds a closed box between two corners.
  void box(const Vec3d& low, const Vec3d& high, double repeat = 1);
  void append(const Mesh& mesh, const Affine& map);

  Mesh take(const std::string& name);
  // Takes the mesh as the part for a slot, which gives the mesh its name.
  ShapePart part(const std::string& slot) { return {slot, take(slot)}; }

 private:
  Shading shading_;
  Mesh mesh_;
};

// Returns a shape of one part.
inline Shape singlePart(Mesh mesh) { return Shape(ShapePart{"surface", std::move(mesh)}); }

// Returns the subdivided icosahedron: unit points, and 20 * 4^level triangles.
std::pair<std::vector<Vec3d>, std::vector<std::array<std::uint32_t, 3>>> icosphereMesh(int level);

// Cosine and sine of i / n of a turn. They are bit-equal for i and i + n, and exact at the
// quarters.
struct TurnPoint {
  double cosine, sine;
};
TurnPoint turn(int i, int n);

// Returns an outline through (r, y) points, with normals averaged at corners that turn by less than
// `creaseDegrees`; v is the length along the outline divided by `repeat`.
std::vector<ProfilePoint> creasedProfile(const std::vector<std::array<double, 2>>& points,
                                         double creaseDegrees, double repeat = 1);

}  // namespace whit::procedural
