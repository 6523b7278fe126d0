// The effects the renderer knows, one bit each. A scene calls for some of them; a frame's plan
// leaves out the rest. The way to add one is in src/README.md, "Adding an effect, an option, a
// member".
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/enum_set.h"
#include "core/index.h"

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
  X(fog, "fog of the air")                          \
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

constexpr std::string_view nameOf(Effect e) { return entryOf(kEffectNames, e).name; }

using EffectSet = EnumSet<Effect, kEffectCount>;

// Parses "shadows,mirror"; throws a usage Error that names the nearest effect for an unknown one.
EffectSet parseEffects(const std::string& commaSeparated);

}  // namespace whit
