// Reading OpenEXR.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfTileDescription.h>

#include <algorithm>
#include <new>
#include <utility>

#include "core/error.h"
#include "io/image/exr.h"
#include "io/image/image_decoders.h"
#include "io/image/image_layers.h"
#include "io/read_file.h"

namespace whit {

namespace {

using Imath::Box2i;

std::int64_t sideOf(int low, int high) { return std::int64_t{high} - low + 1; }

// Runs `use`, and tells what OpenEXR throws in our own terms.
template <typename Use>
auto translating(const std::string& path, Use&& use) {
  try {
    return use();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throwLimit(path + ": not enough memory for this image");
  } catch (const std::exception& e) {
    throwBadScene(path, std::string("not a valid OpenEXR image (") + e.what() + ")");
  }
}

// Throws unless the first part is a flat image.
void requireFlat(const std::string& path, const Imf::Header& header) {
  if (header.hasType() && !Imf::isImage(header.type()))
    throwBadScene(path, "expected a flat image, found deep data");
}

struct Layout {
  std::vector<const char*> channels;  // nullptr: not in the file, 0
  bool lumaChroma = false;
};

Layout layoutOf(const std::string& path, const Imf::Header& header) {
  const Imf::ChannelList& list = header.channels();
  const auto has = [&](const char* name) { return list.findChannel(name) != nullptr; };
  Layout layout;
  if (has("R") || has("G") || has("B")) {
    for (const char* name : {"R", "G", "B"}) layout.channels.push_back(has(name) ? name : nullptr);
  } else if (has("Y") && has("RY") && has("BY")) {
    layout.lumaChroma = true;
    layout.channels = {"R", "G", "B"};
  } else if (has("Y")) {
    layout.channels = {"Y"};
  } else {
    std::string found;
    for (auto it = list.begin(); it != list.end(); ++it) found += std::string(" ") + it.name();
    throwBadScene(path,
                  "expected a channel R, G, B or Y, found" + (found.empty() ? " none" : found));
  }
  if (has("A")) layout.channels.push_back("A");
  return layout;
}

void checkSizes(const std::string& path, const Imf::Header& header, std::size_t channels,
                const ImageLimits& limits) {
  const std::uint64_t bytes = channels * sizeof(float);
  for (const Box2i& box : {header.displayWindow(), header.dataWindow()})
    checkImageSize(path, sideOf(box.min.x, box.max.x), sideOf(box.min.y, box.max.y), bytes, limits);
  if (header.hasTileDescription()) {
    // Tiles are decoded whole, a row of them at a time.
    const Imf::TileDescription& tiles = header.tileDescription();
    const std::int64_t across = sideOf(header.dataWindow().min.x, header.dataWindow().max.x);
    checkImageSize(path, across + tiles.xSize, tiles.ySize, bytes,
                   ImageLimits{2 * limits.side, limits.bytes});
  }
}

MemoryHold holdBox(const std::string& path, const Box2i& box, std::size_t channels,
                   const ImageLimits& limits) {
  return holdImage(path, sideOf(box.min.x, box.max.x), sideOf(box.min.y, box.max.y),
                   channels * sizeof(float), limits);
}

// The data window's values, interleaved.
std::vector<float> readParts(const std::string& path, const Box2i& data, const Layout& layout) {
  const std::size_t channels = layout.channels.size();
  const auto width = static_cast<std::size_t>(sideOf(data.min.x, data.max.x));
  const auto height = static_cast<std::size_t>(sideOf(data.min.y, data.max.y));
  std::vector<float> values(width * height * channels);
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < channels; ++c) {
    if (layout.channels[c] == nullptr) continue;
    frame.insert(layout.channels[c],
                 Imf::Slice::Make(Imf::FLOAT, values.data() + c, data, channels * sizeof(float),
                                  width * channels * sizeof(float)));
  }
  Imf::MultiPartInputFile file(path.c_str());
  Imf::InputPart part(file, 0);
  part.setFrameBuffer(frame);
  part.readPixels(data.min.y, data.max.y);
  return values;
}

// Reads an image stored as luminance and subsampled chroma, whose conversion OpenEXR only offers in
// half precision.
std::vector<float> readLumaChroma(const std::string& path, const Box2i& data, std::size_t channels,
                                  const ImageLimits& limits) {
  const auto width = static_cast<std::size_t>(sideOf(data.min.x, data.max.x));
  const auto height = static_cast<std::size_t>(sideOf(data.min.y, data.max.y));
  const MemoryHold held(limits.budget, width * height, sizeof(Imf::Rgba), path);
  std::vector<Imf::Rgba> pixels(width * height);
  Imf::RgbaInputFile file(path.c_str());
  const std::int64_t offset = data.min.x + data.min.y * static_cast<std::int64_t>(width);
  file.setFrameBuffer(pixels.data() - offset, 1, width);
  file.readPixels(data.min.y, data.max.y);
  std::vector<float> values;
  values.reserve(pixels.size() * channels);
  for (const Imf::Rgba& pixel : pixels) {
    values.insert(values.end(), {pixel.r, pixel.g, pixel.b});
    if (channels == 4) values.push_back(pixel.a);
  }
  return values;
}

// Leaves of `values`, which fill `data`, those inside `kept`.
template <typename Value>
std::vector<Value> cropped(const std::vector<Value>& values, const Box2i& data, const Box2i& kept,
                           std::size_t channels) {
  const auto width = static_cast<std::size_t>(sideOf(data.min.x, data.max.x));
  std::vector<Value> inside;
  for (int y = kept.min.y; y <= kept.max.y; ++y) {
    const std::size_t row = static_cast<std::size_t>(std::int64_t{y} - data.min.y) * width;
    const auto at = [&](std::int64_t x) {
      return values.begin() + static_cast<std::ptrdiff_t>(
                                  (row + static_cast<std::size_t>(x - data.min.x)) * channels);
    };
    inside.insert(inside.end(), at(kept.min.x), at(std::int64_t{kept.max.x} + 1));
  }
  return inside;
}

// The part of the data window that the display window has.
Box2i keptBox(const std::string& path, const Imf::Header& header) {
  const Box2i &display = header.displayWindow(), &data = header.dataWindow();
  Box2i kept{{std::max(display.min.x, data.min.x), std::max(display.min.y, data.min.y)},
             {std::min(display.max.x, data.max.x), std::min(display.max.y, data.max.y)}};
  if (kept.isEmpty()) throwBadScene(path, "its data window lies outside its display window");
  return kept;
}

bool isColor(const std::string& name) {
  constexpr const char* kColors[] = {"R", "G", "B", "A", "Y", "RY", "BY"};
  return std::find(std::begin(kColors), std::end(kColors), name) != std::end(kColors);
}

std::vector<ImageLayer> layersOf(const std::string& path, const Imf::Header& header) {
  std::vector<ImageLayer> layers;
  const Imf::ChannelList& list = header.channels();
  for (auto it = list.begin(); it != list.end(); ++it) {
    if (isColor(it.name())) continue;
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
      throwBadScene(
          path, std::string("expected a value a pixel of channel ") + it.name() + ", found fewer");
    }
    layers.push_back({it.name(), it.channel().type == Imf::UINT, {}, {}});
  }
  return layers;
}

