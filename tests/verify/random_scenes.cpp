// H29: random scenes with hostile numbers.
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "sanitized.h"
#include "verify/bodies.h"

namespace whit::verify {

namespace {

// A scene file may hold every number that is used here (io/json_reader.h): finite, up to 1e18.
// Random numbers stand in braces, not in parentheses, because every compiler evaluates
// the elements of braces in order.
class RandomScene {
 public:
  explicit RandomScene(std::uint64_t seed) : numbers_(seed) {}

  SceneDescription make() {
    SceneDescription& d = builder_.description;
    for (int i = below(3); i > 0; --i) addTextures();
    for (int i = 1 + below(4); i > 0; --i) builder_.add(material());
    for (int i = 1 + below(4); i > 0; --i) addObject();
    for (int i = below(4); i > 0; --i) d.lights.push_back(light());
    d.sky = sky();
    if (one(3)) d.ambient = {color(amount()), color(amount())};
    d.cameras = {camera()};
    return builder_.describe();
  }

 private:
  int below(int limit) { return int(numbers_.in(0, limit)); }
  bool one(int of) { return below(of) == 0; }
  // A size of about 1 mostly, and sometimes any size from tiny to huge.
  double size() {
    if (!one(4)) return numbers_.in(0.1, 3);
    return std::pow(10.0, one(4) ? numbers_.in(-18, 17) : numbers_.in(-5, 5));
  }
  Vec3d place() {
    Vec3d near = numbers_.direction();
    near *= numbers_.in(0, 4);
    return one(8) ? near * size() : near;
  }
  // An amount of light: none, an ordinary one, or any.
  float amount() {
    if (one(4)) return 0;
    const double exponent = one(4) ? numbers_.in(-18, 18) : numbers_.in(-2, 3);
    return float(std::pow(10.0, exponent));
  }
  // One of the first three enumerators.
  template <typename Enum>
  Enum any() {
    return Enum(below(3));
  }
  float unit() { return float(one(3) ? below(2) : numbers_.in(0, 1)); }
  Rgb color(float largest = 1) { return Rgb{unit(), unit(), unit()} * largest; }
  std::uint32_t bits() { return std::uint32_t(numbers_.in(0, 4294967296.0)); }

  void addTextures() {
    for (const TexelFormat format : {TexelFormat::color, TexelFormat::data}) {
      const int width = 1 + below(9), height = 1 + below(9);
      std::vector<std::uint32_t> texels(width * height);
      for (std::uint32_t& texel : texels) texel = bits();
      Texture texture = makeTexture(format, width, height, std::move(texels));
      texture.wrapU = any<Wrap>();
      texture.wrapV = any<Wrap>();
      builder_.add(std::move(texture));
    }
  }
  // Textures come in pairs, the colors first.
  std::int32_t map(TexelFormat format) {
    const int pairs = int(builder_.description.textures.size()) / 2;
    if (pairs == 0 || one(2)) return kNoTexture;
    return 2 * below(pairs) + (format == TexelFormat::data ? 1 : 0);
  }

  Material material() {
    Material m;
    m.diffuse = color();
    m.diffuseMap = map(TexelFormat::color);
    m.normalMap = map(TexelFormat::data);
    if (one(2)) {
      m.specular = color();
      m.specularMap = map(TexelFormat::color);
    }
    m.roughness = unit();

    if (one(4)) {
      m.emission = color(amount());
      m.emissionMap = map(TexelFormat::color);
    }
    m.vertexTint = any<VertexTint>();
    if (one(4)) {
      m.alphaMap = map(TexelFormat::data);
      m.alphaCutoff = unit();
    }
    if (one(6)) {
      m.coverage = unit();
      m.coverageMap = map(TexelFormat::data);
    }

    if (one(3)) {
      m.mirror = color();
      m.mirrorGrazing = color();
    }
    if (one(2)) {
      m.transmission = color();
      m.ior = one(4) ? 1.0f : float(std::pow(10.0, numbers_.in(-1, 1)));
      if (one(2)) m.absorption = color(amount());
      m.priority = below(5) - 2;
      m.thin = one(4);
    }

    m.castsShadow = !one(4);
    return m;
  }

