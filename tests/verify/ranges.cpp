// H51 to H58: very small and very large numbers in vectors, intensities and textures.
#include <unistd.h>

#include <array>
#include <filesystem>

#include "core/text.h"
#include "io/image/image_file.h"
#include "io/image/texture_from_image.h"
#include "simd/kernels.h"
#include "verify/bodies.h"

namespace whit::verify {

namespace {

// The kernels produce normals of unit length for scenes of any size.
Finding unitNormals(const Setup& setup) {
  Finding finding(3 * 0x1p-24);
  Numbers numbers(51);
  Mesh mesh;
  constexpr std::uint32_t kTriangles = 4000;
  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    // Below 1e-14 some edges are shorter than the least normal float.
    const double size = std::pow(10, numbers.in(-14, 17.5));
    for (int k = 0; k < 3; ++k) mesh.positions.emplace_back(numbers.direction() * size);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }

  const Scene scene = sceneOf(mesh, diffuseMaterial(1));
  Probe probe(scene, setup);
  probe.hitEach(kTriangles);
  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    finding.note(std::fabs(length(Vec3d(probe.ng(i))) - 1),
                 [&] { return "first corner " + hexText(mesh.positions[3 * i]); });
  }
  return finding;
}

// Directions keep their length over 64 reflections in a box of mirrors.
Finding lengthAfter64Reflections(const Setup& setup) {
  Finding finding(3 * 0x1p-24);
  const Scene scene = sceneOf(box({-1, -1, -1}, {1, 1, 1}, 0), mirrorMaterial(1));
  Numbers numbers(52);
  std::vector<ProbeRay> rays;
  rays.reserve(64);
  for (int i = 0; i < 64; ++i) rays.push_back({{0.1f, 0.2f, 0.3f}, Vec3f(numbers.direction())});

  Probe probe(scene, setup);
  for (int bounce = 0; bounce < 64; ++bounce) {
    probe.cast(rays);
    rays = raysOf(probe.reflections());
  }

  for (const ProbeRay& ray : rays) {
    finding.note(std::fabs(length(Vec3d(ray.direction)) - 1), described(ray));
  }
  return finding;
}

SceneDescription litFloor(float intensity) {
  SceneBuilder builder;
  builder.add(floorAt(0, 4, builder.add(diffuseMaterial(0.5f))));
  builder.add(sphereMesh(3, {0, 1, 0}, 0.7, 0, true));
  builder.description.lights = {lightAt({1, 3, 1}, intensity)};
  builder.description.cameras = {{.eye = {0, 3, 5}, .at = {0, 0.5f, 0}}};
  return builder.describe();
}

Image litPicture(float intensity, const Setup& setup) {
  const Scene scene = repaired(litFloor(intensity));
  return pictureOf(scene, scene.cameras[0], optionsOf(setup, {33, 21}));
}

// Light of 1e-39 loses only the values that the workers flush to zero.
Finding denormalLight(const Setup& setup) {
  Finding finding(1e-37);
  const float intensity = 1e-39f;
  const Image image = litPicture(intensity, setup), unit = litPicture(1, setup);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double exact = static_cast<double>(unit.pixels[i].x) * static_cast<double>(intensity);
    finding.note(std::fabs(static_cast<double>(image.pixels[i].x) - exact),
                 [&] { return "pixel " + std::to_string(i); });
  }
  return finding;
}

// The picture divided by the intensity has the same bits for powers of two, and differs by ulps for
// others.
Finding extremeIntensities(const Setup& setup) {
  Finding finding(4);
  const Image unit = litPicture(1, setup);
  for (const float intensity : {0x1p-90f, 0x1p90f, 1e-30f, 1e-10f, 1e10f, 1e30f}) {
    const Image image = litPicture(intensity, setup);
    const bool power = std::fabs(std::log2(intensity)) == 90;

    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const double one = static_cast<double>(unit.pixels[i].x);
      const double got = static_cast<double>(image.pixels[i].x) / static_cast<double>(intensity);
      const double ulps = one == 0 ? std::fabs(got) : std::fabs(got / one - 1) / 0x1p-23;
      finding.note(power && ulps > 0 ? 100 : ulps,
                   [&] { return "intensity " + hexText(double{intensity}); });
    }
  }
  return finding;
}

