// H5 to H8: gaps, contacts and corners, where an offset that is too large goes through.
#include "verify/bodies.h"

namespace whit::verify {

namespace {

constexpr int kThinPlaceRays = 1500;

void thinGap(Run& run) {
  for (const float gap : {1e-5f, 1e-4f, 1e-3f, 1e-2f}) {
    SceneBuilder builder;
    const auto glass = builder.add(glassMaterial(1.5f));
    builder.add(floorAt(0, 0.5f, glass));
    builder.add(floorAt(-gap, 0.5f), diffuseMaterial(1));
    const Scene scene = builder.build();

    Probe probe(scene, run, randomRays(kThinPlaceRays, 5, [](Numbers& numbers, int) {
                  const Vec3f target(Vec3d{numbers.in(-0.4, 0.4), 0, numbers.in(-0.4, 0.4)});
                  return rayThrough(target + Vec3f{0.3f, 1, 0.2f}, target);
                }));

    std::vector<ProbeRay> children;
    // Gaps of less than four offsets may be skipped.
    for (const ProbeChild& child : probe.refractions()) {
      if (gap > 4 * probe.surfels().offset[child.parent]) children.push_back(child.ray);
    }

    const Probe below(scene, run, children);
    for (const auto i : indices(below)) {
      const bool lower = below.isHit(i) && below.hits().triangle[i] >= 2;
      run.count(!lower, "gap ", gap, " ", children[i]);
    }
  }
}

// Counts the pixels that are not black.
void litPixels(Run& run, const Scene& scene) {
  const Camera above{.eye = {0.5f, 3, 4}, .at = {0, 0.5f, 0}};
  const Image image = pictureOf(scene, above, optionsOf(run, {64, 48}));
  forEachPixel(64, 48,
               [&](int x, int y) { run.count(!(image.at(x, y) == Rgb()), "pixel ", x, ",", y); });
}

void contactLeak(Run& run) {
  for (const bool ball : {true, false}) {
    SceneBuilder builder;
    const auto gray = builder.add(diffuseMaterial(1));
    builder.add(floorAt(0, 50, gray));
    Mesh body = box({-1, 0, -1}, {1, 1.5f, 1}, gray);
    if (ball) body = sphereMesh(4, {0, 1, 0}, 1, gray);
    builder.add(std::move(body));
    builder.description.lights = {lightAt({0.2f, -1, 0.3f}, 100), lightAt({0, -1e-3f, 0}, 100)};
    litPixels(run, builder.build());
  }
}

// Rays towards edges and corners of the inside of a cube, off by up to four units in the last
// place.
std::vector<ProbeRay> intoCorners(int n, std::uint64_t seed) {
  return randomRays(n, seed, [](Numbers& numbers, int i) {
    Vec3d target = numbers.inCube(1);
    for (int axis = 0; axis < (i % 3 == 0 ? 3 : 2); ++axis) {
      const double off = std::floor(numbers.in(0, 5)) * 0x1p-24;
      target[axis] = numbers.in(-1, 1) < 0 ? off - 1 : 1 - off;
    }
    return rayThrough({0, 0, 0}, Vec3f(target));
  });
}

void concaveCorners(Run& run) {
  const Scene scene = sceneOf(box({-1, -1, -1}, {1, 1, 1}), diffuseMaterial(1));
  Probe probe(scene, run, intoCorners(kThinPlaceRays, 7));
  for (const Vec3f& outside : {Vec3f{2.3f, 1.7f, 0.4f}, {-1.01f, 0.2f, 0.3f}, {0, 1.5f, -1.5f}}) {
    probe.light(lightAt(outside, 1));
    for (const auto i : indices(probe)) {
      run.count(probe.visible(i), probe.ray(i));
    }
  }
}

void lightOnASurface(Run& run) {
  float height = 2;
  for (int ulps = 0; ulps < 4; ++ulps, height = std::nextafter(height, 0.0f)) {
    SceneBuilder builder;
    const auto gray = builder.add(diffuseMaterial(1));
    builder.add(floorAt(0, 3, gray));
    builder.add(ceilingAt(2, 3, gray));
    const Scene scene = builder.build();

    Probe probe(scene, run, randomRays(kThinPlaceRays, 8, [](Numbers& numbers, int) {
                  const Vec3f target(Vec3d{numbers.in(-2, 2), 0, numbers.in(-2, 2)});
                  return rayThrough({0.1f, 1, 0.1f}, target);
                }));
    probe.light(lightAt({0.3f, height, 0.1f}, 1));
    for (const auto i : indices(probe)) {
      run.count(!probe.visible(i), ulps, " ulp below, ", probe.ray(i));
    }
  }
}

}  // namespace

const Family kThinPlaceCases{"gaps and contacts",
                             {{"H5", "thin gaps are not skipped",
                               "refracted rays between sheets 1e-5 to 1e-2 apart", thinGap},
                              {"H6", "no light through contacts",
                               "ball and box on a floor, lights below it; lit pixels", contactLeak},
                              {"H7", "no light into a closed cube",
                               "surfels within 4 ulp of edges and corners", concaveCorners},
                              {"H8", "a light on a surface lights",
                               "light on a ceiling and 1 to 3 ulp below it", lightOnASurface}}};

}  // namespace whit::verify
