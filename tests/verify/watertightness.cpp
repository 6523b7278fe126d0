// H12 to H18: rays through edges and corners.
#include "core/image.h"
#include "simd/kernels.h"
#include "verify/bodies.h"

namespace whit::verify {

namespace {

// A point well inside the sphere.
Vec3f inside(Numbers& numbers, const Vec3d& center, double radius) {
  return Vec3f(center + numbers.direction() * (0.5 * radius));
}

// Rays from inside towards the middle of every edge.
std::vector<ProbeRay> throughEdges(const Mesh& mesh, const Vec3d& center, double radius) {
  Numbers numbers(13);
  std::vector<ProbeRay> rays;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d a(mesh.positions[triangle[i]]), b(mesh.positions[triangle[(i + 1) % 3]]);
      rays.push_back(rayThrough(inside(numbers, center, radius), Vec3f((a + b) * 0.5)));
    }
  }
  return rays;
}

// A ray from the origin goes exactly through its target, which is the direction.
ProbeRay exactlyThrough(const Vec3f& target) { return {{0, 0, 0}, target}; }

// Rays towards every corner: exactly from the origin the first time, then from any point inside.
std::vector<ProbeRay> throughCorners(const Mesh& mesh, const Vec3d& center, double radius,
                                     int times) {
  Numbers numbers(14);
  std::vector<ProbeRay> rays;
  for (int k = 0; k < times; ++k) {
    for (const Vec3f& corner : mesh.positions) {
      rays.push_back(k == 0 ? exactlyThrough(corner)
                            : rayThrough(inside(numbers, center, radius), corner));
    }
  }
  return rays;
}

constexpr std::size_t kEdgeRays = 4000;

// Counts the rays from inside a closed mesh that miss.
Finding misses(const Mesh& mesh, const std::vector<ProbeRay>& rays, double bound,
               const Setup& setup) {
  Finding finding(bound);
  const Scene scene = sceneOf(mesh, diffuseMaterial(1));
  countHits(finding, Probe(scene, setup, rays), true);
  return finding;
}

const Vec3d kFar{148376, 1234, -223423};

Finding randomRays(const Setup& setup) {
  Finding finding(0);
  for (const Vec3d& center : {Vec3d{}, kFar}) {
    Numbers numbers(12);
    std::vector<ProbeRay> rays;
    for (std::size_t i = 0; i < kEdgeRays; ++i) {
      rays.push_back({inside(numbers, center, 2), Vec3f(numbers.direction())});
    }
    finding.merge(misses(sphereMesh(5, center, 2, 0), rays, 0, setup));
  }
  return finding;
}

Finding edges(const Setup& setup) {
  Finding finding(0);
  for (const Vec3d& center : {Vec3d{}, kFar}) {
    const Mesh ball = sphereMesh(3, center, 2, 0);
    std::vector<ProbeRay> rays = throughEdges(ball, center, 2);

    if (center == Vec3d{}) {
      for (const auto& triangle : ball.triangles) {
        const Vec3f a = ball.positions[triangle[0]], b = ball.positions[triangle[1]];
        rays.push_back(exactlyThrough((a + b) * 0.5f));
      }
    }
    finding.merge(misses(ball, rays, 0, setup));
  }
  return finding;
}

Finding corners(const Setup& setup) {
  const Mesh ball = sphereMesh(4, {}, 2, 0);
  const std::vector<ProbeRay> rays = throughCorners(ball, {}, 2, 2);
  return misses(ball, rays, 0.02 * static_cast<double>(rays.size()), setup);
}

Finding unsharedCube(const Setup& setup) {
  const Mesh cube = unshared(box({-1, -1, -1}, {1, 1, 1}, 0));
  std::vector<ProbeRay> rays = throughEdges(cube, {}, 1);
  Numbers numbers(31);
  while (rays.size() < kEdgeRays) {
    Vec3d target{numbers.in(-1, 1), numbers.in(-1, 1), numbers.in(-1, 1)};
    target[0] = target[0] < 0 ? -1 : 1;
    target[1] = target[1] < 0 ? -1 : 1;
    rays.push_back(rayThrough(inside(numbers, {}, 1), Vec3f(target)));
  }
  return misses(cube, rays, 0, setup);
}

