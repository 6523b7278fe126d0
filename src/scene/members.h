// The members of each noun of a scene's description, one line a member. Scene files, --set,
// validation, comparison, digests, edits between frames and the viewer's widgets follow from it.
#pragma once

#include <tuple>
#include <type_traits>

#include "core/options.h"
#include "scene/camera.h"

namespace whit {

// Scene files give no number beyond this; Embree's limit for coordinates is 1.844e18.
inline constexpr double kLargestNumber = 1e18;

// What the type of a member does not say.
enum class MemberKind { plain, color };

template <typename Noun>
struct MemberRules {
  MemberKind kind = MemberKind::plain;
  double low = -kLargestNumber, high = kLargestNumber;  // of numbers; channels are at least 0
};

template <typename Noun, typename Value>
struct Member {
  const char* name;  // in scene files and in the library
  Value Noun::*field;
  MemberRules<Noun> rules = {};
};
template <typename Noun, typename Value>
Member(const char*, Value Noun::*, MemberRules<Noun> = {}) -> Member<Noun, Value>;

template <typename Noun>
inline constexpr auto kMembers = std::tuple{};

template <>
inline constexpr auto kMembers<Camera> = std::tuple{
    Member{"eye", &Camera::eye},
    Member{"at", &Camera::at},
    Member{"up", &Camera::up},
    Member{"fov", &Camera::fov, {.low = kLeastFov, .high = kLargestFov}},
    Member{"orthographicHeight", &Camera::orthographicHeight, {.low = 0}},
};

// Calls visit(member) for each member of the noun.
template <typename Noun, typename Visit>
constexpr void forEachMember(Visit&& visit) {
  std::apply([&](const auto&... members) { (visit(members), ...); }, kMembers<Noun>);
}

template <typename Noun>
bool sameMembers(const Noun& a, const Noun& b) {
  bool same = true;
  forEachMember<Noun>(
      [&](const auto& member) { same = same && a.*member.field == b.*member.field; });
  return same;
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
