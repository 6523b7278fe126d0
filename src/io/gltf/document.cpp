#include "io/gltf/document.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "io/gltf/faults.h"
#include "io/gltf/schema.h"
#include "io/read_file.h"
#include "io/scene/json_text.h"
#include "io/uri.h"

namespace whit {

// The container of glTF files: JSON text, or JSON and a binary chunk in a .glb file. glTF 2.0
// specification, section 4 (GLB).
struct GltfFile {    // NOLINT(bugprone-exception-escape): moving Json does not throw
  std::string name;  // for errors
  Json json;         // an object
  bool hasBinary = false;
  std::string binary;               // the chunk of a .glb
  std::vector<std::string> faults;  // of the container
};

namespace {

constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
constexpr char kUnalignedChunk[] = "a chunk whose length is no multiple of 4";
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
// What a value takes at most once parsed: a member of an object with its name.
constexpr std::uint64_t kBytesPerJsonValue = 128;

std::uint32_t wordAt(std::string_view bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

// Takes a chunk off the front of `rest`.
std::string_view takeChunk(std::string_view& rest, std::uint32_t& type, const std::string& file) {
  if (rest.size() < kChunkHeaderBytes) throwBadScene(file, "the file ends within a chunk's header");
  const std::uint64_t length = wordAt(rest, 0);
  type = wordAt(rest, 4);
  rest.remove_prefix(kChunkHeaderBytes);
  if (length > rest.size()) {
    throwBadScene(file, "a chunk of " + std::to_string(length) + " bytes, of which " +
                            std::to_string(rest.size()) + " are there");
  }
  const std::string_view chunk = rest.substr(0, length);
  rest.remove_prefix(length);
  return chunk;
}

// The JSON text; the binary chunk goes to `to`.
std::string_view splitBinary(std::string_view bytes, GltfFile& to) {
  if (bytes.size() < kHeaderBytes) throwBadScene(to.name, "the file ends within its header");
  const std::uint32_t version = wordAt(bytes, 4), length = wordAt(bytes, 8);
  if (version != 2) {
    throwBadScene(to.name, "expected glTF 2.0, found glTF " + std::to_string(version) + ".0");
  }
  if (length < kHeaderBytes || length > bytes.size()) {
    throwBadScene(to.name, "its header says " + std::to_string(length) + " bytes, the file has " +
                               std::to_string(bytes.size()));
  }
  std::string_view rest = bytes.substr(kHeaderBytes, length - kHeaderBytes);
  std::uint32_t type = 0;
  const std::string_view text = takeChunk(rest, type, to.name);
  if (type != kJsonChunk) throwBadScene(to.name, "expected JSON in the first chunk");
  if (text.size() % 4 != 0) to.faults.emplace_back(kUnalignedChunk);
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::string_view chunk = takeChunk(rest, type, to.name);
    if (chunk.size() % 4 != 0) to.faults.emplace_back(kUnalignedChunk);
    if (type == kJsonChunk || (type == kBinaryChunk && number > 1)) {
      to.faults.emplace_back("a chunk that is there twice or at another place than it has to be");
    }
    if (type != kBinaryChunk || to.hasBinary) continue;  // others are an extension's
    if (chunk.empty() && number > 1) to.faults.emplace_back("an empty chunk");
    to.hasBinary = true;
    to.binary = chunk;
  }
  return text;
}

// Where the first version has objects the second has lists; its files may not name it.
void refuseFirstVersion(const GltfFile& file) {
  const auto asset = file.json.find("asset");
  const bool named = asset != file.json.end() && asset->is_object() && asset->contains("version");
  const std::string version = named ? (*asset)["version"].dump() : "";
  const auto meshes = file.json.find("meshes");
  const bool unnamed = !named && meshes != file.json.end() && meshes->is_object();
  if (!unnamed && !version.starts_with("\"1.") && !version.starts_with("1.")) return;
  throwBadScene(file.name + "#/asset", "expected glTF 2.0, found glTF 1.0");
}

// Told by its content.
GltfFile readGltfFile(const std::filesystem::path& path, MemoryBudget& budget) {
  GltfFile file;
  file.name = path.string();
  const std::string bytes = readTextFile(path, budget.left() / 2);
  budget.charge(bytes.size(), 2, file.name);
  const bool isBinary = bytes.starts_with("glTF");
  const std::string_view text = isBinary ? splitBinary(bytes, file) : std::string_view(bytes);
  const auto values = std::count_if(text.begin(), text.end(),
                                    [](char c) { return c == ',' || c == '[' || c == '{'; });
  budget.charge(static_cast<std::uint64_t>(values), kBytesPerJsonValue, file.name);
  file.json = parseJson(std::string(text), file.name);
  if (!file.json.is_object()) throwBadScene(file.name + "#", "expected an object");
  refuseFirstVersion(file);
  return file;
}

constexpr std::array<std::string_view, 11> kSupported = {
    "EXT_mesh_gpu_instancing",         "KHR_lights_punctual",  "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength", "KHR_materials_ior",    "KHR_materials_specular",
    "KHR_materials_transmission",      "KHR_materials_unlit",  "KHR_materials_volume",
    "KHR_mesh_quantization",           "KHR_texture_transform"};
// Names of extensions become kinds of warnings.
constexpr std::size_t kReportedExtensions = 64, kReportedLetters = 64;
// Of the structures that elements of the lists become.
constexpr std::uint64_t kBytesPerElement = 2048;

// A JSON list that may be missing.
const Json& listOf(const Json& object, const char* name) {
  static const Json nothing = Json::array();
  const auto found = object.find(name);
  return found == object.end() ? nothing : *found;
}

std::uint64_t wholeOf(const Json& object, const char* name) {
  return object.value(name, std::uint64_t{0});
}

std::string decodeUri(const Json& uri, const std::string& where, MemoryBudget& budget) {
  const auto& text = uri.get_ref<const std::string&>();
  budget.charge(text.size(), 2, where);
  return dataOfUri(text, where);
}

bool isSupported(const std::string& extension) {
  return std::find(kSupported.begin(), kSupported.end(), extension) != kSupported.end();
}

}  // namespace

struct GltfDocument::Source {
  GltfFile file;
  std::filesystem::path folder;
  const PathRules& rules;

