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

class OpenFile {
 public:
  explicit OpenFile(const fs::path& path) : path_(path.string()) {
    std::error_code error;
    const auto status = fs::status(path, error);
    if (!fs::exists(status)) throwIo(path_, "cannot open " + path_ + ": no such file");
    if (!fs::is_regular_file(status)) throwIo(path_, "cannot read " + path_ + ": not a file");
    in_.open(path, std::ios::binary);
    if (!in_) throwIo(path_, "cannot open " + path_ + ": " + std::strerror(errno));
    size_ = fs::file_size(path, error);
    if (error) throwIo(path_, "cannot read " + path_ + ": " + error.message());
  }

  std::uint64_t size() const { return size_; }
  std::string read(std::uint64_t bytes) {
    std::string text(bytes, '\0');
    in_.read(text.data(), static_cast<std::streamsize>(bytes));
    if (!in_) throwIo(path_, "cannot read " + path_ + ": reading stopped early");
    return text;
  }

 private:
  std::string path_;
  std::ifstream in_;
  std::uint64_t size_ = 0;
};

// Told by its mark, or by the zeros beside its first two letters.
bool isUtf16(const std::string& text) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) return true;
  const auto letters = [&](std::size_t at) {
    return text[at] != 0 && text[at + 2] != 0 && text[1 - at] == 0 && text[3 - at] == 0;
  };
  return text.size() >= 4 && (letters(0) || letters(1));
}

}  // namespace

std::string readFile(const fs::path& path, std::uint64_t maxBytes) {
  OpenFile file(path);
  if (file.size() > maxBytes) {
    throwLimit(path.string() + " has " + std::to_string(file.size()) +
               " bytes, more than the limit of " + std::to_string(maxBytes));
  }
  std::string bytes = file.read(file.size());
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
  OpenFile file(path);
  return file.read(std::min(file.size(), bytes));
}

}  // namespace whit
