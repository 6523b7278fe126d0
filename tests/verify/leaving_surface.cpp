// H1 to H4 and H9 to H11: rays that start on a surface.
#include <algorithm>
#include <array>

#include "reference/intersect.h"
#include "verify/bodies.h"

namespace whit::verify {

namespace {

constexpr std::size_t kLeavingRays = 1500;
// A ray that leaves a facet at a smaller cosine than this may hit the neighboring facet within the
// precision of floats.
constexpr double kLeast = 1e-3;

// Counts the reflected and shadow rays that hit the convex body which they leave.
Finding selfHits(const Scene& scene, const Vec3d& center, double radius, const Setup& setup,
                 std::uint64_t seed) {
  Finding finding(0);
  Probe probe(scene, setup, raysOnto(center, radius, kLeavingRays, seed));

  std::vector<ProbeRay> spawned;
  for (const ProbeChild& child : probe.reflections()) {
    if (dot(Vec3d(child.ray.direction), Vec3d(probe.ng(child.parent))) > kLeast) {
      spawned.push_back(child.ray);
    }
  }

  const Light light = lightAt(Vec3f(center + Vec3d{3, 2.5, -2} * radius), 1);
  probe.light(light);
  for (std::size_t i = 0; i < probe.size(); ++i) {
    if (maxComponent(probe.unshadowed(i)) <= 0 || !probe.isHit(i)) continue;
    const Vec3d l = normalized(Vec3d(light.position) - Vec3d(probe.position(i)));
    if (dot(l, Vec3d(probe.ng(i))) <= kLeast) continue;
    finding.count(!probe.visible(i), [&] { return "shadow of " + describeRay(probe.ray(i)); });
  }

  countHits(finding, Probe(scene, setup, spawned), false);
  return finding;
}

Finding sphereSelfHits(const Vec3d& center, double radius, const Setup& setup) {
  const Scene scene = sceneOf(sphereMesh(3, center, radius, 0), shinyMaterial());
  return selfHits(scene, center, radius, setup, 1);
}

Finding scaleSweep(const Setup& setup) {
  Finding finding(0);
  for (const double size : {1e-4, 1e-2, 1.0, 1e3, 1e6}) {
    finding.merge(sphereSelfHits({}, size, setup));
  }
  return finding;
}

Finding farFromOrigin(const Setup& setup) {
  Finding finding(0);
  for (const double away : {1e2, 1e4, 1e6}) {
    for (const double ratio : {1.0, 1e-2, 1e-4}) {
      finding.merge(sphereSelfHits(Vec3d{1, 0.7, -1.3} * away, away * ratio, setup));
    }
  }
  return finding;
}

// gamma(7) * sum of magnitudes bounds a point interpolated in float (pbrt-v4, section 6.8.5).
constexpr double kGamma7 = 7 * 0x1p-24 / (1 - 7 * 0x1p-24);

Finding pointsFromFarAway(const Setup& setup) {
  Finding finding(1);
  const Mesh patch = quad({0, 0.1f, 0}, {1, 0.2f, 0.1f}, {1.1f, 0.7f, 1}, {0.1f, 0.6f, 0.9f}, 0);
  const Scene scene = sceneOf(patch, diffuseMaterial(1));

  Numbers numbers(3);
  std::vector<ProbeRay> rays;
  for (std::size_t i = 0; i < kLeavingRays; ++i) {
    const Vec3d target{numbers.in(0.2, 0.8), numbers.in(0.3, 0.5), numbers.in(0.2, 0.8)};
    const Vec3d towards = normalized(Vec3d{1, numbers.in(0.02, 1.5), numbers.in(-0.5, 0.5)});
    rays.push_back(rayThrough(Vec3f(target + towards * 1e5), Vec3f(target)));
  }

  Probe probe(scene, setup, rays);
  for (std::size_t i = 0; i < probe.size(); ++i) {
    if (!probe.isHit(i)) continue;
    const Corners c = worldCorners(scene, probe.hits().triangle[i], reference::kNoHit);
    const Vec3d n = normalized(cross(c[1] - c[0], c[2] - c[0]));
    const Vec3d at(probe.position(i));
    const double sum = std::fabs(at.x) + std::fabs(at.y) + std::fabs(at.z);
    finding.note(std::fabs(dot(at - c[0], n)) / (kGamma7 * sum), described(rays[i]));
  }
  return finding;
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

  return static_cast<double>(std::fabs(dot(Vec(point) - Vec(*base), n)));
}

// The test sets the hits itself, so that triangles of every shape have some. They are so far away
// that the weights are more precise than the distance.
Finding offsetBoundsTheError(const Setup& setup) {
  Finding finding(1);
  Numbers numbers(4);
  Mesh mesh;
  constexpr std::uint32_t kTriangles = 4096;
  constexpr float kFar = 1e12f;

  for (std::uint32_t i = 0; i < 3 * kTriangles; ++i) {
    const double size = std::pow(10, numbers.in(-8, 8));
    mesh.positions.emplace_back(numbers.direction() * size);
    if (i % 3 == 2) mesh.triangles.push_back({i - 2, i - 1, i});
  }

  const Scene scene = sceneOf(mesh, diffuseMaterial(1));
  Probe probe(scene, setup);
  probe.load(std::vector<ProbeRay>(kTriangles, {{0, 0, 0}, {0, 0, -1}}));
  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    const double u = numbers.in(0, 1), v = numbers.in(0, 1 - u);
    probe.hit(i, i, kFar, static_cast<float>(u), static_cast<float>(v));
  }
  probe.interpolate();

  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    const Corners c = worldCorners(scene, i, reference::kNoHit);
    const double u = static_cast<double>(probe.hits().u[i]),
                 v = static_cast<double>(probe.hits().v[i]);
    // Only the distance to the plane counts: the rounding of 1 - u - v moves the point further
    // within the plane.
    const double error = distanceToPlane(c, Vec3d(probe.position(i)));
    finding.note(error / static_cast<double>(probe.surfels().offset[i]), [&] {
      return hexText(Vec3f(c[0])) + ", " + hexText(Vec3f(c[1])) + ", " + hexText(Vec3f(c[2])) +
             " at " + hexText(u) + " " + hexText(v);
    });
  }
  return finding;
}

