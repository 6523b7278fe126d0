#include "io/files.h"

#include <fcntl.h>
#include <sys/auxv.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

#include "core/index.h"
#include "core/option_table.h"
#include "core/text.h"

namespace whit {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kDataVariable = "$WHIT_DATA";

fs::path realPath(const fs::path& path) {
  std::error_code error;
  const fs::path result = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? path.lexically_normal() : result;
}

bool isBelow(const fs::path& path, const fs::path& folder) {
  if (folder.empty()) return false;
  const auto [inFolder, inPath] =
      std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  // A folder written with a final separator has an empty last part.
  return inFolder == folder.end() || inFolder->empty();
}

// Returns the relative path `name` as an existing file in `folder` spells it, whatever the
// capitals.
std::optional<fs::path> spelledOnDisk(const fs::path& folder, const fs::path& name) {
  fs::path found;
  for (const fs::path& part : name) {
    std::error_code error;
    if (fs::exists(folder / found / part, error)) {
      found /= part;
      continue;
    }

    // Capitals may differ in a model from another system, so names are compared in lower case.
    const std::string wanted = inLowerCase(part.string());
    fs::directory_iterator entry(folder / found, error), end;
    while (!error && entry != end && inLowerCase(entry->path().filename().string()) != wanted) {
      entry.increment(error);
    }

    if (error || entry == end) return std::nullopt;
    found /= entry->path().filename();
  }
  return found;
}

// Returns the file of the running program. Without /proc, as in many a chroot, it is taken from the
// name by which the program was called.
fs::path programFile() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const auto* called = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
  return error && called ? realPath(called) : program;
}

std::vector<fs::path> sceneFolders(const std::string& shippedScenes = "") {
  std::vector<fs::path> folders;
  if (const char* variable = std::getenv("WHIT_SCENES"); variable && *variable) {
    folders.emplace_back(variable);
  }

  // Scenes lie beside the program, in the share folder of an installation, or beside the folder of
  // the build.
  if (const fs::path program = programFile(); !program.empty()) {
    folders.push_back(program.parent_path() / "scenes");
    folders.push_back(program.parent_path().parent_path() / "share/whit/scenes");
    folders.push_back(program.parent_path().parent_path() / "scenes");
  }

  if (!shippedScenes.empty()) folders.emplace_back(shippedScenes);
  return folders;
}

// Returns the names of the files with these extensions, as findScene() takes them: names of models
// keep the extension.
std::vector<std::string> shippedNames(const std::vector<fs::path>& folders,
                                      const std::vector<std::string>& extensions) {
  std::vector<std::string> names;
  for (const fs::path& folder : folders) {
    std::error_code error;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
      const fs::path& file = i->path();
      const std::string extension = file.extension().string();
      if (!contains(extensions, extension) || !i->is_regular_file(error)) continue;
      names.push_back((extension == ".json" ? file.stem() : file.filename()).string());
    }
  }

  // Several folders may have a scene of the same name.
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

// Reads at most `maxBytes`; a longer file is Error(limit) or, with `cut`, read in part.
std::string read(const fs::path& path, std::uint64_t maxBytes, bool cut) {
  // Errors show only the beginning and the end of a long path.
  constexpr std::size_t kShown = 250;
  std::string name = path.string();
  if (name.size() > kShown) name = excerpt(name) + name.substr(name.size() - kShown / 2);

  std::error_code error;
  const auto status = fs::status(path, error);
  if (!fs::exists(status)) throwIo(name, "cannot open " + name + ": no such file");
  if (!fs::is_regular_file(status)) throwIo(name, "cannot read " + name + ": not a file");

  std::ifstream in(path, std::ios::binary);
  if (!in) throwIo(name, "cannot open " + name + ": " + std::strerror(errno));
  const std::uint64_t size = fs::file_size(path, error);
  if (error) throwIo(name, "cannot read " + name + ": " + error.message());
  if (size > maxBytes && !cut) {
    throwLimit(concat(name, " has ", size, " bytes, more than the limit of ", maxBytes));
  }

  std::string bytes(std::min(size, maxBytes), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in) throwIo(name, "cannot read " + name + ": reading stopped early");
  return bytes;
}

// Recognizes UTF-16 by its byte order mark, or by zeros beside the first letters.
bool isUtf16(const std::string& text) {
  return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") ||
         text.substr(0, 4).find('\0') != std::string::npos;
}