// The values of the whole data window.
void readLayerValues(const std::string& path, const Box2i& data, std::vector<ImageLayer>& layers) {
  const auto width = static_cast<std::size_t>(sideOf(data.min.x, data.max.x));
  const auto height = static_cast<std::size_t>(sideOf(data.min.y, data.max.y));
  Imf::FrameBuffer frame;
  const auto insert = [&](const ImageLayer& layer, Imf::PixelType type, auto& values) {
    values.resize(width * height);
    frame.insert(layer.name,
                 Imf::Slice::Make(type, values.data(), data, sizeof(float), width * sizeof(float)));
  };
  for (ImageLayer& layer : layers) {
    if (layer.countsThings) {
      insert(layer, Imf::UINT, layer.numbers);
    } else {
      insert(layer, Imf::FLOAT, layer.floats);
    }
  }
  Imf::MultiPartInputFile file(path.c_str());
  Imf::InputPart part(file, 0);
  part.setFrameBuffer(frame);
  part.readPixels(data.min.y, data.max.y);
}

}  // namespace

std::vector<ImageLayer> readLayers(const std::string& path, const ImageLimits& limits) {
  if (!isExr(asBytes(readBeginning(path, 4)))) return {};
  return translating(path, [&] {
    const Imf::Header header = readExrHeaders(path).front();
    requireFlat(path, header);
    std::vector<ImageLayer> layers = layersOf(path, header);
    if (layers.empty()) return layers;
    checkSizes(path, header, layers.size(), limits);
    const Box2i kept = keptBox(path, header), &data = header.dataWindow();
    readLayerValues(path, data, layers);
    if (kept == data) return layers;
    for (ImageLayer& layer : layers) {
      if (layer.countsThings) {
        layer.numbers = cropped(layer.numbers, data, kept, 1);
      } else {
        layer.floats = cropped(layer.floats, data, kept, 1);
      }
    }
    return layers;
  });
}

bool isExr(std::span<const std::uint8_t> beginning) {
  constexpr std::uint8_t kMagic[] = {0x76, 0x2f, 0x31, 0x01};
  return beginning.size() >= 4 && std::equal(kMagic, kMagic + 4, beginning.begin());
}

ExrPixels decodeExr(const std::string& path, const ImageLimits& limits) {
  return translating(path, [&] {
    const Imf::Header header = readExrHeaders(path).front();
    requireFlat(path, header);
    const Layout layout = layoutOf(path, header);
    const std::size_t channels = layout.channels.size();
    checkSizes(path, header, channels, limits);
    const Box2i &display = header.displayWindow(), &data = header.dataWindow();
    const Box2i kept = keptBox(path, header);

    ExrPixels pixels;
    pixels.width = static_cast<int>(sideOf(display.min.x, display.max.x));
    pixels.height = static_cast<int>(sideOf(display.min.y, display.max.y));
    // The sizes have been checked, so these differences fit.
    pixels.window = {kept.min.x - display.min.x, kept.min.y - display.min.y,
                     kept.max.x - display.min.x + 1, kept.max.y - display.min.y + 1};
    pixels.channels = static_cast<int>(channels);
    pixels.held = holdBox(path, data, channels, limits);
    const MemoryHold working(limits.budget, exrChunkBytes(header), 1, path);
    pixels.values = layout.lumaChroma ? readLumaChroma(path, data, channels, limits)
                                      : readParts(path, data, layout);
    if (kept != data) {
      const MemoryHold whole = std::exchange(pixels.held, holdBox(path, kept, channels, limits));
      pixels.values = cropped(pixels.values, data, kept, channels);
    }
    return pixels;
  });
}

}  // namespace whit
