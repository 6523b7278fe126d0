// PLY files, the data: one number after the other, as text or as bytes.
#pragma once

#include <cstdint>
#include <string>

#include "io/ply_header.h"

namespace whit {

class PlyData {
 public:
  // Reads `text`, the whole file, from the end of its header on.
  PlyData(const std::string& text, const PlyHeader& header, std::string file)
      : text_(text), file_(std::move(file)), format_(header.format), at_(header.bytes) {
    line_ = header.lines + 1;
  }

  // Throw badScene with place() where there is no such number.
  double number(PlyType type);
  std::uint64_t listLength(const PlyProperty& property);
  void skip(const PlyElement& element);

  // "file:line", or "file" and the byte.
  std::string place() const;

 private:
  double textNumber();
  double binaryNumber(PlyType type);

  const std::string& text_;
  std::string file_;
  PlyHeader::Format format_;
  std::size_t at_;
  std::uint64_t line_ = 1;
};

}  // namespace whit
