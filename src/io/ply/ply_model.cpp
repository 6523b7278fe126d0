// PLY files (G. Turk, "The PLY Polygon File Format", 1994) as models: vertices with normals,
// texture coordinates and colors, faces of any number of corners with texture coordinates and
// colors of their own, triangle strips, pictures.
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
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/display.h"
#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "io/files.h"
#include "io/line_reader.h"
#include "io/model.h"
#include "io/polygon.h"
#include "io/smooth_normals.h"
#include "scene/origin.h"

namespace whit {

namespace {

template <typename T>
double valueOf(const char* data, bool reversed) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), data, sizeof(T));
  if (reversed) std::ranges::reverse(bytes);
  return static_cast<double>(std::bit_cast<T>(bytes));
}

struct PlyType {
  const char* name;
  const char* otherName;
  std::size_t bytes;
  double (*value)(const char* data, bool reversed);
  double white;  // the sRGB code of 1; colors of types where it is 0 are linear
};
constexpr PlyType kTypes[] = {{"char", "int8", 1, valueOf<std::int8_t>, 255},
                              {"uchar", "uint8", 1, valueOf<std::uint8_t>, 255},
                              {"short", "int16", 2, valueOf<std::int16_t>, 65535},
                              {"ushort", "uint16", 2, valueOf<std::uint16_t>, 65535},
                              {"int", "int32", 4, valueOf<std::int32_t>, 4294967295.0},
                              {"uint", "uint32", 4, valueOf<std::uint32_t>, 4294967295.0},
                              {"float", "float32", 4, valueOf<float>, 0},
                              {"double", "float64", 8, valueOf<double>, 0}};

struct PlyProperty {
  std::string name;
  const PlyType* type;
  const PlyType* countType;  // type of a list's count, else null
};

struct PlyElement {
  std::string name;
  std::uint64_t count;
  std::string where;  // file:line of its declaration
  std::vector<PlyProperty> properties;

  const PlyProperty* find(std::string_view property) const {
    const auto found = std::ranges::find(properties, property, &PlyProperty::name);
    return found == properties.end() ? nullptr : &*found;
  }
  // Returns the property that holds the corners of faces or strips.
  const PlyProperty* corners() const {
    const PlyProperty* const found = find("vertex_indices");
    return found ? found : find("vertex_index");
  }
};

enum Component { kX, kY, kZ, kNx, kNy, kNz, kU, kV, kR, kG, kB, kAlpha, kComponents };
constexpr std::array<std::string_view, 3> kComponentNames[kComponents] = {
    {"x"},
    {"y"},
    {"z"},
    {"nx"},
    {"ny"},
    {"nz"},
    {"u", "s", "texture_u"},
    {"v", "t", "texture_v"},
    {"red", "diffuse_red", "r"},
    {"green", "diffuse_green", "g"},
    {"blue", "diffuse_blue", "b"},
    {"alpha", "diffuse_alpha", "a"}};

// Returns the component that a property holds, or kComponents if it holds none.
Component componentOf(const PlyProperty& property) {
  int component = property.countType ? int{kComponents} : 0;
  while (component < kComponents && !contains(kComponentNames[component], property.name)) {
    ++component;
  }
  return static_cast<Component>(component);
}

// A picture that the header names.
struct PlyPicture {
  std::string name, where;
};

// Returns the value of a component. Colors of integer types are sRGB codes, which become linear.
float valueOf(const PlyProperty& property, Component component, double value) {
  const double white = component >= kR && component <= kAlpha ? property.type->white : 0;
  if (white > 0) value /= white;
  const bool isCode = white > 0 && component != kAlpha;
  return static_cast<float>(isCode ? srgbToLinear(value) : value);
}

// A face with its corners, texture coordinates and color.
struct PlyFace {
  std::vector<double> corners, coordinates;  // coordinates u and v of each corner
  std::array<float, kComponents + 1> values{};
  double picture = 0;
};

