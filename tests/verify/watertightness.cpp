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

// Calls visit(a, b) with the corners of every edge of every triangle.
template <typename Visit>
void forEachEdge(const Mesh& mesh, const Visit& visit) {
  for (const auto& triangle : mesh.triangles) {
    for (const auto i : indices(3)) {
      visit(mesh.positions[triangle[i]], mesh.positions[triangle[(i + 1) % 3]]);
    }
  }
}

Vec3f middleOf(const Vec3f& a, const Vec3f& b) { return Vec3f((Vec3d(a) + Vec3d(b)) * 0.5); }

// Rays from inside towards the middle of every edge.
std::vector<ProbeRay> throughEdges(const Mesh& mesh, const Vec3d& center, double radius) {
  Numbers numbers(13);
  std::vector<ProbeRay> rays;
  forEachEdge(mesh, [&](const Vec3f& a, const Vec3f& b) {
    rays.push_back(rayThrough(inside(numbers, center, radius), middleOf(a, b)));
  });
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

constexpr int kEdgeRays = 4000;

// Counts the rays from inside a closed mesh that miss.
void misses(Run& run, const Mesh& mesh, const std::vector<ProbeRay>& rays) {
  countHits(run, Probe(sceneOf(mesh, diffuseMaterial(1)), run, rays), true);
}

const Vec3d kFar{148376, 1234, -223423};

void raysFromInside(Run& run) {
  for (const Vec3d& center : {Vec3d{}, kFar}) {
    const auto rays = randomRays(kEdgeRays, 12, [&](Numbers& numbers, int) {
      return ProbeRay{inside(numbers, center, 2), Vec3f(numbers.direction())};
    });
    misses(run, sphereMesh(5, center, 2, 0), rays);
  }
}

void edges(Run& run) {
  for (const Vec3d& center : {Vec3d{}, kFar}) {
    const Mesh ball = sphereMesh(3, center, 2);
    std::vector<ProbeRay> rays = throughEdges(ball, center, 2);

    if (center == Vec3d{}) {
      for (const auto& triangle : ball.triangles) {
        const Vec3f a = ball.positions[triangle[0]], b = ball.positions[triangle[1]];
        rays.push_back(exactlyThrough((a + b) * 0.5f));
      }
    }
    misses(run, ball, rays);
  }
}

void corners(Run& run) {
  const Mesh ball = sphereMesh(4, {}, 2);
  const std::vector<ProbeRay> rays = throughCorners(ball, {}, 2, 2);
  run.boundBy(0.02 * double(rays.size()));
  misses(run, ball, rays);
}

void unsharedCube(Run& run) {
  const Mesh cube = unshared(box({-1, -1, -1}, {1, 1, 1}, 0));
  std::vector<ProbeRay> rays = throughEdges(cube, {}, 1);
  Numbers numbers(31);
  while (rays.size() < kEdgeRays) {
    Vec3d target = numbers.inCube(1);
    target[0] = target[0] < 0 ? -1 : 1;
    target[1] = target[1] < 0 ? -1 : 1;
    rays.push_back(rayThrough(inside(numbers, {}, 1), Vec3f(target)));
  }
  misses(run, cube, rays);
}

// Glass of index 1 does not change the rays, and the stack of media counts the crossings.
void crossingsBalance(Run& run) {
  const Mesh ball = sphereMesh(2, {}, 1);
  const Scene scene = sceneOf(ball, glassMaterial(1));

  Numbers numbers(15);
  std::vector<ProbeRay> rays;
  forEachEdge(ball, [&](const Vec3f& a, const Vec3f& b) {
    const Vec3f from(numbers.direction() * 3.0);
    rays.push_back(rayThrough(from, middleOf(a, b)));
    rays.push_back(rayThrough(from, a));
  });

  Probe probe(scene, run);
  for (int crossing = 0; crossing < 8 && !rays.empty(); ++crossing) {
    probe.cast(rays);
    for (const auto i : indices(rays)) {
      run.count(!probe.isHit(i) && rays[i].media != 0, rays[i]);
    }
    rays = raysOf(probe.refractions());
  }
  run.count(!rays.empty(), "some are never out");
}

void tJunctions(Run& run) {
  run.boundBy(kNoBound);
  for (const float displaced : {0.0f, 1.0f}) {
    const float middle = displaced > 0 ? std::nextafter(0.0f, 1.0f) + 0x1p-24f : 0;
    Mesh mesh;
    mesh.positions = {{-1, 0, 0}, {1, 0, 0}, {0, 0, -1}, {0, 0, middle}, {0, 0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 4, 3}, {3, 4, 1}};

    const auto rays = randomRays(kEdgeRays, 16, [](Numbers& numbers, int) {
      const Vec3f target(Vec3d{numbers.in(-0.9, 0.9), 0, 0});
      return rayThrough(Vec3f(Vec3d{numbers.in(-1, 1), 2, numbers.in(-1, 1)}), target);
    });

    misses(run, mesh, rays);
  }
}

// Rays that start between the shells 5 and 6 and go outwards hit shell 6. A far mesh changes only
// the hierarchy.
void nestedShells(Run& run) {
  for (const bool farMesh : {false, true}) {
    SceneBuilder builder;
    const auto gray = builder.add(diffuseMaterial(1));
    Mesh sixth;
    std::uint32_t before = 0, count = 0;
    for (int shell = 0; shell < 10; ++shell) {
      const Mesh ball = sphereMesh(3, {}, std::pow(1.05, shell), gray);
      count = size32(ball.triangles);
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
      rays.push_back({ray.direction * float(start), ray.direction});
    }

    Probe probe(scene, run, rays);
    for (const auto i : indices(probe)) {
      const std::uint32_t triangle = probe.hits().triangle[i];
      run.count(triangle < before || triangle >= before + count, rays[i]);
    }
  }
}

// The hit of a ray exactly on an open border is not specified, but it is always the same.
void openBorder(Run& run) {
  const Scene scene = sceneOf(floorAt(0, 1), diffuseMaterial(1));

  const auto rays = randomRays(kEdgeRays, 18, [](Numbers& numbers, int) {
    return rayThrough({0.25f, 1, 0.125f}, Vec3f(Vec3d{1, 0, numbers.in(-1, 1)}));
  });

  const Probe first(scene, run, rays), second(scene, run, rays);
  for (const auto i : indices(rays)) {
    run.count(first.hits().triangle[i] != second.hits().triangle[i], rays[i]);
  }
}

// A closed room with a corner exactly in the middle of every pixel: a wall that extends the grid of
// pixels by one on all sides, and a hood from its border to a point behind the eye.
Mesh roomOfPixels(const CameraFrame& frame) {
  const int columns = frame.width + 2, rows = frame.height + 2;
  std::vector<std::uint32_t> pixels;
  forEachPixel(columns, rows, [&](int x, int y) { pixels.push_back(packedPixel(x, y)); });
  // The grid begins one pixel up and left of the picture. The middle of the larger picture is one
  // pixel further right and down, which corrects that.
  CameraFrame rays = frame;
  rays.width = columns;
  rays.height = rows;

  const ColumnStore<RayColumns> directions = raysThrough(pixels, rays);

  Mesh mesh;
  mesh.materials = {0};
  for (const auto i : indices(pixels)) mesh.positions.push_back(directions->dir.at(i) * 4.0f);

  const auto at = [&](int x, int y) { return std::uint32_t(y * columns + x); };
  const std::uint32_t behind = size32(mesh.positions);
  mesh.positions.push_back({0, 0, 4});
  forEachPixel(columns - 1, rows - 1, [&](int x, int y) {
    mesh.triangles.push_back({at(x, y), at(x, y + 1), at(x + 1, y + 1)});
    mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x + 1, y)});
  });

  for (int y = 0; y + 1 < rows; ++y) {
    for (const int x : {0, columns - 1}) {
      mesh.triangles.push_back({at(x, y), at(x, y + 1), behind});
    }
  }
  for (int x = 0; x + 1 < columns; ++x) {
    for (const int y : {0, rows - 1}) {
      mesh.triangles.push_back({at(x, y), at(x + 1, y), behind});
    }
  }
  return mesh;
}

