// H1 to H4 and H9 to H11: rays that start on a surface.
#include <algorithm>

#include "surfaces/intersect.h"
#include "verify/bodies.h"

namespace whit::verify {

namespace {

constexpr int kLeavingRays = 1500;
// A ray that leaves a facet at a smaller cosine than this may hit the neighboring facet within the
// precision of floats.
constexpr double kLeast = 1e-3;

// Counts the reflected and shadow rays that hit the convex body which they leave.
void selfHits(Run& run, const Scene& scene, const Vec3d& center, double radius,
              std::uint64_t seed) {
  Probe probe(scene, run, raysOnto(center, radius, kLeavingRays, seed));

  std::vector<ProbeRay> spawned;
  for (const ProbeChild& child : probe.reflections()) {
    if (dot(Vec3d(child.ray.direction), Vec3d(probe.ng(child.parent))) > kLeast) {
      spawned.push_back(child.ray);
    }
  }

  const Light light = lightAt(Vec3f(center + Vec3d{3, 2.5, -2} * radius), 1);
  probe.light(light);
  for (const auto i : indices(probe)) {
    if (maxComponent(probe.unshadowed(i)) <= 0 || !probe.isHit(i)) continue;
    const Vec3d l = normalized(Vec3d(light.position) - Vec3d(probe.position(i)));
    if (dot(l, Vec3d(probe.ng(i))) <= kLeast) continue;
    run.count(!probe.visible(i), "shadow of ", probe.ray(i));
  }

  countHits(run, Probe(scene, run, spawned), false);
}

void sphereSelfHits(Run& run, const Vec3d& center, double radius) {
  const Scene scene = sceneOf(sphereMesh(3, center, radius), shinyMaterial());
  selfHits(run, scene, center, radius, 1);
}

void scaleSweep(Run& run) {
  for (const double size : {1e-4, 1e-2, 1.0, 1e3, 1e6}) {
    sphereSelfHits(run, {}, size);
  }
}

void farFromOrigin(Run& run) {
  for (const double away : {1e2, 1e4, 1e6}) {
    for (const double ratio : {1.0, 1e-2, 1e-4}) {
      sphereSelfHits(run, Vec3d{1, 0.7, -1.3} * away, away * ratio);
    }
  }
}

// gamma(7) * sum of magnitudes bounds a point interpolated in float (pbrt-v4, section 6.8.5).
constexpr double kGamma7 = 7 * 0x1p-24 / (1 - 7 * 0x1p-24);

void pointsFromFarAway(Run& run) {
  run.boundBy(1);
  const Mesh patch = quad({0, 0.1f, 0}, {1, 0.2f, 0.1f}, {1.1f, 0.7f, 1}, {0.1f, 0.6f, 0.9f}, 0);
  const Scene scene = sceneOf(patch, diffuseMaterial(1));

  const auto rays = randomRays(kLeavingRays, 3, [](Numbers& numbers, int) {
    const Vec3d target{numbers.in(0.2, 0.8), numbers.in(0.3, 0.5), numbers.in(0.2, 0.8)};
    const Vec3d towards = normalized(Vec3d{1, numbers.in(0.02, 1.5), numbers.in(-0.5, 0.5)});
    return rayThrough(Vec3f(target + towards * 1e5), Vec3f(target));
  });

  Probe probe(scene, run, rays);
  for (const auto i : indices(probe)) {
    if (!probe.isHit(i)) continue;
    const Corners c = worldCorners(scene, probe.hits().triangle[i], kNoHit);
    const Vec3d n = normalized(cross(c[1] - c[0], c[2] - c[0]));
    const Vec3d at(probe.position(i));
    const double sum = dot(abs(at), Vec3d(1));
    run.note(std::fabs(dot(at - c[0], n)) / (kGamma7 * sum), rays[i]);
  }
}

// Returns the distance of a point from the plane of a triangle. It is computed in long double and
// from the corner nearest to the origin, because the sizes of the corners differ by up to 1e16.
double distanceToPlane(const Corners& c, const Vec3d& point) {
  using Vec = Vec3<long double>;
  const Vec n = normalized(cross(Vec(c[1]) - Vec(c[0]), Vec(c[2]) - Vec(c[0])));

  const Vec3d* base = &c[0];
  for (const Vec3d& corner : c) {
    if (maxComponent(abs(corner)) < maxComponent(abs(*base))) base = &corner;
  }

  return double(std::fabs(dot(Vec(point) - Vec(*base), n)));
}

// The test sets the hits itself, so that triangles of every shape have some. They are so far away
// that the weights are more precise than the distance.
void offsetBoundsTheError(Run& run) {
  run.boundBy(1);
  Numbers numbers(4);
  Mesh mesh;
  constexpr std::uint32_t kTriangles = 4096;
  constexpr float kFar = 1e12f;

  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    const auto corner = [&] {
      const double size = std::pow(10, numbers.in(-8, 8));
      return Vec3f(numbers.direction() * size);
    };
    addTriangle(mesh, {corner(), corner(), corner()});
  }