// Reads a file. It allocates nothing that the file cannot fill. Elements other than vertex, face
// and tristrips are skipped; faces with vertices out of range are counted in the warnings.
class PlyReader {
 public:
  PlyReader(const std::string& text, const std::string& file, MemoryBudget& budget,
            Warnings& warnings)
      : text_(text), file_(file), lines_(text, file), budget_(budget), warnings_(warnings) {}

  Mesh read() {
    readHeader();
    // Each corner may become a triangle.
    budget_.charge(text_.size() / (ascii_ ? 2 : 1), sizeof(mesh_.triangles[0]), file_);

    std::uint64_t faces = 0;
    for (const PlyElement& element : elements_) {
      if (element.properties.empty()) continue;
      if (element.name == "vertex") {
        readVertices(element);
      } else if (element.name == "face" || element.name == "tristrips") {
        faces += element.count;
        readFaces(element);
      } else if (element.count > 0) {
        for (std::uint64_t i = 0; i < element.count; ++i) {
          readElement(element, [](const PlyProperty&, double) {});
        }
        warnings_.add("elements of a kind that is not shown", file_);
      }
    }

    if (mesh_.triangles.empty()) {
      const char* const why = faces == 0 ? "no faces" : "no face that can be built";
      warnNothingToDraw(mesh_.positions.empty() ? "no vertices" : why, file_, warnings_);
    }

    if (mesh_.materials.empty()) mesh_.materials = {0};
    return std::move(mesh_);
  }

  std::vector<PlyPicture> pictures;
  Vec3d origin;  // subtracted from all vertices, see originOf()

 private:
  // Returns "file:line", or "file: byte N" in binary data.
  std::string place() const {
    if (ascii_) return lines_.place();
    return concat(file_, ": byte ", at_);
  }
  [[noreturn]] void failInHeader(const std::string& what) const {
    throwBadScene(lines_.place(), what);
  }

  void readHeader() {
    if (nextWords() != std::vector<std::string>{"ply"}) failInHeader("expected a line \"ply\"");

    bool hasFormat = false;
    for (;;) {
      lines_.nextLine();
      if (LineReader line = lines_; line.word() == "comment" && line.word() == "TextureFile") {
        pictures.push_back({std::string(line.rest()), lines_.place()});
      }

      const std::vector<std::string> words = nextWords();
      const std::string keyword = words.empty() ? "" : words[0];
      if (keyword == "end_header") break;

      if (keyword == "format") {
        readFormat(words);
        hasFormat = true;
      } else if (keyword == "element") {
        addElement(words);
      } else if (keyword == "property") {
        addProperty(words);
      } else if (!words.empty() && keyword != "comment" && keyword != "obj_info") {
        failInHeader("expected \"format\", \"element\", \"property\" or \"end_header\"");
      }
    }

    if (!hasFormat) failInHeader("expected a line \"format\" before the header's end");
    lines_.nextLine();
    at_ = lines_.at();
    for (const PlyElement& element : elements_) checkCount(element);
  }

  std::vector<std::string> nextWords() {
    if (lines_.done()) failInHeader("expected a line of a PLY header");
    std::vector<std::string> words;
    for (std::string_view word; !(word = lines_.word()).empty();) words.emplace_back(word);
    return words;
  }

  void readFormat(const std::vector<std::string>& words) {
    const bool known = words.size() == 3 && words[2] == "1.0";
    ascii_ = known && words[1] == "ascii";
    const bool little = known && words[1] == "binary_little_endian";
    if (!ascii_ && !little && !(known && words[1] == "binary_big_endian")) {
      failInHeader("expected ascii, binary_little_endian or binary_big_endian, and 1.0");
    }
    reversed_ = little != (std::endian::native == std::endian::little);
  }

  void addElement(const std::vector<std::string>& words) {
    std::uint64_t count = 0;
    const char* const end = words.back().data() + words.back().size();
    const auto [rest, error] = std::from_chars(words.back().data(), end, count);
    if (words.size() != 3 || error != std::errc() || rest != end) {
      failInHeader("expected the name of an element and how many there are");
    }
    elements_.push_back({words[1], count, lines_.place(), {}});
  }

