#include "io/ply_header.h"

#include <charconv>
#include <map>
#include <sstream>

#include "core/error.h"

namespace whit {
namespace {

constexpr std::uint64_t kLineLimit = 4096;
constexpr std::size_t kLineBytesLimit = 4096;

const std::map<std::string, PlyType>& typeNames() {
  static const std::map<std::string, PlyType> names = {
      {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
      {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
      {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
      {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
      {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
      {"float64", PlyType::float64}};
  return names;
}

class HeaderReader {
 public:
  HeaderReader(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  PlyHeader read() {
    if (nextLine() != std::vector<std::string>{"ply"}) fail("expected a line \"ply\"");
    for (;;) {
      const std::vector<std::string> words = nextLine();
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        format(words);
      } else if (words[0] == "element") {
        element(words);
      } else if (words[0] == "property") {
        property(words);
      } else {
        fail("expected \"format\", \"element\", \"property\" or \"end_header\"");
      }
    }
    if (!hasFormat_) fail("expected a line \"format\" before the header's end");
    header_.bytes = at_;
    header_.lines = line_;
    checkSizes();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throwBadScene(file_ + ":" + std::to_string(line_), what);
  }

  // Its words; lines end as on any system.
  std::vector<std::string> nextLine() {
    ++line_;
    const std::size_t end = text_.find_first_of("\r\n", at_);
    if (end == std::string::npos || end - at_ > kLineBytesLimit || line_ > kLineLimit) {
      fail("expected a line of a PLY header");
    }
    std::istringstream in(text_.substr(at_, end - at_));
    at_ = text_.compare(end, 2, "\r\n") == 0 ? end + 2 : end + 1;
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
  }

  void format(const std::vector<std::string>& words) {
    static const std::map<std::string, PlyHeader::Format> formats = {
        {"ascii", PlyHeader::Format::ascii},
        {"binary_little_endian", PlyHeader::Format::littleEndian},
        {"binary_big_endian", PlyHeader::Format::bigEndian}};
    const auto known = words.size() == 3 ? formats.find(words[1]) : formats.end();
    if (known == formats.end() || words[2] != "1.0") {
      fail("expected ascii, binary_little_endian or binary_big_endian, and 1.0");
    }
    header_.format = known->second;
    hasFormat_ = true;
  }

  void element(const std::vector<std::string>& words) {
    PlyElement element;
    if (words.size() == 3) {
      element.name = words[1];
      const char* end = words[2].data() + words[2].size();
      const auto [rest, error] = std::from_chars(words[2].data(), end, element.count);
      if (error == std::errc() && rest == end) {
        header_.elements.push_back(element);
        return;
      }
    }
    fail("expected the name of an element and how many there are");
  }

  PlyType type(const std::string& word) const {
    const auto known = typeNames().find(word);
    if (known == typeNames().end()) fail("\"" + word + "\" is no type of a property");
    return known->second;
  }

  void property(const std::vector<std::string>& words) {
    if (header_.elements.empty()) fail("expected an element before its properties");
    PlyProperty property;
    property.isList = words.size() == 5 && words[1] == "list";
    if (property.isList) {
      property.countType = type(words[2]);
      if (property.countType >= PlyType::float32) fail("expected a whole type for a list's length");
    } else if (words.size() != 3) {
      fail("expected \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"");
    }
    property.type = type(words[words.size() - 2]);
    property.name = words.back();
    header_.elements.back().properties.push_back(property);
  }

  void checkSizes() const {
    const bool ascii = header_.format == PlyHeader::Format::ascii;
    const std::uint64_t left = text_.size() - at_ + (ascii ? 1 : 0);  // the last line's end
    for (const PlyElement& element : header_.elements) {
      const std::uint64_t least = element.leastBytes(ascii);
      if (least == 0 || element.count <= left / least) continue;
      throwBadScene(file_, "expected at most " + std::to_string(left / least) + " elements \"" +
                               element.name + "\", as many as fit into the " +
                               std::to_string(text_.size() - at_) +
                               " bytes after the header, found " + std::to_string(element.count));
    }
  }

  const std::string& text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::uint64_t line_ = 0;
  bool hasFormat_ = false;
  PlyHeader header_;
};

}  // namespace

std::size_t bytesOf(PlyType type) {
  constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

std::uint64_t PlyElement::leastBytes(bool ascii) const {
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : properties) {
    bytes += ascii ? 2 : bytesOf(p.isList ? p.countType : p.type);  // a digit and a blank
  }
  return bytes;
}

std::size_t PlyElement::find(std::string_view property) const {
  std::size_t i = 0;
  while (i < properties.size() && properties[i].name != property) ++i;
  return i;
}

PlyHeader readPlyHeader(const std::string& text, const std::string& file) {
  return HeaderReader(text, file).read();
}

}  // namespace whit
