#include <map>
#include <numbers>
#include <utility>

#include "make/shapes/mesh_builder.h"
#include "scene/generation_limit.h"

namespace whit::procedural {
namespace {

int segmentsOf(ShapeParameters& parameters, int fallback) {
  return parameters.integer("segments", fallback, 3, 4096);
}

double radiusOf(ShapeParameters& parameters, double fallback = 1) {
  return parameters.number("radius", fallback, 1e-6, 1e9);
}

// Completes a round shape. Without normals its faces are flat.
Shape finished(Mesh mesh, ShapeParameters& parameters) {
  if (!parameters.flag("smooth", true)) mesh.normals.clear();
  return singlePart(std::move(mesh));
}

Mesh sphereMesh(double radius, int segments, int rings) {
  std::vector<ProfilePoint> profile;
  for (int j = 0; j <= rings; ++j) {
    // turn() is exact at the quarters, so that both poles lie exactly on the axis.
    const TurnPoint t = turn(j, 2 * rings);
    profile.push_back(
        {radius * t.sine, -radius * t.cosine, t.sine, -t.cosine, static_cast<double>(j) / rings});
  }

  MeshBuilder builder;
  builder.revolve(profile, segments);
  return builder.take("sphere");
}

Shape exactSphere(double radius) {
  Mesh mesh;
  mesh.name = "sphere";
  mesh.spheres = {Affine::scaling(Vec3d(radius))};
  return singlePart(std::move(mesh));
}

// Returns 0 if the number of facets is not given: then the sphere is exact.
int facetsOf(ShapeParameters& parameters, const std::string& key, int least) {
  constexpr int kMost = 4096;
  const int given = parameters.integer(key, 0, 0, kMost);
  return given == 0 ? 0 : parameters.integer(key, given, least, kMost);
}

// Reads how many units of length a texture covers; 0 stretches it over the face.
double repeatOf(ShapeParameters& parameters, double fallback) {
  return parameters.number("uvRepeat", fallback, 0, 1e9);
}

double side(ShapeParameters& parameters, const char* key, double fallback) {
  return parameters.number(key, fallback, 1e-6, 1e9);
}

}  // namespace

Shape makeSphere(ShapeParameters& parameters) {
  const double radius = radiusOf(parameters);
  const int segments = facetsOf(parameters, "segments", 3);
  const int rings = facetsOf(parameters, "rings", 2);
  const bool smooth = parameters.flag("smooth", true);
  if (segments == 0 && rings == 0 && smooth) return exactSphere(radius);

  const int around = segments == 0 ? 64 : segments;
  Mesh mesh = sphereMesh(radius, around, rings == 0 ? std::max(2, around / 2) : rings);
  if (!smooth) mesh.normals.clear();
  return singlePart(std::move(mesh));
}

void tessellateSpheres(Mesh& mesh, int segments) {
  if (mesh.spheres.empty()) return;

  const Mesh unit = sphereMesh(1, segments, segments / 2);
  GenerationLimit::charge(mesh.spheres.size(),
                          unit.positions.size() * (2 * sizeof(Vec3f) + sizeof(Vec2f)) +
                              unit.triangles.size() * sizeof(unit.triangles[0]));

  for (const Affine& map : std::exchange(mesh.spheres, {})) {
    Mesh sphere = unit;
    transform(sphere, map);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());

    const auto append = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(mesh.positions, sphere.positions);
    append(mesh.normals, sphere.normals);
    append(mesh.uvs, sphere.uvs);
    for (const auto& [i, j, k] : sphere.triangles) {
      mesh.triangles.push_back({first + i, first + j, first + k});
    }
  }
}

