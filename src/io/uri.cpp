#include "io/uri.h"

#include <algorithm>
#include <cctype>
#include <cstdint>

#include "core/error.h"

namespace whit {
namespace {

constexpr std::string_view kScheme = "data:";

int hexValue(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// Below 0: no digit.
int base64Value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

std::string base64Decoded(std::string_view digits, const std::string& where) {
  while (digits.ends_with('=')) digits.remove_suffix(1);
  std::string bytes;
  bytes.reserve(digits.size() / 4 * 3 + 2);
  std::uint32_t held = 0;
  int bits = 0;
  for (const char c : digits) {
    const int value = base64Value(c);
    if (value < 0) {
      throwBadScene(where, "expected base64, found a letter that is none of its digits");
    }
    held = held << 6 | static_cast<std::uint32_t>(value);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(held >> bits & 255u);
  }
  if (bits == 6) throwBadScene(where, "expected base64, which ends within a byte");
  return bytes;
}

}  // namespace

std::string percentDecoded(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool code = uri[i] == '%' && i + 2 < uri.size() && hexValue(uri[i + 1]) >= 0 &&
                      hexValue(uri[i + 2]) >= 0;
    text += code ? static_cast<char>(16 * hexValue(uri[i + 1]) + hexValue(uri[i + 2])) : uri[i];
    if (code) i += 2;
  }
  return text;
}

bool isDataUri(const std::string& uri) {
  return uri.size() >= kScheme.size() &&
         std::equal(kScheme.begin(), kScheme.end(), uri.begin(), [](char a, char b) {
           return a == std::tolower(static_cast<unsigned char>(b));
         });
}

std::string dataOfUri(const std::string& uri, const std::string& where) {
  constexpr std::string_view kBase64 = ";base64";
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos) throwBadScene(where, "expected a comma before a URI's data");
  const std::string_view head = std::string_view(uri).substr(0, comma);
  const std::string data = percentDecoded(std::string_view(uri).substr(comma + 1));
  return head.ends_with(kBase64) ? base64Decoded(data, where) : data;
}

}  // namespace whit