// Glass of index 1 does not change the rays, and the stack of media counts the crossings.
Finding crossingsBalance(const Setup& setup) {
  Finding finding(0);
  const Mesh ball = sphereMesh(2, {}, 1, 0);
  const Scene scene = sceneOf(ball, glassMaterial(1));

  Numbers numbers(15);
  std::vector<ProbeRay> rays;
  for (const auto& triangle : ball.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d a(ball.positions[triangle[i]]), b(ball.positions[triangle[(i + 1) % 3]]);
      const Vec3f from(numbers.direction() * 3.0);
      rays.push_back(rayThrough(from, Vec3f((a + b) * 0.5)));
      rays.push_back(rayThrough(from, ball.positions[triangle[i]]));
    }
  }

  Probe probe(scene, setup);
  for (int crossing = 0; crossing < 8 && !rays.empty(); ++crossing) {
    probe.cast(rays);
    for (std::size_t i = 0; i < probe.size(); ++i) {
      const bool outside = !probe.isHit(i);
      finding.count(outside && rays[i].media != 0, described(rays[i]));
    }
    rays = raysOf(probe.refractions());
  }
  finding.count(!rays.empty(), [&] { return "never out: " + describeRay(rays[0]); });
  return finding;
}

Finding tJunctions(const Setup& setup) {
  Finding finding(kNoBound);
  for (const float displaced : {0.0f, 1.0f}) {
    const float middle = displaced > 0 ? std::nextafter(0.0f, 1.0f) + 0x1p-24f : 0;
    Mesh mesh;
    mesh.positions = {{-1, 0, 0}, {1, 0, 0}, {0, 0, -1}, {0, 0, middle}, {0, 0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 4, 3}, {3, 4, 1}};

    Numbers numbers(16);
    std::vector<ProbeRay> rays;
    for (std::size_t i = 0; i < kEdgeRays; ++i) {
      const Vec3f target(Vec3d{numbers.in(-0.9, 0.9), 0, 0});
      rays.push_back(rayThrough(Vec3f(Vec3d{numbers.in(-1, 1), 2, numbers.in(-1, 1)}), target));
    }

    finding.merge(misses(mesh, rays, kNoBound, setup));
  }
  return finding;
}

// Rays that start between the shells 5 and 6 and go outwards hit shell 6. A far mesh changes only
// the hierarchy.
Finding nestedShells(const Setup& setup) {
  Finding finding(0);
  for (const bool farMesh : {false, true}) {
    SceneBuilder builder;
    const auto gray = builder.add(diffuseMaterial(1));
    Mesh sixth;
    std::uint32_t before = 0, count = 0;
    for (int shell = 0; shell < 10; ++shell) {
      const Mesh ball = sphereMesh(3, {}, std::pow(1.05, shell), gray);
      count = static_cast<std::uint32_t>(ball.triangles.size());
      if (shell < 6) before += count;
      if (shell == 6) sixth = ball;
      builder.add(ball);
    }
    if (farMesh) builder.add(sphereMesh(2, {50, 3, 7}, 1, gray));

    const Scene scene = builder.build();
    std::vector<ProbeRay> rays;
    const double start = (std::pow(1.05, 5) + std::pow(1.05, 6)) / 2;
    for (const Vec3f& corner : sixth.positions) {
      rays.push_back(rayThrough(Vec3f(normalized(Vec3d(corner)) * start), corner));
    }
    for (const ProbeRay& ray : throughEdges(sixth, {}, 0)) {
      rays.push_back({ray.direction * static_cast<float>(start), ray.direction});
    }

    Probe probe(scene, setup, rays);
    for (std::size_t i = 0; i < probe.size(); ++i) {
      const std::uint32_t triangle = probe.hits().triangle[i];
      finding.count(triangle < before || triangle >= before + count, described(rays[i]));
    }
  }
  return finding;
}

// The hit of a ray exactly on an open border is not specified, but it is always the same.
Finding openBorder(const Setup& setup) {
  Finding finding(0);
  const Scene scene = sceneOf(floorAt(0, 1, 0), diffuseMaterial(1));

  Numbers numbers(18);
  std::vector<ProbeRay> rays;
  for (std::size_t i = 0; i < kEdgeRays; ++i) {
    const Vec3f target(Vec3d{1, 0, numbers.in(-1, 1)});
    rays.push_back(rayThrough({0.25f, 1, 0.125f}, target));
  }

  Probe first(scene, setup), second(scene, setup);
  first.cast(rays);
  second.cast(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    finding.count(first.hits().triangle[i] != second.hits().triangle[i], described(rays[i]));
  }
  return finding;
}