  const Scene scene = sceneOf(mesh, diffuseMaterial(1));
  Probe probe(scene, run);
  probe.load(std::vector<ProbeRay>(kTriangles, {{0, 0, 0}, {0, 0, -1}}));
  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    const double u = numbers.in(0, 1), v = numbers.in(0, 1 - u);
    probe.hit(i, i, kFar, float(u), float(v));
  }
  probe.interpolate();

  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    const Corners c = worldCorners(scene, i, kNoHit);
    // Only the distance to the plane counts: the rounding of 1 - u - v moves the point further
    // within the plane.
    const double error = distanceToPlane(c, Vec3d(probe.position(i)));
    run.note(error / probe.surfels().offset[i], c[0], ", ", c[1], ", ", c[2], " at ",
             probe.hits().u[i], " ", probe.hits().v[i]);
  }
}

// The views are from straight above to 0.06 degrees over the plane, onto corners, edges and any
// point.
void startOnAPlane(Run& run) {
  const Scene scene = sceneOf(floorAt(0, 1), shinyMaterial());

  const auto rays = randomRays(kLeavingRays, 9, [](Numbers& numbers, int i) {
    Vec3d target{numbers.in(-1, 1), 0, numbers.in(-1, 1)};
    if (i % 3 == 0) target = {std::floor(target.x), 0, std::floor(target.z)};
    const double elevation = std::pow(10, numbers.in(-3, 0)), turn = numbers.in(0, 6.28);
    const Vec3d back{std::cos(turn), i % 7 == 0 ? 1e6 : elevation, std::sin(turn)};
    return rayThrough(Vec3f(target + normalized(back) * 2.0), Vec3f(target));
  });

  Probe probe(scene, run, rays);
  countHits(run, Probe(scene, run, raysOf(probe.reflections())), false);
}

// An eye in the plane of a glowing floor, and parallel rays that all start in it, see only the sky.
void eyeInAPlane(Run& run) {
  constexpr float kSky = 0.25f;

  for (const float height : {0.0f, 0.1f, 1000.1f, -3e6f}) {
    const Scene scene = sceneOf(floorAt(height, 10), emittingMaterial(1), kSky);

    for (const Vec3f& towards : {Vec3f(1, 0, 0.2f), Vec3f(0.1f, 1, 0), Vec3f(0, -1, 0.1f),
                                 Vec3f(0.3f, 0.7f, -1), Vec3f(-1, -0.4f, 0.2f)}) {
      for (const float parallel : {0.0f, 2.0f}) {
        // Parallel rays all start in the plane only if they are perpendicular to it.
        if (parallel > 0 && std::fabs(towards.y) < 1) continue;

        const Vec3f eye{0.3f, height, 0.2f};
        const Vec3f along = parallel > 0 ? Vec3f(0, towards.y, 0) : towards;
        const Camera camera{.eye = eye,
                            .at = eye + along,
                            .up = {0, 0.3f, 1},
                            .fov = 100,
                            .orthographicHeight = parallel};

        for (const Rgb& pixel : pictureOf(scene, camera, optionsOf(run, {32, 24})).pixels) {
          run.count(pixel.x != kSky, "height ", height, " towards ", along,
                    parallel > 0 ? ", parallel" : "");
        }
      }
    }
  }
}