  const PlyType& typeOf(const std::string& word) const {
    const auto* const found = std::ranges::find_if(
        kTypes, [&](const PlyType& type) { return word == type.name || word == type.otherName; });
    if (found == std::end(kTypes)) {
      failInHeader("\"" + excerpt(word) + "\" is no type of a property");
    }
    return *found;
  }

  void addProperty(const std::vector<std::string>& words) {
    if (elements_.empty()) failInHeader("expected an element before its properties");
    const bool isList = words.size() == 5 && words[1] == "list";
    if (!isList && words.size() != 3) {
      failInHeader("expected \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"");
    }
    const PlyType* const countType = isList ? &typeOf(words[2]) : nullptr;
    if (isList && countType->white == 0) failInHeader("expected a whole type for a list's length");
    elements_.back().properties.push_back(
        {words.back(), &typeOf(words[words.size() - 2]), countType});
  }

  // Each element takes at least a byte.
  void checkCount(const PlyElement& element) const {
    const std::uint64_t left = text_.size() - at_;
    if (element.properties.empty() || element.count <= left) return;
    throwBadScene(element.where,
                  concat("expected at most ", left, " elements \"", excerpt(element.name),
                         "\", as many as there are bytes after the header, found ", element.count));
  }

  // Calls use(property, value) for each value of an element.
  template <typename Use>
  void readElement(const PlyElement& element, Use&& use) {
    for (const PlyProperty& property : element.properties) {
      const std::uint64_t count = property.countType ? listLength(property) : 1;
      for (std::uint64_t i = 0; i < count; ++i) use(property, number(*property.type));
    }

    // In text each element begins a line. MeshLab writes colors of corners without a property.
    if (!ascii_ || !lines_.hasMore()) return;
    if (!looksAhead_) {
      warnings_.add("values that no property of the header names left out", place());
    }
    lines_.rest();
  }

  double number(const PlyType& type) {
    if (ascii_) return textNumber();
    if (text_.size() - at_ < type.bytes) {
      throwBadScene(place(), "expected a number, found the file's end");
    }
    at_ += type.bytes;
    return type.value(text_.data() + at_ - type.bytes, reversed_);
  }

  double textNumber() {
    double value = 0;
    while (!lines_.number(value)) {
      // Some programs write comments between the elements.
      LineReader line = lines_;
      const bool isSkipped = !line.hasMore() || line.word() == "comment";
      if (lines_.done() || !isSkipped) throwBadScene(place(), "expected a number");
      lines_.nextLine();
    }
    return value;
  }

  std::uint64_t listLength(const PlyProperty& property) {
    const double length = number(*property.countType);
    const auto most = static_cast<double>(text_.size());
    if (!(length >= 0 && length <= most && length == std::floor(length))) {
      throwBadScene(place(), "expected a list that fits into the file");
    }
    return static_cast<std::uint64_t>(length);
  }

  void readVertices(const PlyElement& element) {
    std::array<bool, kComponents + 1> has{};
    std::vector<Component> components;
    for (const PlyProperty& property : element.properties) {
      const Component component = components.emplace_back(componentOf(property));
      has[component] = true;
      if (component == kComponents) nameUnread(element, property);
    }

    if (!has[kX] || !has[kY] || !has[kZ] || !mesh_.positions.empty()) {
      throwBadScene(element.where, "expected one element \"vertex\" with x, y and z");
    }
    if (element.count > std::numeric_limits<std::uint32_t>::max()) {
      throwLimit(element.where + ": more than 2^32 - 1 vertices");
    }

    const bool normals = has[kNx] && has[kNy] && has[kNz], uvs = has[kU] && has[kV];
    const bool colors = has[kR] && has[kG] && has[kB];
    if (has[kR] && !colors) warnings_.add("vertex colors that lack a channel left out", file_);
    bool isTranslucent = false;

    budget_.charge(element.count,
                   sizeof(Vec3d) + 2 * sizeof(Vec3f) + sizeof(Vec2f) + (colors ? sizeof(Rgb) : 0),
                   file_);
    vertices_ = element.count;

    std::vector<Vec3d> positions(element.count);
    if (normals) mesh_.normals.resize(element.count);
    if (uvs) mesh_.uvs.resize(element.count);
    if (colors) mesh_.colors.resize(element.count);
    std::array<float, kComponents + 1> v{};

    for (const auto i : indices(element.count)) {
      readElement(element, [&](const PlyProperty& property, double value) {
        const Component to = components[&property - element.properties.data()];
        v[to] = valueOf(property, to, value);
        if (to <= kZ) positions[i][to] = value;
      });

      isTranslucent = isTranslucent || (has[kAlpha] && v[kAlpha] < 1);
      if (normals) mesh_.normals[i] = {v[kNx], v[kNy], v[kNz]};
      if (uvs) mesh_.uvs[i] = {v[kU], v[kV]};
      if (colors) mesh_.colors[i] = {v[kR], v[kG], v[kB]};
    }

    // Positions are rounded after the origin of a far model was subtracted.
    origin = originOf(boxOfFaces(element, positions));
    mesh_.positions.reserve(element.count);
    for (const Vec3d& position : positions) mesh_.positions.emplace_back(position - origin);

    if (isTranslucent) warnings_.add("alpha of vertex colors left out", file_);
  }

  // Returns the box of the vertices that faces use, because others are no part of the model. The
  // search ends once that box is as large as it is far away, because such a box stays near however
  // it grows.
  BoxOf<Vec3d> boxOfFaces(const PlyElement& vertices, const std::vector<Vec3d>& positions) {
    const LineReader lines = lines_;
    const std::size_t at = at_;
    looksAhead_ = true;

    BoxOf<Vec3d> box;
    const auto isNear = [&] { return !box.empty() && length(box.center()) < box.diagonal(); };
    for (const PlyElement& element : elements_) {
      if (&element <= &vertices || element.properties.empty()) continue;
      const PlyProperty* const corners = element.corners();
      for (std::uint64_t i = 0; i < element.count && !isNear(); ++i) {
        readElement(element, [&](const PlyProperty& property, double value) {
          if (&property == corners && isVertex(value)) {
            box.add(positions[static_cast<std::size_t>(value)]);
          }
        });
      }
    }

    // The faces are read after this.
    lines_.goTo(lines);
    at_ = at;
    looksAhead_ = false;
    return box;
  }

  // Notes a property that is not read. Often such a property would not be visible anyway.
  void nameUnread(const PlyElement& element, const PlyProperty& property) {
    warnings_.note("property of PLY that is not read: " + excerpt(property.name),
                   file_ + ": element " + excerpt(element.name));
  }

  void readFaces(const PlyElement& element) {
    const PlyProperty* const corners = element.corners();
    if (!corners || !corners->countType) {
      throwBadScene(element.where,
                    "expected a list \"vertex_indices\" in the element \"" + element.name + "\"");
    }
    if (element.count > 0 && mesh_.positions.empty()) {
      throwBadScene(element.where,
                    "expected the vertices before the element \"" + element.name + "\"");
    }

    const bool areFaces = element.name == "face";
    const PlyProperty* const coordinates = areFaces ? element.find("texcoord") : nullptr;
    const PlyProperty* const picture = areFaces ? element.find("texnumber") : nullptr;
    hasFaceCoordinates_ = coordinates && coordinates->countType;
    const bool isColored = startFaceColors(element, areFaces);
    if (hasFaceCoordinates_) mesh_.uvs.resize(mesh_.positions.size());

    PlyFace face;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      face.corners.clear();
      face.coordinates.clear();
      readElement(element, [&](const PlyProperty& property, double value) {
        if (&property == corners) face.corners.push_back(value);
        if (&property == coordinates) face.coordinates.push_back(value);
        if (&property == picture) face.picture = value;
        if (!isColored || property.countType) return;
        const Component component = componentOf(property);
        face.values[component] = valueOf(property, component, value);
      });

      if (areFaces) {
        addFace(face);
      } else {
        addStrips(face.corners);
      }
    }
  }