std::pair<std::vector<Vec3d>, std::vector<std::array<std::uint32_t, 3>>> icosphereMesh(int level) {
  // A closed mesh has about half as many vertices as triangles.
  GenerationLimit::charge(20ull << (2 * level), 3 * sizeof(std::uint32_t) + sizeof(Vec3d) / 2);

  // The corners of an icosahedron are those of three golden rectangles.
  const double g = 1.6180339887498948482;
  std::vector<Vec3d> points{{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                            {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                            {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  for (Vec3d& p : points) p = normalized(p);

  std::vector<std::array<std::uint32_t, 3>> triangles{
      {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};

  // Each level splits a triangle into four, and moves the new points out to the unit sphere.
  for (int k = 0; k < level; ++k) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    // Neighboring triangles share the middle of their edge.
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, fresh] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
      if (fresh) points.push_back(normalized(points[a] + points[b]));
      return entry->second;
    };

    std::vector<std::array<std::uint32_t, 3>> finer;
    finer.reserve(triangles.size() * 4);
    for (const auto& [a, b, c] : triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  return {std::move(points), std::move(triangles)};
}

Shape makeIcosphere(ShapeParameters& parameters) {
  const double radius = radiusOf(parameters);
  const auto [points, triangles] = icosphereMesh(parameters.integer("level", 4, 0, 9));

  MeshBuilder builder;
  for (const Vec3d& p : points) {
    // One vertex for each point keeps the mesh seamless; u jumps once around the back.
    builder.vertex({p * radius,
                    p,
                    {0.5 + std::atan2(-p.z, p.x) / (2 * std::numbers::pi),
                     0.5 + std::asin(std::clamp(p.y, -1.0, 1.0)) / std::numbers::pi}});
  }

  for (const auto& [a, b, c] : triangles) builder.triangle(a, b, c);
  return finished(builder.take("icosphere"), parameters);
}

Shape makeCylinder(ShapeParameters& parameters) {
  const double r = radiusOf(parameters), h = parameters.number("height", 2, 1e-6, 1e9) / 2;
  MeshBuilder builder;
  builder.revolve(creasedProfile({{0, -h}, {r, -h}, {r, h}, {0, h}}, 0, 2 * std::numbers::pi * r),
                  segmentsOf(parameters, 64));
  return finished(builder.take("cylinder"), parameters);
}

Shape makeCone(ShapeParameters& parameters) {
  const double r = radiusOf(parameters), h = parameters.number("height", 2, 1e-6, 1e9) / 2;
  const double top = parameters.number("topRadius", 0, 0, 1e9);

  std::vector<std::array<double, 2>> outline{{0, -h}, {r, -h}, {top, h}};
  if (top > 0) outline.push_back({0, h});

  MeshBuilder builder;
  builder.revolve(creasedProfile(outline, 0, 2 * std::numbers::pi * r), segmentsOf(parameters, 64));
  return finished(builder.take("cone"), parameters);
}

Shape makeTorus(ShapeParameters& parameters) {
  const double radius = radiusOf(parameters);
  const double tube = parameters.number("tubeRadius", 0.25 * radius, 1e-9, radius);
  const int rings = parameters.integer("rings", 32, 3, 4096);

  std::vector<ProfilePoint> profile;
  for (int j = 0; j <= rings; ++j) {
    const TurnPoint t = turn(j, rings);
    profile.push_back({radius + tube * t.cosine, tube * t.sine, t.cosine, t.sine,
                       static_cast<double>(j) / rings});
  }

  MeshBuilder builder;
  builder.revolve(profile, segmentsOf(parameters, 96));
  return finished(builder.take("torus"), parameters);
}

// A disc that faces up.
Shape makeDisc(ShapeParameters& parameters) {
  const double radius = radiusOf(parameters);
  const int segments = segmentsOf(parameters, 64);
  MeshBuilder builder(MeshBuilder::Shading::flat);

  // Vertex 0 is the center, and the circle follows.
  const std::uint32_t center = builder.vertex({{0, 0, 0}, {0, 1, 0}, {0.5, 0.5}});
  for (int i = 0; i < segments; ++i) {
    const TurnPoint t = turn(i, segments);
    builder.vertex({{radius * t.cosine, 0, -radius * t.sine},
                    {0, 1, 0},
                    {0.5 + 0.5 * t.cosine, 0.5 + 0.5 * t.sine}});
  }

  const auto n = static_cast<std::uint32_t>(segments);
  for (std::uint32_t i = 0; i < n; ++i) builder.triangle(center, 1 + i, 1 + (i + 1) % n);
  return singlePart(builder.take("disc"));
}

// A rectangle that faces up, centered on the origin: width along x, depth along z.
Shape makeQuad(ShapeParameters& parameters) {
  const double width = side(parameters, "width", 2), depth = side(parameters, "depth", 2);
  const double repeat = repeatOf(parameters, 0);

  MeshBuilder builder(MeshBuilder::Shading::flat);
  builder.sheet(1, 1, [&](int u, int v) {
    const Uv uv = repeat > 0 ? Uv{u * width / repeat, v * depth / repeat} : Uv{1.0 * u, 1.0 * v};
    return SurfacePoint{{(u - 0.5) * width, 0, (0.5 - v) * depth}, {0, 1, 0}, uv};
  });
  return singlePart(builder.take("quad"));
}

Shape makeBox(ShapeParameters& parameters) {
  const Vec3d size = parameters.vector("size", {2, 2, 2});
  const double repeat = repeatOf(parameters, 1);
  const Vec3d half = abs(size) / 2.0;

  MeshBuilder builder(MeshBuilder::Shading::flat);
  builder.box(-half, half, repeat > 0 ? repeat : std::max(maxComponent(abs(size)), 1e-12));
  return singlePart(builder.take("box"));
}

// A cube whose six faces are grids; each point is pushed out from the inner box by the radius, so
// neighboring faces compute the same points along their common edges.
Shape makeRoundedBox(ShapeParameters& parameters) {
  const Vec3d half = max(abs(parameters.vector("size", {2, 2, 2})) / 2.0, Vec3d(1e-9));
  const double least = std::min(half.x, std::min(half.y, half.z));
  const double radius = parameters.number("radius", 0.1 * least, 1e-9, 1e9);
  const int steps = parameters.integer("steps", 4, 1, 256);

  const double r = std::min(radius, least);
  const int n = 2 * steps + 1;

  // Each face has half of a rounding on either side of its flat middle, in equal angles.
  const auto coordinate = [&](int i, double h) {
    const int k = i <= steps ? steps - i : i - steps - 1;
    const double c = (h - r) + (k == steps ? r : r * std::tan(std::numbers::pi / 4 * k / steps));
    return i <= steps ? -c : c;
  };

  MeshBuilder builder;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double sign = face % 2 == 0 ? 1 : -1;
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;

    builder.sheet(n, n, [&](int i, int j) {
      const int first = sign > 0 ? i : n - i;  // mirrored, so that the face points outwards
      Vec3d p;
      p[axis] = sign * ((half[axis] - r) + r);
      p[a] = coordinate(first, half[a]);
      p[b] = coordinate(j, half[b]);

      // At the edge of a face the coordinate is bit-equal to the one that the neighboring face
      // fixes.
      const Vec3d inner = max(min(p, half - Vec3d(r)), Vec3d(r) - half);
      const Vec3d out = normalized(p - inner);

      return SurfacePoint{
          inner + out * r, out, {static_cast<double>(first) / n, static_cast<double>(j) / n}};
    });
  }
  return singlePart(builder.take("roundedBox"));
}

// A flight climbing towards -z, one closed solid: `steps` steps of `rise` and `run`.
Shape makeStairs(ShapeParameters& parameters) {
  const int steps = parameters.integer("steps", 5, 1, 1000);
  const double width = side(parameters, "width", 2) / 2, rise = side(parameters, "rise", 0.17);
  const double run = side(parameters, "run", 0.3), repeat = side(parameters, "uvRepeat", 1);

  using Corners = std::array<Vec3d, 4>;
  MeshBuilder builder(MeshBuilder::Shading::flat);
  const double w = width;
  for (int k = 0; k < steps; ++k) {
    const double z0 = -k * run, z1 = -(k + 1) * run, y1 = (k + 1) * rise;
    // A step consists of its riser, its tread and a piece of the underside.
    builder.plate(Corners{{{-w, k * rise, z0}, {w, k * rise, z0}, {w, y1, z0}, {-w, y1, z0}}},
                  repeat);
    builder.plate(Corners{{{-w, y1, z0}, {w, y1, z0}, {w, y1, z1}, {-w, y1, z1}}}, repeat);
    builder.plate(Corners{{{-w, 0, z1}, {w, 0, z1}, {w, 0, z0}, {-w, 0, z0}}}, repeat);

    // The sides are divided at the height of every step, so that there are no T-junctions.
    for (int m = 0; m <= k; ++m) {
      const double a = m * rise, b = (m + 1) * rise;
      builder.plate(Corners{{{w, a, z0}, {w, a, z1}, {w, b, z1}, {w, b, z0}}}, repeat);
      builder.plate(Corners{{{-w, a, z1}, {-w, a, z0}, {-w, b, z0}, {-w, b, z1}}}, repeat);
    }
  }

  // The back is divided at the heights of the steps.
  const double back = -steps * run;
  for (int m = 0; m < steps; ++m) {
    const double a = m * rise, b = (m + 1) * rise;
    builder.plate(Corners{{{w, a, back}, {-w, a, back}, {-w, b, back}, {w, b, back}}}, repeat);
  }
  return singlePart(builder.take("stairs"));
}

}  // namespace whit::procedural