// Counts the pixels that see the white outside through a corner.
void lostPixels(Run& run) {
  const Camera camera{.eye = {0, 0, 0}, .at = {0, 0, -1}, .fov = 70};

  SceneBuilder builder;
  Material glowing = blackMaterial();
  glowing.emission = {0, 1, 0};
  builder.add(glowing);
  builder.add(roomOfPixels(makeCameraFrame(camera, 97, 61)));
  builder.sky(1);
  builder.description.cameras = {camera};  // the scene is closed around it

  const Image image = pictureOf(builder.build(), camera, optionsOf(run, {97, 61}));
  forEachPixel(image.width, image.height, [&](int x, int y) {
    run.count(!(image.at(x, y) == Rgb{0, 1, 0}), "pixel ", x, ",", y);
  });
}

}  // namespace

const Family kWatertightnessCases{
    "watertightness",
    {{"H12", "no random ray leaves a closed sphere",
      "20480 triangles at the origin and at (148376, 1234, -223423)", raysFromInside},
     {"H13", "no ray leaves through an edge", "towards the middle of every edge of a sphere",
      edges},
     {"H14", "few rays leave through a corner", "towards every corner of a sphere", corners},
     {"H14a", "no pixel is lost at corners", "closed room with a corner in every pixel's middle",
      lostPixels},
     {"H15", "every ray that enters a body leaves it",
      "media stacks of rays through edges and corners", crossingsBalance},
     {"H16", "cracks at T-junctions (reported only: such a mesh is not closed)",
      "rays onto an edge that a corner of its neighbors divides", tJunctions},
     {"H17", "the next one of nested shells is hit",
      "10 spheres 5 % apart, with and without a far mesh", nestedShells},
     {"H18", "on an open border the answer is always the same", "rays exactly onto a border, twice",
      openBorder},
     {"H31", "closed without shared corners", "cube of 36 corners; rays onto its edges",
      unsharedCube}}};

}  // namespace whit::verify
