// Feature flags of a plan, found once for all frames. Whole calls test these and nothing else,
// neither null columns nor empty tables: a set of columns belongs to a feature and exists only with
// it, and steps ask their chunk (`chunk.has(Feature::cones)`).
#pragma once

#include <cstdint>

#include "core/enum_set.h"

namespace whit {

// name, what it is there for
#define WHIT_FEATURES(X)                                                  \
  X(always, "every frame")                                                \
  X(ambient, "ambient light, blurred sky")                                \
  X(spotLights, "cones of spot lights")                                   \
  X(emission, "materials that emit")                                      \
  X(emissionFactors, "emission by maps or vertex colors")                 \
  X(vertexColors, "vertex colors")                                        \
  X(sky, "a sky that is not black")                                       \
  X(glossy, "glossy lobes")                                               \
  X(roughnessMaps, "roughness by a map")                                  \
  X(coverage, "surfaces that are there in part")                          \
  X(streams, "random numbers along paths")                                \
  X(transmission, "media along rays")                                     \
  X(absorption, "media that absorb")                                      \
  X(instances, "hits on instances")                                       \
  X(spheres, "hits on exact spheres")                                     \
  X(coplanar, "triangles that overlap others in their plane")             \
  X(shadows, "shadow rays")                                               \
  X(lift, "shadow rays that start above their facets (--terminator)")     \
  X(cones, "the width of pixels along rays (--texture-filter trilinear)") \
  X(smoothNormals, "vertex normals")                                      \
  X(textures, "maps of colors")                                           \
  X(normalMaps, "maps of normals")                                        \
  X(secondUvs, "maps looked up with second texture coordinates")

enum class Feature : std::uint8_t {
#define WHIT_FEATURE_ENUM(name, text) name,
  WHIT_FEATURES(WHIT_FEATURE_ENUM)
#undef WHIT_FEATURE_ENUM
};

#define WHIT_FEATURE_COUNT(name, text) +1
inline constexpr int kFeatureCount = 0 WHIT_FEATURES(WHIT_FEATURE_COUNT);
#undef WHIT_FEATURE_COUNT

using FeatureSet = EnumSet<Feature, kFeatureCount, 1u>;  // always has Feature::always

}  // namespace whit