[[noreturn]] void throwCannotWrite(const std::string& path, int error) {
  throwIo(path, "cannot write '" + path + "': " + std::strerror(error));
}

// Creates an empty file beside `path`. Its name does not grow with `path`'s, which may already be
// as long as the file system allows.
std::string createBeside(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  const fs::path folder = fs::path(path).parent_path();

  for (;;) {
    const std::string name = concat(".whit-", ::getpid(), "-", counter++, ".tmp");
    std::string temporary = (folder / name).string();
    const int file = ::open(temporary.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (file >= 0) {
      ::close(file);
      return temporary;
    }
    if (errno != EEXIST) throwCannotWrite(path, errno);
  }
}

}  // namespace

std::string inLowerCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string extensionOf(const fs::path& path) { return inLowerCase(path.extension().string()); }

fs::file_time_type timeOf(const fs::path& file) {
  std::error_code error;
  return fs::last_write_time(file, error);
}

fs::path dataFolder() {
  const char* const variable = std::getenv("WHIT_DATA");
  return variable ? variable : "";
}

PathRules::PathRules(const fs::path& sceneFolder, bool allowOutside)
    : sceneFolder_(realPath(sceneFolder.empty() ? "." : sceneFolder)),
      dataFolder_(dataFolder().empty() ? fs::path() : realPath(dataFolder())),
      allowOutside_(allowOutside) {}

bool PathRules::permits(const fs::path& path) const {
  return allowOutside_ || isBelow(path, sceneFolder_) ||
         (!dataFolder_.empty() && isBelow(path, dataFolder_));
}

fs::path PathRules::resolve(const std::string& text, const fs::path& folder,
                            const std::string& where) const {
  if (text.empty()) throwBadScene(where, "expected the path of a file, found an empty string");

  const bool nul = text.find('\0') != std::string::npos;
  if (nul || text.find("://") != std::string::npos) {
    throwBadScene(where, "expected the path of a file on this machine, found " +
                             (nul ? "a NUL byte" : excerpt(text)));
  }

  fs::path path;
  if (text.starts_with(kDataVariable)) {
    if (text.size() > kDataVariable.size() && text[kDataVariable.size()] != '/') {
      throwBadScene(where, "expected \"$WHIT_DATA/...\", found \"" + excerpt(text) + "\"");
    }
    if (dataFolder_.empty()) {
      throwIo(where + ": cannot open \"" + excerpt(text) +
              "\": WHIT_DATA is not set, set it to the folder that has this file");
    }
    path = dataFolder() / fs::path(text.substr(kDataVariable.size())).relative_path();
  } else {
    path = folder / text;
  }

  // Links are followed before the check, so that none of them leads out of the permitted folders.
  fs::path result = realPath(path);
  if (!permits(result)) {
    throwBadScene(where, "\"" + excerpt(text) +
                             "\" leaves the scene's folder and $WHIT_DATA (--allow-outside "
                             "permits that)");
  }
  return result;
}

fs::path PathRules::find(std::string text, const fs::path& folder, const std::string& where,
                         Warnings& warnings) const {
  std::ranges::replace(text, '\\', '/');
  const fs::path name(text);

  // A file whose path differs only in capitals is preferred to one of that name beside the model,
  // unless it is not permitted.
  fs::path fallback = spelledOnDisk(folder, name).value_or(fs::path());
  if (fallback.empty() || !permits(realPath(folder / fallback))) {
    fallback = spelledOnDisk(folder, name.filename()).value_or(fs::path());
  }

  // A path that is not permitted is an error only if there is no other file.
  try {
    fs::path path = resolve(text, folder, where);
    std::error_code error;
    if (fs::exists(path, error) || fallback.empty()) return path;
  } catch (const Error&) {
    if (fallback.empty()) throw;
  }

  fs::path path = resolve(fallback.string(), folder, where);
  warnings.add("file taken whose name or folder differs from the one in the model",
               where + ": " + fallback.string() + " for " + excerpt(text));
  return path;
}

