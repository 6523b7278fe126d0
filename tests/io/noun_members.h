// Compares members of cameras, lights and materials by their names in scene files.
#pragma once

#include "io/scene/scene_sections.h"
#include "scene/members.h"
#include "scene_files.h"

namespace whit {

// Expects members that are given as JSON. One number stands for all three of a color. Numbers may
// be off by so many roundings of float.
template <typename Noun>
void expectMembers(const Noun& noun, const std::string& members, int roundings = 4) {
  Json wanted = Json::parse(asJson(members));
  forEachMember<Noun>([&](const auto& member) {
    if (!wanted.contains(member.name)) return;
    const Json got = describe(noun.*member.field), right = wanted[member.name];
    if (right.is_array()) {
      EXPECT_EQ(got.size(), right.size()) << member.name;
    } else {
      EXPECT_GT(got.size(), 0u) << member.name;
    }
    for (const auto i : indices(got.size())) {
      const Json& a = got.is_array() ? got[i] : got;
      const Json& b = right.is_array() ? right.at(i) : right;
      if (a.is_number()) {
        const double x = b.get<double>(), rounding = std::max(1.0, std::abs(x)) / (1 << 23);
        EXPECT_NEAR(a.get<double>(), x, roundings * rounding) << member.name;
      } else {
        EXPECT_EQ(a, b) << member.name;
      }
    }
    wanted.erase(member.name);
  });
  EXPECT_TRUE(wanted.empty()) << wanted;
}

// Expects the floats that are the nearest to the numbers.
template <typename Noun>
void expectExactly(const Noun& noun, const std::string& members) {
  expectMembers(noun, members, 0);
}

}  // namespace whit
