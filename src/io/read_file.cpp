#include "io/read_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/error.h"

namespace whit {
namespace fs = std::filesystem;
namespace {

// Reads at most `maxBytes`; a longer file is Error(limit) or, with `cut`, read in part.
std::string read(const fs::path& path, std::uint64_t maxBytes, bool cut) {
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
    throwLimit(name + " has " + std::to_string(size) + " bytes, more than the limit of " +
               std::to_string(maxBytes));
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

}  // namespace

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

}  // namespace whit
