// OBJ files: the text, checked before it is parsed.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace whit {

// The result of a scan of the whole text, before anything is allocated for it.
struct ObjSummary {
  struct Name {
    std::string text;
    std::uint64_t line = 0;
  };
  std::vector<Name> libraries;  // what follows each mtllib
  std::vector<Name> materials;  // of usemtl, each name once
  std::uint64_t positions = 0, normals = 0, uvs = 0, faces = 0, corners = 0;
  // The content that is left out, and the first line of each kind: colors of vertices; points,
  // lines, free forms.
  struct LeftOut {
    std::uint64_t count = 0, line = 0;
  };
  LeftOut colors, others;
  // Numbers of vertices, from 0, with a coordinate that is not finite ("nan", "1.#INF", 1e999).
  std::vector<std::uint64_t> nonFinitePositions, nonFiniteNormals, nonFiniteUvs;
};

class ObjText {
 public:
  // Repairs what OBJ writers differ in: lines continued by a backslash, bare carriage returns,
  // comments after faces. Throws badScene "file:line" where v, vn or vt lack numbers.
  ObjText(std::string text, std::string file);

  const ObjSummary& summary() const { return summary_; }
  std::string& text() { return text_; }
  const std::string& file() const { return file_; }
  // "file:line" of the line that ends before `offset`.
  std::string placeOf(std::uint64_t offset);

 private:
  void repairLineEnds();
  void readLine(std::size_t begin, std::size_t end);
  void readVertex(std::size_t begin, std::size_t end);
  void readFace(std::size_t begin, std::size_t end);
  void leaveOut(ObjSummary::LeftOut& what);
  std::string here() const { return file_ + ":" + std::to_string(line_); }

  std::string text_, file_;
  std::vector<std::uint64_t> joined_;  // offsets of line ends that became spaces
  std::uint64_t line_ = 1;
  std::size_t countedTo_ = 0;  // where placeOf() has counted to
  std::uint64_t breaks_ = 0;   // the lines that end before that
  std::set<std::string> seenMaterials_, seenLibraries_;
  ObjSummary summary_;
};

// Without blanks at either end.
std::string_view trimmed(std::string_view text);

}  // namespace whit
