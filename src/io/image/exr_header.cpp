#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfStdIO.h>
#include <ImfThreading.h>
#include <ImfTileDescription.h>
#include <ImfVersion.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>

#include "core/error.h"
#include "io/image/exr.h"

namespace whit {
namespace {

// The size of values of these types. The library reads as much, whatever an attribute says.
std::optional<std::uint32_t> fixedSize(const std::string& type) {
  static const std::map<std::string, std::uint32_t> sizes = {{"box2f", 16},
                                                             {"box2i", 16},
                                                             {"chromaticities", 32},
                                                             {"compression", 1},
                                                             {"deepImageState", 1},
                                                             {"double", 8},
                                                             {"envmap", 1},
                                                             {"float", 4},
                                                             {"int", 4},
                                                             {"keycode", 28},
                                                             {"lineOrder", 1},
                                                             {"m33d", 72},
                                                             {"m33f", 36},
                                                             {"m44d", 128},
                                                             {"m44f", 64},
                                                             {"rational", 8},
                                                             {"tiledesc", 9},
                                                             {"timecode", 8},
                                                             {"v2d", 16},
                                                             {"v2f", 8},
                                                             {"v2i", 8},
                                                             {"v3d", 24},
                                                             {"v3f", 12},
                                                             {"v3i", 12}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? std::nullopt : std::optional(found->second);
}

// "OpenEXR File Layout": magic number, version, then headers. A header is attributes, each a name
// and a type that end with a 0, the size of its value and the value; and a 0 at its end. Behind the
// last header of several parts there is one more 0.
class AttributeWalk {
 public:
  explicit AttributeWalk(const std::string& path)
      : path_(path), in_(path, std::ios::binary), left_(std::filesystem::file_size(path)) {}

  void check() {
    number();
    const bool manyParts = (number() & Imf::MULTI_PART_FILE_FLAG) != 0;
    while (header() && manyParts) continue;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throwBadScene(path_, what); }

  // False where there is none.
  bool header() {
    bool any = false;
    for (std::string name; !(name = text()).empty(); any = true) {
      const std::string type = text();
      const std::uint32_t size = number();
      if (size > left_) fail("the file ends within its header");
      if (size != fixedSize(type).value_or(size)) failSize(name, type);
      const std::uint64_t end = left_ - size;
      if (type == "chlist") channels();
      if (type == "preview") preview(name, size);
      while (type == "stringvector" && left_ > end) skip(number());
      if (left_ < end || (type == "chlist" && left_ != end)) failSize(name, type);
      skip(left_ - end);
    }
    return any;
  }
  [[noreturn]] void failSize(const std::string& name, const std::string& type) const {
    fail("attribute \"" + name + "\" does not have the size of a " + type);
  }
  // Name, type, linearity and 3 bytes to spare, sampling rates.
  void channels() {
    while (!text().empty()) skip(16);
  }
  void preview(const std::string& name, std::uint32_t size) {
    const std::uint64_t width = number(), height = number();
    if (size < 8 || width * height != (size - 8) / 4) failSize(name, "preview");
  }
  std::string text() {
    std::string letters;
    while (const std::uint32_t letter = byte()) letters += static_cast<char>(letter);
    return letters;
  }
  std::uint32_t number() {
    std::uint32_t value = 0;
    for (int shift = 0; shift < 32; shift += 8) value |= byte() << shift;
    return value;
  }
  std::uint32_t byte() {
    const int value = in_.get();
    if (value < 0) fail("the file ends within its header");
    --left_;
    return static_cast<std::uint32_t>(value);
  }
  void skip(std::uint64_t bytes) {
    if (bytes > left_) fail("the file ends within its header");
    in_.seekg(static_cast<std::streamoff>(bytes), std::ios::cur);
    left_ -= bytes;
  }

  const std::string& path_;
  std::ifstream in_;
  std::uint64_t left_;
};

std::int64_t linesInChunk(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
    case Imf::RLE_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
      return 1;
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
      return 32;
    default:
      return 256;
  }
}

// A table says in 8 bytes where each chunk is: a tile, or some lines.
void checkChunks(const std::string& path, const Imf::Header& header) {
  const auto fit = static_cast<std::int64_t>(std::filesystem::file_size(path) / 8);
  const Imath::Box2i& data = header.dataWindow();
  const std::int64_t width = std::int64_t{data.max.x} - data.min.x + 1;
  const std::int64_t height = std::int64_t{data.max.y} - data.min.y + 1;
  bool fits = false;
  if (header.hasTileDescription()) {
    const Imf::TileDescription& tiles = header.tileDescription();
    if (tiles.xSize == 0 || tiles.ySize == 0)
      throwBadScene(path, "expected tiles that have a size");
    const std::int64_t across = width / tiles.xSize, down = height / tiles.ySize;
    fits = across <= 0 || down <= fit / across;
  } else {
    fits = height / linesInChunk(header.compression()) <= fit;
  }
  if (!fits) {
    throwBadScene(path, "expected at most the " + std::to_string(fit) +
                            " tiles or blocks of lines whose places the file can hold");
  }
}

}  // namespace

std::uint64_t exrChunkBytes(const Imf::Header& header) {
  const Imath::Box2i& data = header.dataWindow();
  auto columns = static_cast<std::uint64_t>(std::int64_t{data.max.x} - data.min.x + 1);
  auto lines = static_cast<std::uint64_t>(linesInChunk(header.compression()));
  if (header.hasTileDescription()) {
    columns += header.tileDescription().xSize;  // a row of tiles, all whole
    lines = header.tileDescription().ySize;
  } else {
    lines = std::min(lines, static_cast<std::uint64_t>(std::int64_t{data.max.y} - data.min.y + 1));
  }
  std::uint64_t bytes = 0;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    bytes += it.channel().type == Imf::HALF ? 2 : 4;
  }
  const int chunks = std::max(1, 2 * Imf::globalThreadCount());
  return columns * lines * bytes * 4 * static_cast<std::uint64_t>(chunks);
}

std::vector<Imf::Header> readExrHeaders(const std::string& path) {
  AttributeWalk(path).check();
  Imf::StdIFStream stream(path.c_str());
  char beginning[8];
  stream.read(beginning, 8);
  int version = 0;
  for (int i = 0; i < 4; ++i)
    version |= static_cast<int>(static_cast<unsigned char>(beginning[4 + i]) << (8 * i));
  std::vector<Imf::Header> headers;
  for (;;) {
    Imf::Header header;
    header.readFrom(stream, version);
    if (header.readsNothing()) break;
    checkChunks(path, header);
    headers.push_back(header);
    if ((version & Imf::MULTI_PART_FILE_FLAG) == 0) break;
  }
  if (headers.empty()) throwBadScene(path, "expected an image, found no part");
  return headers;
}

}  // namespace whit
