// H19 to H22 and H30: rays along axes and planes, and coincident surfaces.
#include "surfaces/intersect.h"
#include "verify/bodies.h"

namespace whit::verify {

namespace {

// Casts the same rays along each direction; all must hit the same triangles.
void alikeAlong(Run& run, const std::vector<Vec3f>& directions) {
  const Scene scene = sceneOf(grid(), diffuseMaterial(1));
  std::vector<std::uint32_t> expected;
  for (const Vec3f& direction : directions) {
    std::vector<ProbeRay> rays;
    // The rays hit corners, edges and centers inside the border.
    forEachPixel(125, 42, [&](int x, int y) {
      rays.push_back({Vec3f(Vec3d((x - 62) * 0.5, 16, (3 * y - 62) * 0.5)), direction});
    });

    Probe probe(scene, run, rays);
    for (const auto i : indices(rays)) {
      const std::uint32_t triangle = probe.hits().triangle[i];
      if (expected.size() < rays.size()) expected.push_back(triangle);
      run.count(triangle == kMiss || triangle != expected[i], rays[i]);
    }
  }
}

void axisAligned(Run& run) {
  alikeAlong(run, {{0.0f, -1, 0.0f}, {-0.0f, -1, -0.0f}, {0.0f, -1, -0.0f}});
}

void denormalComponents(Run& run) {
  alikeAlong(run, {{0.0f, -1, 0.0f}, {1e-40f, -1, 0.0f}, {-1e-40f, -1, 1e-42f}});
}

void coplanarRays(Run& run) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};

  std::vector<ProbeRay> rays{{{-1, 0.25f, 0}, {1, 0, 0}},
                             {{0.25f, 0.25f, 0}, {1, 0, 0}},
                             {{0.25f, 0.25f, 0}, {0, -1, 0}},
                             {{-1, 0, 0}, {1, 0, 0}}};

  Numbers numbers(21);
  for (int i = 0; i < 500; ++i) {
    const double turn = numbers.in(0, 6.28);
    rays.push_back({Vec3f(Vec3d{numbers.in(-1, 1), numbers.in(-1, 1), 0}),
                    Vec3f(Vec3d{std::cos(turn), std::sin(turn), 0})});
  }

  countHits(run, Probe(sceneOf(mesh, diffuseMaterial(1)), run, rays), false);
}

// Needles with edges of 11.2, 9.7 and 1.4 at a distance of 600, seen almost along their plane. The
// error is the distance of the hit beyond the triangle's bounds, relative to its size.
void nearlyCoplanar(Run& run) {
  run.boundBy(kNoBound);
  Numbers numbers(22);
  std::vector<ProbeRay> rays;
  Mesh mesh;
  for (int i = 0; i < 300; ++i) {
    const Vec3d n = numbers.direction(), along = normalized(cross(n, numbers.direction()));
    const Vec3d across = cross(n, along), at = numbers.direction() * 600.0;
    addTriangle(mesh,
                {Vec3f(at), Vec3f(at + along * 11.2), Vec3f(at + along * 9.7 + across * 0.9)});
    for (int k = 0; k < 8; ++k) {
      const double angle = std::pow(10, -numbers.in(2, 7));
      const Vec3d target = at + along * numbers.in(4, 10) + across * numbers.in(0, 0.3);
      const Vec3d direction = along * std::cos(angle) - n * std::sin(angle);
      rays.push_back(rayThrough(Vec3f(target - direction * 600.0), Vec3f(target)));
    }
  }

  const Scene scene = sceneOf(mesh, diffuseMaterial(1));
  Probe probe(scene, run, rays);
  for (const auto i : indices(rays)) {
    if (!probe.isHit(i)) {
      run.note(0, rays[i]);
      continue;
    }

    const Corners c = worldCorners(scene, probe.hits().triangle[i], kNoHit);
    const Vec3d point =
        Vec3d(rays[i].origin) + Vec3d(rays[i].direction) * double{probe.hits().t[i]};
    const Vec3d low = min(c[0], min(c[1], c[2])), high = max(c[0], max(c[1], c[2]));
    const Vec3d beyond = max(max(low - point, point - high), Vec3d{});
    run.note(length(beyond) / 11.2, rays[i]);
  }
}

// Every packet width hits the same one of two coincident squares.
void coplanarOverlap(Run& run) {
  SceneBuilder builder;
  builder.add(floorAt(0, 1), diffuseMaterial(1));
  builder.add(floorAt(0, 1), diffuseMaterial(0.5f));
  const Scene scene = builder.build();

  const std::vector<ProbeRay> rays = raysOnto({}, 0.9, 2000, 30);
  Probe expected(scene, {run.simd, 1}, rays);
  Probe probe(scene, run, rays);
  for (const auto i : indices(rays)) {
    run.count(probe.hits().triangle[i] != expected.hits().triangle[i], rays[i]);
  }
}

}  // namespace

const Family kOddDirectionCases{
    "odd directions",
    {{"H19", "axis-aligned rays, with +0 and with -0",
      "grid of 64 x 64 from above onto its corners, edges and centers", axisAligned},
     {"H20", "denormal components count as zero", "the same with 1e-40", denormalComponents},
     {"H21", "a ray in the plane of a triangle does not hit it", "one triangle, 504 rays",
      coplanarRays},
     {"H22", "how far hits lie beside needles seen edge on (reported only)",
      "angles of 1e-2 to 1e-7; distance of the point by t to the triangle's box, over its length",
      nearlyCoplanar},
     {"H30", "the same one of two coincident squares wins for every packet width",
      "2000 rays against single rays", coplanarOverlap}}};

}  // namespace whit::verify
