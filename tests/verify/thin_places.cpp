// H5 to H8: gaps, contacts and corners, where an offset that is too large goes through.
#include "verify/bodies.h"

namespace whit::verify {

namespace {

constexpr std::size_t kThinPlaceRays = 1500;

Finding thinGap(const Setup& setup) {
  Finding finding(0);
  for (const float gap : {1e-5f, 1e-4f, 1e-3f, 1e-2f}) {
    SceneBuilder builder;
    const auto glass = builder.add(glassMaterial(1.5f));
    builder.add(floorAt(0, 0.5f, glass));
    builder.add(floorAt(-gap, 0.5f, builder.add(diffuseMaterial(1))));
    const Scene scene = builder.build();

    Probe probe(scene, setup), below(scene, setup);
    Numbers numbers(5);
    std::vector<ProbeRay> rays, children;
    for (std::size_t i = 0; i < kThinPlaceRays; ++i) {
      const Vec3f target(Vec3d{numbers.in(-0.4, 0.4), 0, numbers.in(-0.4, 0.4)});
      rays.push_back(rayThrough(target + Vec3f{0.3f, 1, 0.2f}, target));
    }

    probe.cast(rays);
    // Gaps of less than four offsets may be skipped.
    for (const ProbeChild& child : probe.refractions()) {
      if (gap > 4 * probe.surfels().offset[child.parent]) children.push_back(child.ray);
    }

    below.cast(children);
    for (std::size_t i = 0; i < below.size(); ++i) {
      const bool lower = below.isHit(i) && below.hits().triangle[i] >= 2;
      finding.count(!lower,
                    [&] { return "gap " + hexText(double{gap}) + " " + describeRay(children[i]); });
    }
  }
  return finding;
}

// Counts the pixels that are not black.
Finding litPixels(const Scene& scene, const Setup& setup) {
  Finding finding(0);
  const Camera above{.eye = {0.5f, 3, 4}, .at = {0, 0.5f, 0}};
  const Image image = pictureOf(scene, above, optionsOf(setup, {64, 48}));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    finding.count(!(image.pixels[i] == Rgb(0.0f)),
                  [&] { return "pixel " + std::to_string(i % 64) + "," + std::to_string(i / 64); });
  }
  return finding;
}

Finding contactLeak(const Setup& setup) {
  Finding finding(0);
  for (const bool ball : {true, false}) {
    SceneBuilder builder;
    const auto gray = builder.add(diffuseMaterial(1));
    builder.add(floorAt(0, 50, gray));
    Mesh body = box({-1, 0, -1}, {1, 1.5f, 1}, gray);
    if (ball) body = sphereMesh(4, {0, 1, 0}, 1, gray);
    builder.add(std::move(body));
    builder.description.lights = {lightAt({0.2f, -1, 0.3f}, 100), lightAt({0, -1e-3f, 0}, 100)};
    finding.merge(litPixels(builder.build(), setup));
  }
  return finding;
}

// Rays towards edges and corners of the inside of a cube, off by up to four units in the last
// place.
std::vector<ProbeRay> intoCorners(std::size_t n, std::uint64_t seed) {
  Numbers numbers(seed);
  std::vector<ProbeRay> rays;
  for (std::size_t i = 0; i < n; ++i) {
    Vec3d target{numbers.in(-1, 1), numbers.in(-1, 1), numbers.in(-1, 1)};
    const int corner = i % 3 == 0 ? 3 : 2;
    for (int axis = 0; axis < corner; ++axis) {
      const double off = std::floor(numbers.in(0, 5)) * 0x1p-24;
      target[axis] = numbers.in(-1, 1) < 0 ? off - 1 : 1 - off;
    }
    rays.push_back(rayThrough({0, 0, 0}, Vec3f(target)));
  }
  return rays;
}

Finding concaveCorners(const Setup& setup) {
  Finding finding(0);
  const Scene scene = sceneOf(box({-1, -1, -1}, {1, 1, 1}, 0), diffuseMaterial(1));
  Probe probe(scene, setup, intoCorners(kThinPlaceRays, 7));
  for (const Vec3f& outside : {Vec3f{2.3f, 1.7f, 0.4f}, {-1.01f, 0.2f, 0.3f}, {0, 1.5f, -1.5f}}) {
    probe.light(lightAt(outside, 1));
    for (std::size_t i = 0; i < probe.size(); ++i) {
      finding.count(probe.visible(i), described(probe.ray(i)));
    }
  }
  return finding;
}

Finding lightOnASurface(const Setup& setup) {
  Finding finding(0);
  float height = 2;
  for (int ulps = 0; ulps < 4; ++ulps, height = std::nextafter(height, 0.0f)) {
    SceneBuilder builder;
    const auto gray = builder.add(diffuseMaterial(1));
    builder.add(floorAt(0, 3, gray));
    builder.add(ceilingAt(2, 3, gray));
    const Scene scene = builder.build();

    Probe probe(scene, setup);
    std::vector<ProbeRay> rays;
    Numbers numbers(8);
    for (std::size_t i = 0; i < kThinPlaceRays; ++i) {
      const Vec3f target(Vec3d{numbers.in(-2, 2), 0, numbers.in(-2, 2)});
      rays.push_back(rayThrough({0.1f, 1, 0.1f}, target));
    }

    probe.cast(rays);
    probe.light(lightAt({0.3f, height, 0.1f}, 1));
    for (std::size_t i = 0; i < probe.size(); ++i) {
      finding.count(!probe.visible(i), [&] {
        return std::to_string(ulps) + " ulp below, " + describeRay(probe.ray(i));
      });
    }
  }
  return finding;
}

constexpr Case kThinPlaceCases[] = {
    {"H5", "thin gaps are not skipped", "refracted rays between sheets 1e-5 to 1e-2 apart",
     Runs::packets, thinGap},
    {"H6", "no light through contacts", "ball and box on a floor, lights below it; lit pixels",
     Runs::packets, contactLeak},
    {"H7", "no light into a closed cube", "surfels within 4 ulp of edges and corners",
     Runs::packets, concaveCorners},
    {"H8", "a light on a surface lights", "light on a ceiling and 1 to 3 ulp below it",
     Runs::packets, lightOnASurface},
};

}  // namespace

std::span<const Case> thinPlaceCases() { return kThinPlaceCases; }

}  // namespace whit::verify
