// Files: which of them scenes may name, where shipped scenes are found, how files are read into
// memory, and files that appear under their name only when complete.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/warnings.h"

namespace whit {

std::string inLowerCase(std::string text);
std::string extensionOf(const std::filesystem::path& path);  // in lower case, ".exr"

// Returns when the file was last written; the least time where there is none, which is no error
// because it may just be replaced.
std::filesystem::file_time_type timeOf(const std::filesystem::path& file);

// Returns the folder $WHIT_DATA; the path is empty where the variable is not set.
std::filesystem::path dataFolder();

// Decides which files a scene may name: those below its own folder or below the data folder, unless
// allowOutside is set. Links are followed before the decision.
class PathRules {
 public:
  PathRules(const std::filesystem::path& sceneFolder, bool allowOutside);

  // Returns the path that a file in `folder` calls `text`. "$WHIT_DATA/..." is expanded. The file
  // need not exist. Throws badScene at `where`.
  std::filesystem::path resolve(const std::string& text, const std::filesystem::path& folder,
                                const std::string& where) const;

  // Resolves a name in a model, which may have been written on another system: backslashes are
  // separators. If there is no such file, or it is not permitted, one whose name differs in
  // capitals is taken, or one of that name that lies beside the model; such replacements are
  // counted in `warnings`.
  std::filesystem::path find(std::string text, const std::filesystem::path& folder,
                             const std::string& where, Warnings& warnings) const;

 private:
  bool permits(const std::filesystem::path& path) const;  // of a path without links

  std::filesystem::path sceneFolder_, dataFolder_;
  bool allowOutside_;
};

// A name such as "landscape?triangles=2000&seed=3", split into the file and its parameters.
struct SceneName {
  std::string file;
  std::map<std::string, double> parameters;
};

// Throws Error(usage) when a parameter is not of the form name=number.
SceneName parseSceneName(const std::string& name);

// Returns the path of a scene. Names with a separator are paths. Names with an extension are paths
// unless there is no such file and a shipped scene or model is called so. Bare names are shipped
// scenes. These are also looked for in `shippedScenes` unless that is empty. Throws Error(usage)
// for a bare name that is not shipped, naming the nearest.
std::filesystem::path findScene(const std::string& file, const std::string& shippedScenes = "");

// Returns all shipped scenes that are found, in order of their names.
std::vector<std::filesystem::path> shippedScenes();

// Throws Error(io) if the file cannot be read, limit if it has more than `maxBytes`, badScene if it
// is a Git LFS pointer.
std::string readFile(const std::filesystem::path& path, std::uint64_t maxBytes);

// Reads text without a byte order mark of UTF-8. Refuses UTF-16.
std::string readTextFile(const std::filesystem::path& path, std::uint64_t maxBytes);

// Reads at most `bytes` bytes of the file.
std::string readBeginning(const std::filesystem::path& path, std::uint64_t bytes);

// Returns the beginning of a text, for errors that quote it.
inline std::string excerpt(const std::string& text) {
  constexpr std::size_t kShown = 60;
  return text.size() > kShown ? text.substr(0, kShown) + "..." : text;
}

// Calls `read`, which opens a file that is named at the place `where` (empty: by the user). An
// Error(io) then names that place as well.
template <typename Read>
auto readNamedAt(const std::string& where, const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    if (error.status() != ExitStatus::io || where.empty()) throw;
    throw Error(ExitStatus::io, where + ": " + error.what(), error.place());
  }
}

inline std::span<const std::uint8_t> asBytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Returns the file that a symbolic link leads to, which need not exist; of other files `path`.
std::string linkTarget(const std::string& path);

// A temporary name beside `path`. commit() renames it to `path`; without commit the destructor
// removes it, so that an error or an interruption leaves nothing half-written. A symbolic link
// stays and its target is what is written.
class AtomicFile {
 public:
  // Throws Error(io) when the folder, or a file that is there, is not writable.
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& temporaryPath() const { return temporary_; }
  void commit();  // throws Error(io)

 private:
  std::string path_, temporary_;
  bool committed_ = false;
};

// Writes the whole text at once.
void writeTextFile(const std::string& path, const std::string& text);

}  // namespace whit