// A sky texel that is not a number is repaired when its image is read; at most the colors of its
// neighbors change.
Finding badSkyTexels(const Setup& setup) {
  Finding finding(0);
  const std::string file =
      std::filesystem::temp_directory_path() / formatted("whit-verify-%d.exr", int{getpid()});
  for (const float bad : {kNan, kInf, -kInf, -1.0f}) {
    SceneBuilder builder;
    builder.add(floorAt(0, 1, builder.add(mirrorMaterial(1))));

    Image image(4, 4);
    image.pixels.assign(16, Rgb(1.0f));
    image.pixels[5] = Rgb(bad);
    writeExr(file, image, {});

    Warnings warnings;
    builder.description.sky.kind = Sky::Kind::image;
    builder.description.sky.image = makeEnvironment(readRawImage(file, ImageLimits(), warnings));
    std::filesystem::remove(file);
    const Scene scene = repaired(builder.describe());
    finding.count(warnings.entries().empty(),
                  [&] { return "not counted: " + hexText(double{bad}); });

    const Camera camera{.eye = {0, 1, 3}, .fov = 120};
    for (const Rgb& pixel : pictureOf(scene, camera, optionsOf(setup, {33, 21})).pixels) {
      finding.count(!isFinite(pixel) || pixel.x < 0 || (bad != kInf && pixel.x > 1.00001f),
                    [&] { return "texel " + hexText(double{bad}); });
    }
  }
  return finding;
}

// Min and Max treat a NaN differently on different CPUs; the codes must be the same.
Finding oddRadiance(const Setup&) {
  Finding finding(0);
  const std::array<std::pair<float, std::uint32_t>, 8> cases{{{kNan, 0},
                                                              {-kNan, 0},
                                                              {kInf, 255},
                                                              {-kInf, 0},
                                                              {-1.0f, 0},
                                                              {-0.0f, 0},
                                                              {1e-40f, 0},
                                                              {3e38f, 255}}};

  for (const ToneCurve curve : {ToneCurve::none, ToneCurve::filmic, ToneCurve::reinhard}) {
    ColumnStore<RadianceColumns> radiance(64, FeatureSet());
    for (std::size_t i = 0; i < 64; ++i) {
      radiance->rgb.x[i] = radiance->rgb.y[i] = radiance->rgb.z[i] = cases[i % 8].first;
    }
    std::array<std::uint32_t, 96> codes{};
    simd::encodeDisplay({.curve = curve, .radiance = *radiance, .n = 64, .codes = codes.data()});

    for (std::size_t i = 0; i < 64; ++i) {
      const auto& [value, code] = cases[i % 8];
      const std::uint32_t got = codes[i] & 255u;
      // The end values of tone curves differ; the test only compares which end is reached.
      const bool right = curve == ToneCurve::none || code == 0 ? got == code : got > 250;
      finding.count(!right, [&, v = value] { return "radiance " + hexText(double{v}); });
    }
  }
  return finding;
}

constexpr Case kRangeCases[] = {
    {"H51", "normals have unit length for corners from 1e-14 to 3e17",
     "4000 triangles of all shapes", Runs::targets, unitNormals},
    {"H52", "directions keep their length over 64 reflections", "box of mirrors, 64 rays",
     Runs::packets, lengthAfter64Reflections},
    {"H55", "light of 1e-39", "against the picture for light 1, scaled; absolute error",
     Runs::packets, denormalLight},
    {"H56", "light of 1e-30 to 1e30",
     "against the picture for light 1; ulps, none allowed for powers of two", Runs::packets,
     extremeIntensities},
    {"H57", "sky texels that are not numbers", "NaN, infinities, -1 among 16 texels", Runs::packets,
     badSkyTexels},
    {"H58", "codes of radiance that is not a number", "NaN, infinities, negative; all tone curves",
     Runs::targets, oddRadiance},
};

}  // namespace

std::span<const Case> rangeCases() { return kRangeCases; }

}  // namespace whit::verify
