// Paths that scenes name: which of them may be read, and where shipped scenes are found.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace whit {

std::string extensionOf(const std::filesystem::path& path);  // in lower case, ".exr"

// $WHIT_DATA; empty where that is not set.
std::filesystem::path dataFolder();

// Which files a scene may name: those below its own folder or below the data folder, unless
// allowOutside. Links are followed before that is judged.
class PathRules {
 public:
  PathRules(const std::filesystem::path& sceneFolder, bool allowOutside);

  // The path that a file lying in `folder` calls `text`. "$WHIT_DATA/..." is expanded; backslashes
  // are separators when `backslashes` (OBJ and MTL files written on other systems). The file need
  // not exist. Throws badScene at `where`.
  std::filesystem::path resolve(std::string text, const std::filesystem::path& folder,
                                const std::string& where, bool backslashes = false) const;

 private:
  bool inside(const std::filesystem::path& path) const;

  std::filesystem::path sceneFolder_, dataFolder_;
  bool allowOutside_;
};

// "landscape?triangles=2000&seed=3" taken apart.
struct SceneName {
  std::string file;
  std::map<std::string, double> parameters;
};
// Throws Error(usage) when a parameter is not of the form name=number.
SceneName parseSceneName(const std::string& name);

// A path for names that look like one (a separator or an extension), a shipped scene for bare
// names, which are also looked for in `shippedScenes` unless that is empty. Throws Error(usage) for
// a bare name that is not shipped, naming the nearest.
std::filesystem::path findScene(const std::string& file, const std::string& shippedScenes = "");
// All of them that are found, in order of their names.
std::vector<std::filesystem::path> shippedScenes();

}  // namespace whit
