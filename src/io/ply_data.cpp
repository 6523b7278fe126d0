#include "io/ply_data.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>

#include "core/error.h"

namespace whit {
namespace {

template <typename T>
double valueOf(const char* data, bool reversed) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), data, sizeof(T));
  if (reversed) std::reverse(bytes.begin(), bytes.end());
  return static_cast<double>(std::bit_cast<T>(bytes));
}

bool isPlySpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace

double PlyData::number(PlyType type) {
  return format_ == PlyHeader::Format::ascii ? textNumber() : binaryNumber(type);
}

double PlyData::textNumber() {
  for (; at_ < text_.size() && isPlySpace(text_[at_]); ++at_) line_ += text_[at_] == '\n';
  if (at_ < text_.size() && text_[at_] == '+') ++at_;
  double value = 0;
  const char* end = text_.data() + text_.size();
  const auto [rest, error] = std::from_chars(text_.data() + at_, end, value);
  const bool wellFormed =
      error != std::errc::invalid_argument && (rest == end || isPlySpace(*rest));
  if (!wellFormed) throwBadScene(place(), "expected a number");
  at_ = static_cast<std::size_t>(rest - text_.data());
  return value;
}

double PlyData::binaryNumber(PlyType type) {
  const std::size_t size = bytesOf(type);
  if (text_.size() - at_ < size) throwBadScene(place(), "expected a number, found the file's end");
  const char* data = text_.data() + at_;
  at_ += size;
  const bool little = format_ == PlyHeader::Format::littleEndian;
  const bool reversed = little != (std::endian::native == std::endian::little);
  switch (type) {
    case PlyType::int8:
      return valueOf<std::int8_t>(data, reversed);
    case PlyType::uint8:
      return valueOf<std::uint8_t>(data, reversed);
    case PlyType::int16:
      return valueOf<std::int16_t>(data, reversed);
    case PlyType::uint16:
      return valueOf<std::uint16_t>(data, reversed);
    case PlyType::int32:
      return valueOf<std::int32_t>(data, reversed);
    case PlyType::uint32:
      return valueOf<std::uint32_t>(data, reversed);
    case PlyType::float32:
      return valueOf<float>(data, reversed);
    case PlyType::float64:
      return valueOf<double>(data, reversed);
  }
  return 0;
}

std::uint64_t PlyData::listLength(const PlyProperty& property) {
  const double length = number(property.countType);
  const std::size_t least = format_ == PlyHeader::Format::ascii ? 2 : bytesOf(property.type);
  const std::size_t most = (text_.size() - at_ + 1) / least;
  if (!(length >= 0 && length <= static_cast<double>(most))) {
    throwBadScene(place(), "expected a list that fits into the rest of the file");
  }
  return static_cast<std::uint64_t>(length);
}

void PlyData::skip(const PlyElement& element) {
  for (const PlyProperty& property : element.properties) {
    const std::uint64_t count = property.isList ? listLength(property) : 1;
    for (std::uint64_t i = 0; i < count; ++i) number(property.type);
  }
}

std::string PlyData::place() const {
  if (format_ == PlyHeader::Format::ascii) return file_ + ":" + std::to_string(line_);
  return file_ + ": byte " + std::to_string(at_);
}

}  // namespace whit
