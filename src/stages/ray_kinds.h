// The kinds of rays, with all that reports, explanations and drawings need of a kind.
// stages/lobes.h and render/plan.cpp decide which rays a frame traces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/effects.h"
#include "core/index.h"

namespace whit {

enum class RayKind : std::uint8_t { primary, shadow, reflection, refraction, indirect, occlusion };

// Name in a legend and color of lines that stand for rays.
struct RayStyle {
  std::string_view name;
  std::array<std::uint8_t, 3> color{};  // sRGB
};

struct RayKindRow {
  RayKind kind;
  std::string_view name;   // name in tables and files
  EffectSet effects;       // a frame traces such rays if it has any of these; none: every frame
  std::string_view light;  // the light that impulses bring a surface, for sentences
  RayStyle style;
  RayStyle blocked;  // style of occluded rays, if such rays only test for occlusion

  // True for rays that only test for occlusion; others find their closest hit.
  constexpr bool testsOcclusion() const { return !blocked.name.empty(); }

  constexpr bool calledForBy(EffectSet frame) const {
    return effects == EffectSet() || (frame.bits() & effects.bits()) != 0;
  }
};

// clang-format off
inline constexpr std::array kRayKinds{
    RayKindRow{RayKind::primary, "primary", EffectSet(), "",
               {"primary", {255, 255, 255}}, {}},
    RayKindRow{RayKind::shadow, "shadow", EffectSet().with(Effect::shadows), "",
               {"to a light", {255, 224, 64}}, {"to a light, blocked", {0, 0, 0}}},
    RayKindRow{RayKind::reflection, "reflection",
               EffectSet().with(Effect::mirror).with(Effect::glossyReflection), "reflection",
               {"reflection", {255, 64, 64}}, {}},
    RayKindRow{RayKind::refraction, "refraction",
               EffectSet().with(Effect::transmission), "refraction",
               {"refraction", {64, 160, 255}}, {}},
    RayKindRow{RayKind::indirect, "indirect", EffectSet().with(Effect::indirect), "indirect light",
               {"indirect", {64, 224, 96}}, {}},
    RayKindRow{RayKind::occlusion, "occlusion", EffectSet().with(Effect::ambientOcclusion), "",
               {"ambient, open", {240, 128, 255}}, {"ambient, occluded", {112, 0, 144}}}};
// clang-format on
inline constexpr std::size_t kRayKindCount = kRayKinds.size();
static_assert([] {
  for (const auto i : indices(kRayKindCount)) {
    if (kRayKinds[i].kind != static_cast<RayKind>(i)) return false;
  }
  return true;
}());

constexpr const RayKindRow& rowOf(RayKind kind) { return entryOf(kRayKinds, kind); }

// The kinds of impulses, in the order in which a queue holds them.
inline constexpr std::array kImpulseKinds{RayKind::reflection, RayKind::refraction,
                                          RayKind::indirect};

// Returns the kind of rays that test whether a light, or the ambient light, reaches a surface.
constexpr RayKind shadowKind(bool ofAmbientLight) {
  return ofAmbientLight ? RayKind::occlusion : RayKind::shadow;
}

}  // namespace whit
