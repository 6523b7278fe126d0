// OpenEXR files that other programs could have written: through OpenEXR itself.
#pragma once

#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>

#include <half.h>

#include <map>
#include <string>
#include <vector>

namespace whit {

// Channels of constant value on a data window.
struct ForeignFile {
  std::map<std::string, float> channels{{"R", 1}, {"G", 2}, {"B", 4}};
  Imath::Box2i display{{0, 0}, {3, 2}}, data{{0, 0}, {3, 2}};
  Imf::PixelType type = Imf::FLOAT;
  Imf::Compression compression = Imf::ZIP_COMPRESSION;

  Imf::Header header() const {
    Imf::Header header(display, data);
    header.compression() = compression;
    for (const auto& [name, value] : channels) header.channels().insert(name, Imf::Channel(type));
    return header;
  }
  // Writes the pixels of a file or of one of its parts.
  template <typename Output>
  void fill(Output&& output) const {
    const auto width = static_cast<std::size_t>(data.max.x - data.min.x + 1);
    const auto height = static_cast<std::size_t>(data.max.y - data.min.y + 1);
    // The values must outlive the call that writes them.
    std::map<std::string, std::vector<float>> floats;
    std::map<std::string, std::vector<half>> halves;

    Imf::FrameBuffer frame;
    for (const auto& [name, value] : channels) {
      floats[name].assign(width * height, value);
      halves[name].assign(width * height, half(value));
      const bool isHalf = type == Imf::HALF;
      const void* values = isHalf ? static_cast<const void*>(halves[name].data())
                                  : static_cast<const void*>(floats[name].data());
      const std::size_t size = isHalf ? sizeof(half) : sizeof(float);
      frame.insert(name, Imf::Slice::Make(type, values, data, size, width * size));
    }

    output.setFrameBuffer(frame);
    if constexpr (requires { output.writeTiles(0, 0, 0, 0); }) {
      output.writeTiles(0, output.numXTiles() - 1, 0, output.numYTiles() - 1);
    } else {
      output.writePixels(static_cast<int>(height));
    }
  }

  void write(const std::string& path) const { fill(Imf::OutputFile(path.c_str(), header())); }
  void writeTiled(const std::string& path) const {
    Imf::Header tiled = header();
    tiled.setTileDescription(Imf::TileDescription(4, 8, Imf::MIPMAP_LEVELS));
    fill(Imf::TiledOutputFile(path.c_str(), tiled));
  }
};

}  // namespace whit