// The views are from straight above to 0.06 degrees over the plane, onto corners, edges and any
// point.
Finding startOnAPlane(const Setup& setup) {
  Finding finding(0);
  const Scene scene = sceneOf(floorAt(0, 1, 0), shinyMaterial());

  Numbers numbers(9);
  std::vector<ProbeRay> rays;
  for (std::size_t i = 0; i < kLeavingRays; ++i) {
    Vec3d target{numbers.in(-1, 1), 0, numbers.in(-1, 1)};
    if (i % 3 == 0) target = {std::floor(target.x), 0, std::floor(target.z)};
    const double elevation = std::pow(10, numbers.in(-3, 0)), turn = numbers.in(0, 6.28);
    const Vec3d back{std::cos(turn), i % 7 == 0 ? 1e6 : elevation, std::sin(turn)};
    rays.push_back(rayThrough(Vec3f(target + normalized(back) * 2.0), Vec3f(target)));
  }

  Probe probe(scene, setup, rays);
  countHits(finding, Probe(scene, setup, raysOf(probe.reflections())), false);
  return finding;
}

// An eye in the plane of a glowing floor, and parallel rays that all start in it, see only the sky.
Finding eyeInAPlane(const Setup& setup) {
  Finding finding(0);
  constexpr float kSky = 0.25f;

  for (const float height : {0.0f, 0.1f, 1000.1f, -3e6f}) {
    SceneBuilder builder;
    Material glowing = blackMaterial();
    glowing.emission = {1, 1, 1};
    builder.add(floorAt(height, 10, builder.add(glowing)));
    builder.sky(kSky);
    const Scene scene = builder.build();

    for (const Vec3f& towards : {Vec3f(1, 0, 0.2f), Vec3f(0.1f, 1, 0), Vec3f(0, -1, 0.1f),
                                 Vec3f(0.3f, 0.7f, -1), Vec3f(-1, -0.4f, 0.2f)}) {
      for (const float parallel : {0.0f, 2.0f}) {
        // Parallel rays all start in the plane only if they are perpendicular to it.
        if (parallel > 0 && std::fabs(towards.y) < 1) continue;

        Camera camera;
        camera.eye = {0.3f, height, 0.2f};
        const Vec3f along = parallel > 0 ? Vec3f(0, towards.y, 0) : towards;
        camera.at = {camera.eye.x + along.x, camera.eye.y + along.y, camera.eye.z + along.z};
        camera.up = {0, 0.3f, 1};
        camera.fov = 100;
        camera.orthographicHeight = parallel;

        RenderOptions options = optionsOf(setup, {32, 24});
        for (const Rgb& pixel : pictureOf(scene, camera, options).pixels) {
          finding.count(pixel.x != kSky, [&] {
            return "height " + hexText(double{height}) + " towards " + hexText(along) +
                   (parallel > 0 ? ", parallel" : "");
          });
        }
      }
    }
  }
  return finding;
}