  Mesh mesh() {
    const auto m = std::uint32_t(below(int(builder_.description.materials.size())));
    const int kind = below(5), level = below(3);
    const Vec3d where = place(), sizes{size(), size(), size()};

    switch (kind) {
      case 0:
        return floorAt(float(where.y), float(sizes.x), m);
      case 1:
        return box(Vec3f(-1), Vec3f(sizes), m);
      case 2:
        return sphereMesh(level, where, sizes.x, m, one(2));
      case 3:
        return unshared(sphereMesh(level, {}, 1, m));
      default:
        return soup(m);
    }
  }
  // Triangles of any corners, normals and coordinates, some of them random bits.
  Mesh soup(std::uint32_t material) {
    Mesh mesh;
    mesh.materials = {material};
    const auto number = [&] { return std::bit_cast<float>(bits()); };
    for (int i = 0; i < 30; ++i) {
      mesh.positions.push_back(one(9) ? Vec3f{number(), number(), number()} : Vec3f(place()));
      mesh.normals.push_back(one(3) ? Vec3f{number(), number(), number()}
                                    : Vec3f(numbers_.direction()));
      mesh.uvs.push_back(one(3) ? Vec2f{number(), number()} : Vec2f{unit(), unit()});
      mesh.colors.push_back(one(3) ? Rgb{number(), number(), number()} : color());
    }

    for (int i = 0; i < 40; ++i) {
      const auto index = [&] { return std::uint32_t(below(31)); };
      mesh.triangles.push_back({index(), index(), index()});
    }
    return mesh;
  }

  Affine transform() {
    const Vec3d sizes{size(), -size(), size()}, axis = numbers_.direction();
    const Affine turned = Affine::rotation(axis, numbers_.in(0, 360));
    const Affine scaled = Affine::scaling(one(2) ? Vec3d(sizes.x) : sizes);
    return Affine::translation(place()) * turned * scaled;
  }
  void addObject() {
    std::vector<Affine> placements;
    for (int i = 1 + below(3); i > 0; --i) placements.push_back(one(3) ? Affine() : transform());
    std::vector<Mesh> meshes{mesh()};
    if (one(3)) meshes.push_back(mesh());
    builder_.place({"", std::move(meshes)}, placements);
  }

  Light light() {
    Light light;
    light.position = Vec3f(place());
    light.intensity = color(amount());
    light.radius = float(std::max(1e-6, 0.01 * size()));

    light.kind = any<Light::Kind>();
    light.direction = Vec3f(numbers_.direction());
    light.outerConeAngle = float(numbers_.in(0.5, 90));
    light.innerConeAngle = 0.99f * light.outerConeAngle * unit();
    return light;
  }
  Sky sky() {
    Sky sky;
    sky.kind = any<Sky::Kind>();
    for (Rgb* part : {&sky.zenith, &sky.horizon, &sky.ground}) *part = color(amount());
    sky.scale = unit();
    return sky;
  }
  // A camera anywhere, also inside objects.
  Camera camera() {
    Camera camera;
    camera.eye = Vec3f(place());
    camera.at = one(8) ? camera.eye : Vec3f(place());
    camera.up = one(8) ? camera.at - camera.eye : Vec3f(numbers_.direction());
    if (one(4)) camera.orthographicHeight = float(size());
    camera.fov = one(4) ? float(numbers_.in(0.01, 179)) : 60;
    return camera;
  }

  Numbers numbers_;
  SceneBuilder builder_;
};

// Returns nothing for a scene that is refused, for example because a transform is singular.
std::optional<Scene> finalized(std::uint64_t seed) {
  Warnings warnings;
  try {
    return Scene::finalize(RandomScene(seed).make(), warnings);
  } catch (const Error& error) {
    if (error.status() == ExitStatus::badScene) return std::nullopt;
    throw;
  }
}

// Renders in both modes. The pictures need not agree, because rays hit many borders.
void randomScenes(Run& run) {
  // Sanitizers also watch RandomPictures.*, which are as hostile.
  constexpr std::uint64_t kScenes = kSanitized ? 100 : 250;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
    const std::optional<Scene> scene = finalized(seed);
    if (!scene) continue;

    RenderOptions options = optionsOf(run, {8, 6});
    options.depth = 5;
    if (seed % 2 == 0) options.shading.textureFilter = TextureFilter::trilinear;
    const auto [packets, reference] = picturesOf(*scene, scene->cameras[0], options);
    for (const Image* image : {&packets, &reference}) {
      const char* const mode = image == &packets ? "packets" : "reference";
      for (const Rgb& pixel : image->pixels) {
        run.count(!isFinite(pixel) || std::min({pixel.x, pixel.y, pixel.z}) < 0, "seed ", seed,
                  ", ", mode, ": ", pixel);
      }
    }
  }
}

}  // namespace

const Family kRandomSceneCases{
    "random scenes",
    {{"H29a", "random scenes have finite pixels",
      "250 scenes of hostile numbers, packets and reference; pixels that are not finite",
      randomScenes, Runs::once}}};

}  // namespace whit::verify
