// H45 to H50: nested dielectrics, an eye inside one, sheets without a far side, and absorption.
#include <array>

#include "verify/bodies.h"

namespace whit::verify {

namespace {

// Follows refracted rays through the scene, and calls visit(ray) for each ray that leaves it.
template <typename Visit>
void follow(const Scene& scene, const Setup& setup, std::vector<ProbeRay> rays,
            const Visit& visit) {
  Probe probe(scene, setup);
  for (int crossing = 0; crossing < 16 && !rays.empty(); ++crossing) {
    probe.cast(rays);
    for (const auto i : indices(rays)) {
      if (!probe.isHit(i)) visit(rays[i]);
    }
    rays = raysOf(probe.refractions());
  }
}

// 200 rays from above, up to 1.2 radians from the vertical.
std::vector<ProbeRay> fanFromAbove(double aside) {
  std::vector<ProbeRay> rays;
  for (int i = 0; i < 200; ++i) {
    const double angle = 1.2 * i / 200;
    rays.push_back({{0, 2, 0}, Vec3f(Vec3d{std::sin(angle), -std::cos(angle), aside})});
  }
  return rays;
}

// Glass on water, apart and overlapping: a ray leaves in the direction in which it came, and in no
// medium.
void glassOnWater(Run& run) {
  run.boundBy(1e-5);
  for (const float gap : {1e-2f, 1e-3f, -1e-3f, -1e-2f}) {
    SceneBuilder builder;
    addSlab(builder, 1, 0, glassMaterial(1.5f, 2), 50);
    addSlab(builder, -gap, -1, glassMaterial(1.33f, 1), 50);

    std::vector<ProbeRay> start = fanFromAbove(0.1);
    for (ProbeRay& ray : start) ray.direction = Vec3f(normalized(Vec3d(ray.direction)));

    std::size_t left = 0;
    follow(builder.build(), run, start, [&](const ProbeRay& ray) {
      ++left;
      double turned = 10;
      for (const ProbeRay& s : start) {
        turned = std::min(turned, length(Vec3d(ray.direction) - Vec3d(s.direction)));
      }
      run.note(ray.media == 0 ? turned : 1, "gap ", gap, " ", ray);
    });
    run.note(left == start.size() ? 0 : 1, "some never left");
  }
}

// Coincident faces: a ray hits one of them and starts beyond the other.
void coincidentFaces(Run& run) {
  SceneBuilder builder;
  addSlab(builder, 1, 0, glassMaterial(1.5f), 50);
  addSlab(builder, 0, -1, glassMaterial(1.33f), 50);
  follow(builder.build(), run, fanFromAbove(0),
         [&](const ProbeRay& ray) { run.count(ray.media != 0, ray); });
}

// The interface of an overlap is between water and glass, not between either and the vacuum.
void overlapIsOneInterface(Run& run) {
  run.boundBy(16 * 0x1p-24);
  SceneBuilder builder;
  addSlab(builder, 1, 0, glassMaterial(1.5f, 2), 50);
  addSlab(builder, 0.01f, -1, glassMaterial(1.33f, 1), 50);
  const Scene scene = builder.build();
  Probe probe(scene, run);
  std::vector<ProbeRay> rays{{{0, 2, 0}, {0, -1, 0}}};

  // From above: into glass, into the overlap (hidden), out of glass into water.
  const double wanted[] = {0.04, 0, std::pow((1.5 - 1.33) / (1.5 + 1.33), 2)};
  for (int face = 0; face < 3; ++face) {
    probe.cast(rays);
    const std::vector<ProbeChild> refracted = probe.refractions(), reflected = probe.reflections();
    if (refracted.size() != 1) break;
    const double r = wanted[face];
    const double got = reflected.empty() ? 0 : reflected[0].weight.x;
    run.note(r == 0 ? got : std::fabs(got / r - 1), "face ", face);
    rays = {refracted[0].ray};
  }
}

// Four spheres around different centers: the stack has one medium for each sphere around the point.
void stackCountsSpheres(Run& run) {
  const std::array<Vec3d, 4> center{Vec3d{}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0.05, 0.1, 0.1}};
  SceneBuilder builder;
  for (int i = 0; i < 4; ++i) {
    // Index 1 keeps the paths straight, so that the oracle only tests a point against the spheres.
    const auto m = builder.add(glassMaterial(1, i));
    builder.add(sphereMesh(4, center[i], 1 - 0.2 * i, m));
  }

