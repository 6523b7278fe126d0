#include "io/gltf/document.h"

#include <strings.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "core/text.h"

namespace whit {

namespace {

std::string base64Decoded(std::string_view digits, const std::string& where) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  while (digits.ends_with('=')) digits.remove_suffix(1);

  std::string bytes;
  bytes.reserve(digits.size() / 4 * 3 + 2);

  // `held` collects the six bits of each digit until a byte is complete.
  std::uint32_t held = 0;
  int bits = 0;
  for (const char c : digits) {
    const std::size_t value = kDigits.find(c);
    if (value == std::string_view::npos) {
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

// Decodes "%20" and its like: RFC 3986, section 2.1.
std::string percentDecoded(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned code = 0;
    const char* const digits = uri.data() + i + 1;
    const bool isCode = uri[i] == '%' && i + 2 < uri.size() &&
                        std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
    text += isCode ? static_cast<char>(code) : uri[i];
    if (isCode) i += 2;
  }
  return text;
}

// Data URIs: RFC 2397.
bool isDataUri(const std::string& uri) { return strncasecmp(uri.c_str(), "data:", 5) == 0; }

constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
// Upper bound on the memory of one parsed JSON value: a member of an object with its name.
constexpr std::uint64_t kBytesPerJsonValue = 128;

std::uint32_t wordAt(std::string_view bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

// Takes a .glb file apart (glTF 2.0 specification, section 4): returns the JSON text, and copies
// the binary chunk.
std::string_view splitBinary(std::string_view bytes, const std::string& file,
                             std::optional<std::string>& binary) {
  const auto fail = [&](std::size_t at, const std::string& expected, std::uint64_t found) {
    throwBadScene(concat(file, ": byte ", at), concat("expected ", expected, ", found ", found));
  };

  // The header consists of a magic word, the version and the length of the file.
  if (bytes.size() < kHeaderBytes) fail(0, "a header of 12 bytes", bytes.size());
  const std::uint32_t version = wordAt(bytes, 4), length = wordAt(bytes, 8);
  if (version != 2) fail(4, "glTF 2", version);
  if (length < kHeaderBytes || length > bytes.size()) {
    fail(8, concat("a length up to the file's ", bytes.size(), " bytes"), length);
  }

  // Chunks follow, the first of which holds the JSON text.
  std::string_view text;
  std::size_t at = kHeaderBytes;
  do {
    if (length - at < kChunkHeaderBytes) fail(at, "8 bytes of a chunk's header", length - at);
    const std::uint32_t size = wordAt(bytes, at), type = wordAt(bytes, at + 4);
    const std::size_t left = length - at - kChunkHeaderBytes;
    if (size > left) fail(at, concat("a chunk of ", size, " bytes"), left);

    const std::string_view chunk = bytes.substr(at + kChunkHeaderBytes, size);
    if (at == kHeaderBytes) {
      if (type != kJsonChunk) fail(at + 4, "a chunk of JSON first", type);
      text = chunk;
    } else if (type == kBinaryChunk && !binary) {  // other chunks are those of extensions
      binary = chunk;
    }

    at += kChunkHeaderBytes + size;
  } while (at < length);

  return text;
}

// The content tells whether the file is binary. Stores the binary chunk of a .glb.
Json parseGltf(const std::string& bytes, const std::string& name, MemoryBudget& budget,
               std::optional<std::string>& binary) {
  budget.charge(bytes.size(), 2, name);

  const bool isBinary = bytes.starts_with("glTF");
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (!isBinary && (first == std::string::npos || bytes[first] != '{')) {
    throwBadScene(name, "expected a GLB, which begins with \"glTF\", or JSON, which begins with {");
  }

  std::string_view text = bytes;
  if (isBinary) text = splitBinary(bytes, name, binary);

  // Each value follows a separator, so that their number limits the memory of the parsed text.
  const auto values =
      std::ranges::count_if(text, [](char c) { return c == ',' || c == '[' || c == '{'; });
  budget.charge(values, kBytesPerJsonValue, name);
  return parseJson(std::string(text), name);
}

constexpr std::string_view kSupported[] = {
#ifdef WHIT_DRACO
    "KHR_draco_mesh_compression",
#endif
#ifdef WHIT_MESHOPT
    "EXT_meshopt_compression",
#endif
#ifdef WHIT_WEBP
    "EXT_texture_webp",
#endif
    "EXT_mesh_gpu_instancing",    "FB_ngon_encoding",  // polygons as triangles, which read the same
    "KHR_lights_punctual",        "KHR_materials_clearcoat", "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_specular",  "KHR_materials_transmission",
    "KHR_materials_unlit",        "KHR_materials_variants",  "KHR_materials_volume",
    "KHR_mesh_quantization",      "KHR_texture_transform"};

// Says what the user can do about an extension that is not supported; may be empty.
std::string adviceOn(const std::string& extension) {
  const std::map<std::string, std::string> advice{
      {"KHR_texture_basisu", ": `gltf-transform ktxdecompress IN OUT` converts the file"},
      {"KHR_meshopt_compression", ": `gltfpack -c -i IN -o OUT` converts the file"},
      {"KHR_draco_mesh_compression", ": this whit was built without libdraco-dev"},
      {"EXT_meshopt_compression", ": this whit was built without libmeshoptimizer-dev"},
      {"EXT_texture_webp", ": this whit was built without libwebp-dev"}};
  const auto found = advice.find(extension);
  return found == advice.end() ? "" : found->second;
}

// Upper bound on the memory that the readers need for one node, mesh, material and so on.
constexpr std::uint64_t kBytesPerElement = 2048;

}  // namespace

GltfDocument::GltfDocument(const std::filesystem::path& path, const std::string& bytes,
                           const PathRules& rules, MemoryBudget& budget, Warnings& warnings)
    : name_(path.string()), budget_(budget), warnings_(warnings) {
  std::optional<std::string> binary;
  json_ = std::make_unique<const JsonDocument>(
      JsonDocument{name_, parseGltf(bytes, name_, budget, binary), {}});
  if (!root().isObject()) root().fail("an object");
  checkExtensions();

  for (const auto& [name, list] : json_->root.items()) {
    if (list.is_array()) budget_.charge(this->list(name).size(), kBytesPerElement, name_);
  }

  // The first buffer of a GLB has no URI and is the binary chunk.
  buffers_.resize(list("buffers").size());
  if (!buffers_.empty() && !list("buffers")[0]["uri"].exists()) buffers_[0] = std::move(binary);
  readBuffers(path.parent_path(), rules);
  decoded_ = decodeCompressed(*this);
  readImages(path.parent_path(), rules);
}

bool GltfDocument::reads(const std::string& extension) { return contains(kSupported, extension); }

Bytes GltfDocument::range(const JsonValue& source) const {
  const JsonValue buffers = list("buffers");
  const std::size_t number = source.need("buffer").indexInto(buffers).value_or(0);
  const std::optional<std::string>& buffer = buffers_[number];
  if (!buffer) buffers[number].fail("a buffer with data", "none");

  const std::uint64_t size = buffer->size(), offset = source["byteOffset"].wholeOr(0);
  const std::uint64_t length = source.need("byteLength").wholeOr(0);
  if (offset > size || length > size - offset) {
    source.fail(concat("a range within the buffer's ", size, " bytes"),
                concat(length, " from byte ", offset));
  }
  return asBytes(*buffer).subspan(offset, length);
}

GltfBufferView GltfDocument::view(const JsonValue& reference) const {
  const std::optional<std::size_t> index = reference.indexInto(list("bufferViews"));
  if (!index) reference.fail("a buffer view");
  const JsonValue view = list("bufferViews")[*index];
  const std::uint64_t stride = view["byteStride"].wholeOr(0, 252);
  if (stride % 4 != 0) view["byteStride"].fail("a multiple of 4");

  const std::optional<Bytes> bytes = decoded(view);
  return {bytes ? *bytes : range(view), *index, stride};
}

std::optional<Bytes> GltfDocument::decoded(const JsonValue& value) const {
  const auto found = decoded_.find(value.pointer());
  return found == decoded_.end() ? std::nullopt : std::optional(asBytes(found->second));
}

void GltfDocument::checkExtensions() const {
  const JsonValue asset = root().need("asset"), version = asset.need("version");
  if (!version.textOr("").starts_with("2.")) version.fail("2.0");
  const JsonValue least = asset["minVersion"];
  if (least.textOr("2.0") > "2.0") least.fail("at most 2.0, which is the version that can be read");

  for (const JsonValue& required : list("extensionsRequired").elements()) {
    const std::string extension = required.textOr("");
    if (reads(extension)) continue;
    throwBadScene(required.where(), "the file cannot be shown without " + excerpt(extension) +
                                        ", which is not supported" + adviceOn(extension));
  }

  for (const JsonValue& used : list("extensionsUsed").elements()) {
    const std::string extension = used.textOr("");
    if (!reads(extension)) warnings_.add("extension ignored: " + excerpt(extension), name_);
  }
}

// Decodes a data URI of any type (base64: RFC 4648, padded or not).
std::string GltfDocument::decodeUri(const JsonValue& uri) const {
  const std::string text = uri.textOr(""), where = uri.where();
  budget_.charge(text.size(), 2, where);
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) throwBadScene(where, "expected a comma before a URI's data");

  const std::string data = percentDecoded(std::string_view(text).substr(comma + 1));
  constexpr std::string_view kBase64 = ";base64";
  const std::size_t mark = std::max(comma, kBase64.size()) - kBase64.size();
  const bool isBase64 = strncasecmp(&text[mark], kBase64.data(), kBase64.size()) == 0;
  return isBase64 ? base64Decoded(data, where) : data;
}

void GltfDocument::readBuffers(const std::filesystem::path& folder, const PathRules& rules) {
  for (const auto i : indices(buffers_)) {
    const JsonValue buffer = list("buffers")[i], uri = buffer["uri"];
    const std::uint64_t length = buffer.need("byteLength").wholeOr(0);
    std::optional<std::string>& bytes = buffers_[i];

    // A fallback buffer is for programs that cannot decode its views.
    const JsonValue fallback = buffer["extensions"]["EXT_meshopt_compression"]["fallback"];
    if (fallback.flagOr(false) && reads("EXT_meshopt_compression")) continue;

    if (isDataUri(uri.textOr(""))) {
      bytes = decodeUri(uri);
    } else if (uri.exists()) {
      const auto file = rules.find(percentDecoded(uri.textOr("")), folder, uri.where(), warnings_);
      bytes = readNamedAt(uri.where(), [&] { return readFile(file, budget_.left() / 2); });
      budget_.charge(bytes->size(), 1, uri.where());
    }

    if (bytes && bytes->size() < length) {
      buffer["byteLength"].fail(concat(length, " bytes of data"), std::to_string(bytes->size()));
    }
  }
}

void GltfDocument::readImages(const std::filesystem::path& folder, const PathRules& rules) {
  const JsonValue images = list("images");
  images_.resize(images.size());

  for (const auto i : indices(images_)) {
    GltfImageSource& image = images_[i];
    image.where = images[i].where();
    const JsonValue uri = images[i]["uri"], view = images[i]["bufferView"];

    if (!uri.exists()) {
      if (!view.exists()) images[i].fail("a member \"uri\" or \"bufferView\"");
      image.bytes = this->view(view).bytes;
    } else if (isDataUri(uri.textOr(""))) {
      image.own = decodeUri(uri);
      image.bytes = asBytes(image.own);
    } else {
      // An unusable path leaves out one texture, so its error waits until the image is decoded.
      try {
        image.path =
            rules.find(percentDecoded(uri.textOr("")), folder, uri.where(), warnings_).string();
      } catch (const Error&) {
        image.error = std::current_exception();
      }
    }
  }
}

}  // namespace whit
