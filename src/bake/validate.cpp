#include <cmath>
#include <limits>

#include "bake/finalize_steps.h"
#include "core/formatted.h"
#include "core/options.h"
#include "scene/members.h"

namespace whit {

namespace {

// Kernels address all texels of a scene with a signed 32-bit index.
constexpr std::uint64_t kTexelLimit = std::numeric_limits<std::int32_t>::max();

std::string place(const std::string& scene, const std::string& kind, std::size_t i,
                  const std::string& name) {
  const std::string thing = kind + (name.empty() ? " " + std::to_string(i) : " '" + name + "'");
  return scene.empty() ? thing : scene + ": " + thing;
}

bool isRadiance(const Rgb& c) { return isFinite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0; }

void checkSize(const SceneDescription& d) {
  const auto fits = [](int side) { return side >= 1 && side <= kImageSideLimit; };
  if (fits(d.width) && fits(d.height)) return;
  throwBadScene(d.name.empty() ? "image size" : d.name + ": image size",
                "expected 1 to " + std::to_string(kImageSideLimit) + " pixels a side");
}

template <typename Noun>
void checkMembers(const Noun& noun, const std::string& where) {
  forEachMember<Noun>([&](const auto& member) {
    const auto& value = noun.*member.field;
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, Vec3f>) {
      if (!isFinite(value)) throwBadScene(where, std::string("expected a finite ") + member.name);
      if (member.rules.kind == MemberKind::color && !isRadiance(value)) {
        throwBadScene(where, std::string("expected channels of 0 or more in ") + member.name);
      }
    } else if constexpr (!std::is_enum_v<Value>) {
      const double low = member.rules.low, high = member.rules.high;
      if (value >= low && value <= high) return;
      throwBadScene(where, formatted("expected %s to be from %g to %g", member.name, low, high));
    }
  });
}

void checkCameras(const SceneDescription& d) {
  for (std::size_t i = 0; i < d.cameras.size(); ++i) {
    checkMembers(d.cameras[i], place(d.name, "camera", i, d.cameras[i].name));
  }
  for (std::size_t i = 0; i < d.cameraPath.size(); ++i) {
    const std::string where = place(d.name, "keyframe", i, "");
    checkMembers(d.cameraPath[i].camera, where);
    const float time = d.cameraPath[i].time;
    if (!std::isfinite(time)) throwBadScene(where, "expected a finite time");
    if (i > 0 && !(time > d.cameraPath[i - 1].time)) {
      throwBadScene(where, "expected a time after that of the keyframe before");
    }
  }
}

void checkLights(const SceneDescription& d) {
  for (std::size_t i = 0; i < d.lights.size(); ++i) {
    const Light& light = d.lights[i];
    const std::string where = place(d.name, "light", i, light.name);
    checkMembers(light, where);
    if (hasDirection(light) && !(maxComponent(abs(light.direction)) > 0)) {
      throwBadScene(where, "expected a direction that is not 0");
    }
    if (hasCone(light) && !(light.innerConeAngle < light.outerConeAngle)) {
      throwBadScene(where, "expected cone angles with inner < outer");
    }
  }
}

void checkEnvironment(EnvironmentImage& image, const std::string& where, Warnings& warnings) {
  const std::uint64_t texels =
      image.width > 0 && image.height > 0
          ? static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height)
          : 0;
  if (texels == 0 || image.r.size() != texels || image.g.size() != texels ||
      image.b.size() != texels) {
    throwBadScene(where, "expected width * height texels in each of three planes");
  }
  if (texels > kTexelLimit) throwLimit(where + ": more than 2^31 - 1 texels");
  std::uint64_t repaired = 0;
  for (auto* plane : {&image.r, &image.g, &image.b}) {
    for (float& x : *plane) {
      if (x >= 0 && std::isfinite(x)) continue;
      x = 0;
      ++repaired;
    }
  }
  warnings.add("negative or non-finite sky texel set to 0", where, repaired);
}

void checkSky(SceneDescription& d, Warnings& warnings) {
  const std::string prefix = d.name.empty() ? "" : d.name + ": ";
  Sky& sky = d.sky;
  checkMembers(sky, prefix + "sky");
  if (sky.kind == Sky::Kind::image) checkEnvironment(sky.image, prefix + "sky image", warnings);
  checkMembers(d.ambient, prefix + "ambient");
}

void checkTextures(const SceneDescription& d) {
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < d.textures.size(); ++i) {
    const Texture& t = d.textures[i];
    if (t.width < 1 || t.height < 1 ||
        t.texels.size() !=
            static_cast<std::uint64_t>(t.width) * static_cast<std::uint64_t>(t.height)) {
      throwBadScene(place(d.name, "texture", i, t.name), "expected width * height texels");
    }
    total += t.texels.size();
  }
  if (total > kTexelLimit) throwLimit(d.name + ": more than 2^31 - 1 texels in all textures");
}

void checkMap(const SceneDescription& d, const std::string& where, const char* name,
              std::int32_t index, TextureUse use) {
  if (index == kNoTexture) return;
  if (index < 0 || static_cast<std::size_t>(index) >= d.textures.size()) {
    throwBadScene(where, std::string(name) + " is texture " + std::to_string(index) +
                             ", expected below " + std::to_string(d.textures.size()));
  }
  const TexelFormat format = formatOf(use);
  const TexelFormat is = d.textures[static_cast<std::size_t>(index)].format;
  if (is != format && !(use == TextureUse::emission && is == TexelFormat::radiance)) {
    throwBadScene(where, std::string(name) + " expected a texture of " +
                             (format == TexelFormat::color ? "color" : "data"));
  }
}