// Returns true if the line from `p` to `q` hits the unit box on the floor, enlarged by `larger` on
// all sides.
bool meetsUnitBox(const Vec3d& p, const Vec3d& q, double larger) {
  const Vec3d low = Vec3d{-0.5, 0, -0.5} - Vec3d(larger), high = Vec3d{0.5, 1, 0.5} + Vec3d(larger);

  // The line is clipped at the two planes of each axis.
  double enters = 0, leaves = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = q[axis] - p[axis], a = (low[axis] - p[axis]) / way,
                 b = (high[axis] - p[axis]) / way;
    enters = std::max(enters, std::min(a, b));
    leaves = std::min(leaves, std::max(a, b));
  }

  return enters <= leaves;
}

Mesh turned(Mesh mesh, const Affine& turn) {
  for (Vec3f& p : mesh.positions) p = Vec3f(turn.vector(Vec3d(p)));
  return mesh;
}

// The floor is so large that its corners' ulps are a sixteenth of a unit, but where it is seen its
// points are of the order of 1. A tilted floor needs offsets in proportion to its size: up to 1000
// times the box, its shadow is still where it belongs.
void shadowOnLargeFloors(Run& run) {
  constexpr double kUnsure = 0.01;  // next to the box and to the shadow's edge; pixels are larger
  constexpr float kLargestTilted = 1e3f;
  for (const double degrees : {0.0, 30.0, 137.0}) {
    const Affine turn = Affine::rotation({1, 0.3, 0.5}, degrees);
    const auto there = [&](const Vec3d& p) { return Vec3f(turn.vector(p)); };
    for (const float half : {10.0f, 1e3f, 1e5f, 1e6f}) {
      if (degrees > 0 && half > kLargestTilted) break;

      SceneBuilder builder;
      const auto white = builder.add(diffuseMaterial(0.8f));
      builder.add(turned(floorAt(0, half, white), turn));
      builder.add(turned(box({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}, white), turn));
      builder.description.lights = {lightAt(there({2, 3, 1}), 30)};

      const Camera upright{.eye = {0.3f, 5, 4}, .at = {-0.3f, 0.3f, 0}, .fov = 30};
      Camera camera = upright;
      camera.eye = there(Vec3d(upright.eye));
      camera.at = there(Vec3d(upright.at));
      camera.up = there(Vec3d(upright.up));

      const Image image = pictureOf(builder.build(), camera, optionsOf(run, {64, 48}));
      forEachRay(upright, 64, 48, [&](const Vec3d& eye, const Vec3d& way, int x, int y) {
        // The pixel shows this point of the floor unless the box hides it.
        const Vec3d at = eye - way * (eye.y / way.y);
        if (meetsUnitBox(eye, at, kUnsure)) return;

        const bool hidden = meetsUnitBox(at, {2, 3, 1}, -kUnsure);
        if (!hidden && meetsUnitBox(at, {2, 3, 1}, kUnsure)) return;
        run.count((image.at(x, y).x > 0) == hidden, "floor ", half, ", tilted by ", degrees,
                  ", pixel ", x, ",", y);
      });
    }
  }
}