// Returns true if the line from `p` to `q` hits the unit box on the floor, enlarged by `larger` on
// all sides.
bool meetsUnitBox(const Vec3d& p, const Vec3d& q, double larger) {
  const Vec3d low = Vec3d{-0.5, 0, -0.5} - Vec3d(larger), high = Vec3d{0.5, 1, 0.5} + Vec3d(larger);

  // The line is clipped at the two planes of each axis.
  double enters = 0, leaves = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (low[axis] - p[axis]) / (q[axis] - p[axis]),
                 b = (high[axis] - p[axis]) / (q[axis] - p[axis]);
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
Finding shadowOnLargeFloors(const Setup& setup) {
  constexpr double kUnsure = 0.01;  // next to the box and to the shadow's edge; pixels are larger
  constexpr float kLargestTilted = 1e3f;
  Finding finding(0);
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

      const RenderOptions options = optionsOf(setup, {64, 48});
      const Image image = pictureOf(builder.build(), camera, options);
      const CameraFrame frame = makeCameraFrame(upright, image.width, image.height);

      for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
          // The pixel shows this point of the floor unless the box hides it.
          const Vec3d way = frame.forward + asideOf(frame, x, y);
          const Vec3d at = frame.eye - way * (frame.eye.y / way.y);
          if (meetsUnitBox(frame.eye, at, kUnsure)) continue;

          const bool hidden = meetsUnitBox(at, {2, 3, 1}, -kUnsure);
          if (!hidden && meetsUnitBox(at, {2, 3, 1}, kUnsure)) continue;
          finding.count((image.at(x, y).x > 0) == hidden, [&] {
            return "floor " + hexText(double{half}) + ", tilted by " + std::to_string(degrees) +
                   ", pixel " + std::to_string(x) + "," + std::to_string(y);
          });
        }
      }
    }
  }
  return finding;
}

// A shade 16 float steps under a lamp far from the origin keeps the floor dark.
Finding shadeNextToItsLamp(const Setup& setup) {
  Finding finding(0);
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
    RenderOptions options = optionsOf(setup, {32, 24});

    for (const Rgb& pixel : pictureOf(builder.build(), camera, options).pixels) {
      finding.count(pixel.x != 0, [&] { return "lamp at " + hexText(double{far}); });
    }
  }
  return finding;
}

