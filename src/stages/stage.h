// The eight stages of a frame. The names here are those of the kernels' files, of the timing tables
// and of the text (after the stages of the 2016 report that this system takes up). Steps of stages
// state what they read and write.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/enum_set.h"

namespace whit {

// clang-format off
// | stage                           | reads                       | writes                        |
// |---------------------------------|-----------------------------|-------------------------------|
// | generateRays                    | camera, pixels              | rays                          |
// | findIntersections               | rays, scene                 | hits (Embree), then surfels   |
// | writeEmittedAndReflectiveAmbient| surfels, sky                | radiance (=)                  |
// | findRadianceAndShadowRays       | surfels, one light          | unshadowed light, shadow rays |
// | checkShadows                    | shadow rays, scene          | visibility (Embree)           |
// | addShading                      | unshadowed light, visibility| radiance (+=)                 |
// | addImpulses                     | surfels                     | the next depth's rays; then   |
// |                                 |                             | their radiance by weight (+=) |
// | updateImage                     | radiance, pixels            | film, display codes           |
// clang-format on
#define WHIT_STAGES(X)                \
  X(generateRays)                     \
  X(findIntersections)                \
  X(writeEmittedAndReflectiveAmbient) \
  X(findRadianceAndShadowRays)        \
  X(checkShadows)                     \
  X(addShading)                       \
  X(addImpulses)                      \
  X(updateImage)

enum class Stage : std::uint8_t {
#define WHIT_STAGE_ENUM(name) name,
  WHIT_STAGES(WHIT_STAGE_ENUM)
#undef WHIT_STAGE_ENUM
};

inline constexpr std::array kStageNames{
#define WHIT_STAGE_NAME(name) std::string_view(#name),
    WHIT_STAGES(WHIT_STAGE_NAME)
#undef WHIT_STAGE_NAME
};
inline constexpr std::size_t kStageCount = kStageNames.size();

// The parts of a chunk that a step reads and writes. Builds without NDEBUG check that steps keep to
// it (render/tile_tracer.cpp), and plans are checked for steps that read a part which no earlier
// step has written.
enum class Part : std::uint8_t {
  pixels,
  rays,  // the rays of the chunk
  hits,
  surfels,
  radiance,
  unshadowed,  // one light's radiance, and whether it is visible
  shadows,     // shadow rays
  children,    // rays of the next depth
  parentRadiance,
  codes,
  film,
  rayCounts,  // numbers of rays that follow from each ray, with itself
  channels    // channels of the film
};

using Parts = EnumSet<Part, static_cast<int>(Part::channels) + 1>;

}  // namespace whit
