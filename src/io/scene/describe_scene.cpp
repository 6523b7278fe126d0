#include "io/scene/describe_scene.h"

#include <cstdlib>

#include "core/option_values.h"
#include "io/paths.h"

namespace whit {

namespace fs = std::filesystem;

namespace {

class PathMover {
 public:
  PathMover(fs::path from, fs::path to) : from_(std::move(from)), to_(std::move(to)) {}

  bool leaves() const { return leaves_; }

  void moveIn(Json& object, const char* key) {
    if (!object.is_object()) return;
    const auto found = object.find(key);
    if (found == object.end() || !found->is_string()) return;
    const auto text = found->get<std::string>();
    if (text.starts_with("$")) return;  // $WHIT_DATA, wherever the scene is
    const std::string moved = describePath(from_ / text, to_);
    leaves_ |= leavesFolder(moved);
    *found = moved;
  }
  void moveInItems(Json& items) {
    if (!items.is_array()) return;
    for (Json& item : items) {
      moveIn(item, "model");
      if (item.is_object() && item.contains("group")) moveInItems(item["group"]);
    }
  }

 private:
  fs::path from_, to_;
  bool leaves_ = false;
};

template <typename Visit>
void forEachEntry(Json& root, const char* section, const Visit& visit) {
  const auto found = root.find(section);
  if (found == root.end() || !found->is_object()) return;
  for (auto& [name, value] : found->items()) visit(value);
}

}  // namespace

Json describe(float x) {
  const double shortest = std::strtod(formatValue(OptionSpec{}, x).c_str(), nullptr);
  return static_cast<float>(shortest) == x ? shortest : static_cast<double>(x);
}

Json describe(const Vec3f& v) { return Json::array({describe(v.x), describe(v.y), describe(v.z)}); }

std::string describePath(const fs::path& file, const fs::path& folder) {
  const fs::path real = fs::weakly_canonical(fs::current_path() / file);
  const fs::path inData = real.lexically_relative(fs::weakly_canonical(dataFolder()));
  if (!inData.empty() && !leavesFolder(inData.string())) {
    return (fs::path("$WHIT_DATA") / inData).string();
  }
  return real.lexically_relative(fs::weakly_canonical(fs::current_path() / folder)).string();
}

bool leavesFolder(const std::string& path) { return *fs::path(path).begin() == ".."; }

bool movePaths(Json& root, const fs::path& from, const fs::path& to) {
  PathMover mover(from, to);
  if (root.contains("sky")) mover.moveIn(root["sky"], "image");
  forEachEntry(root, "textures", [&](Json& texture) { mover.moveIn(texture, "image"); });
  forEachEntry(root, "objects", [&](Json& items) { mover.moveInItems(items); });
  if (root.contains("scene")) mover.moveInItems(root["scene"]);
  return mover.leaves();
}

}  // namespace whit
