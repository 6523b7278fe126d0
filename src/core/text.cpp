#include "core/text.h"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/edit_distance.h"
#include "core/error.h"
#include "core/index.h"

namespace whit {

namespace {

// The length in bytes of the character at `at`; 0 if it must not be printed as it is.
std::size_t printableBytes(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(at);

  // ASCII characters, except for control characters, are printable.
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;

  // The first byte of a UTF-8 sequence gives its length and bounds the second byte, so that each
  // character has one spelling (RFC 3629, section 4). U+0080 to U+009F are control characters.
  struct Form {
    unsigned first, last, lowest, highest;
    std::size_t length;
  };
  constexpr Form kForms[] = {
      {0xc2, 0xc2, 0xa0, 0xbf, 2}, {0xc3, 0xdf, 0x80, 0xbf, 2}, {0xe0, 0xe0, 0xa0, 0xbf, 3},
      {0xe1, 0xec, 0x80, 0xbf, 3}, {0xed, 0xed, 0x80, 0x9f, 3}, {0xee, 0xef, 0x80, 0xbf, 3},
      {0xf0, 0xf0, 0x90, 0xbf, 4}, {0xf1, 0xf3, 0x80, 0xbf, 4}, {0xf4, 0xf4, 0x80, 0x8f, 4}};
  const Form* const form = std::ranges::find_if(
      kForms, [&](const Form& f) { return first >= f.first && first <= f.last; });
  if (form == std::end(kForms) || at + form->length > text.size()) return 0;
  if (byte(at + 1) < form->lowest || byte(at + 1) > form->highest) return 0;

  // The other bytes of a sequence have the form 10xxxxxx.
  for (std::size_t i = at + 2; i < at + form->length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  return form->length;
}

// Options of other programs and of former versions, and their names here. A name may be followed by
// the value that has the same effect.
constexpr std::pair<std::string_view, std::string_view> kSynonyms[] = {
    {"aa", "spp"},
    {"alpha", "background transparent"},
    {"ao", "ambient-samples"},
    {"avx512", "avx3"},
    {"background-color", "background"},
    {"bg", "background"},
    {"bgcolor", "background"},
    {"bounces", "depth"},
    {"cores", "threads"},
    {"env", "sky"},
    {"environment", "sky"},
    {"envmap", "sky"},
    {"from", "eye"},
    {"gamma", "tonemap"},
    {"gi", "indirect"},
    {"hdr", "sky"},
    {"hdri", "sky"},
    {"height", "size"},
    {"host", "bind"},
    {"j", "threads"},
    {"look-at", "at"},
    {"lookat", "at"},
    {"lookfrom", "eye"},
    {"max-depth", "depth"},
    {"no-shadows", "disable shadows"},
    {"O", "output"},
    {"out", "output"},
    {"position", "eye"},
    {"q", "quality"},
    {"range", "frames"},
    {"ray-depth", "depth"},
    {"reference", "mode"},
    {"res", "size"},
    {"resolution", "size"},
    {"runs", "frames"},
    {"s", "spp"},
    {"samples", "spp"},
    {"seconds", "budget"},
    {"skybox", "sky"},
    {"transparent", "background transparent"},
    {"v", "stats"},
    {"verbose", "stats"},
    {"w", "size"},
    {"widht", "size"},
    {"width", "size"},
    {"fine", "good"}};

}  // namespace

std::string quoted(const std::string& word) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/%@";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;

  // Between single quotes a shell takes every character as it is, except for the single quote.
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string printable(const std::string& text) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string result;

  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = printableBytes(text, at);
    if (length == 0) {
      // The byte is written as a hexadecimal escape, so that it cannot control the terminal.
      const auto byte = static_cast<unsigned char>(text[at]);
      result += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
    } else {
      result += text.substr(at, length);
    }

    at += std::max<std::size_t>(length, 1);
  }

  return result;
}

std::string nearestName(const std::string& word, const std::vector<std::string>& names) {
  const std::size_t dashes = std::min(word.find_first_not_of('-'), word.size());

  // A known synonym of another program is a better guess than any similar name.
  for (const auto& [theirs, ours] : kSynonyms) {
    std::string name = (dashes > 0 ? "--" : "") + std::string(ours);
    const bool isKnown = contains(names, name.substr(0, name.find(' ')));
    if (isKnown && word.compare(dashes, std::string::npos, theirs) == 0) return name;
  }

  // The beginning of a single name stands for it.
  constexpr std::size_t kClearBeginning = 3;  // letters
  const auto beginsSo = [&](const std::string& name) { return name.starts_with(word); };
  if (word.size() >= dashes + kClearBeginning && std::ranges::count_if(names, beginsSo) == 1) {
    return *std::ranges::find_if(names, beginsSo);
  }

  // Otherwise the name with the fewest edits is taken, at most about a third of the letters.
  std::string nearest;
  const std::size_t letters = word.size() - dashes;
  std::size_t least = std::min(std::max<std::size_t>(1, (letters + 1) / 3) + 1, letters);

  for (const std::string& name : names) {
    const std::size_t edits = editDistance(word, name);
    if (edits >= least) continue;
    least = edits;
    nearest = name;
  }

  return nearest;
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& names,
                       const std::string& kind) {
  const std::string nearest = nearestName(word, names);
  if (!nearest.empty()) return "; did you mean '" + nearest + "'?";
  if (kind.empty() || names.empty()) return "";

  return "; every " + kind + " there is: " + joined(names);
}

std::string joined(const std::vector<std::string>& names, const std::string& separator) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : separator) + name;
  return all;
}

std::string counted(std::uint64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::vector<std::size_t> indicesOf(const std::string& commaSeparated,
                                   const std::vector<std::string>& names, const std::string& kind) {
  std::vector<std::size_t> indices;
  std::istringstream in(commaSeparated);

  for (std::string word; std::getline(in, word, ',');) {
    if (word.empty()) continue;

    const auto found = std::ranges::find(names, word);
    if (found == names.end()) {
      throwUsage("no " + kind + " is called '" + word + "'" + didYouMean(word, names, kind));
    }

    indices.push_back(static_cast<std::size_t>(found - names.begin()));
  }

  return indices;
}

std::vector<std::string> distinctNames(const std::vector<std::string>& names) {
  std::set<std::string> taken(names.begin(), names.end());
  std::map<std::string, int> uses;
  std::vector<std::string> distinct;

  for (const std::string& given : names) {
    std::string name = given;
    int& use = uses[given];
    // The first use keeps the name; later ones count up to a number that makes a free name.
    while (++use > 1 && !taken.insert(name = given + "#" + std::to_string(use)).second) {
    }

    distinct.push_back(name);
  }

  return distinct;
}

}  // namespace whit