// A refracted ray that starts on the wrong side hits its own face again.
Finding sideOfTheOffset(const Setup& setup) {
  Finding finding(0);
  SceneBuilder builder;
  addSlab(builder, 0, -0.25f, builder.add(glassMaterial(1.5f)), 40);
  const Scene scene = builder.build();

  std::vector<ProbeRay> rays;
  Numbers numbers(10);
  for (std::size_t i = 0; i < kLeavingRays; ++i) {
    const double angle = numbers.in(0, 1.5);
    rays.push_back({{0, 1, 0}, Vec3f(Vec3d{std::sin(angle), -std::cos(angle), 0})});
  }

  // The rays hit the upper face (triangles 0 and 1), then the lower one (2 and 3), then nothing.
  Probe probe(scene, setup);
  for (const int expected : {0, 2, -1}) {
    probe.cast(rays);
    for (std::size_t i = 0; i < probe.size(); ++i) {
      const int got = probe.isHit(i) ? static_cast<int>(probe.hits().triangle[i] / 2) * 2 : -1;
      finding.count(got != expected, described(probe.ray(i)));
    }
    if (expected < 0) break;

    const Vec3f up{0, 1, 0};
    for (const ProbeChild& child : probe.reflections()) {
      const bool above =
          dot(child.ray.direction, up) > 0 && child.ray.origin.y > probe.position(child.parent).y;
      const bool below =
          dot(child.ray.direction, up) < 0 && child.ray.origin.y < probe.position(child.parent).y;
      finding.count(!above && !below, described(child.ray));
    }

    rays = raysOf(probe.refractions());
  }
  return finding;
}

Finding instanced(const Setup& setup) {
  Finding finding(0);
  const Affine turn = Affine::rotation({1, 2, 3}, 40);
  const std::array<std::pair<Affine, double>, 4> maps{
      {{Affine::scaling({1e-3, 1e-3, 1e-3}), 1e-3},
       {Affine::scaling({1e3, 1e3, 1e3}), 1e3},
       {turn * Affine::scaling({1, 3, 0.3}), 1},
       {Affine::translation({30, -20, 10}) * turn * Affine::scaling({-2, 1, 1}), 1}}};

  for (const auto& [map, size] : maps) {
    SceneBuilder builder;
    const auto material = builder.add(shinyMaterial());
    // The second placement, far away, makes instances of both.
    const Affine elsewhere = Affine::translation(map.p + Vec3d{1e5, 1e5, 1e5} * size) * map;
    builder.place({"ball", {sphereMesh(3, {}, 1, material)}}, {map, elsewhere});
    finding.merge(selfHits(builder.build(), map.p, size, setup, 11));
  }
  return finding;
}

