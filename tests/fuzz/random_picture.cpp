#include "fuzz/random_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <type_traits>

#include "bake/scene.h"
#include "core/error.h"
#include "core/option_table.h"
#include "inspect/reference_frame.h"
#include "make/studio_sky.h"
#include "render/renderer.h"
#include "scene/members.h"

namespace whit::fuzz {

namespace {

constexpr int kLargestSide = 33;

Vec3f pointIn(Draws& draws, double size) {
  const auto coordinate = [&] { return float(draws.uniform(-size, size)); };
  return Vec3f{coordinate(), coordinate(), coordinate()};
}

Affine placement(Draws& draws) {
  const Vec3d axis(pointIn(draws, 1));
  const Affine turned =
      draws.chance(0.5) ? Affine::rotation(axis, draws.uniform(0, 360)) : Affine();
  const auto scale = [&] { return std::exp2(draws.uniform(-4, 2)) * (draws.chance(0.1) ? -1 : 1); };
  const double x = scale(), y = scale();
  return Affine::translation(Vec3d(pointIn(draws, 2))) * turned *
         Affine::scaling(draws.chance(0.5) ? Vec3d(x) : Vec3d(x, y, scale()));
}

// A normal that need not have to do with its surface, of any length, often of none.
Vec3f anyNormal(Draws& draws) {
  constexpr double kLengths[] = {1, 1, 1e-20, 0, 3e-16, 1e10};
  const double length = kLengths[draws.below(std::size(kLengths))];
  Vec3f normal = pointIn(draws, 1) * float(length);
  if (draws.chance(0.2)) normal.x = 0;
  if (draws.chance(0.2)) normal.y = normal.z = 0;
  return normal;
}

Vec2f anyUv(Draws& draws) {
  constexpr double kSizes[] = {1, 1, 0, 1e-20, 1e4, 1e30};
  const double size = kSizes[draws.below(std::size(kSizes))];
  return {float(draws.uniform(-size, size)), float(draws.uniform(-size, size))};
}

Rgb anyColor(Draws& draws, double low, double high) {
  const auto channel = [&] { return float(draws.number(low, high)); };
  const float r = channel();
  if (draws.chance(0.5)) return Rgb(r);
  return Rgb{r, channel(), channel()};
}

Texture anyTexture(Draws& draws, TexelFormat format) {
  Texture texture;
  texture.format = format;
  texture.width = 1 + int(draws.below(9));
  texture.height = 1 + int(draws.below(9));
  texture.wrapU = static_cast<Wrap>(draws.below(3));
  texture.wrapV = static_cast<Wrap>(draws.below(3));

  for (int i = 0; i < texture.width * texture.height; ++i) {
    const Rgb color = anyColor(draws, 0, 1);
    const float alpha = draws.chance(0.3) ? 0.0f : 1.0f;
    std::uint32_t texel = encodeRadianceTexel(color * 100.0f);
    if (format == TexelFormat::data) texel = encodeDataTexel(color.x, color.y, color.z, alpha);
    if (format == TexelFormat::color) texel = encodeColorTexel(color);
    texture.texels.push_back(texel);
  }
  return texture;
}

// A texture that a map of this use may name, or none.
std::int32_t anyMap(Draws& draws, TextureUse use, std::vector<Texture>& textures) {
  if (!draws.chance(0.15)) return kNoTexture;
  const bool bright = use == TextureUse::emission && draws.chance(0.5);
  textures.push_back(anyTexture(draws, bright ? TexelFormat::radiance : formatOf(use)));
  return int(textures.size() - 1);
}

// Draws as many numbers as the member of a camera may have.
std::vector<float> anyNumbers(Draws& draws, const Camera& camera, std::vector<float> Camera::*field,
                              double low, double high) {
  const bool table = field == &Camera::azimuths || field == &Camera::elevations;
  if (!table && draws.chance(0.7)) return {};

  std::size_t count = 1 + draws.below(5);
  // Some members have a fixed number of values.
  if (field == &Camera::k) count = 4 + draws.below(2);
  if (field == &Camera::kSize) count = 2;
  if (field == &Camera::distortion) count = isFisheye(camera) ? 4 : 5;
  const double size = field == &Camera::distortion ? 0.3 : 40;

  std::vector<float> numbers;
  while (numbers.size() < count) {
    numbers.push_back(float(draws.uniform(std::max(low, field == &Camera::distortion ? -size : 1),
                                          std::min(high, size))));
  }
  return numbers;
}

// Draws a value for every member of the table, and leaves some as they are.
template <typename Noun>
void drawMembers(Draws& draws, double changed, SceneDescription& scene, Noun& noun) {
  forEachMember<Noun>([&](const auto& member) {
    using Value = typename std::remove_cvref_t<decltype(member)>::Type;
    const auto& rules = member.rules;
    if ((rules.exists && !rules.exists(noun)) || !draws.chance(changed)) return;
    Value& value = noun.*member.field;

    const double low = rules.low, high = rules.high;
    // How a value is drawn depends on its type, and for vectors and numbers on the rules as well.
    if constexpr (std::is_same_v<Value, bool>) {
      value = draws.chance(0.5);
    } else if constexpr (std::is_same_v<Value, std::vector<float>>) {
      value = anyNumbers(draws, noun, member.field, low, high);
    } else if constexpr (std::is_same_v<Value, Vec3f>) {  // a color is the same type
      const bool color = rules.kind == kColorMember;
      value = color ? anyColor(draws, 0, std::min(high, rules.usual)) : pointIn(draws, 4);
    } else if constexpr (std::is_enum_v<Value>) {
      constexpr std::size_t kCount = std::max<std::size_t>(kWords<Value>.size(), 3);
      value = static_cast<Value>(draws.below(kCount));
    } else if constexpr (std::is_arithmetic_v<Value>) {
      const bool map = rules.kind == MemberKind::map;
      value = map ? static_cast<Value>(anyMap(draws, rules.use, scene.textures))
                  : static_cast<Value>(draws.number(low, high));
    }
  });
}

Mesh anyMesh(Draws& draws, std::size_t materials) {
  Mesh mesh;
  const double size = std::exp2(draws.uniform(-2, 4));
  const std::size_t corners = 3 + draws.below(12);
  const bool flat = draws.chance(0.2);

  for (std::size_t i = 0; i < corners; ++i) {
    mesh.positions.push_back(pointIn(draws, size));
    if (flat) mesh.positions.back().y = 0;
  }

  const auto forEachCorner = [&](double probability, auto&& add) {
    for (std::size_t i = 0, all = draws.chance(probability) ? corners : 0; i < all; ++i) add();
  };
  forEachCorner(0.7, [&] { mesh.normals.push_back(anyNormal(draws)); });
  forEachCorner(0.7, [&] { mesh.uvs.push_back(anyUv(draws)); });
  forEachCorner(0.3, [&] { mesh.secondUvs.push_back(anyUv(draws)); });
  forEachCorner(0.3, [&] { mesh.colors.push_back(anyColor(draws, 0, 1)); });

  // Triangles may repeat corners and have no area.
  const auto corner = [&] { return std::uint32_t(draws.below(corners)); };
  for (std::size_t i = 1 + draws.below(16); i > 0; --i) {
    mesh.triangles.push_back({corner(), corner(), corner()});
    mesh.materials.push_back(std::uint32_t(draws.below(materials)));
  }
  if (draws.chance(0.2)) mesh.spheres.push_back(placement(draws));
  return mesh;
}

Sky anySky(Draws& draws, SceneDescription& scene) {
  Sky sky;
  sky.kind = static_cast<Sky::Kind>(draws.below(4));
  if (sky.kind == Sky::Kind::image && draws.chance(0.5)) {
    sky = studioSky();
  } else if (sky.kind == Sky::Kind::image) {
    EnvironmentImage& image = sky.image;
    image.width = 1 + int(draws.below(9));
    image.height = 1 + int(draws.below(9));
    for (int i = 0; i < image.width * image.height; ++i) {
      const Rgb color = anyColor(draws, 0, 100);
      image.r.push_back(color.x);
      image.g.push_back(color.y);
      image.b.push_back(color.z);
    }
  }

  drawMembers(draws, 0.5, scene, sky);
  sky.scale = std::min(sky.scale, 1e3f);
  return sky;
}

SceneDescription anyScene(Draws& draws) {
  SceneDescription scene;
  scene.name = "random";

  for (std::size_t i = 1 + draws.below(4); i > 0; --i) {
    // The material is a local value, because the description's vectors grow while it is drawn.
    Material material;
    drawMembers(draws, draws.chance(0.5) ? 0.15 : 0.6, scene, material);
    scene.materials.push_back(material);
  }

  for (std::size_t i = draws.below(4); i > 0; --i) {
    Light light;
    light.position = pointIn(draws, 4);
    drawMembers(draws, 0.5, scene, light);
    light.innerConeAngle = std::min(light.innerConeAngle, 0.9f * light.outerConeAngle);
    scene.lights.push_back(light);
  }

  scene.sky = anySky(draws, scene);
  drawMembers(draws, 0.5, scene, scene.ambient);

  for (std::size_t objects = 1 + draws.below(3); objects > 0; --objects) {
    const std::uint32_t object = size32(scene.objects);
    scene.objects.push_back({"object", {anyMesh(draws, scene.materials.size())}});
    for (std::size_t i = draws.chance(0.6) ? 1 : 2; i > 0; --i) {
      scene.instances.push_back({object, draws.chance(0.6) ? Affine() : placement(draws)});
    }
  }

  Camera camera;
  camera.eye = pointIn(draws, 4);
  camera.at = pointIn(draws, 1);
  camera.projection = static_cast<Projection>(draws.below(kWords<Projection>.size()));
  if (isTable(camera)) {
    camera.azimuths = {-30, 30};
    camera.elevations = {20, -20};
  }
  // The projection was drawn already, and other members depend on it.
  const Projection kept = camera.projection;
  drawMembers(draws, 0.2, scene, camera);
  camera.projection = kept;
  camera.eyeDistance = std::min(camera.eyeDistance, 1.0f);

  // Some members depend on each other.
  if (camera.projection == Projection::fisheye && camera.k.empty()) camera.k = {30, 30, 16, 12};
  if (!camera.k.empty()) {
    camera.k[0] = camera.k[1] = 30;
    camera.kSize = {33, 24};
  }
  if (!camera.k.empty() || !camera.distortion.empty()) camera.orthographicHeight = 0;
  scene.cameras.push_back(camera);
  return scene;
}

// Options that this file chooses by itself, or that need another program to do their work.
bool isLeftAlone(std::string_view name) {
  constexpr std::string_view kNames[] = {"quality", "size",    "camera",          "eye",  "at",
                                         "up",      "fov",     "ortho",           "crop", "threads",
                                         "simd",    "strict",  "sphere-segments", "mode", "packet",
                                         "disable", "channels"};
  return contains(kNames, name);
}

RenderOptions anyOptions(Draws& draws) {
  RenderOptions options;
  const auto side = [&] { return 1 + int(draws.below(kLargestSide)); };
  options.size = ImageSize{side(), side()};
  options.threads = 1;

  const double changed = draws.chance(0.3) ? 0 : 0.25;
  forEachOption(options, [&](const OptionSpec& spec, auto& value) {
    if (isLeftAlone(spec.name) || !draws.chance(changed)) return;
    using Value = std::remove_cvref_t<decltype(value)>;
    const std::vector<std::string> words = choicesOf(spec);
    if constexpr (std::is_same_v<Value, bool>) {
      value = draws.chance(0.5);
    } else if constexpr (std::is_integral_v<Value>) {
      const double most = std::min(spec.high, spec.low + 4);
      value = static_cast<Value>(draws.uniform(spec.low, most + 1));
    } else if constexpr (std::is_floating_point_v<Value>) {
      value = static_cast<Value>(draws.number(spec.low, spec.high));
    } else if (!words.empty()) {
      // Choices in capitals stand for values of another kind.
      const std::string& word = words[draws.below(words.size())];
      if (word.find_first_of("ACEV") == std::string::npos) parseValue(spec, word, value);
    }
  });

  // Without a bound some pictures would never end.
  if (options.maxRays == 0) options.maxRays = 1000;
  const std::vector<std::string> packets = {"auto", "1", "4", "8", "16"};
  setOption(options, "packet", packets[draws.below(packets.size())]);
  if (draws.chance(0.1)) options.mode = Mode::reference;
  if (draws.chance(0.1))
    options.channels = parseChannels("depth,normal,albedo,uv,rays,alpha,error");
  if (draws.chance(0.2))
    options.disable = EffectSet::all().without(static_cast<Effect>(draws.below(kEffectCount)));
  return options;
}

bool mayRefuse(ExitStatus status) {
  return status == ExitStatus::usage || status == ExitStatus::badScene ||
         status == ExitStatus::limit;
}

}  // namespace

Draws::Draws(std::span<const std::uint8_t> bytes) : left_(bytes) {
  std::seed_seq seed(bytes.begin(), bytes.end());
  random_.seed(seed);
}

std::uint32_t Draws::next() {
  if (left_.size() <= 4) return std::uint32_t(random_());
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | left_[i];
  left_ = left_.subspan(4);
  return value;
}

double Draws::number(double low, double high) {
  const std::size_t kind = below(8);
  if (kind == 0) return low;
  if (kind == 1) return high;
  if (kind == 2) return std::clamp(0.0, low, high);
  if (kind == 3) return std::clamp(1.0, low, high);
  if (kind == 4) return std::clamp(std::exp2(uniform(-60, 60)), low, high);
  return uniform(std::max(low, -10.0), std::min(high, std::max(low, -10.0) + 20));
}

RandomPicture drawPicture(Draws& draws) { return {anyScene(draws), anyOptions(draws)}; }

std::array<std::uint8_t, 4> bytesOfPicture(std::uint32_t number) {
  const auto byte = [&](int i) { return std::uint8_t(number >> (24 - 8 * i)); };
  return {byte(0), byte(1), byte(2), byte(3)};
}

bool renderPicture(std::span<const std::uint8_t> bytes, const std::string& simd,
                   FrameStats* stats) {
  Draws draws(bytes);
  RandomPicture picture = drawPicture(draws);
  picture.options.simd = simd;
  try {
    Warnings warnings;
    const Scene scene = Scene::finalize(std::move(picture.scene), warnings);
    Renderer renderer(scene, picture.options);
    Film film = makeFilm(scene, picture.options);
    const FrameStats frame =
        renderFrame(renderer, picture.options.mode, chooseCamera(scene, picture.options), film);
    if (stats) *stats = frame;
  } catch (const Error& error) {
    if (!mayRefuse(error.status())) throw;
    return false;
  }
  return true;
}

}  // namespace whit::fuzz
