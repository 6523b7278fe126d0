// Writes numbers, members and paths for scene files; reading them gives the same bits.
#pragma once

#include <filesystem>
#include <string>

#include "core/vec3.h"
#include "io/json_reader.h"
#include "scene/members.h"

namespace whit {

// The shortest decimals that are read as this float.
Json describe(float x);
Json describe(const Vec3f& v);
inline Json describe(bool x) { return x; }
inline Json describe(int x) { return x; }
inline Json describe(Light::Kind kind) { return kLightKindNames[static_cast<std::size_t>(kind)]; }

template <typename Noun>
Json describeMembers(const Noun& noun) {
  Json json;
  forEachMemberInFiles(
      noun, [&](const auto& member) { json[member.name] = describe(noun.*member.field); });
  return json;
}

// The path of a file for a scene in `folder`: "$WHIT_DATA/..." where it lies below that, else
// relative to the folder.
std::string describePath(const std::filesystem::path& file, const std::filesystem::path& folder);

// True if the path leaves the folder, so that a scene there needs --allow-outside for it.
bool leavesFolder(const std::string& path);

// Rewrites all paths of the scene file `root` from the folder `from` to the folder `to`. Returns
// whether one of them leaves that folder.
bool movePaths(Json& root, const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace whit