  // A buffer that has none is for whom extensions tell what to fill it with.
  bool hasData(std::size_t buffer) const {
    return listOf(file.json, "buffers")[buffer].contains("uri") || (buffer == 0 && file.hasBinary);
  }
  std::filesystem::path resolve(const Json& uri, const std::string& where) const {
    return rules.resolve(percentDecoded(uri.get<std::string>()), folder, where);
  }
};

GltfDocument::GltfDocument(const std::filesystem::path& path, const PathRules& rules,
                           MemoryBudget& budget, Warnings& warnings)
    : name_(path.string()), budget_(budget), warnings_(warnings) {
  Source source{readGltfFile(path, budget), path.parent_path(), rules};
  checkGltf(source.file.json, name_);
  checkExtensions(source);
  readBuffers(source);
  checkViews(source);
  readImages(source);
  for (const std::string& fault : source.file.faults) {
    warnings_.add("not valid glTF: " + fault, name_);
  }
  countGltfFaults({source.file.json, name_, buffers_, warnings_});
  readStructure(source);
}

std::string GltfDocument::where(const std::string& list, std::size_t index,
                                const std::string& rest) const {
  return gltfPlace(name_, list, index) + rest;
}

Bytes GltfDocument::view(std::size_t bufferView) const {
  const tinygltf::BufferView& view = model_.bufferViews[bufferView];
  return asBytes(buffers_[static_cast<std::size_t>(view.buffer)])
      .subspan(view.byteOffset, view.byteLength);
}

void GltfDocument::checkExtensions(const Source& source) const {
  const Json& json = source.file.json;
  const std::string version = json["asset"]["version"].get<std::string>();
  if (!version.starts_with("2.")) {
    throwBadScene(name_ + "#/asset/version", "expected 2.0, found \"" + version + "\"");
  }
  const Json& required = listOf(json, "extensionsRequired");
  for (std::size_t i = 0; i < required.size(); ++i) {
    const std::string extension = required[i].get<std::string>();
    if (isSupported(extension)) continue;
    throwBadScene(where("extensionsRequired", i),
                  "the file cannot be shown without " + extension + ", which is not supported");
  }
  std::size_t reported = 0;
  for (const Json& used : listOf(json, "extensionsUsed")) {
    const std::string extension = used.get<std::string>();
    if (isSupported(extension) || ++reported > kReportedExtensions) continue;
    warnings_.add("extension ignored: " + extension.substr(0, kReportedLetters), name_);
  }
}

void GltfDocument::readBuffers(Source& source) {
  const Json& list = listOf(source.file.json, "buffers");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::uint64_t length = wholeOf(list[i], "byteLength");
    const auto uri = list[i].find("uri");
    std::string& bytes = buffers_.emplace_back();
    const std::string place = where("buffers", i, "/uri");
    if (uri == list[i].end()) {
      if (!source.hasData(i)) continue;
      bytes = std::exchange(source.file.binary, {});
    } else if (isDataUri(uri->get_ref<const std::string&>())) {
      bytes = decodeUri(*uri, place, budget_);
    } else {
      bytes = readFile(source.resolve(*uri, place), budget_.left() / 2);
      budget_.charge(bytes.size(), 1, place);
    }
    if (bytes.size() < length) {
      throwBadScene(where("buffers", i, "/byteLength"), "expected " + std::to_string(length) +
                                                            " bytes of data, found " +
                                                            std::to_string(bytes.size()));
    }
  }
}

