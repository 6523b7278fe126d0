// PLY files as models: vertices with normals and texture coordinates, faces of any number of
// corners. Errors name a line, and nothing is allocated that the file cannot fill.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/srgb.h"
#include "io/line_reader.h"
#include "io/model.h"
#include "io/polygon.h"
#include "io/read_file.h"

namespace whit {

namespace {

// The header (G. Turk, "The PLY Polygon File Format", 1994) says how the data after it is stored.

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;  // of each value of a list
  bool isList = false;
  PlyType countType = PlyType::uint8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  // Lower bound on the bytes of one element in the file: its lists are empty.
  std::uint64_t leastBytes(bool ascii) const;
  // Index of the property with this name, properties.size() if there is none.
  std::size_t find(std::string_view property) const;
};

struct PlyHeader {
  enum class Format { ascii, littleEndian, bigEndian };
  Format format = Format::ascii;
  std::vector<PlyElement> elements;
  std::size_t bytes = 0;    // where the data begins
  std::uint64_t lines = 0;  // of the header
};

constexpr std::uint64_t kLineLimit = 4096;
constexpr std::size_t kLineBytesLimit = 4096;

template <typename T>
double valueOf(const char* data, bool reversed) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), data, sizeof(T));
  if (reversed) std::reverse(bytes.begin(), bytes.end());
  return static_cast<double>(std::bit_cast<T>(bytes));
}

struct PlyTypeInfo {
  const char* name;
  const char* otherName;
  std::size_t bytes;
  double (*value)(const char* data, bool reversed);
};
constexpr std::array<PlyTypeInfo, 8> kTypes = {{{"char", "int8", 1, valueOf<std::int8_t>},
                                                {"uchar", "uint8", 1, valueOf<std::uint8_t>},
                                                {"short", "int16", 2, valueOf<std::int16_t>},
                                                {"ushort", "uint16", 2, valueOf<std::uint16_t>},
                                                {"int", "int32", 4, valueOf<std::int32_t>},
                                                {"uint", "uint32", 4, valueOf<std::uint32_t>},
                                                {"float", "float32", 4, valueOf<float>},
                                                {"double", "float64", 8, valueOf<double>}}};

const PlyTypeInfo& infoOf(PlyType type) { return kTypes[static_cast<std::size_t>(type)]; }

class HeaderReader {
 public:
  // `text` is the whole file.
  HeaderReader(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  // Throws badScene "file:line" where the file does not begin with a header, or where more elements
  // are named than fit into the data.
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

  // The words of the next line, which may end as on any system.
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
    for (std::size_t i = 0; i < kTypes.size(); ++i) {
      if (word == kTypes[i].name || word == kTypes[i].otherName) return static_cast<PlyType>(i);
    }
    fail("\"" + word + "\" is no type of a property");
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

std::uint64_t PlyElement::leastBytes(bool ascii) const {
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : properties) {
    bytes +=
        ascii ? 2 : infoOf(p.isList ? p.countType : p.type).bytes;  // at least a digit and a blank
  }
  return bytes;
}

std::size_t PlyElement::find(std::string_view property) const {
  std::size_t i = 0;
  while (i < properties.size() && properties[i].name != property) ++i;
  return i;
}

// The data after the header: one number after the other, as text or as bytes.
bool isPlySpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

class PlyData {
 public:
  // Reads `text`, the whole file, from the end of its header on.
  PlyData(const std::string& text, const PlyHeader& header, std::string file)
      : text_(text),
        file_(std::move(file)),
        format_(header.format),
        at_(header.bytes),
        line_(header.lines + 1) {}

  // Reads an element and calls use(number of the property, value) for each of its values. Throws
  // badScene with place() where a number is missing.
  template <typename Use>
  void read(const PlyElement& element, Use&& use) {
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      const std::uint64_t count = property.isList ? listLength(property) : 1;
      for (std::uint64_t i = 0; i < count; ++i) use(p, number(property.type));
    }
  }

