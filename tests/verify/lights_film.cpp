// H65 to H76: lights at no distance, texture coordinates, film, camera.

#include "core/image.h"
#include "reference/generate_rays.h"
#include "simd/kernels.h"
#include "verify/bodies.h"

namespace whit::verify {

namespace {

// Lights on the surface and up to 1e-5 above it, over a point that a ray hits exactly.
void lightsAtNoDistance(Run& run) {
  for (const float height : {0.0f, 1e-42f, 1e-30f, 1e-20f, 1e-10f, 1e-5f}) {
    SceneBuilder builder;
    Material m = diffuseMaterial(1);
    m.specular = Rgb(0.5f);
    builder.add(floorAt(0, 1), m);

    builder.description.lights = {lightAt({0, height, 0}, 1)};
    builder.description.lights[0].radius = 1e-3f;

    // The center of the middle pixel shows the point below the light.
    // I / radius^2 (kd / pi + the lobe's peak at normal incidence, 0.5 / (4 pi alpha^2) with
    // roughness 0.5) is an upper bound on the reflected light.
    const float most = 1e6f * (0.32f + 0.5f / (12.5f * 0.0625f));
    for (const Rgb& pixel :
         pictureOf(builder.build(), lookingDown(), optionsOf(run, {33, 33})).pixels) {
      run.count(!isFinite(pixel) || pixel.x < 0 || pixel.x > most, "height ", height);
    }
  }
}

void lightInABox(Run& run) {
  SceneBuilder builder;
  const auto gray = builder.add(diffuseMaterial(1));
  builder.add(box({-1, 0, -1}, {1, 2, 1}, gray));
  builder.add(floorAt(-0.5f, 8, gray));
  builder.description.lights = {lightAt({0.3f, 1.2f, -0.2f}, 100),
                                lightAt({0.999f, 0.001f, 0}, 100)};

  const Camera camera{.eye = {3, 4, 5}, .at = {0, 1, 0}};
  for (const Rgb& pixel : pictureOf(builder.build(), camera, optionsOf(run, {48, 36})).pixels) {
    run.count(!(pixel == Rgb()), pixel);
  }
}

// Coordinates that are too large for fractions of a texel, or not numbers, count as 0.
float tame(float s) { return std::fabs(s) <= 0x1p20f ? s : 0.0f; }

// Looks up coordinates through the kernel in a row of texels that are black and white in turn. The
// coordinates in both halves of `uvs` must have the same colors.
void textureAt(Run& run, const std::vector<Vec2f>& uvs, Wrap wrap, int width) {
  SceneBuilder builder;

  std::vector<std::uint32_t> texels;
  for (int i = 0; i < width; ++i) texels.push_back(i % 2 ? 0x3fffffffu : 0u);

  Texture texture = makeTexture(TexelFormat::color, width, 1, texels);
  texture.wrapU = texture.wrapV = wrap;
  Material m = diffuseMaterial(1);
  m.diffuseMap = builder.add(texture);
  builder.add(m);

  Mesh mesh;
  mesh.materials = {0};
  for (const Vec2f& uv : uvs) {
    const float z = float(mesh.triangles.size());  // coincident triangles would be merged
    addTriangle(mesh, {{0, 0, z}, {1, 0, z}, {0, 1, z}});
    mesh.uvs.insert(mesh.uvs.end(), 3, uv);
  }
  builder.add(mesh);

  const Scene scene = repaired(builder.describe());
  Probe probe(scene, run);
  probe.hitEach(size32(uvs));

  for (const auto i : indices(uvs)) {
    const float got = probe.surfels().diffuse.x[i];
    const std::size_t half = uvs.size() / 2;
    const float wanted = probe.surfels().diffuse.x[i < half ? i + half : i];
    run.count(!(got >= 0 && got <= 1 && got == wanted), "uv ", uvs[i].x, " ", uvs[i].y);
  }
}

void oddTextureCoordinates(Run& run) {
  std::vector<Vec2f> uvs;
  for (const float x : {0.0f, -0.0f, -1e-9f, -1e-30f, 1e-40f, 1 - 0x1p-24f, 1.0f, 1 + 0x1p-23f,
                        1e3f, 1e6f, 8.4e6f, 2e9f, 5e9f, 1e30f, -1e30f, 3e38f, kInf, -kInf, kNan}) {
    uvs.push_back({x, 0.5f});
    uvs.push_back({0.3f, x});
    uvs.push_back({x, x});
  }

  // The second half holds the tame coordinates, whose colors the first half must have.
  const std::size_t count = uvs.size();
  for (const auto i : indices(count)) uvs.push_back({tame(uvs[i].x), tame(uvs[i].y)});

  for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
    for (const int width : {1, 2, 3, 5, 64}) {
      textureAt(run, uvs, wrap, width);
    }
  }
}

// Compares codes with the formula in double; the error is the distance beyond rounding, in codes.
void srgbCodes(Run& run) {
  run.boundBy(0.01);
  Numbers numbers(72);
  constexpr std::size_t kValues = 1 << 16;
  ColumnStore<RadianceColumns> radiance(kValues, FeatureSet());
  for (const auto i : indices(kValues)) {
    const double x = i % 2 ? numbers.in(0, 1) : std::pow(10, numbers.in(-6, 0));
    radiance->rgb.set(i, Rgb(float(x)));
  }

  std::vector<std::uint32_t> codes(kValues + 16);
  simd::encodeDisplay({.radiance = *radiance, .n = kValues, .codes = codes.data()});

  for (const auto i : indices(kValues)) {
    const double x = radiance->rgb.x[i];
    const double exact = 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
    const double off = std::fabs(exact - (codes[i] & 255u));
    run.note(std::max(0.0, off - 0.5), x);
  }
}

// Compares directions of the kernel with double, from the narrowest to the widest view, and far
// away.
void cameraDirections(Run& run) {
  run.boundBy(4 * 0x1p-24);
  std::vector<std::uint32_t> pixels;
  forEachPixel(32, 32, [&](int x, int y) { pixels.push_back(packedPixel(x * 31, y * 17)); });

  for (const float fov : {1e-3f, 1.0f, 45.0f, 120.0f, 179.9f}) {
    for (const Vec3f& eye : {Vec3f{0, 0, 5}, {1e6f, -2e6f, 5e5f}}) {
      const Camera camera{.eye = eye, .at = eye + Vec3f{1, 0.25f, -1}, .fov = fov};
      const CameraFrame frame = makeCameraFrame(camera, 1024, 576);
      const ColumnStore<RayColumns> columns = raysThrough(pixels, frame);

      for (const auto i : indices(pixels)) {
        const double x = pixelX(pixels[i]) + 0.5, y = pixelY(pixels[i]) + 0.5;
        const Vec3d exact = reference::generateRay(frame, x, y).direction;
        const Vec3d got(columns->dir.at(i));
        run.note(length(got - exact), "fov ", fov, ", pixel ", pixels[i]);
      }
    }
  }
}

void equalSamples(Run& run) {
  SceneBuilder builder;
  builder.description.sky.kind = Sky::Kind::color;
  builder.description.sky.zenith = {0.1f, 1.0f / 3, 7e-5f};
  builder.add(floorAt(-100, 1), diffuseMaterial(1));
  const Scene scene = builder.build();

  const Camera up{.eye = {0, 0, 0}, .at = {0, 1, 0}};
  for (const int spp : {1, 2, 3, 5, 16, 1000}) {
    RenderOptions options = optionsOf(run, {3, 2});
    options.spp = spp;
    for (const Rgb& pixel : pictureOf(scene, up, options).pixels) {
      run.count(!(pixel == scene.sky.zenith), spp, " samples");
    }
  }
}

}  // namespace

const Family kLightAndFilmCases{
    "lights, textures, film, camera",
    {{"H65", "lights at no distance", "on the floor and up to 1e-5 above it; finite and bounded",
      lightsAtNoDistance},
     {"H66", "a light in a closed box lights nothing outside", "box above a floor; lit pixels",
      lightInABox},
     {"H68", "texture coordinates that are far away, tiny, or not numbers",
      "19 values, every wrap mode, textures 1 to 64 wide; colors outside [0, 1] or untamed",
      oddTextureCoordinates, Runs::targets},
     {"H72", "sRGB codes", "65536 values; codes beyond half a code from the formula in double",
      srgbCodes, Runs::targets},
     {"H75", "directions from the camera",
      "fov 0.001 to 179.9 degrees, at 2e6 too; length of error", cameraDirections, Runs::targets},
     {"H76", "the mean of equal samples is the sample", "1 to 1000 samples of a plain sky",
      equalSamples, Runs::targets}}};

}  // namespace whit::verify