void GltfDocument::checkViews(const Source& source) const {
  const Json& list = listOf(source.file.json, "bufferViews");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::uint64_t buffer = wholeOf(list[i], "buffer"), size = buffers_[buffer].size();
    if (!source.hasData(buffer))
      throwBadScene(where("buffers", buffer), "expected a member \"uri\"");
    const std::uint64_t offset = wholeOf(list[i], "byteOffset");
    const std::uint64_t length = wholeOf(list[i], "byteLength");
    if (offset > size || length > size - offset) {
      throwBadScene(where("bufferViews", i), "expected a range within the buffer's " +
                                                 std::to_string(size) + " bytes, found " +
                                                 std::to_string(length) + " from byte " +
                                                 std::to_string(offset));
    }
    const std::uint64_t stride = wholeOf(list[i], "byteStride");
    if (stride % 4 != 0) {
      throwBadScene(where("bufferViews", i, "/byteStride"), "expected a multiple of 4");
    }
  }
}

void GltfDocument::readImages(const Source& source) {
  const Json& list = listOf(source.file.json, "images");
  const Json& views = listOf(source.file.json, "bufferViews");
  images_.resize(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    GltfImageSource& image = images_[i];
    image.where = where("images", i);
    const auto uri = list[i].find("uri");
    if (uri == list[i].end()) {
      if (!list[i].contains("bufferView")) {
        throwBadScene(image.where, "expected a member \"uri\" or \"bufferView\"");
      }
      const Json& view = views[wholeOf(list[i], "bufferView")];
      image.bytes = asBytes(buffers_[wholeOf(view, "buffer")])
                        .subspan(wholeOf(view, "byteOffset"), wholeOf(view, "byteLength"));
    } else if (isDataUri(uri->get_ref<const std::string&>())) {
      image.own = decodeUri(*uri, image.where + "/uri", budget_);
      image.bytes = asBytes(image.own);
    } else {
      image.path = source.resolve(*uri, image.where + "/uri").string();
    }
  }
}

// tinygltf refuses indices without a buffer view, which are zeros: until it is done they have one.
void GltfDocument::readStructure(Source& source) {
  Json& json = source.file.json;
  const std::size_t views = listOf(json, "bufferViews").size();
  if (json.contains("accessors")) {
    for (Json& accessor : json["accessors"]) {
      if (accessor.contains("bufferView")) continue;
      accessor["bufferView"] = views;
      json["bufferViews"][views] = {{"buffer", 0}, {"byteLength", 0}};
    }
  }
  readWithTinygltf(json);
  model_.bufferViews.resize(views);
  for (tinygltf::Accessor& accessor : model_.accessors) {
    if (accessor.bufferView == static_cast<int>(views)) accessor.bufferView = -1;
  }
}

// What tinygltf would load or does not need is taken out before.
void GltfDocument::readWithTinygltf(Json& json) {
  if (json.contains("animations")) animations_ = std::move(json["animations"]);
  if (json.contains("skins")) skins_ = std::move(json["skins"]);
  for (const char* list : {"buffers", "images", "animations", "skins", "extras"}) json.erase(list);
  for (const auto& [name, list] : json.items()) {
    if (list.is_array()) budget_.charge(list.size(), kBytesPerElement, name_);
  }
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  tinygltf::TinyGLTF reader;
  std::string error, warning;
  if (!reader.LoadASCIIFromString(&model_, &error, &warning, text.c_str(),
                                  static_cast<unsigned int>(text.size()), "")) {
    throwBadScene(name_ + "#",
                  "expected the structure of glTF 2.0 (" + error.substr(0, error.find('\n')) + ")");
  }
}

}  // namespace whit
