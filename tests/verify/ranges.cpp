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
void unitNormals(Run& run) {
  run.boundBy(3 * 0x1p-24);
  Numbers numbers(51);
  Mesh mesh;
  constexpr std::uint32_t kTriangles = 4000;
  while (mesh.triangles.size() < kTriangles) {
    // Below 1e-14 some edges are shorter than the least normal float.
    const double size = std::pow(10, numbers.in(-14, 17.5));
    const auto corner = [&] { return Vec3f(numbers.direction() * size); };
    addTriangle(mesh, {corner(), corner(), corner()});
  }

  const Scene scene = sceneOf(mesh, diffuseMaterial(1));
  Probe probe(scene, run);
  probe.hitEach(kTriangles);
  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    run.note(std::fabs(length(Vec3d(probe.ng(i))) - 1), "first corner ", mesh.positions[3 * i]);
  }
}

// Directions keep their length over 64 reflections in a box of mirrors.
void lengthAfter64Reflections(Run& run) {
  run.boundBy(3 * 0x1p-24);
  const Scene scene = sceneOf(box({-1, -1, -1}, {1, 1, 1}), mirrorMaterial(1));
  auto rays = randomRays(64, 52, [](Numbers& numbers, int) {
    return ProbeRay{{0.1f, 0.2f, 0.3f}, Vec3f(numbers.direction())};
  });

  Probe probe(scene, run);
  for (int bounce = 0; bounce < 64; ++bounce) {
    probe.cast(rays);
    rays = raysOf(probe.reflections());
  }

  for (const ProbeRay& ray : rays) {
    run.note(std::fabs(length(Vec3d(ray.direction)) - 1), ray);
  }
}

SceneDescription litFloor(float intensity) {
  SceneBuilder builder;
  builder.add(floorAt(0, 4), diffuseMaterial(0.5f));
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
void denormalLight(Run& run) {
  run.boundBy(1e-37);
  const float intensity = 1e-39f;
  const Image image = litPicture(intensity, run), unit = litPicture(1, run);
  for (const auto i : indices(image.pixels)) {
    const double exact = double{unit.pixels[i].x} * intensity;
    run.note(std::fabs(image.pixels[i].x - exact), "pixel ", i);
  }
}

// The picture divided by the intensity has the same bits for powers of two, and differs by ulps for
// others.
void extremeIntensities(Run& run) {
  run.boundBy(4);
  const Image unit = litPicture(1, run);
  for (const float intensity : {0x1p-90f, 0x1p90f, 1e-30f, 1e-10f, 1e10f, 1e30f}) {
    const Image image = litPicture(intensity, run);
    const bool power = std::fabs(std::log2(intensity)) == 90;

    for (const auto i : indices(image.pixels)) {
      const double one = unit.pixels[i].x, got = double{image.pixels[i].x} / intensity;
      const double ulps = one == 0 ? std::fabs(got) : std::fabs(got / one - 1) / 0x1p-23;
      run.note(power && ulps > 0 ? 100 : ulps, "intensity ", intensity);
    }
  }
}

// A sky texel that is not a number is repaired when its image is read; at most the colors of its
// neighbors change.
void badSkyTexels(Run& run) {
  const std::string file =
      std::filesystem::temp_directory_path() / formatted("whit-verify-%d.exr", int{getpid()});
  for (const float bad : {kNan, kInf, -kInf, -1.0f}) {
    SceneBuilder builder;
    builder.add(floorAt(0, 1), mirrorMaterial(1));

    Image image(4, 4);
    image.pixels.assign(16, Rgb(1.0f));
    image.pixels[5] = Rgb(bad);
    writeExr(file, image, {});

    Warnings warnings;
    builder.description.sky.kind = Sky::Kind::image;
    builder.description.sky.image = makeEnvironment(readRawImage(file, ImageLimits(), warnings));
    std::filesystem::remove(file);
    const Scene scene = repaired(builder.describe());
    run.count(warnings.entries().empty(), "not counted: ", bad);

    const Camera camera{.eye = {0, 1, 3}, .fov = 120};
    for (const Rgb& pixel : pictureOf(scene, camera, optionsOf(run, {33, 21})).pixels) {
      run.count(!isFinite(pixel) || pixel.x < 0 || (bad != kInf && pixel.x > 1.00001f), "texel ",
                bad);
    }
  }
}

// Min and Max treat a NaN differently on different CPUs; the codes must be the same.
void oddRadiance(Run& run) {
  const std::pair<float, std::uint32_t> cases[] = {{kNan, 0},   {-kNan, 0},  {kInf, 255},
                                                   {-kInf, 0},  {-1.0f, 0},  {-0.0f, 0},
                                                   {1e-40f, 0}, {3e38f, 255}};

  for (const ToneCurve curve : {ToneCurve::none, ToneCurve::filmic, ToneCurve::reinhard}) {
    ColumnStore<RadianceColumns> radiance(64, FeatureSet());
    for (const auto i : indices(64)) {
      radiance->rgb.set(i, Rgb(cases[i % 8].first));
    }
    std::array<std::uint32_t, 96> codes{};
    simd::encodeDisplay({.curve = curve, .radiance = *radiance, .n = 64, .codes = codes.data()});

    for (const auto i : indices(64)) {
      const auto& [value, code] = cases[i % 8];
      const std::uint32_t got = codes[i] & 255u;
      // The end values of tone curves differ; the test only compares which end is reached.
      const bool right = curve == ToneCurve::none || code == 0 ? got == code : got > 250;
      run.count(!right, "radiance ", value);
    }
  }
}

}  // namespace

const Family kRangeCases{
    "vectors and ranges",
    {{"H51", "normals have unit length for corners from 1e-14 to 3e17",
      "4000 triangles of all shapes", unitNormals, Runs::targets},
     {"H52", "directions keep their length over 64 reflections", "box of mirrors, 64 rays",
      lengthAfter64Reflections},
     {"H55", "light of 1e-39", "against the picture for light 1, scaled; absolute error",
      denormalLight},
     {"H56", "light of 1e-30 to 1e30",
      "against the picture for light 1; ulps, none allowed for powers of two", extremeIntensities},
     {"H57", "sky texels that are not numbers", "NaN, infinities, -1 among 16 texels",
      badSkyTexels},
     {"H58", "codes of radiance that is not a number", "NaN, infinities, negative; all tone curves",
      oddRadiance, Runs::targets}}};

}  // namespace whit::verify