  // "file:line", or "file" and the byte.
  std::string place() const {
    if (format_ == PlyHeader::Format::ascii) return file_ + ":" + std::to_string(line_);
    return file_ + ": byte " + std::to_string(at_);
  }

 private:
  double number(PlyType type) {
    return format_ == PlyHeader::Format::ascii ? textNumber() : binaryNumber(type);
  }

  double textNumber() {
    for (; at_ < text_.size() && isPlySpace(text_[at_]); ++at_) line_ += text_[at_] == '\n';
    double value = 0;
    const char* const end = text_.data() + text_.size();
    const char* const rest = parseNumber(text_.data() + at_, end, value);
    if (rest == nullptr || (rest != end && !isPlySpace(*rest))) {
      throwBadScene(place(), "expected a number");
    }
    at_ = static_cast<std::size_t>(rest - text_.data());
    return value;
  }

  double binaryNumber(PlyType type) {
    const std::size_t size = infoOf(type).bytes;
    if (text_.size() - at_ < size) {
      throwBadScene(place(), "expected a number, found the file's end");
    }
    const char* const data = text_.data() + at_;
    at_ += size;
    const bool little = format_ == PlyHeader::Format::littleEndian;
    return infoOf(type).value(data, little != (std::endian::native == std::endian::little));
  }

  std::uint64_t listLength(const PlyProperty& property) {
    const double length = number(property.countType);
    const std::size_t least = format_ == PlyHeader::Format::ascii ? 2 : infoOf(property.type).bytes;
    const std::size_t most = (text_.size() - at_ + 1) / least;
    if (!(length >= 0 && length <= static_cast<double>(most) && length == std::floor(length))) {
      throwBadScene(place(), "expected a list that fits into the rest of the file");
    }
    return static_cast<std::uint64_t>(length);
  }

  const std::string& text_;
  std::string file_;
  PlyHeader::Format format_;
  std::size_t at_;
  std::uint64_t line_;
};

// The components of a vertex.
enum Component { kX, kY, kZ, kNx, kNy, kNz, kU, kV, kR, kG, kB, kComponents };

Component componentOf(const std::string& name) {
  static const std::pair<const char*, Component> names[] = {{"x", kX},
                                                            {"y", kY},
                                                            {"z", kZ},
                                                            {"nx", kNx},
                                                            {"ny", kNy},
                                                            {"nz", kNz},
                                                            {"u", kU},
                                                            {"v", kV},
                                                            {"s", kU},
                                                            {"t", kV},
                                                            {"texture_u", kU},
                                                            {"texture_v", kV},
                                                            {"red", kR},
                                                            {"green", kG},
                                                            {"blue", kB},
                                                            {"diffuse_red", kR},
                                                            {"diffuse_green", kG},
                                                            {"diffuse_blue", kB}};
  for (const auto& [known, component] : names) {
    if (name == known) return component;
  }
  return kComponents;
}

double linearColor(double value, PlyType type) {
  const double largest = type == PlyType::uint8 || type == PlyType::int8     ? 255
                         : type == PlyType::uint16 || type == PlyType::int16 ? 65535
                         : type == PlyType::uint32 || type == PlyType::int32 ? 4294967295.0
                                                                             : 0;
  return largest > 0 ? srgbToLinear(value / largest) : value;
}

class PlyReader {
 public:
  PlyReader(const std::string& text, const std::string& file, MemoryBudget& budget,
            Warnings& warnings)
      : header_(HeaderReader(text, file).read()),
        data_(text, header_, file),
        file_(file),
        budget_(budget),
        warnings_(warnings) {
    // Each corner may become a triangle.
    const bool ascii = header_.format == PlyHeader::Format::ascii;
    budget.charge(text.size() / (ascii ? 2 : 1), sizeof(mesh_.triangles[0]), file);
  }