// A shade 16 float steps under a lamp far from the origin keeps the floor dark.
void shadeNextToItsLamp(Run& run) {
  for (const float far : {0x1p10f, 0x1p14f, 0x1p18f}) {
    SceneBuilder builder;
    const auto white = builder.add(diffuseMaterial(0.8f));
    const float shade = 4 - 16 * far * 0x1p-23f;

    builder.add(quad({far - 2, 0, 2}, {far + 2, 0, 2}, {far + 2, 0, -2}, {far - 2, 0, -2}, white));
    builder.add(quad({far - 0.5f, shade, -0.5f}, {far - 0.5f, shade, 0.5f},
                     {far + 0.5f, shade, 0.5f}, {far + 0.5f, shade, -0.5f}, white));
    builder.description.lights = {lightAt({far, 4, 0}, 30)};

    Camera camera = lookingDown();
    camera.eye.x = camera.at.x = far;
    const RenderOptions options = optionsOf(run, {32, 24});
    for (const Rgb& pixel : pictureOf(builder.build(), camera, options).pixels) {
      run.count(pixel.x != 0, "lamp at ", far);
    }
  }
}

// A refracted ray that starts on the wrong side hits its own face again.
void sideOfTheOffset(Run& run) {
  SceneBuilder builder;
  addSlab(builder, 0, -0.25f, glassMaterial(1.5f), 40);
  const Scene scene = builder.build();

  auto rays = randomRays(kLeavingRays, 10, [](Numbers& numbers, int) {
    const double angle = numbers.in(0, 1.5);
    return ProbeRay{{0, 1, 0}, Vec3f(Vec3d{std::sin(angle), -std::cos(angle), 0})};
  });

  // The rays hit the upper face (triangles 0 and 1), then the lower one (2 and 3), then nothing.
  Probe probe(scene, run);
  for (const int expected : {0, 2, -1}) {
    probe.cast(rays);
    for (const auto i : indices(probe)) {
      const int got = probe.isHit(i) ? int(probe.hits().triangle[i] / 2) * 2 : -1;
      run.count(got != expected, probe.ray(i));
    }
    if (expected < 0) break;

    for (const auto& [ray, weight, parent] : probe.reflections()) {
      const float up = ray.direction.y, height = ray.origin.y - probe.position(parent).y;
      run.count(!(up * height > 0), ray);
    }

    rays = raysOf(probe.refractions());
  }
}

void instanced(Run& run) {
  const Affine turn = Affine::rotation({1, 2, 3}, 40);
  const std::pair<Affine, double> maps[] = {
      {Affine::scaling(Vec3d(1e-3)), 1e-3},
      {Affine::scaling(Vec3d(1e3)), 1e3},
      {turn * Affine::scaling({1, 3, 0.3}), 1},
      {Affine::translation({30, -20, 10}) * turn * Affine::scaling({-2, 1, 1}), 1}};

  for (const auto& [map, size] : maps) {
    SceneBuilder builder;
    const auto material = builder.add(shinyMaterial());
    // The second placement, far away, makes instances of both.
    const Affine elsewhere = Affine::translation(map.p + Vec3d(1e5 * size)) * map;
    builder.place({"ball", {sphereMesh(3, {}, 1, material)}}, {map, elsewhere});
    selfHits(run, builder.build(), map.p, size, 11);
  }
}

// Triangles with two orthogonal edges of half a unit, at random corners between -2 and 2.
Mesh looseTriangles(std::size_t count, std::uint32_t material) {
  Numbers numbers(3);
  Mesh mesh;
  mesh.materials = {material};

  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d corner = numbers.inCube(2);
    const Vec3d n = numbers.direction(), e1 = normalized(cross(n, numbers.direction()));
    addTriangle(mesh,
                {Vec3f(corner), Vec3f(corner + e1 * 0.5), Vec3f(corner + cross(n, e1) * 0.5)});
  }
  return mesh;
}