  // Returns true if faces have colors that are shown: those of vertices come first, unless all
  // vertices have one gray, as programs write it that color faces.
  bool startFaceColors(const PlyElement& element, bool areFaces) {
    std::array<bool, kComponents + 1> has{};
    for (const PlyProperty& property : element.properties) {
      const Component component = componentOf(property);
      const std::string& name = property.name;
      const bool isKnown = name == "vertex_indices" || name == "vertex_index" ||
                           name == "texcoord" || name == "texnumber";
      has[component] = true;
      if (!isKnown && (component < kR || component > kB)) nameUnread(element, property);
    }

    const bool isColored = has[kR] && has[kG] && has[kB];
    const bool areGray = std::ranges::all_of(mesh_.colors, [&](const Rgb& color) {
      return color == Rgb(color.x) && color == mesh_.colors[0];
    });
    hasFaceColors_ = isColored && areFaces && areGray;
    if (hasFaceColors_) mesh_.colors.resize(mesh_.positions.size(), Rgb(1.0f));
    if (has[kR] && !hasFaceColors_) {
      warnings_.add(isColored ? "colors of faces left out, because vertices have colors"
                              : "colors of faces that lack a channel left out",
                    file_);
    }
    return hasFaceColors_;
  }

  // Gives the face vertices of its own where it has coordinates or a color.
  void takeOwnVertices(const PlyFace& face) {
    const bool mapped = hasFaceCoordinates_ && face.coordinates.size() == 2 * numbers_.size();
    if (hasFaceCoordinates_ && !mapped) {
      warnings_.add("face without a texture coordinate for each corner", place());
    }
    if (!mapped && !hasFaceColors_) return;
    for (const auto i : indices(numbers_)) {
      budget_.charge(1, 2 * sizeof(Vec3f) + sizeof(Vec2f) + sizeof(Rgb), file_);
      const std::uint32_t old = numbers_[i];
      numbers_[i] = size32(mesh_.positions);
      appendCopy(old, mesh_);

      if (hasFaceColors_) {
        mesh_.colors.back() = {face.values[kR], face.values[kG], face.values[kB]};
      }
      if (mapped) {
        mesh_.uvs.back() = {static_cast<float>(face.coordinates[2 * i]),
                            static_cast<float>(face.coordinates[2 * i + 1])};
      }
    }
  }