  // Faces in front of their vertices are skipped first, and read at the end.
  Mesh read() {
    std::vector<std::pair<const PlyElement*, PlyData>> early;
    std::uint64_t faces = 0;
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;
      const bool isFaces = element.name == "face" || element.name == "tristrips";
      if (isFaces) faces += element.count;
      if (element.name == "vertex") {
        readVertices(element);
      } else if (isFaces && !mesh_.positions.empty()) {
        readFaces(element, data_);
      } else {
        if (isFaces) early.emplace_back(&element, data_);
        for (std::uint64_t i = 0; i < element.count; ++i) {
          data_.read(element, [](std::size_t, double) {});
        }
        if (!isFaces && element.count > 0) {
          warnings_.add("elements of a kind that is not shown", file_);
        }
      }
    }
    for (auto& [element, data] : early) readFaces(*element, data);
    if (mesh_.triangles.empty()) {
      warnNothingToDraw(mesh_.positions.empty() ? "no vertices"
                        : faces == 0            ? "no faces"
                                                : "no face that can be built",
                        file_, warnings_);
    }
    return std::move(mesh_);
  }

 private:
  void readVertices(const PlyElement& element) {
    std::array<bool, kComponents> has{};
    std::vector<Component> components;
    for (const PlyProperty& property : element.properties) {
      components.push_back(property.isList ? kComponents : componentOf(property.name));
      if (components.back() != kComponents) has[components.back()] = true;
    }
    if (!has[kX] || !has[kY] || !has[kZ] || !mesh_.positions.empty()) {
      throwBadScene(file_, "expected one element \"vertex\" with x, y and z");
    }
    const bool normals = has[kNx] && has[kNy] && has[kNz], uvs = has[kU] && has[kV];
    const bool colors = has[kR] && has[kG] && has[kB];
    if (has[kR] && !colors) warnings_.add("vertex colors that lack a channel left out", file_);
    reserve(element.count, normals, uvs, colors);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const std::array<float, kComponents> v = readVertex(element, components);
      mesh_.positions.push_back({v[kX], v[kY], v[kZ]});
      if (normals) mesh_.normals.push_back({v[kNx], v[kNy], v[kNz]});
      if (uvs) mesh_.uvs.push_back({v[kU], v[kV]});
      if (colors) mesh_.colors.push_back({v[kR], v[kG], v[kB]});
    }
  }

  void reserve(std::uint64_t count, bool normals, bool uvs, bool colors) {
    if (count > std::numeric_limits<std::uint32_t>::max()) {
      throwLimit(file_ + " has more than 2^32 - 1 vertices");
    }
    budget_.charge(count, 2 * sizeof(Vec3f) + sizeof(Vec2f) + (colors ? sizeof(Rgb) : 0), file_);
    mesh_.positions.reserve(count);
    if (normals) mesh_.normals.reserve(count);
    if (uvs) mesh_.uvs.reserve(count);
    if (colors) mesh_.colors.reserve(count);
  }

  std::array<float, kComponents> readVertex(const PlyElement& element,
                                            const std::vector<Component>& components) {
    std::array<float, kComponents> values{};
    data_.read(element, [&](std::size_t p, double value) {
      if (components[p] == kComponents) return;
      if (components[p] >= kR) value = linearColor(value, element.properties[p].type);
      values[components[p]] = static_cast<float>(value);
    });
    return values;
  }

  void readFaces(const PlyElement& element, PlyData& data) {
    std::size_t corners = element.find("vertex_indices");
    if (corners == element.properties.size()) corners = element.find("vertex_index");
    if (corners == element.properties.size() || !element.properties[corners].isList) {
      throwBadScene(file_,
                    "expected a list \"vertex_indices\" in the element \"" + element.name + "\"");
    }
    warnAboutFaces(element);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      face_.clear();
      data.read(element, [&](std::size_t p, double value) {
        if (p == corners) face_.push_back(value);
      });
      if (element.name == "face") {
        addFace(data);
      } else {
        addStrips(data);
      }
    }
  }

  // Warns about properties of faces that are only read from vertices.
  void warnAboutFaces(const PlyElement& element) {
    constexpr std::pair<const char*, const char*> kLeftOut[] = {
        {"texcoord", "texture coordinates of a face's corners left out"},
        {"red", "colors of faces left out"}};
    for (const auto& [property, warning] : kLeftOut) {
      const bool there = element.find(property) < element.properties.size();
      if (there && element.count > 0) warnings_.add(warning, file_);
    }
  }

  // Returns false if there is no such vertex.
  bool addCorner(double corner) {
    const bool exists = corner >= 0 && corner < static_cast<double>(mesh_.positions.size());
    if (!exists || corner != std::floor(corner)) return false;
    numbers_.push_back(static_cast<std::uint32_t>(corner));
    return true;
  }

  // -1 ends a strip.
  void addStrips(const PlyData& data) {
    numbers_.clear();
    for (const double corner : face_) {
      if (addCorner(corner)) continue;
      if (corner != -1) {
        warnings_.add("rest of a strip behind a vertex index out of range dropped", data.place());
        break;
      }
      addStrip(numbers_, mesh_.triangles);
      numbers_.clear();
    }
    addStrip(numbers_, mesh_.triangles);
  }

  void addFace(const PlyData& data) {
    if (face_.size() < 3) {
      return warnings_.add("face with fewer than three corners dropped", data.place());
    }
    points_.clear();
    numbers_.clear();
    for (const double corner : face_) {
      if (!addCorner(corner)) {
        return warnings_.add("face with a vertex index out of range dropped", data.place());
      }
      points_.emplace_back(mesh_.positions[numbers_.back()]);
    }
    triangles_.clear();
    if (!triangulate(points_, triangles_)) {
      warnings_.add("polygon without a simple outline", data.place());
    }
    for (const auto& t : triangles_) {
      mesh_.triangles.push_back({numbers_[t[0]], numbers_[t[1]], numbers_[t[2]]});
    }
  }

  PlyHeader header_;
  PlyData data_;
  const std::string& file_;
  MemoryBudget& budget_;
  Warnings& warnings_;
  Mesh mesh_;
  std::vector<double> face_;
  std::vector<Vec3d> points_;
  std::vector<std::uint32_t> numbers_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

