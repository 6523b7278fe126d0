// PLY files, the header: what the data that follows it looks like. G. Turk, "The PLY Polygon File
// Format", 1994.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace whit {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
std::size_t bytesOf(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;  // of a list: of its items
  bool isList = false;
  PlyType countType = PlyType::uint8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  // The least that one of them takes in the file; with lists that are empty.
  std::uint64_t leastBytes(bool ascii) const;
  // Where the property of this name is, or properties.size().
  std::size_t find(std::string_view property) const;
};

struct PlyHeader {
  enum class Format { ascii, littleEndian, bigEndian };
  Format format = Format::ascii;
  std::vector<PlyElement> elements;
  std::size_t bytes = 0;    // where the data begins
  std::uint64_t lines = 0;  // of the header
};

// Throws badScene "file:line" where `text`, the whole file, does not begin with a header, or where
// an element cannot fit into what follows it.
PlyHeader readPlyHeader(const std::string& text, const std::string& file);

}  // namespace whit