SceneName parseSceneName(const std::string& name) {
  std::error_code error;
  const std::size_t mark = name.find('?');
  refuseIf(name.substr(0, mark).empty(),
           "expected a scene file, a model or the name of a shipped scene, found '" + name + "'");
  if (mark == std::string::npos || fs::exists(name, error)) return {name, {}};

  SceneName result{name.substr(0, mark), {}};
  for (std::size_t begin = mark + 1; begin <= name.size();) {
    const std::size_t end = std::min(name.find('&', begin), name.size());
    const std::string part = name.substr(begin, end - begin);
    const std::size_t equals = part.find('=');
    const std::string number = equals == std::string::npos ? "" : part.substr(equals + 1);

    double value = 0;
    if (equals == 0 || !readNumber(number, value)) {
      throwUsage("\"" + name + "\": expected name=number after the question mark, found \"" + part +
                 "\"");
    }

    result.parameters[part.substr(0, equals)] = value;
    begin = end + 1;
  }

  return result;
}

fs::path findScene(const std::string& file, const std::string& shippedScenes) {
  fs::path path(file);
  std::error_code error;
  if (path.has_parent_path() || (path.has_extension() && fs::exists(path, error))) return path;

  // Shipped models are found by the name of their file: "chess.glb".
  const std::vector<fs::path> folders = sceneFolders(shippedScenes);
  for (const fs::path& folder : folders) {
    fs::path candidate = folder / (path.has_extension() ? file : file + ".json");
    if (fs::is_regular_file(candidate, error)) return candidate;
  }
  if (path.has_extension()) return path;

  if (fs::is_directory(path, error)) {
    throwUsage("'" + file + "' is a folder: name a scene file or a model in it");
  }
  const std::vector<std::string> names = shippedNames(folders, {".json", ".glb"});
  throwUsage("no scene is called '" + file + "'" +
             (names.empty() ? " (no scenes found; is $WHIT_SCENES set?)"
                            : didYouMean(file, names, "scene")));
}

std::vector<fs::path> shippedScenes() {
  std::vector<fs::path> scenes;
  for (const std::string& name : shippedNames(sceneFolders(), {".json"})) {
    scenes.push_back(findScene(name));
  }
  return scenes;
}

std::string readFile(const fs::path& path, std::uint64_t maxBytes) {
  std::string bytes = read(path, maxBytes, false);
  if (bytes.starts_with("version https://git-lfs.github.com/spec/")) {
    throwBadScene(path.string(),
                  "expected the file itself, found a Git LFS pointer to it (git lfs pull fetches "
                  "it)");
  }
  return bytes;
}

std::string readTextFile(const fs::path& path, std::uint64_t maxBytes) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  std::string text = readFile(path, maxBytes);
  if (isUtf16(text)) {
    throwBadScene(path.string(), "expected text in UTF-8, found UTF-16: save it as UTF-8");
  }
  if (text.starts_with(kMark)) text.erase(0, kMark.size());
  return text;
}

std::string readBeginning(const fs::path& path, std::uint64_t bytes) {
  return read(path, bytes, true);
}

std::string linkTarget(const std::string& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return path;

  // Links to pipes in /proc can be opened, though the names that they hold lead nowhere.
  if (fs::exists(path, error)) {
    const fs::path target = fs::canonical(path, error);
    return error ? path : target.string();
  }

  constexpr int kMostLinks = 40;  // as many as Linux follows
  fs::path target(path);
  for (int links = 0; links < kMostLinks && fs::is_symlink(target, error); ++links) {
    target = target.parent_path() / fs::read_symlink(target, error);
  }
  return target.string();
}

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  if (path_.empty()) throwIo("cannot write a file without a name");
  path_ = linkTarget(path_);

  struct stat info {};
  if (::stat(path_.c_str(), &info) == 0) {
    if (S_ISDIR(info.st_mode)) throwCannotWrite(path_, EISDIR);
    // A rename would replace a file that is protected.
    if (::access(path_.c_str(), W_OK) != 0) throwCannotWrite(path_, errno);
    // Devices and pipes are opened directly, because a rename would replace them by a file.
    if (!S_ISREG(info.st_mode)) {
      temporary_ = path_;
      return;
    }
  }

  temporary_ = createBeside(path_);
}

AtomicFile::~AtomicFile() {
  if (!committed_ && temporary_ != path_) std::remove(temporary_.c_str());
}

void AtomicFile::commit() {
  if (temporary_ != path_ && std::rename(temporary_.c_str(), path_.c_str()) != 0)
    throwCannotWrite(path_, errno);
  committed_ = true;
}

void writeTextFile(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  std::ofstream out(file.temporaryPath(), std::ios::binary | std::ios::trunc);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) throwCannotWrite(path, errno != 0 ? errno : EIO);
  file.commit();
}

}  // namespace whit