class PlyModel : public Model {
 public:
  // Reads the whole file. Elements other than vertex, face and tristrips are skipped; faces with
  // vertices out of range are counted. Integer colors of vertices are sRGB, as scanners and their
  // tools write them; others are linear.
  PlyModel(const std::filesystem::path& path, const PathRules& rules, MemoryBudget& budget,
           Warnings& warnings);

  // A gray one; white where vertices have colors.
  const std::vector<Material>& materials() const override { return materials_; }
  TexturedMaterial withMaps(std::size_t, Material material, const GivenMembers&,
                            TextureLoader&) override {
    return {std::move(material), {}};
  }
  Body content(SceneLayout& layout, const std::vector<std::uint32_t>& materials) override;

 private:
  std::string file_;
  MemoryBudget& budget_;
  std::vector<Material> materials_;
  std::vector<Mesh> meshes_;
};

PlyModel::PlyModel(const std::filesystem::path& path, const PathRules&, MemoryBudget& budget,
                   Warnings& warnings)
    : file_(path.string()), budget_(budget) {
  Material gray;
  gray.name = "default";
  gray.diffuse = Rgb(kModelGray);
  materials_.push_back(gray);
  const std::string text = readTextFile(path, budget.left());
  budget.charge(text.size(), 1, file_);
  Mesh mesh = PlyReader(text, file_, budget, warnings).read();
  if (mesh.triangles.empty()) return;
  if (!mesh.colors.empty()) materials_[0].diffuse = Rgb(1.0f);
  mesh.name = path.stem().string();
  mesh.materials = {0};
  meshes_.push_back(std::move(mesh));
}

Body PlyModel::content(SceneLayout&, const std::vector<std::uint32_t>& materials) {
  Body body;
  addParts(meshes_, materials, file_, budget_, body);
  return body;
}

}  // namespace

std::unique_ptr<Model> openPly(const std::filesystem::path& path, const PathRules& rules,
                               MemoryBudget& budget, Warnings& warnings, const Instant&) {
  return std::make_unique<PlyModel>(path, rules, budget, warnings);
}

}  // namespace whit
