// The rules that turn effects on. Each says why, on or off, in words for `whit info`.
#include <algorithm>

#include "bake/bake_triangles.h"
#include "bake/finalize_steps.h"
#include "core/index.h"
#include "core/text.h"

namespace whit {

namespace {

// Normals closer to the face's than this are its own, written down with five digits or more.
constexpr double kFlat = 1e-5;

bool isSkyBlack(const Sky& sky) {
  const auto bright = [](float x) { return x > 0; };
  const auto isDark = [&](const std::vector<float>& p) { return std::ranges::none_of(p, bright); };
  if (!(sky.scale > 0) || sky.kind == Sky::Kind::none) return true;
  if (sky.kind == Sky::Kind::image) {
    return isDark(sky.image.r) && isDark(sky.image.g) && isDark(sky.image.b);
  }
  const bool isOneColor = sky.kind == Sky::Kind::color;
  return isBlack(sky.zenith) && (isOneColor || (isBlack(sky.horizon) && isBlack(sky.ground)));
}

// An effect that is on when some triangle's material has what it takes; `what` completes "a
// material ...".
struct MaterialRule {
  Effect effect;
  const char* what;
  bool (*has)(const Material&);
};
constexpr MaterialRule kMaterialRules[] = {
    {Effect::textures, "with a color texture",
     [](const Material& m) {
       return (m.diffuseMap != kNoTexture && !isBlack(m.diffuse)) ||
              (m.specularMap != kNoTexture && m.hasGlossy()) || m.variesRoughness() ||
              m.occlusionMap != kNoTexture || (m.mirrorMap != kNoTexture && m.hasMirror()) ||
              (m.transmissionMap != kNoTexture && m.hasTransmission()) ||
              (m.emissionMap != kNoTexture && !isBlack(m.emission));
     }},
    {Effect::emissionMaps, "with a texture of emission",
     [](const Material& m) { return m.emissionMap != kNoTexture && !isBlack(m.emission); }},
    {Effect::normalMaps, "with a normal map",
     [](const Material& m) { return m.normalMap != kNoTexture; }},
    {Effect::alphaMasks, "with an alpha mask",
     [](const Material& m) { return m.alphaMap != kNoTexture && m.alphaCutoff > 0; }},
    {Effect::coverage, "whose coverage is not 1",
     [](const Material& m) { return m.isPartlyThere(); }},

    {Effect::glossy, "with a glossy lobe",
     [](const Material& m) { return m.hasGlossy() || m.isFrosted(); }},
    {Effect::glossyReflection, "whose glossy lobe reflects the scene",
     [](const Material& m) { return m.hasGlossyReflection() || m.isFrosted(); }},
    {Effect::indirect, "whose diffuse color reflects the scene",
     [](const Material& m) { return m.hasDiffuseReflection(); }},
    {Effect::emission, "with emission", [](const Material& m) { return !isBlack(m.emission); }},
    {Effect::transmission, "that light passes", [](const Material& m) { return m.passesLight(); }},
    {Effect::absorption, "with absorption", [](const Material& m) { return m.hasAbsorption(); }},
    // Fresnel reflection needs two different refractive indices at a surface. The vacuum's is 1, so
    // one that differs from it is enough; and where none does, nested media do not reflect either.
    {Effect::mirror, "with a mirror, a smooth lobe or a reflecting dielectric",
     [](const Material& m) {
       return m.hasMirror() || m.isSmooth() || (m.boundsMedium() && m.ior != 1);
     }},
};

class Gatherer {
 public:
  explicit Gatherer(Scene& scene) : scene_(scene), uses_(trianglesOfMaterials(scene)) {}

  void run() {
    scene_.effects = EffectSet();
    for (const MaterialRule& rule : kMaterialRules) byMaterial(rule);
    geometry();
    surroundings();
    lights();
    cameras();
  }

 private:
  void set(Effect effect, bool on, const std::string& yes, const std::string& no) {
    entryOf(scene_.reasons, effect) = {on, on ? yes : no};
    if (on) scene_.effects = scene_.effects.with(effect);
  }

  void byMaterial(const MaterialRule& rule) {
    const std::string what = rule.what;
    std::uint64_t count = 0, triangles = 0;
    for (const auto i : indices(scene_.materials)) {
      if (uses_[i] == 0 || !rule.has(scene_.materials[i])) continue;
      ++count;
      triangles += uses_[i];
    }

    const char* const uses = triangles == 1 ? " uses " : " use ";
    set(rule.effect, count > 0,
        counted(count, "material") + " " + what + ", " + counted(triangles, surface()) + uses +
            (count == 1 ? "it" : "them"),
        "no mesh uses a material " + what);
  }

  // The noun for counts.
  std::string surface() const { return scene_.instancedSpheres > 0 ? "surface" : "triangle"; }

  void geometry() {
    set(Effect::smoothNormals, hasSmoothNormals(scene_),
        "some vertex normals differ from their triangle's",
        "no vertex normal differs from its triangle's");
    set(Effect::vertexColors, !scene_.colors.empty(), "some vertices are not white",
        "no vertex has a color");
    set(Effect::spheres, scene_.triangles.size() > scene_.firstSphere,
        counted(scene_.instancedSpheres, "sphere"), "no analytic spheres");

    const auto& records = scene_.motion.ofGeometry ? scene_.motion.instances : scene_.instances;
    const std::size_t instances = records.size();
    set(Effect::instances, instances > 0,
        counted(instances, "instance") + " of " + counted(scene_.geometries.size() - 1, "object"),
        "no object is used more than once");
  }

