#include "make/leave_out.h"

#include <algorithm>

#include "make/shape.h"

namespace whit {

namespace {

constexpr Rgb kBlack{0, 0, 0};

void leaveOutOfMaterial(Material& m, EffectSet effects) {
  if (effects.has(Effect::textures)) {
    m.diffuseMap = m.specularMap = m.roughnessMap = m.emissionMap = m.occlusionMap = kNoTexture;
    m.mirrorMap = m.transmissionMap = kNoTexture;
  }

  if (effects.has(Effect::emissionMaps)) m.emissionMap = kNoTexture;
  if (effects.has(Effect::normalMaps)) m.normalMap = kNoTexture;
  if (effects.has(Effect::alphaMasks)) m.alphaMap = kNoTexture;

  if (effects.has(Effect::coverage) || effects.has(Effect::transmission)) {
    m.coverage = 1;
    m.coverageMap = kNoTexture;
  }

  if (effects.has(Effect::glossy)) {
    m.specular = kBlack;
    m.frosted = false;
  }
  if (effects.has(Effect::glossyReflection)) m.glossyReflection = m.frosted = false;
  if (effects.has(Effect::indirect)) m.diffuseReflection = false;

  if (effects.has(Effect::emission)) m.emission = kBlack;
  if (effects.has(Effect::shadows)) m.castsShadow = false;

  // Without mirrored rays all lobes reflect the blurred sky.
  if (effects.has(Effect::mirror)) {
    m.mirror = m.mirrorGrazing = kBlack;
    m.roughness = std::max(m.roughness, kBlurredRoughness);
    m.roughnessMap = kNoTexture;
    m.ior = 1;
  }

  if (effects.has(Effect::transmission)) m.transmission = kBlack;
  if (effects.has(Effect::absorption)) m.absorption = kBlack;
}

void leaveOutOfSky(Sky& sky, EffectSet effects) {
  if (effects.has(Effect::sky)) sky = Sky();
  if (!effects.has(Effect::skyImage) || sky.kind != Sky::Kind::image) return;

  // A gradient replaces the image.
  sky.kind = Sky::Kind::gradient;
  sky.image = EnvironmentImage();
  sky.zenith = {0.2f, 0.35f, 0.7f};
  sky.horizon = {0.7f, 0.75f, 0.8f};
  sky.ground = {0.2f, 0.18f, 0.15f};
}

void leaveOutOfLights(std::vector<Light>& lights, EffectSet effects) {
  if (effects.has(Effect::lights)) lights.clear();
  for (Light& light : lights) {
    const bool wide = effects.has(Effect::spotLights) && light.kind == Light::Kind::spot;
    if (wide) light.kind = Light::Kind::point;
    if (effects.has(Effect::softShadows)) light.radius = kPointRadius;
  }
  if (!effects.has(Effect::directionalLights)) return;
  std::erase_if(lights, [](const Light& light) { return light.kind == Light::Kind::directional; });
}

// Keeps only the first instance of each object.
void keepFirstUses(SceneDescription& d) {
  std::vector<bool> seen(d.objects.size(), false);
  std::erase_if(d.instances, [&](const Instance& instance) {
    const bool again = seen[instance.object];
    seen[instance.object] = true;
    return again;
  });
}

constexpr int kSegmentsOfSphere = 64;

}  // namespace

void leaveOut(SceneDescription& d, EffectSet effects) {
  for (Material& m : d.materials) leaveOutOfMaterial(m, effects);
  leaveOutOfSky(d.sky, effects);
  leaveOutOfLights(d.lights, effects);
  if (effects.has(Effect::fog)) d.fog = Fog();

  if (effects.has(Effect::ambient)) d.ambient = {.reflection = d.ambient.reflection};
  if (effects.has(Effect::blurredSky)) d.ambient.reflection = 0;
  if (effects.has(Effect::ambientOcclusion)) d.ambient.occlusion = 0;

  if (effects.has(Effect::depthOfField)) {
    for (Camera& camera : d.cameras) camera.aperture = 0;
    for (Keyframe& key : d.cameraPath) key.camera.aperture = 0;
  }

  if (effects.has(Effect::instances)) keepFirstUses(d);
  for (Object& object : d.objects) {
    for (Mesh& mesh : object.meshes) {
      if (effects.has(Effect::spheres)) procedural::tessellateSpheres(mesh, kSegmentsOfSphere);
      if (effects.has(Effect::smoothNormals)) mesh.normals.clear();
      if (effects.has(Effect::vertexColors)) mesh.colors.clear();
    }
  }
}

}  // namespace whit
