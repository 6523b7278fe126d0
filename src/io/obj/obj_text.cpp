#include "io/obj/obj_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/error.h"

namespace whit {
namespace {

bool isObjBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

constexpr std::array<bool, 256> numberCharacters() {
  std::array<bool, 256> table{};
  for (const char c : {'0', '1', '2', '3', '4', '5', '6', '7', '8', '9', '+', '-', '.', 'e', 'E'}) {
    table[static_cast<unsigned char>(c)] = true;
  }
  return table;
}
constexpr std::array<bool, 256> kInNumber = numberCharacters();

struct Numbers {
  int count = 0;
  bool finite = true;
};

// Writers' ways of spelling what is not finite that strtod does not know (old MSVC).
bool isOldNan(std::string_view word) {
  const std::size_t mark = word.find(".#");
  return mark != std::string_view::npos && mark > 0 && word.find_first_of("IQSN") == mark + 2;
}

// Word by word, for lines that are not made of plain numbers. Stops at a comment or at the first
// word that is no number.
Numbers readOddNumbers(std::string_view text) {
  Numbers result;
  for (std::size_t i = 0; i < text.size();) {
    if (isObjBlank(text[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < text.size() && !isObjBlank(text[end])) ++end;
    const std::string word(text.substr(i, end - i));
    char* rest = nullptr;
    const double value = std::strtod(word.c_str(), &rest);
    const bool old = isOldNan(word), hex = word.find_first_of("xX") != std::string::npos;
    if (!old && (hex || rest == word.c_str() || *rest != '\0')) break;
    if (old || !std::isfinite(static_cast<float>(value))) result.finite = false;
    ++result.count;
    i = end;
  }
  return result;
}

Numbers readNumbers(std::string_view text) {
  Numbers result;
  bool inside = false, exponent = false;
  for (const char c : text) {
    if (isObjBlank(c)) {
      inside = false;
      continue;
    }
    if (!kInNumber[static_cast<unsigned char>(c)]) return readOddNumbers(text);
    exponent |= c == 'e' || c == 'E';
    result.count += !inside;
    inside = true;
  }
  // Only an exponent, or a very long row of digits, can go beyond what a float holds.
  constexpr std::size_t kPlainLength = 100;
  return exponent || text.size() > kPlainLength ? readOddNumbers(text) : result;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && isObjBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && isObjBlank(text.back())) text.remove_suffix(1);
  return text;
}

ObjText::ObjText(std::string text, std::string file)
    : text_(std::move(text)), file_(std::move(file)) {
  repairLineEnds();
  std::size_t nextJoined = 0;
  for (std::size_t begin = 0; begin < text_.size(); ++line_) {
    const std::size_t end = std::min(text_.find('\n', begin), text_.size());
    readLine(begin, end);
    while (nextJoined < joined_.size() && joined_[nextJoined] < end) ++nextJoined, ++line_;
    begin = end + 1;
  }
}

void ObjText::repairLineEnds() {
  for (std::size_t i = text_.find('\r'); i != std::string::npos; i = text_.find('\r', i + 1)) {
    if (i + 1 == text_.size() || text_[i + 1] != '\n') text_[i] = '\n';
  }
  std::size_t lineStart = 0, looked = 0;
  for (std::size_t i = text_.find('\\'); i != std::string::npos; i = text_.find('\\', i + 1)) {
    const std::size_t lineBreak = std::string_view(text_).substr(looked, i - looked).rfind('\n');
    if (lineBreak != std::string::npos) lineStart = looked + lineBreak + 1;
    looked = i;
    const std::size_t end = i + 1 < text_.size() && text_[i + 1] == '\r' ? i + 2 : i + 1;
    if (end >= text_.size() || text_[end] != '\n') continue;
    while (isObjBlank(text_[lineStart])) ++lineStart;
    if (text_[lineStart] == '#') continue;
    std::fill(text_.begin() + static_cast<std::ptrdiff_t>(i),
              text_.begin() + static_cast<std::ptrdiff_t>(end) + 1, ' ');
    joined_.push_back(end);
  }
}

void ObjText::readLine(std::size_t begin, std::size_t end) {
  while (begin < end && isObjBlank(text_[begin])) ++begin;
  const std::string_view line(text_.data() + begin, end - begin);
  if (line.starts_with("v")) return readVertex(begin, end);
  if (line.starts_with("f ") || line.starts_with("f\t")) return readFace(begin + 1, end);
  for (const std::string_view keyword : {"l", "p", "curv", "curv2", "surf"}) {
    const bool is = line.size() > keyword.size() && line.starts_with(keyword) &&
                    isObjBlank(line[keyword.size()]);
    if (is) return leaveOut(summary_.others);
  }
  const auto nameAfter = [&](std::string_view keyword) {
    return line.size() > keyword.size() && line.starts_with(keyword) &&
                   isObjBlank(line[keyword.size()])
               ? trimmed(line.substr(keyword.size()))
               : std::string_view();
  };
  const auto addOnce = [&](std::vector<ObjSummary::Name>& names, std::set<std::string>& seen,
                           std::string_view name) {
    const auto [entry, isNew] = seen.emplace(name);
    if (isNew) names.push_back({*entry, line_});
  };
  if (const auto name = nameAfter("usemtl"); !name.empty()) {
    addOnce(summary_.materials, seenMaterials_, name);
  } else if (const auto library = nameAfter("mtllib"); !library.empty()) {
    addOnce(summary_.libraries, seenLibraries_, library);
  }
}

void ObjText::readVertex(std::size_t begin, std::size_t end) {
  const std::size_t word = std::min(text_.find_first_of(" \t\r\n", begin), end) - begin;
  const std::string_view keyword(text_.data() + begin, word);
  const bool isPosition = keyword == "v", isNormal = keyword == "vn", isUv = keyword == "vt";
  if (!isPosition && !isNormal && !isUv) return;
  const Numbers numbers = readNumbers({text_.data() + begin + word, end - begin - word});
  if (numbers.count < (isUv ? 1 : 3)) {
    throwBadScene(here(), "expected " + std::string(isUv ? "numbers" : "three numbers") +
                              " after \"" + std::string(keyword) + "\"");
  }
  std::uint64_t& count = isPosition ? summary_.positions
                         : isNormal ? summary_.normals
                                    : summary_.uvs;
  if (!numbers.finite) {
    (isPosition ? summary_.nonFinitePositions
     : isNormal ? summary_.nonFiniteNormals
                : summary_.nonFiniteUvs)
        .push_back(count);
  }
  ++count;
  constexpr int kWithColor = 6;  // x y z r g b
  if (isPosition && numbers.count >= kWithColor) leaveOut(summary_.colors);
}

void ObjText::leaveOut(ObjSummary::LeftOut& what) {
  if (what.count++ == 0) what.line = line_;
}

void ObjText::readFace(std::size_t begin, std::size_t end) {
  bool inside = false;
  for (std::size_t i = begin; i < end; ++i) {
    if (text_[i] == '#') {
      std::fill(text_.begin() + static_cast<std::ptrdiff_t>(i),
                text_.begin() + static_cast<std::ptrdiff_t>(end), ' ');
      break;
    }
    const bool blank = isObjBlank(text_[i]);
    summary_.corners += !blank && !inside;
    inside = !blank;
  }
  ++summary_.faces;
}

std::string ObjText::placeOf(std::uint64_t offset) {
  const std::size_t end = std::min<std::size_t>(offset > 0 ? offset - 1 : 0, text_.size());
  // Places are asked for in order, and there may be one for every line.
  if (end < countedTo_) countedTo_ = breaks_ = 0;
  breaks_ += static_cast<std::uint64_t>(
      std::count(text_.begin() + static_cast<std::ptrdiff_t>(countedTo_),
                 text_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
  countedTo_ = end;
  const auto joined = std::lower_bound(joined_.begin(), joined_.end(), end) - joined_.begin();
  return file_ + ":" + std::to_string(breaks_ + static_cast<std::uint64_t>(joined) + 1);
}

}  // namespace whit