  void surroundings() {
    const bool sky = !isSkyBlack(scene_.sky), image = sky && scene_.sky.kind == Sky::Kind::image;
    set(Effect::sky, sky, "the sky is not black", "the sky is black");
    set(Effect::skyImage, image, "the sky is an image",
        sky ? "the sky is not an image" : "the sky is black");
    // The interface of frosted glass reflects no blurred sky.
    const bool rough = scene_.effects.has(Effect::glossyReflection) &&
                       std::ranges::any_of(scene_.materials, &Material::hasGlossyReflection);
    const char* const missing =
        rough ? "the ambient light has a reflection of 0"
              : "no mesh uses a material whose glossy lobe reflects the scene";
    set(Effect::blurredSky, sky && rough && scene_.ambient.reflection > 0,
        "a glossy lobe reflects the sky", sky ? missing : "the sky is black");
    const bool blurred = scene_.effects.has(Effect::blurredSky);
    // Making the image takes milliseconds; editSky() removes it where the sky becomes another one.
    if (!blurred) scene_.blurredSky = EnvironmentImage();
    if (blurred && scene_.blurredSky.r.empty()) scene_.blurredSky = blurredSky(scene_.sky);

    set(Effect::fog, !isBlack(scene_.fog.density), "the fog has a density", "the scene has no fog");

    const bool ambient = !isBlack(scene_.ambient.up) || !isBlack(scene_.ambient.down);
    set(Effect::ambient, ambient, "the ambient light is not black", "the ambient light is black");
    const bool occludes = ambient || blurred;
    set(Effect::ambientOcclusion, occludes && scene_.ambient.occlusion > 0,
        "the ambient light has a radius of occlusion",
        occludes ? "the ambient light has no radius of occlusion" : "the ambient light is black");
  }

  void lights() {
    std::uint64_t shining = 0, spots = 0, directional = 0, wide = 0, casting = 0;
    for (const Light& light : scene_.lights) {
      if (isBlack(light.intensity)) continue;
      ++shining;
      spots += light.kind == Light::Kind::spot;
      directional += light.kind == Light::Kind::directional;
      wide += hasExtent(light);
    }
    for (const auto i : indices(scene_.materials)) {
      if (scene_.materials[i].castsShadow) casting += uses_[i];
    }
    const std::string dark =
        scene_.lights.empty() ? "the scene has no light" : "every light is black";
    set(Effect::lights, shining > 0, counted(shining, "light"), dark);
    set(Effect::spotLights, spots > 0, counted(spots, "spot light"), "no light has a cone");
    set(Effect::directionalLights, directional > 0, counted(directional, "directional light"),
        "no light is directional");
    set(Effect::shadows, shining > 0 && casting > 0,
        counted(shining, "light") + ", " + counted(casting, surface()) +
            (casting == 1 ? " casts shadows" : " cast shadows"),
        shining > 0 ? "no triangle casts a shadow" : dark);
    set(Effect::softShadows, wide > 0 && casting > 0, counted(wide, "light") + " with a radius",
        wide > 0 ? "no triangle casts a shadow" : "no light has a radius");
  }

  void cameras() {
    const auto wide = std::ranges::count_if(scene_.cameras, &Camera::hasLens);
    const bool path = std::ranges::any_of(scene_.cameraPath,
                                          [](const Keyframe& key) { return key.camera.hasLens(); });
    set(Effect::depthOfField, wide > 0 || path,
        wide > 0 ? counted(static_cast<std::uint64_t>(wide), "camera") + " with an aperture"
                 : "the camera path has an aperture",
        "no camera has an aperture");
  }

  Scene& scene_;
  std::vector<std::uint64_t> uses_;
};

}  // namespace

std::vector<std::uint64_t> trianglesOfMaterials(const Scene& scene) {
  std::vector<std::uint64_t> uses(scene.materials.size());
  for (const TriangleRecord& t : scene.triangles) ++uses[t.material];
  return uses;
}

bool hasSmoothNormals(const Scene& scene) {
  if (scene.normals.empty()) return false;
  const auto& bent = scene.motion.bent;
  if (std::ranges::any_of(bent,
                          [](const BentVertices& b) { return !b.deformation->normals.empty(); })) {
    return true;
  }
  for (std::uint32_t i = 0; i < scene.firstSphere; ++i) {
    const Vec3d face = faceNormal(scene.triangles[i]);
    const float* n = scene.normals[i].normal;
    for (int corner = 0; corner < 9; corner += 3) {
      const Vec3d normal = normalized(Vec3d(n[corner], n[corner + 1], n[corner + 2]));
      if (maxComponent(abs(normal - face)) > kFlat) return true;
    }
  }
  return false;
}

bool hasVertexColors(const Scene& scene) {
  return std::ranges::any_of(scene.colors, [](const ColorRecord& record) {
    return std::ranges::any_of(record.color, [](float x) { return x != 1; });
  });
}

EffectSet effectsOf(const Material& material) {
  EffectSet effects;
  for (const MaterialRule& rule : kMaterialRules) {
    if (rule.has(material)) effects = effects.with(rule.effect);
  }
  return effects;
}

void gatherEffects(Scene& scene) { Gatherer(scene).run(); }

}  // namespace whit