  // Returns the number of the face's picture, or the first one if there is no such picture.
  std::uint32_t pictureOf(const PlyFace& face) {
    const bool exists = face.picture >= 0 && face.picture < static_cast<double>(pictures.size());
    if (!exists && face.picture != 0) {
      warnings_.add("face with the number of a picture that is not there", place());
    }
    return exists ? static_cast<std::uint32_t>(face.picture) : 0;
  }

  bool isVertex(double corner) const {
    return corner >= 0 && corner < static_cast<double>(vertices_) && corner == std::floor(corner);
  }

  // Adds a vertex to numbers_. Returns false if there is no such vertex.
  bool addCorner(double corner) {
    if (!isVertex(corner)) return false;
    numbers_.push_back(static_cast<std::uint32_t>(corner));
    return true;
  }

  // Adds the triangles of one or more strips; the index -1 ends a strip.
  void addStrips(const std::vector<double>& corners) {
    numbers_.clear();
    for (const double corner : corners) {
      if (addCorner(corner)) continue;
      if (corner != -1) {
        warnings_.add("rest of a strip behind a vertex index out of range dropped", place());
        break;
      }
      addStrip(numbers_, mesh_.triangles);
      numbers_.clear();
    }
    addStrip(numbers_, mesh_.triangles);
    if (pictures.size() > 1) mesh_.materials.resize(mesh_.triangles.size());
  }

  void addFace(const PlyFace& face) {
    if (face.corners.size() < 3) {
      warnings_.add("face with fewer than three corners dropped", place());
      return;
    }

    points_.clear();
    numbers_.clear();
    for (const double corner : face.corners) {
      if (!addCorner(corner)) {
        warnings_.add("face with a vertex index out of range dropped", place());
        return;
      }
      points_.emplace_back(mesh_.positions[numbers_.back()]);
    }
    takeOwnVertices(face);

    triangles_.clear();
    if (!triangulate(points_, triangles_)) {
      warnings_.add("polygon without a simple outline", place());
    }
    for (const auto& t : triangles_) {
      mesh_.triangles.push_back({numbers_[t[0]], numbers_[t[1]], numbers_[t[2]]});
      if (pictures.size() > 1) mesh_.materials.push_back(pictureOf(face));
    }
  }