  const Scene scene = builder.build();
  Probe probe(scene, run);
  std::vector<ProbeRay> rays = raysOnto({}, 1, 2000, 46);

  for (int crossing = 0; crossing < 12 && !rays.empty(); ++crossing) {
    probe.cast(rays);
    for (const auto i : indices(rays)) {
      if (!probe.isHit(i)) {
        run.count(rays[i].media != 0, rays[i]);
        continue;
      }

      // The stack is compared with the spheres around the middle of the way to this hit.
      const Vec3d middle = (Vec3d(rays[i].origin) + Vec3d(probe.position(i))) * 0.5;
      int inside = 0;
      double clear = 1;
      for (const auto k : indices(4)) {
        const double r = 1 - 0.2 * double(k), d = length(middle - center[k]);
        inside += d < r;
        clear = std::min(clear, std::fabs(d - r));
      }
      // Facets lie up to 0.003 inside the sphere.
      if (clear < 0.004) continue;
      run.count(mediaCount(rays[i].media) != inside, rays[i]);
    }
    rays = raysOf(probe.refractions());
  }
}

// From the middle of a ball of glass in a white room all rays leave along the normal. The light of
// the paths that are still inside at the greatest depth is missing.
void eyeInGlass(Run& run) {
  // Facets are up to 2 degrees off, where F differs from 0.04 by 1e-6.
  run.boundBy(1e-5);
  const Scene scene = sceneOf(sphereMesh(4, {}, 1), glassMaterial(1.5f), 1);
  const Camera camera{.eye = {0, 0, 0}, .at = {0.3f, 0.2f, -1}};

  for (const int depth : {1, 4}) {
    RenderOptions options = optionsOf(run, {33, 21});
    options.depth = depth;
    options.cutoff = 0;
    for (const Image& image : picturesOf(scene, camera, options)) {
      for (const Rgb& pixel : image.pixels) {
        run.note(std::fabs(1 - std::pow(0.04, depth) - pixel.x), "depth ", depth);
      }
    }
  }
}

// A dozen roundings of the distance and of the exponential, whose argument is below 10.
constexpr double kBeerBound = 64 * 0x1p-24;

// A material that absorbs and does not refract.
Material tintedMaterial() {
  Material m = glassMaterial(1);
  m.absorption = {0.5f, 1, 0};
  return m;
}

// Compares both pictures of walls with radiance 1 that are seen through tinted water. way(start,
// direction) is the distance in the water.
template <typename Way>
void lookThroughWater(Run& run, const Scene& scene, const Camera& camera, const Way& way) {
  RenderOptions options = optionsOf(run, {34, 22});
  options.cutoff = 0;
  const auto [packets, reference] = picturesOf(scene, camera, options);
  const Image* const images[] = {&packets, &reference};

  forEachRay(camera, packets.width, packets.height,
             [&](const Vec3d& start, const Vec3d& direction, int x, int y) {
               const double t = way(start, direction);
               for (int i = 0; i < 6; ++i) {
                 const int c = i / 2;
                 const float got = images[i % 2]->at(x, y)[c];
                 const double wanted = std::exp(-double{tintedMaterial().absorption[c]} * t);
                 run.note(std::fabs(got / wanted - 1), i % 2 == 0 ? "packets" : "reference",
                          ", pixel ", x, ",", y, ", way ", t);
               }
             });
}

// A room with glowing walls; the water reaches beyond the walls or ends before them. The eye is not
// in the glass over the room, which a line from it enters and leaves again.
void waterBeforeTheEye(Run& run) {
  run.boundBy(kBeerBound);
  constexpr float kWall = 2;
  for (const float water : {1.5f, 3.0f}) {
    SceneBuilder builder;
    builder.add(box(Vec3f(-kWall), Vec3f(kWall)), emittingMaterial(1));
    builder.add(box(Vec3f(-water), Vec3f(water)), tintedMaterial());
    builder.add(box({-2, 2.2f, -2}, {2, 2.8f, 2}), glassMaterial(1, 1));

    const Camera camera{.eye = {0, 0, 0}, .at = {0.3f, 0.2f, -1}};
    const double half = std::min(water, kWall);
    lookThroughWater(run, builder.build(), camera,
                     [&](const Vec3d&, const Vec3d& d) { return half / maxComponent(abs(d)); });
  }
}

// The lower half of a parallel camera's rays start in water, the upper half above it.
void parallelRaysInWater(Run& run) {
  run.boundBy(kBeerBound);
  SceneBuilder builder;
  builder.add(box(Vec3f(-2), Vec3f(2)), emittingMaterial(1));
  builder.add(box({-4, -8, -4}, {4, 0, 4}), tintedMaterial());

  const Camera camera{.eye = {0, 0, 1}, .at = {0, 0, -1}, .orthographicHeight = 2};
  lookThroughWater(run, builder.build(), camera,
                   [](const Vec3d& start, const Vec3d&) { return start.y < 0 ? 3.0 : 0.0; });
}

// An eye in the surface of the water: rays that go down start in water, rays that go up do not.
void eyeOnTheWater(Run& run) {
  run.boundBy(kBeerBound);
  for (const float level : {0.0f, 0.1f, 40.3f}) {
    SceneBuilder builder;
    builder.add(box({-2, level - 2, -2}, {2, level + 2, 2}), emittingMaterial(1));
    builder.add(box({-4, level - 8, -4}, {4, level, 4}), tintedMaterial());
    const Camera camera{.eye = {0.1f, level, 0.2f}, .at = {0.1f, level, -1}};

    // The corners of the room are rounded, so that the floor and the ceiling are not exactly 2
    // away.
    const double up = double{level + 2} - level, down = double{level} - double{level - 2};

    lookThroughWater(run, builder.build(), camera, [&](const Vec3d& start, const Vec3d& d) {
      if (d.y > 0) return 0.0;
      const auto until = [](double from, double along, double half) {
        return along == 0 ? 1e30 : (std::copysign(half, along) - from) / along;
      };
      return std::min(
          {until(start.x, d.x, 2), until(start.z, d.z, 2), (d.y < 0 ? down : up) / std::fabs(d.y)});
    });
  }
}

// Between the eye and the surface of the water there are more than 255 sheets that bound no medium.
void sheetsInWater(Run& run) {
  run.boundBy(kBeerBound);
  SceneBuilder builder;
  const auto black = builder.add(blackMaterial());
  for (int i = 0; i < 600; ++i) builder.add(floorAt(0.5f + 0.001f * float(i), 8, black));
  builder.add(floorAt(-1, 8), emittingMaterial(1));
  builder.add(box(Vec3f(-9), Vec3f(9)), tintedMaterial());

  const Camera camera{.eye = {0, 0, 0}, .at = {0, -1, 0}, .up = {0, 0, -1}};
  lookThroughWater(run, builder.build(), camera,
                   [](const Vec3d&, const Vec3d& d) { return -1 / d.y; });
}

// A ball of glass in a white room is white up to its silhouette.
void whiteRim(Run& run) {
  // The normals are smooth; between flat facets total reflection really keeps rays inside.
  run.boundBy(1e-4);
  const Scene scene = sceneOf(sphereMesh(5, {}, 1, 0, true), glassMaterial(1.5f), 1);
  RenderOptions options = optionsOf(run, {32, 32});
  options.depth = 16;
  options.cutoff = 1e-5f;

  double mean = 0;
  for (const Rgb& pixel : pictureOf(scene, {.eye = {0, 0, 5}, .fov = 26}, options).pixels) {
    mean += double{pixel.x} / (32 * 32);
    if (pixel.x > 1.00001f) run.note(1, "brighter than white");
  }
  run.note(1 - mean, "mean of the picture");
}

// A single sheet of glass begins a medium that no surface ends.
void openGlass(Run& run) {
  run.boundBy(1e-6);
  SceneBuilder builder;
  const auto glass = builder.add(glassMaterial(1.5f));
  for (int i = 0; i < 6; ++i) builder.add(floorAt(float(-i), 50, glass));
  builder.sky(1);
  const Camera camera{.eye = {0, 3, 0}, .up = {0, 0, -1}};

  RenderOptions options = optionsOf(run, {17, 11});
  options.depth = 12;
  options.cutoff = 0;
  for (const Rgb& pixel : pictureOf(builder.build(), camera, options).pixels) {
    run.note(std::fabs(1 - double{pixel.x}), "six sheets");
  }
}

// Glowing sheets with a coverage of a quarter, from above and from below: each sheet lets three
// quarters of the light behind it through. No medium begins between them or beside them.
void sheetsInPart(Run& run) {
  // Each sheet takes three roundings.
  run.boundBy(20 * 0x1p-24);
  constexpr int kSheets = 6;
  SceneBuilder builder;
  Material sheet = emittingMaterial(1);
  sheet.coverage = 0.25f;
  const auto material = builder.add(sheet);
  for (int i = 0; i < kSheets; ++i) builder.add(floorAt(float(-i), 50, material));
  builder.sky(5);
  const Scene scene = builder.build();

  RenderOptions options = optionsOf(run, {17, 11});
  options.depth = kSheets + 1;
  options.cutoff = 0;
  const double through = std::pow(0.75, kSheets), wanted = 1 - through + 5 * through;

  for (const float height : {3.0f, -8.0f}) {
    const Camera camera{.eye = {0, height, 0}, .at = {0, -2.5f, 0}, .up = {0, 0, -1}};
    for (const Rgb& pixel : pictureOf(scene, camera, options).pixels) {
      run.note(std::fabs(pixel.x / wanted - 1), "eye at ", height);
    }
  }
}

// Tests exp(-sigma t) of the kernel for products from 0 to beyond underflow, and for 0 times
// infinity.
void absorption(Run& run) {
  // Highway's exp is good to 2 ulp; the rounding of the product, amplified by its size, adds 88.
  run.boundBy(100 * 0x1p-23);
  Material m = glassMaterial(1);
  m.absorption = {0, 1, 1e-8f};
  const Scene scene = sceneOf(floorAt(0, 1), m);
  Probe probe(scene, run);

  // The distance of a ray that leaves the scene is infinity.
  const std::vector<float> distances{0, 1e-8f, 1, 50, 87, 88, 104, 1e4f, 1e30f, kInf};
  const std::uint32_t medium = probe.tables().materials[0].medium;
  probe.load(std::vector<ProbeRay>(distances.size(), {{0, 1, 0}, {0, -1, 0}, medium}));

  for (const auto i : indices(distances)) {
    const float t = distances[i];
    probe.hit(i, std::isinf(t) ? kMiss : 0, t, 0.25f, 0.25f);
  }
  probe.interpolate();

  for (const auto i : indices(distances)) {
    const double t = distances[i];
    for (int c = 0; c < 3; ++c) {
      // Values below the least normal float are 0.
      const double sigma = m.absorption[c], exact = sigma == 0 ? 1 : std::exp(-sigma * t);
      const double least = 0x1p-125, got = probe.rays().weight.at(i)[c];
      double error = std::fabs(got / exact - 1);
      if (exact < least) error = got > least ? 1 : 0;
      run.note(error, "sigma ", sigma, ", t ", t);
    }
  }
}

}  // namespace