// Triangles with two orthogonal edges of half a unit, at random corners between -2 and 2.
Mesh looseTriangles(std::size_t count, std::uint32_t material) {
  Numbers numbers(3);
  Mesh mesh;
  mesh.materials = {material};

  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3d corner{numbers.in(-2, 2), numbers.in(-2, 2), numbers.in(-2, 2)};
    const Vec3d n = numbers.direction(), e1 = normalized(cross(n, numbers.direction()));
    for (const Vec3d& p : {corner, corner + e1 * 0.5, corner + cross(n, e1) * 0.5}) {
      mesh.positions.emplace_back(p);
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// How far a hit is from where the ray pierces the plane, along the ray or across it, in roundings
// of the distance; 0 where the ray grazes the plane.
double hitError(const ProbeRay& ray, const Corners& corners, const double (&hit)[3]) {
  struct Vector {
    long double x, y, z;
  };
  const auto minus = [](const Vec3d& a, const Vec3d& b) {
    return Vector{static_cast<long double>(a.x) - b.x, static_cast<long double>(a.y) - b.y,
                  static_cast<long double>(a.z) - b.z};
  };
  const auto dotOf = [](const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  };
  const auto crossOf = [](const Vector& a, const Vector& b) {
    return Vector{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  };

  const Vector way = minus(Vec3d(ray.direction), {}), from = minus(Vec3d(ray.origin), corners[0]);
  const Vector e1 = minus(corners[1], corners[0]), e2 = minus(corners[2], corners[0]);
  const Vector normal = crossOf(e1, e2);
  const long double slope = dotOf(normal, way), area = std::sqrt(dotOf(normal, normal));
  if (std::fabs(slope) < area / 2) return 0;

  const long double t = -dotOf(normal, from) / slope;
  const long double u = dotOf(crossOf(e2, way), from) / slope;
  const long double v = dotOf(crossOf(way, e1), from) / slope;

  const long double side = std::sqrt(area);
  const long double off =
      std::max({std::fabs(hit[0] - t), std::fabs(hit[1] - u) * side, std::fabs(hit[2] - v) * side});
  return static_cast<double>(off / (0x1p-24L * t));
}

// The distance and the weights of hits in the world and on instances that scale, turn and mirror
// without rounding.
Finding hitsAreExact(const Setup& setup) {
  Finding finding(8);
  SceneBuilder builder;
  const std::uint32_t material = builder.add(diffuseMaterial(1));
  builder.add(looseTriangles(400, material));
  Object object;
  object.meshes.push_back(looseTriangles(400, material));
  builder.place(object, {Affine{{0, 0, 2}, {0, 2, 0}, {-2, 0, 0}, {16, 0, 0}},
                         Affine{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {-16, 3, 0}}});
  const Scene scene = builder.build();

  const Vec3d middles[] = {{}, {16, 0, 0}, {-16, 3, 0}};
  Numbers numbers(54);
  std::vector<ProbeRay> rays;
  for (std::size_t i = 0; i < 6000; ++i) {
    const Vec3d& middle = middles[i % 3];
    const Vec3d target{numbers.in(-2, 2), numbers.in(-2, 2), numbers.in(-2, 2)};
    const Vec3f from(middle + numbers.direction() * 9.0);
    rays.push_back(rayThrough(from, Vec3f(middle + target)));
  }

  Probe probe(scene, setup, rays);
  const HitColumns& hits = probe.hits();
  for (std::size_t i = 0; i < probe.size(); ++i) {
    if (!probe.isHit(i)) continue;
    const Corners corners = worldCorners(scene, hits.triangle[i], hits.instance[i]);
    finding.note(hitError(rays[i], corners, {hits.t[i], hits.u[i], hits.v[i]}), described(rays[i]));
  }
  return finding;
}

constexpr Case kLeavingSurfaceCases[] = {
    {"H1", "no ray hits the convex body that it leaves, at any size",
     "icospheres of radius 1e-4 to 1e6; reflected and shadow rays", Runs::packets, scaleSweep},
    {"H2", "the same far from the origin", "distance 1e2 to 1e6, radius down to 1e-4 of it",
     Runs::packets, farFromOrigin},
    {"H2b", "the shadow of a box on floors of any size",
     "half of 10 to 1e6 units, to 1e3 tilted; pixels that are not as the box and the lamp have it",
     Runs::packets, shadowOnLargeFloors},
    {"H2c", "a shade next to its lamp, far from the origin",
     "16 float steps apart, 2^10 to 2^18 away; pixels that are lit", Runs::packets,
     shadeNextToItsLamp},
    {"H3", "hit points lie on the triangle, whatever the distance of the eye",
     "patch seen from 1e5; distance to its plane over gamma(7) times the coordinates",
     Runs::packets, pointsFromFarAway},
    {"H3b", "the distance and the weights of a hit are rounded a few times only",
     "1200 triangles in the world and on instances; error over 2^-24 of the distance",
     Runs::packets, hitsAreExact},
    {"H4", "the offset bounds the error of the hit point",
     "4096 triangles with coordinates of 1e-8 to 1e8; distance to the plane over offset",
     Runs::targets, offsetBoundsTheError},
    {"H9", "rays that start on a plane leave it", "views from vertical to 0.06 degrees",
     Runs::packets, startOnAPlane},
    {"H9b", "an eye in a surface's plane does not see it",
     "in a glowing floor, looking along it, away and through; pixels that are not the sky",
     Runs::packets, eyeInAPlane},
    {"H10", "child rays start on the side to which they go", "slab of glass: two faces, then out",
     Runs::packets, sideOfTheOffset},
    {"H11", "no self-hits on instances", "scaled by 1e-3 and 1e3, stretched, mirrored",
     Runs::packets, instanced},
};

}  // namespace

std::span<const Case> leavingSurfaceCases() { return kLeavingSurfaceCases; }

}  // namespace whit::verify
