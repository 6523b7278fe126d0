// The bytes of an image file, read one after the other by the decoders of this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"

namespace whit {

class ImageBytes {
 public:
  ImageBytes(const std::string& path, std::span<const std::uint8_t> file)
      : path_(path), file_(file) {}

  std::size_t at() const { return at_; }
  std::size_t left() const { return file_.size() - at_; }
  // Throw badScene where the file ends before that.
  void need(std::uint64_t bytes) const {
    if (bytes > left()) fail("the file is cut short");
  }
  void skip(std::uint64_t bytes) {
    need(bytes);
    at_ += bytes;
  }
  std::uint8_t next() {
    need(1);
    return file_[at_++];
  }
  // Reads a number of this many bytes, the lowest first.
  std::uint32_t number(int bytes) {
    std::uint32_t value = 0;
    for (int i = 0; i < bytes; ++i) value |= std::uint32_t{next()} << (8 * i);
    return value;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throwBadScene(path_ + ": byte " + std::to_string(at_), what);
  }

 private:
  const std::string& path_;
  std::span<const std::uint8_t> file_;
  std::size_t at_ = 0;
};

// A code of `most` + 1 as one of 256, rounded.
inline std::uint8_t codeOf(std::uint64_t value, std::uint64_t most) {
  return static_cast<std::uint8_t>((value * 255 + most / 2) / most);
}

// For pixels of four channels of which the last need not be meant: where none has any, it was not.
inline void repairAlpha(std::vector<std::uint8_t>& codes) {
  std::uint8_t any = 0;
  for (std::size_t i = 3; i < codes.size(); i += 4) any |= codes[i];
  if (any != 0) return;
  for (std::size_t i = 3; i < codes.size(); i += 4) codes[i] = 255;
}

}  // namespace whit
