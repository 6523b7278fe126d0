#include "io/obj/mtl_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string_view>

#include "core/error.h"

namespace whit {
namespace {

constexpr std::array<std::string_view, 4> kColors{"Kd", "Ks", "Ke", "Tf"};
constexpr std::array<std::string_view, 6> kScalars{"Ns", "Ni", "d", "Tr", "Pr", "Pm"};
constexpr std::array<std::string_view, 10> kMapStatements{"map_Kd",   "map_Ks", "map_Ke", "map_d",
                                                          "map_Bump", "bump",   "norm",   "map_Pr",
                                                          "map_Pm",   "map_Ns"};

bool sameWord(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  });
}

// The usual spelling of `word`, if it is in the list.
template <typename List>
std::optional<std::string> spelling(const List& list, const std::string& word) {
  for (const std::string_view known : list) {
    if (sameWord(known, word)) return std::string(known);
  }
  return std::nullopt;
}

std::optional<double> asNumber(const std::string& word) {
  char* rest = nullptr;
  const double value = std::strtod(word.c_str(), &rest);
  if (word.empty() || *rest != '\0' || !std::isfinite(static_cast<float>(value))) {
    return std::nullopt;
  }
  return value;
}

std::vector<std::string> wordsOf(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

class Normalizer {
 public:
  Normalizer(std::string file, Warnings& warnings) : file_(std::move(file)), warnings_(warnings) {}

  MtlText run(const std::string& text) {
    for (std::size_t begin = 0; begin < text.size(); ++line_) {
      const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
      statement(wordsOf(text.substr(begin, end - begin)), text.substr(begin, end - begin));
      const bool crlf = end + 1 < text.size() && text[end] == '\r' && text[end + 1] == '\n';
      begin = end + (crlf ? 2 : 1);
    }
    return std::move(result_);
  }

 private:
  std::string here() const { return file_ + ":" + std::to_string(line_); }

  void statement(const std::vector<std::string>& words, const std::string& line) {
    if (words.empty() || words[0][0] == '#') return;
    if (sameWord(words[0], "newmtl")) return newMaterial(line);
    if (result_.materials.empty()) return;
    const std::string word = sameWord(words[0], "Kt") ? "Tf" : words[0];
    if (const auto color = spelling(kColors, word)) return colorStatement(*color, words);
    if (const auto scalar = spelling(kScalars, word)) return scalarStatement(*scalar, words);
    if (sameWord(word, "illum")) return scalarStatement("illum", words);
    if (const auto map = spelling(kMapStatements, word)) return mapStatement(*map, words, line);
  }

  void newMaterial(const std::string& line) {
    const std::size_t word = line.find_first_not_of(" \t") + 6;  // behind "newmtl"
    const std::size_t begin = line.find_first_not_of(" \t", word);
    if (begin == std::string::npos) throwBadScene(here(), "expected a name after \"newmtl\"");
    const std::string name = line.substr(begin, line.find_last_not_of(" \t") + 1 - begin);
    if (result_.materials.size() >= kMaterialLimit) {
      throwLimit(here() + ": more than " + std::to_string(kMaterialLimit) + " materials");
    }
    result_.materials.push_back({name, here(), {}});
    result_.text += "newmtl " + name + "\n";
  }

  void emit(const std::string& keyword, const std::string& rest) {
    result_.materials.back().has.insert(keyword);
    result_.text += keyword + " " + rest + "\n";
  }

  void colorStatement(const std::string& keyword, const std::vector<std::string>& words) {
    if (words.size() > 1 && (words[1] == "spectral" || words[1] == "xyz")) {
      return warnings_.add("material color in a form that is not supported", here());
    }
    std::string numbers;
    for (std::size_t i = 1; i <= 3; ++i) {
      // The format lets g and b be left out: they are as r.
      const std::string& word = words.size() > i ? words[i] : words[words.size() > 1 ? 1 : 0];
      if (!asNumber(word)) throwBadScene(here(), "expected numbers after \"" + keyword + "\"");
      numbers += word + " ";
    }
    emit(keyword, numbers);
  }

  void scalarStatement(const std::string& keyword, const std::vector<std::string>& words) {
    const std::size_t at = words.size() > 2 && words[1] == "-halo" ? 2 : 1;
    if (words.size() <= at || !asNumber(words[at])) {
      throwBadScene(here(), "expected a number after \"" + keyword + "\"");
    }
    emit(keyword, words[at]);
  }

  // Options, then the file's name: everything to the end of the line, blanks and all.
  void mapStatement(const std::string& keyword, const std::vector<std::string>& words,
                    const std::string& line) {
    std::string options;
    std::size_t at = 1;
    while (at < words.size() && words[at].size() > 1 && words[at][0] == '-') {
      const std::string& option = words[at];
      const std::size_t most = option == "-s" || option == "-o" || option == "-t" ? 3
                               : option == "-mm"                                  ? 2
                                                                                  : 1;
      options += option + " ";
      std::size_t given = 0;
      for (++at; given < most && at < words.size(); ++given, ++at) {
        if (most > 1 && !asNumber(words[at])) break;
        options += words[at] + " ";
      }
      for (; given < most; ++given) options += option == "-s" ? "1 " : "0 ";
      if (option == "-s" || option == "-o" || option == "-t" || option == "-mm") {
        warnings_.add("texture option that is not supported", here());
      }
    }
    if (at >= words.size()) {
      throwBadScene(here(), "expected the name of a file after \"" + keyword + "\"");
    }
    emit(keyword, options + nameFrom(words, at, line));
  }

  // The part of the line from word number `at`, with the blanks between words as they are.
  static std::string nameFrom(const std::vector<std::string>& words, std::size_t at,
                              const std::string& line) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < at; ++i) begin = line.find(words[i], begin) + words[i].size();
    begin = line.find(words[at], begin);
    return line.substr(begin, line.find_last_not_of(" \t") + 1 - begin);
  }

  std::string file_;
  Warnings& warnings_;
  std::uint64_t line_ = 1;
  MtlText result_;
};

}  // namespace

MtlText normalizeMtl(const std::string& text, const std::string& file, Warnings& warnings) {
  return Normalizer(file, warnings).run(text);
}

}  // namespace whit