const Family kNestedDielectricCases{
    "nested dielectrics",
    {{"H45", "glass on water, apart and overlapping: rays leave as they came",
      "200 angles; how far the direction has turned", glassOnWater},
     {"H45a", "an overlap is the interface of the two media", "relative error of F at each face",
      overlapIsOneInterface},
     {"H45b", "coincident faces of glass and water", "rays that leave in a medium, of 200",
      coincidentFaces},
     {"H46", "the stack of media counts the spheres around a point",
      "four spheres that do not share a center; 2000 paths", stackCountsSpheres},
     {"H47", "an eye inside glass",
      "white room from inside a ball, depths 1 and 4; against 1 - 0.04^depth", eyeInGlass},
     {"H47b", "an eye in tinted water",
      "glowing walls in it, or behind its surface; relative error against exp(-sigma t)",
      waterBeforeTheEye},
     {"H47c", "a parallel camera half in water",
      "each ray starts in its own medium; relative error against exp(-sigma t)",
      parallelRaysInWater},
     {"H47e", "an eye in the water's surface",
      "at three levels; relative error against exp(-sigma t) below, and 1 above", eyeOnTheWater},
     {"H47d", "an eye in water under 600 opaque sheets",
      "only surfaces of dielectrics count; relative error against exp(-sigma t)", sheetsInWater},
     {"H48", "no dark rim", "ball of glass in a white room; what is missing of the mean", whiteRim},
     {"H49", "sheets of glass without a far side", "six of them in a white room", openGlass},
     {"H49a", "sheets with partial coverage",
      "six of them, from both sides; relative error against the sum over sheets", sheetsInPart},
     {"H50", "absorption from nothing to everything",
      "sigma t from 0 to 1e30 and infinity; relative error", absorption, Runs::targets}}};

}  // namespace whit::verify
