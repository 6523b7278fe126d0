#include "io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/error.h"

namespace whit {

namespace {

[[noreturn]] void throwCannotWrite(const std::string& path, int error) {
  throwIo(path, "cannot write '" + path + "': " + std::strerror(error));
}

// A symbolic link keeps pointing where it points; its target is what is replaced.
std::string followLink(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  const std::filesystem::path target = std::filesystem::canonical(path, error);
  return error ? path : target.string();
}

// Creates an empty file beside `path`. Its name does not grow with `path`'s, which may already be
// as long as the file system allows.
std::string createBeside(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  for (;;) {
    const std::string name =
        ".whit-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp";
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

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  if (path_.empty()) throwIo("cannot write a file without a name");
  path_ = followLink(path_);
  struct stat info {};
  if (::stat(path_.c_str(), &info) == 0) {
    if (S_ISDIR(info.st_mode)) throwCannotWrite(path_, EISDIR);
    // Devices and pipes are written straight: replacing /dev/null by a file would be no kindness.
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