// How far a hit is from where the ray pierces the plane, along the ray or across it, in roundings
// of the distance; 0 where the ray grazes the plane.
double hitError(const ProbeRay& ray, const Corners& corners, const double (&hit)[3]) {
  using Vec = Vec3<long double>;
  const Vec way(ray.direction), from = Vec(ray.origin) - Vec(corners[0]);
  const Vec e1 = Vec(corners[1]) - Vec(corners[0]), e2 = Vec(corners[2]) - Vec(corners[0]);
  const Vec normal = cross(e1, e2);
  const long double slope = dot(normal, way), area = length(normal);
  if (std::fabs(slope) < area / 2) return 0;

  const long double t = -dot(normal, from) / slope;
  const long double u = dot(cross(e2, way), from) / slope;
  const long double v = dot(cross(way, e1), from) / slope;

  const long double side = std::sqrt(area);
  const long double off =
      std::max({std::fabs(hit[0] - t), std::fabs(hit[1] - u) * side, std::fabs(hit[2] - v) * side});
  return double(off / (0x1p-24L * t));
}

// The distance and the weights of hits in the world and on instances that scale, turn and mirror
// without rounding.
void hitsAreExact(Run& run) {
  run.boundBy(8);
  SceneBuilder builder;
  const std::uint32_t material = builder.add(diffuseMaterial(1));
  builder.add(looseTriangles(400, material));
  Object object;
  object.meshes.push_back(looseTriangles(400, material));
  builder.place(object, {Affine{{0, 0, 2}, {0, 2, 0}, {-2, 0, 0}, {16, 0, 0}},
                         Affine{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {-16, 3, 0}}});
  const Scene scene = builder.build();

  const Vec3d middles[] = {{}, {16, 0, 0}, {-16, 3, 0}};
  const auto rays = randomRays(6000, 54, [&](Numbers& numbers, int i) {
    const Vec3d& middle = middles[i % 3];
    const Vec3d target = numbers.inCube(2);
    const Vec3f from(middle + numbers.direction() * 9.0);
    return rayThrough(from, Vec3f(middle + target));
  });

  Probe probe(scene, run, rays);
  const HitColumns& hits = probe.hits();
  for (const auto i : indices(probe)) {
    if (!probe.isHit(i)) continue;
    const Corners corners = worldCorners(scene, hits.triangle[i], hits.instance[i]);
    run.note(hitError(rays[i], corners, {hits.t[i], hits.u[i], hits.v[i]}), rays[i]);
  }
}

}  // namespace

const Family kLeavingSurfaceCases{
    "leaving a surface",
    {{"H1", "no ray hits the convex body that it leaves, at any size",
      "icospheres of radius 1e-4 to 1e6; reflected and shadow rays", scaleSweep},
     {"H2", "the same far from the origin", "distance 1e2 to 1e6, radius down to 1e-4 of it",
      farFromOrigin},
     {"H2b", "the shadow of a box on floors of any size",
      "half of 10 to 1e6 units, to 1e3 tilted; pixels that are not as the box and the lamp have it",
      shadowOnLargeFloors},
     {"H2c", "a shade next to its lamp, far from the origin",
      "16 float steps apart, 2^10 to 2^18 away; pixels that are lit", shadeNextToItsLamp},
     {"H3", "hit points lie on the triangle, whatever the distance of the eye",
      "patch seen from 1e5; distance to its plane over gamma(7) times the coordinates",
      pointsFromFarAway},
     {"H3b", "the distance and the weights of a hit are rounded a few times only",
      "1200 triangles in the world and on instances; error over 2^-24 of the distance",
      hitsAreExact},
     {"H4", "the offset bounds the error of the hit point",
      "4096 triangles with coordinates of 1e-8 to 1e8; distance to the plane over offset",
      offsetBoundsTheError, Runs::targets},
     {"H9", "rays that start on a plane leave it", "views from vertical to 0.06 degrees",
      startOnAPlane},
     {"H9b", "an eye in a surface's plane does not see it",
      "in a glowing floor, looking along it, away and through; pixels that are not the sky",
      eyeInAPlane},
     {"H10", "child rays start on the side to which they go", "slab of glass: two faces, then out",
      sideOfTheOffset},
     {"H11", "no self-hits on instances", "scaled by 1e-3 and 1e3, stretched, mirrored",
      instanced}}};

}  // namespace whit::verify
