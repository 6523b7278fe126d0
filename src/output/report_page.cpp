#include "output/report_page.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "core/index.h"
#include "core/text.h"

namespace whit {

namespace {

std::string fieldOf(const Json& value) {
  if (value.is_null()) return {};
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float()) return formatted("%.7g", value.get<double>());
  if (!value.is_string()) return value.dump();

  const auto& text = value.get_ref<const std::string&>();
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;

  // A field with a separator is quoted, and quotation marks in it are doubled (RFC 4180).
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

// The build turns report.html into a string literal.
constexpr std::string_view kTemplate =
#include "report_html.inc"
    ;

}  // namespace

std::string csvOf(const Json& rows) {
  std::string text;
  const auto addLine = [&](const Json& row, const auto& field) {
    std::string line;
    for (const auto& item : row.items()) line += "," + field(item);
    text += line.substr(std::min<std::size_t>(line.size(), 1)) + "\n";
  };

  if (rows.empty()) return text;
  addLine(rows.front(), [](const auto& item) { return item.key(); });
  for (const Json& row : rows) addLine(row, [](const auto& item) { return fieldOf(item.value()); });
  return text;
}

std::string reportPage(const Json& data) { return pageWith(kTemplate, data); }

std::string pageWith(std::string_view html, const Json& data) {
  constexpr std::string_view kPlace = "{{data}}";
  const std::size_t place = html.find(kPlace);
  std::string page(html.substr(0, place));

  // Only strings hold a '<' in JSON. Escaped, it cannot end the element <script>.
  for (const char c : data.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<') {
      page += "\\u003c";
    } else {
      page += c;
    }
  }

  return page.append(html.substr(place + kPlace.size()));
}

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() * 4 / 3 + 4);

  // Three bytes give four digits of six bits each; '=' fills up the last group (RFC 4648).
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (const auto k : indices(3))
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);

    for (const auto k : indices(4))
      text += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace whit