// Materials of model files are often slightly wrong, so the nearest sensible value replaces a bad
// one. Returns whether anything was repaired.
bool repairChannels(Rgb& c) {
  bool repaired = false;
  for (int i = 0; i < 3; ++i) {
    if (c[i] >= 0 && std::isfinite(c[i])) continue;
    c[i] = 0;
    repaired = true;
  }
  return repaired;
}

bool repairFactor(float& x, float fallback) {
  if (x >= 0 && x <= 1) return false;
  x = std::isnan(x) ? fallback : x < 0 ? 0.0f : 1.0f;
  return true;
}

void checkMaterials(SceneDescription& d, Warnings& warnings) {
  const Material fallback;
  for (std::size_t i = 0; i < d.materials.size(); ++i) {
    Material& m = d.materials[i];
    const std::string where = place(d.name, "material", i, m.name);
    if (m.hasTransmission() && !(m.ior > 0 && std::isfinite(m.ior))) {
      throwBadScene(where, "expected an ior above 0");
    }
    std::uint64_t repaired = 0;
    forEachMember<Material>([&](const auto& member) {
      using Value = typename std::remove_cvref_t<decltype(member)>::Type;
      Value& value = m.*member.field;
      if constexpr (std::is_same_v<Value, Rgb>) {
        repaired += repairChannels(value);
      } else if constexpr (std::is_same_v<Value, float>) {
        if (member.rules.high == 1) repaired += repairFactor(value, fallback.*member.field);
      } else if constexpr (std::is_same_v<Value, std::int32_t>) {
        if (member.rules.kind == MemberKind::map) {
          checkMap(d, where, member.name, value, member.rules.use);
        }
      }
    });
    warnings.add("material value out of range repaired", where, repaired);
  }
}

void checkObjects(const SceneDescription& d) {
  for (const Object& object : d.objects) {
    for (std::size_t i = 0; i < object.meshes.size(); ++i) {
      const Mesh& mesh = object.meshes[i];
      const std::string where = place(d.name, "mesh", i, mesh.name);
      const auto expect = [&](const char* what, std::size_t n, std::size_t expected) {
        if (n == expected) return;
        throwBadScene(where, "expected " + std::to_string(expected) + " " + what + ", found " +
                                 std::to_string(n));
      };
      if (!mesh.normals.empty()) expect("normals", mesh.normals.size(), mesh.positions.size());
      if (!mesh.uvs.empty()) expect("uvs", mesh.uvs.size(), mesh.positions.size());
      if (!mesh.secondUvs.empty()) {
        expect("second uvs", mesh.secondUvs.size(), mesh.positions.size());
      }
      if (!mesh.colors.empty()) expect("colors", mesh.colors.size(), mesh.positions.size());
      if (mesh.materials.size() != 1 && !mesh.triangles.empty()) {
        expect("materials", mesh.materials.size(), mesh.triangles.size());
      }
      if (mesh.materials.empty() && !mesh.spheres.empty()) expect("materials", 0, 1);
      if (!mesh.order.empty()) expect("places", mesh.order.size(), mesh.triangles.size());
      for (const std::uint32_t m : mesh.materials) {
        if (m < d.materials.size()) continue;
        throwBadScene(where, "material " + std::to_string(m) + ", expected below " +
                                 std::to_string(d.materials.size()));
      }
    }
  }
}

// Relative to the lengths of its columns, so that a uniformly tiny map is not taken for singular.
bool isSingular(const Affine& a) {
  constexpr double kSmallestSine = 1e-14;
  const double volume = length(a.x) * length(a.y) * length(a.z);
  return !(std::abs(a.determinant()) > kSmallestSine * volume);
}

void checkInstances(const SceneDescription& d) {
  for (std::size_t i = 0; i < d.instances.size(); ++i) {
    const Instance& instance = d.instances[i];
    if (instance.object >= d.objects.size()) {
      throwBadScene(place(d.name, "instance", i, ""), "object " + std::to_string(instance.object) +
                                                          ", expected below " +
                                                          std::to_string(d.objects.size()));
    }
    const Affine& map = instance.toWorld;
    for (const Vec3d& column : {map.x, map.y, map.z, map.p}) {
      if (maxComponent(abs(column)) <= kLargestCoordinate && isFinite(column)) continue;
      throwBadScene(place(d.name, "instance", i, d.objects[instance.object].name),
                    "expected a transform of finite numbers up to 1.844e18");
    }
    if (isSingular(map)) {
      throwBadScene(place(d.name, "instance", i, d.objects[instance.object].name),
                    "expected a transform that can be undone; this one flattens space");
    }
  }
}

}  // namespace

void validate(SceneDescription& description, Warnings& warnings) {
  checkSize(description);
  checkCameras(description);
  checkLights(description);
  checkSky(description, warnings);
  checkTextures(description);
  checkMaterials(description, warnings);
  checkObjects(description);
  checkInstances(description);
}

}  // namespace whit
