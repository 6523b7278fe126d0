// The effects the renderer knows, one bit each. A scene calls for some of them; a frame's plan
// leaves out the rest. Adding one: a line here, the rule in bake/effects_of_scene.cpp that turns
// it on, and the `if constexpr` of the kernel that computes it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace whit {

// name, what it stands for
#define WHIT_EFFECTS(X)                             \
  X(textures, "color textures")                     \
  X(normalMaps, "tangent-space normal maps")        \
  X(alphaMasks, "alpha masks")                      \
  X(coverage, "partial coverage, alpha blending")   \
  X(smoothNormals, "interpolated vertex normals")   \
  X(glossy, "glossy highlights of lights")          \
  X(glossyReflection, "sampled glossy reflections") \
  X(blurredSky, "blurred sky in rough surfaces")    \
  X(emission, "emissive surfaces")                  \
  X(emissionMaps, "emission textures")              \
  X(vertexColors, "vertex colors")                  \
  X(sky, "environment light")                       \
  X(skyImage, "environment map")                    \
  X(ambient, "ambient light")                       \
  X(ambientOcclusion, "ambient occlusion")          \
  X(lights, "point, spot and directional lights")   \
  X(spotLights, "cones of spot lights")             \
  X(directionalLights, "directional lights")        \
  X(shadows, "shadows")                             \
  X(softShadows, "soft shadows of area lights")     \
  X(mirror, "mirror reflection")                    \
  X(transmission, "refraction")                     \
  X(indirect, "indirect diffuse lighting")          \
  X(absorption, "absorption in dielectrics")        \
  X(spheres, "exact spheres")                       \
  X(instances, "instanced geometry")                \
  X(depthOfField, "depth of field by a thin lens")

enum class Effect : std::uint32_t {
#define WHIT_EFFECT_ENUM(name, text) name,
  WHIT_EFFECTS(WHIT_EFFECT_ENUM)
#undef WHIT_EFFECT_ENUM
};

#define WHIT_EFFECT_COUNT(name, text) +1
inline constexpr int kEffectCount = 0 WHIT_EFFECTS(WHIT_EFFECT_COUNT);
#undef WHIT_EFFECT_COUNT

struct EffectName {
  std::string_view name, text;
};
inline constexpr std::array<EffectName, kEffectCount> kEffectNames{{
#define WHIT_EFFECT_NAME(name, text) {#name, text},
    WHIT_EFFECTS(WHIT_EFFECT_NAME)
#undef WHIT_EFFECT_NAME
}};

class EffectSet {
 public:
  constexpr EffectSet() = default;
  constexpr explicit EffectSet(std::uint32_t bits) : bits_(bits) {}
  static constexpr EffectSet all() { return EffectSet((1u << kEffectCount) - 1); }

  constexpr bool has(Effect e) const { return (bits_ & bit(e)) != 0; }
  constexpr EffectSet with(Effect e) const { return EffectSet(bits_ | bit(e)); }
  constexpr EffectSet without(Effect e) const { return EffectSet(bits_ & ~bit(e)); }
  constexpr EffectSet without(EffectSet s) const { return EffectSet(bits_ & ~s.bits_); }
  constexpr std::uint32_t bits() const { return bits_; }
  constexpr bool operator==(const EffectSet&) const = default;

  static constexpr std::uint32_t bit(Effect e) { return 1u << static_cast<std::uint32_t>(e); }

 private:
  std::uint32_t bits_ = 0;
};

// Parses "shadows,mirror"; throws a usage Error that names the nearest effect for an unknown one.
EffectSet parseEffects(const std::string& commaSeparated);

}  // namespace whit