// A closed room with a corner exactly in the middle of every pixel: a wall that extends the grid of
// pixels by one on all sides, and a hood from its border to a point behind the eye.
Mesh roomOfPixels(const CameraFrame& frame) {
  const int columns = frame.width + 2, rows = frame.height + 2;
  std::vector<std::uint32_t> pixels;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) pixels.push_back(packedPixel(x, y));
  }
  // The grid begins one pixel up and left of the picture. The middle of the larger picture is one
  // pixel further right and down, which corrects that.
  CameraFrame rays = frame;
  rays.width = columns;
  rays.height = rows;

  const std::size_t count = pixels.size();
  const ColumnStore<RayColumns> directions = raysThrough(pixels, rays);

  Mesh mesh;
  mesh.materials = {0};
  for (std::size_t i = 0; i < count; ++i) {
    mesh.positions.push_back(directions->dir.at(i) * 4.0f);
  }

  const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * columns + x); };
  const auto behind = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back({0, 0, 4});
  for (int y = 0; y + 1 < rows; ++y) {
    for (int x = 0; x + 1 < columns; ++x) {
      mesh.triangles.push_back({at(x, y), at(x, y + 1), at(x + 1, y + 1)});
      mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x + 1, y)});
    }
    mesh.triangles.push_back({at(0, y), at(0, y + 1), behind});
    mesh.triangles.push_back({at(columns - 1, y), at(columns - 1, y + 1), behind});
  }

  for (int x = 0; x + 1 < columns; ++x) {
    mesh.triangles.push_back({at(x, 0), at(x + 1, 0), behind});
    mesh.triangles.push_back({at(x, rows - 1), at(x + 1, rows - 1), behind});
  }
  return mesh;
}

// Counts the pixels that see the magenta outside through a corner.
Finding lostPixels(const Setup& setup) {
  Finding finding(0);
  const Camera camera{.eye = {0, 0, 0}, .at = {0, 0, -1}, .fov = 70};
  RenderOptions options = optionsOf(setup, {97, 61});

  SceneBuilder builder;
  Material glowing = blackMaterial();
  glowing.emission = {0, 1, 0};
  builder.add(glowing);
  builder.add(roomOfPixels(makeCameraFrame(camera, 97, 61)));
  builder.description.sky.kind = Sky::Kind::color;
  builder.description.sky.zenith = {1, 0, 1};
  builder.description.cameras = {camera};

  const Image image = pictureOf(builder.build(), camera, options);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      finding.count(!(image.at(x, y) == Rgb{0, 1, 0}),
                    [&] { return "pixel " + std::to_string(x) + "," + std::to_string(y); });
    }
  }
  return finding;
}

constexpr Case kWatertightnessCases[] = {
    {"H12", "no random ray leaves a closed sphere",
     "20480 triangles at the origin and at (148376, 1234, -223423)", Runs::packets, randomRays},
    {"H13", "no ray leaves through an edge", "towards the middle of every edge of a sphere",
     Runs::packets, edges},
    {"H14", "few rays leave through a corner", "towards every corner of a sphere", Runs::packets,
     corners},
    {"H14a", "no pixel is lost at corners", "closed room with a corner in every pixel's middle",
     Runs::packets, lostPixels},
    {"H15", "every ray that enters a body leaves it",
     "media stacks of rays through edges and corners", Runs::packets, crossingsBalance},
    {"H16", "cracks at T-junctions (reported only: such a mesh is not closed)",
     "rays onto an edge that a corner of its neighbors divides", Runs::packets, tJunctions},
    {"H17", "the next one of nested shells is hit",
     "10 spheres 5 % apart, with and without a far mesh", Runs::packets, nestedShells},
    {"H18", "on an open border the answer is always the same", "rays exactly onto a border, twice",
     Runs::packets, openBorder},
    {"H31", "closed without shared corners", "cube of 36 corners; rays onto its edges",
     Runs::packets, unsharedCube},
};

}  // namespace

std::span<const Case> watertightnessCases() { return kWatertightnessCases; }

}  // namespace whit::verify