  const std::string& text_;
  const std::string& file_;
  LineReader lines_;  // the header, and the data where it is text
  MemoryBudget& budget_;
  Warnings& warnings_;
  bool ascii_ = false, reversed_ = false;
  bool looksAhead_ = false;  // elements are read that are read again
  std::vector<PlyElement> elements_;
  std::size_t at_ = 0;  // position in binary data
  Mesh mesh_;
  std::uint64_t vertices_ = 0;  // number of the file's vertices; those that faces get follow
  bool hasFaceColors_ = false, hasFaceCoordinates_ = false;
  // The face that is being added.
  std::vector<Vec3d> points_;
  std::vector<std::uint32_t> numbers_;
  std::vector<CornerTriple> triangles_;
};

class PlyModel : public MeshModel {
 public:
  // Makes a white material for each picture, or else a single one, which is white if there are
  // colors and otherwise gray.
  explicit PlyModel(const ModelSource& source) : MeshModel(source) {
    const std::string text = readTextFile(source.path, source.budget.left());
    const std::string file = source.path.string();
    source.budget.charge(text.size(), 1, file);

    PlyReader reader(text, file, source.budget, source.warnings);
    mesh_ = reader.read();
    origin_ = reader.origin;
    if (mesh_.normals.empty()) smoothNormals(mesh_, file, source.budget);
    mesh_.name = source.path.stem().string();

    for (const PlyPicture& picture : reader.pictures) pictures_.push_back(sourceOf(picture));

    const bool isPictured = std::ranges::any_of(
        pictures_, [](const TextureSource& picture) { return !picture.path.empty(); });
    if (isPictured && mesh_.uvs.empty()) {
      source.warnings.add("pictures without texture coordinates left out", file);
      pictures_.clear();
    } else if (isPictured && !mesh_.colors.empty()) {
      // Programs that make pictures leave the colors of the scan beside them.
      source.warnings.add("colors left out, because the file has pictures", file);
      mesh_.colors.clear();
    }

    if (pictures_.empty()) pictures_.emplace_back();
    for (const TextureSource& picture : pictures_) {
      Material& material = materials_.emplace_back();
      material.name = picture.path.empty()
                          ? kNoMaterialName
                          : std::filesystem::path(picture.path).filename().string();
      const bool isWhite = !picture.path.empty() || !mesh_.colors.empty();
      material.diffuse = Rgb(isWhite ? 1.0f : kModelGray);
    }

    if (pictures_.size() == 1) mesh_.materials = {0};
  }

  TexturedMaterial withMaps(std::size_t i, Material material, const GivenMembers& given,
                            TextureLoader& textures) override {
    if (!pictures_[i].path.empty() && !given.contains("diffuseMap")) {
      material.diffuseMap = textures.add(pictures_[i], {TextureUse::color})[0];
    }
    return {std::move(material), {}};
  }

 private:
  // Returns the texture of a picture. It has no path if there is no such file.
  TextureSource sourceOf(const PlyPicture& picture) const {
    TextureSource found;
    found.where = picture.where;
    found.lenient = true;
    try {
      const auto path = source_.rules.find(picture.name, source_.path.parent_path(), picture.where,
                                           source_.warnings);
      std::error_code error;
      if (std::filesystem::exists(path, error)) {
        found.path = path.string();
      } else {
        source_.warnings.add("texture left out", picture.where + ": no file " + path.string());
      }
    } catch (const Error& error) {
      source_.warnings.add("texture left out", error.what());
    }
    return found;
  }

  std::vector<TextureSource> pictures_;  // pictures of materials_
};

}  // namespace

std::unique_ptr<Model> openPly(const ModelSource& source) {
  return std::make_unique<PlyModel>(source);
}

}  // namespace whit
