// Parts of a scene as its file has them; what is read of that is the same bit for bit.
#pragma once

#include <filesystem>
#include <vector>

#include "io/json_text.h"
#include "scene/camera.h"
#include "scene/light.h"

namespace whit {

// The shortest decimals that are read as this float.
Json describe(float x);
Json describe(const Vec3f& v);
Json describe(const Camera& camera);
Json describe(const Ambient& ambient);
Json describe(const std::vector<Light>& lights);

// The path of a file for a scene in `folder`: "$WHIT_DATA/..." where it lies below that, else
// relative to the folder.
std::string describePath(const std::filesystem::path& file, const std::filesystem::path& folder);

// Whether that path leaves the folder, so that a scene there needs --allow-outside for it.
bool leavesFolder(const std::string& path);

// Of the scene file `root` in the folder `from`, all paths as a scene in `to` has them. Whether one
// of them leaves that folder.
bool movePaths(Json& root, const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace whit
