// The members of each noun of a scene's description, one line a member. Scene files, --set,
// validation, comparison, digests, edits between frames and the viewer's widgets follow from it.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "core/option_table.h"
#include "core/options.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/texture.h"

namespace whit {

// Scene files give no number beyond this; Embree's limit for coordinates is 1.844e18.
inline constexpr double kLargestNumber = 1e18;

inline constexpr double kLargestAspect = 100;  // largest aspect ratio of a camera

// Meaning of a member, where its type leaves it open.
enum class MemberKind : std::uint8_t { plain, color, map };
inline constexpr MemberKind kColorMember = MemberKind::color;

template <typename Noun>
struct MemberRules {
  MemberKind kind = MemberKind::plain;
  TextureUse use = TextureUse::color;  // how a map is decoded
  bool inFiles = true;                 // false: only readers of models set it
  bool required = false;               // scene files have to give it
  bool baked = false;                  // triangles or images depend on it: no edit between frames
  double low = -kLargestNumber,
         high = kLargestNumber;            // limits of numbers; channels are at least 0
  double usual = high;                     // upper end of widgets
  bool (*exists)(const Noun&) = nullptr;   // where it is false, scene files cannot give the member
  bool (*matters)(const Noun&) = nullptr;  // where it is false, widgets do not show the member
  std::array<std::string_view, 3> decides{};  // members whose default values follow from this one
};

template <typename Noun, typename Value>
struct Member {
  using Type = Value;
  const char* name;  // name in scene files and in the library
  Value Noun::*field;
  MemberRules<Noun> rules = {};
};
template <typename Noun, typename Value>
Member(const char*, Value Noun::*, MemberRules<Noun> = {}) -> Member<Noun, Value>;

template <typename Noun>
inline constexpr auto kMembers = std::tuple{};

constexpr bool isPerspective(const Camera& c) { return c.projection == Projection::perspective; }
constexpr bool isFisheye(const Camera& c) {
  return c.projection >= Projection::equidistant && c.projection <= Projection::fisheye;
}
constexpr bool hasMatrix(const Camera& c) { return isPerspective(c) || isFisheye(c); }
constexpr bool isDistorted(const Camera& c) {
  return isPerspective(c) || c.projection == Projection::fisheye;
}
// True if eye, at, up, fov and orthographicHeight say where each point is seen.
inline bool isFramedByOptions(const Camera& c) {
  return isPerspective(c) && c.k.empty() && c.distortion.empty() && c.stereo == Stereo::none;
}
constexpr bool isTable(const Camera& c) { return c.projection == Projection::directions; }
constexpr bool isNoCubeMap(const Camera& c) { return c.projection != Projection::cubeMap; }
constexpr bool isStereo(const Camera& c) { return isNoCubeMap(c) && c.stereo != Stereo::none; }

// Words that stand for the enumerators of a member's type, in their order.
template <typename Enum>
inline constexpr std::array<std::string_view, 0> kWords{};
template <>
inline constexpr std::array<std::string_view, 7> kWords<Projection>{
    "perspective", "equidistant", "equisolid", "fisheye", "panorama", "directions", "cubeMap"};
template <>
inline constexpr std::array<std::string_view, 3> kWords<Stereo>{"none", "leftRight", "topBottom"};
template <>
inline constexpr std::array<std::string_view, 3> kWords<Light::Kind>{"point", "spot",
                                                                     "directional"};

template <>
inline constexpr auto kMembers<Camera> = std::tuple{
    Member{"eye", &Camera::eye},
    Member{"at", &Camera::at},
    Member{"up", &Camera::up},
    Member{"projection", &Camera::projection},
    // Other projections pass over it, so that the projection of a camera can be changed alone.
    Member{"fov", &Camera::fov, {.low = kLeastFov, .high = kLargestFov}},
    Member{"orthographicHeight", &Camera::orthographicHeight, {.low = 0, .exists = isPerspective}},
    Member{"aspect", &Camera::aspect, {.low = 0, .high = kLargestAspect, .exists = isPerspective}},
    Member{"aperture", &Camera::aperture, {.low = 0, .exists = isPerspective}},
    Member{"focus", &Camera::focus, {.low = 0, .exists = isPerspective}},
    Member{"k", &Camera::k, {.exists = hasMatrix}},
    Member{"kSize", &Camera::kSize, {.low = 1, .high = kImageSideLimit, .exists = hasMatrix}},
    Member{"distortion", &Camera::distortion, {.exists = isDistorted}},
    Member{"angle", &Camera::angle, {.low = 1, .high = 360, .exists = isFisheye}},
    Member{"azimuths", &Camera::azimuths, {.low = -360, .high = 360, .exists = isTable}},
    Member{"elevations", &Camera::elevations, {.low = -90, .high = 90, .exists = isTable}},
    Member{"stereo", &Camera::stereo, {.exists = isNoCubeMap}},
    Member{"eyeDistance", &Camera::eyeDistance, {.low = 0, .exists = isStereo}},
};

constexpr MemberRules<Material> mapOf(TextureUse use) {
  return {.kind = MemberKind::map, .use = use, .baked = true};
}
inline bool isGlossy(const Material& m) { return m.hasGlossy(); }
inline bool isMirror(const Material& m) { return m.hasMirror(); }
inline bool hasFacets(const Material& m) { return m.hasFacets(); }
inline bool isTransparent(const Material& m) { return m.hasTransmission(); }

// clang-format off
// A member follows those that decide on its default value.
template <>
inline constexpr auto kMembers<Material> = std::tuple{
    Member{"diffuse", &Material::diffuse, {.kind = kColorMember, .high = 1}},
    Member{"diffuseMap", &Material::diffuseMap, mapOf(TextureUse::color)},
    Member{"specular", &Material::specular, {.kind = kColorMember, .high = 1}},
    Member{"specularMap", &Material::specularMap, mapOf(TextureUse::color)},
    Member{"grazingRatio", &Material::grazingRatio, {.inFiles = false}},
    Member{"roughness", &Material::roughness, {.low = 0, .high = 1, .matters = hasFacets}},
    Member{"roughnessMap", &Material::roughnessMap, mapOf(TextureUse::data)},
    Member{"emission", &Material::emission, {.kind = kColorMember, .usual = 1e4}},
    Member{"emissionMap", &Material::emissionMap, mapOf(TextureUse::emission)},
    Member{"normalMap", &Material::normalMap, mapOf(TextureUse::data)},
    Member{"occlusionMap", &Material::occlusionMap, mapOf(TextureUse::data)},
    Member{"alphaMap", &Material::alphaMap, mapOf(TextureUse::mask)},
    Member{"alphaCutoff", &Material::alphaCutoff, {.baked = true, .low = 0, .high = 1}},
    Member{"coverage", &Material::coverage,
           {.baked = true, .low = 0, .high = 1, .decides = {"castsShadow"}}},
    Member{"coverageMap", &Material::coverageMap,
           {.kind = MemberKind::map,
            .use = TextureUse::mask,
            .baked = true,
            .decides = {"alphaMap", "alphaCutoff"}}},
    Member{"mirror", &Material::mirror,
           {.kind = kColorMember,
            .high = 1,
            .decides = {"mirrorGrazing", "glossyReflection", "coat"}}},
    Member{"mirrorMap", &Material::mirrorMap, mapOf(TextureUse::color)},
    Member{"mirrorGrazing", &Material::mirrorGrazing,
           {.kind = kColorMember, .high = 1, .decides = {"glossyReflection"}}},
    Member{"transmission", &Material::transmission,
           {.kind = kColorMember, .high = 1, .decides = {"castsShadow", "glossyReflection"}}},
    Member{"transmissionMap", &Material::transmissionMap, mapOf(TextureUse::color)},
    Member{"thin", &Material::thin, {.matters = isTransparent}},
    Member{"frosted", &Material::frosted, {.matters = isTransparent}},
    Member{"ior", &Material::ior,
           {.low = kLeastIor, .high = kLargestIor, .usual = 3, .matters = isTransparent}},
    Member{"absorption", &Material::absorption,
           {.kind = kColorMember, .usual = 100, .matters = isTransparent}},
    Member{"priority", &Material::priority, {.low = -1000, .high = 1000, .matters = isTransparent}},
    Member{"diffuseReflection", &Material::diffuseReflection},
    Member{"glossyReflection", &Material::glossyReflection, {.matters = isGlossy}},
    Member{"castsShadow", &Material::castsShadow, {.baked = true}},
    Member{"coat", &Material::coat, {.matters = isMirror}},
    Member{"vertexTint", &Material::vertexTint, {.inFiles = false}},
    Member{"emissionBySecondUvs", &Material::emissionBySecondUvs, {.inFiles = false, .baked = true}},
    Member{"normalBySecondUvs", &Material::normalBySecondUvs, {.inFiles = false, .baked = true}},
    Member{"occlusionBySecondUvs", &Material::occlusionBySecondUvs, {.inFiles = false, .baked = true}},
    Member{"alphaByVertex", &Material::alphaByVertex, {.inFiles = false, .baked = true}},
    Member{"doubleSided", &Material::doubleSided, {.baked = true}},
};
// clang-format on

constexpr bool hasPlace(const Light& light) { return light.kind != Light::Kind::directional; }
constexpr bool hasDirection(const Light& light) { return light.kind != Light::Kind::point; }
constexpr bool hasCone(const Light& light) { return light.kind == Light::Kind::spot; }

// The square of the radius is divided by, so it has to be a normal number.
inline constexpr double kLeastLightRadius = 1.1e-19;

constexpr bool isDirectional(const Light& light) { return !hasPlace(light); }

// clang-format off
// The type decides which members exist.
template <>
inline constexpr auto kMembers<Light> = std::tuple{
    Member{"type", &Light::kind},
    Member{"position", &Light::position, {.required = true, .exists = hasPlace}},
    Member{"intensity", &Light::intensity,
           {.kind = kColorMember, .required = true, .usual = 1e6, .exists = hasPlace}},
    Member{"radius", &Light::radius, {.low = kLeastLightRadius, .exists = hasPlace}},
    Member{"direction", &Light::direction, {.required = true, .exists = hasDirection}},
    Member{"irradiance", &Light::intensity,
           {.kind = kColorMember, .required = true, .usual = 1e6, .exists = isDirectional}},
    Member{"innerConeAngle", &Light::innerConeAngle,
           {.low = 0, .high = kLargestConeAngle, .exists = hasCone}},
    Member{"outerConeAngle", &Light::outerConeAngle,
           {.low = kLeastConeAngle, .high = kLargestConeAngle, .exists = hasCone}},
};
// clang-format on

template <>
inline constexpr auto kMembers<Sky> = std::tuple{
    Member{"zenith", &Sky::zenith, {.kind = kColorMember}},
    Member{"horizon", &Sky::horizon, {.kind = kColorMember}},
    Member{"ground", &Sky::ground, {.kind = kColorMember}},
    Member{"scale", &Sky::scale, {.low = 0}},
    Member{"rotation", &Sky::rotation},
};

template <>
inline constexpr auto kMembers<Ambient> = std::tuple{
    Member{"up", &Ambient::up, {.kind = kColorMember}},
    Member{"down", &Ambient::down, {.kind = kColorMember}},
    Member{"occlusion", &Ambient::occlusion, {.low = 0}},
    Member{"reflection", &Ambient::reflection, {.low = 0, .high = 1}},
};

template <>
inline constexpr auto kMembers<Fog> = std::tuple{
    Member{"density", &Fog::density, {.kind = kColorMember, .usual = 1}},
    Member{"color", &Fog::color, {.kind = kColorMember}},
};

// Calls visit(member) for each member of the noun.
template <typename Noun, typename Visit>
constexpr void forEachMember(Visit&& visit) {
  std::apply([&](const auto&... members) { (visit(members), ...); }, kMembers<Noun>);
}

// Calls visit(member) for each member that a scene file can give of this noun, except maps.
template <typename Noun, typename Visit>
constexpr void forEachMemberInFiles(const Noun& noun, Visit&& visit) {
  forEachMember<Noun>([&](const auto& member) {
    using Value = typename std::remove_cvref_t<decltype(member)>::Type;
    const auto& rules = member.rules;
    const bool isThere =
        rules.inFiles && rules.kind != MemberKind::map && (!rules.exists || rules.exists(noun));
    if constexpr (!std::is_same_v<Value, VertexTint>) {  // files give none
      if (isThere) visit(member);
    }
  });
}

// Calls visit(member) for each texture map of a material.
template <typename Visit>
constexpr void forEachMap(Visit&& visit) {
  forEachMember<Material>([&](const auto& member) {
    if constexpr (std::is_same_v<decltype(member.field), std::int32_t Material::*>) {
      if (member.rules.kind == MemberKind::map) visit(member);
    }
  });
}

template <typename Noun>
bool sameMembers(const Noun& a, const Noun& b) {
  bool same = true;
  forEachMember<Noun>(
      [&](const auto& member) { same = same && a.*member.field == b.*member.field; });
  return same;
}

// Options give points in coordinates of the file, the members of cameras are those of the scene.
inline Vec3f memberOf(const Vec3d& option, const Vec3d& origin) { return Vec3f(option - origin); }
template <typename Value>
const Value& memberOf(const Value& option, const Vec3d& /*origin*/) {
  return option;
}
// The inverse. In a scene that was not moved a point has the digits of its single precision.
template <typename Option, typename Value>
Option optionOf(const Value& member, const Vec3d& origin) {
  if constexpr (std::is_same_v<Option, Vec3d>) {
    if (origin != Vec3d()) return Vec3d(member) + origin;
    Vec3d point;
    for (int i = 0; i < 3; ++i) readNumber(shortest(member[i]), point[i]);
    return point;
  } else {
    return member;
  }
}

// Calls visit(option, member) for each option that replaces a member of the chosen camera.
template <typename Visit>
constexpr void forEachCameraOption(Visit&& visit) {
  visit(&RenderOptions::eye, &Camera::eye);
  visit(&RenderOptions::at, &Camera::at);
  visit(&RenderOptions::up, &Camera::up);
  visit(&RenderOptions::fov, &Camera::fov);
  visit(&RenderOptions::ortho, &Camera::orthographicHeight);
}

}  // namespace whit
