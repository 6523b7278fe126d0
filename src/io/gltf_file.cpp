#include "io/gltf_file.h"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "core/error.h"
#include "io/paths.h"

namespace whit {
namespace {

constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
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
    throwBadScene(to.name, "expected version 2 of the format, found " + std::to_string(version));
  }
  if (length < kHeaderBytes || length > bytes.size()) {
    throwBadScene(to.name, "its header says " + std::to_string(length) + " bytes, the file has " +
                               std::to_string(bytes.size()));
  }
  std::string_view rest = bytes.substr(kHeaderBytes, length - kHeaderBytes);
  std::uint32_t type = 0;
  const std::string_view text = takeChunk(rest, type, to.name);
  if (type != kJsonChunk) throwBadScene(to.name, "expected JSON in the first chunk");
  while (!rest.empty()) {
    const std::string_view chunk = takeChunk(rest, type, to.name);
    if (type != kBinaryChunk || to.hasBinary) continue;  // others are an extension's
    to.hasBinary = true;
    to.binary.assign(chunk.begin(), chunk.end());
  }
  return text;
}

}  // namespace

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
  return file;
}

}  // namespace whit
