// Writing OpenEXR, and the text that was written with it.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/image/exr.h"
#include "io/image/image_file.h"

namespace whit {

namespace {

static_assert(sizeof(Rgb) == 3 * sizeof(float), "pixels are written as they lie in memory");

const std::string kPrefix = "whit.";
constexpr std::array<const char*, 3> kRadianceLayers = {"R", "G", "B"};

// Attributes that mean something to OpenEXR itself, and so cannot carry our text.
bool isReserved(const std::string& name) {
  constexpr std::array<const char*, 5> kReserved = {"chunkCount", "name", "type", "version",
                                                    "view"};
  return std::find(kReserved.begin(), kReserved.end(), name) != kReserved.end();
}

std::string attributeName(const Imf::Header& header, const std::string& name) {
  return isReserved(name) || header.find(name) != header.end() ? kPrefix + name : name;
}

Imf::Compression compressionOf(ExrStorage storage) {
  switch (storage) {
    case ExrStorage::none:
      return Imf::NO_COMPRESSION;
    case ExrStorage::dwaa:
      return Imf::DWAA_COMPRESSION;
    default:
      return Imf::ZIP_COMPRESSION;
  }
}

bool inHalf(ExrStorage storage) {
  return storage == ExrStorage::half || storage == ExrStorage::dwaa;
}

// A NaN stays a NaN.
half nearestHalf(float value) {
  return half(std::clamp(value, -static_cast<float>(HALF_MAX), static_cast<float>(HALF_MAX)));
}

std::vector<half> inHalf(const Image& image) {
  std::vector<half> values;
  values.reserve(3 * image.pixels.size());
  for (const Rgb& pixel : image.pixels) {
    for (int c = 0; c < 3; ++c) values.push_back(nearestHalf(pixel[c]));
  }
  return values;
}

// Where there is no room for the library's threads, it does without.
void letCompress(int threads) {
  try {
    if (threads > Imf::globalThreadCount()) Imf::setGlobalThreadCount(threads);
  } catch (const std::system_error&) {
  }
}

Imf::Header makeHeader(const Image& image, const ImageMetadata& metadata, ExrStorage storage,
                       const std::vector<LayerView>& layers) {
  const Crop& w = image.window;
  Imf::Header header(Imath::Box2i({0, 0}, {image.width - 1, image.height - 1}),
                     Imath::Box2i({w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}));
  header.compression() = compressionOf(storage);
  const Imf::Channel channel(inHalf(storage) ? Imf::HALF : Imf::FLOAT);
  for (const char* name : kRadianceLayers) header.channels().insert(name, channel);
  for (const LayerView& layer : layers) {
    header.channels().insert(layer.name, Imf::Channel(layer.numbers ? Imf::UINT : Imf::FLOAT));
  }
  for (const auto& [name, text] : metadata)
    header.insert(attributeName(header, name), Imf::StringAttribute(text));
  return header;
}

void insertLayers(const std::vector<LayerView>& layers, const Imf::OutputFile& exr,
                  const Image& image, Imf::FrameBuffer& frame) {
  static_assert(sizeof(float) == sizeof(std::uint32_t));
  for (const LayerView& layer : layers) {
    const void* const first =
        layer.numbers ? static_cast<const void*>(layer.numbers) : layer.floats;
    const std::size_t stride = layer.stride * sizeof(float);
    frame.insert(
        layer.name,
        Imf::Slice::Make(layer.numbers ? Imf::UINT : Imf::FLOAT, first, exr.header().dataWindow(),
                         stride, stride * static_cast<std::size_t>(image.windowWidth())));
  }
}

// `first` is the first value of the first pixel of the window.
template <typename Value>
void writePixels(Imf::OutputFile& exr, Imf::PixelType type, const Image& image, Value* first,
                 const std::vector<LayerView>& layers) {
  const auto width = static_cast<std::size_t>(image.windowWidth());
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < kRadianceLayers.size(); ++c) {
    frame.insert(kRadianceLayers[c],
                 Imf::Slice::Make(type, first + c, exr.header().dataWindow(), 3 * sizeof(Value),
                                  width * 3 * sizeof(Value)));
  }
  insertLayers(layers, exr, image, frame);
  exr.setFrameBuffer(frame);
  exr.writePixels(image.windowHeight());
}

}  // namespace

void writeExr(const std::string& path, const Image& image, const ImageMetadata& metadata,
              ExrStorage storage, int threads, const std::vector<LayerView>& layers) {
  if (image.pixels.empty()) throwUsage("cannot write '" + path + "': the image has no pixels");
  if (!layers.empty() && storage == ExrStorage::dwaa) {
    throwUsage("cannot write '" + path +
               "': DWAA is lossy for channels as well (position.Y): zip, none and half are not");
  }
  AtomicFile file(path);
  letCompress(threads);
  try {
    // The stream is ours, because OpenEXR keeps quiet about what fails while it closes a file.
    std::ofstream stream(file.temporaryPath(), std::ios::binary | std::ios::trunc);
    {
      Imf::StdOFStream out(stream, path.c_str());
      Imf::OutputFile exr(out, makeHeader(image, metadata, storage, layers), threads);
      if (inHalf(storage)) {
        const std::vector<half> values = inHalf(image);
        writePixels(exr, Imf::HALF, image, values.data(), layers);
      } else {
        writePixels(exr, Imf::FLOAT, image, &image.pixels[0][0], layers);
      }
    }
    stream.close();
    if (!stream) throwIo(path, "cannot write '" + path + "': no space left, or the device failed");
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throwIo(path, "cannot write '" + path + "': " + e.what());
  }
  file.commit();
}

ImageMetadata readExrMetadata(const std::string& path) {
  try {
    readExrHeaders(path);
    Imf::MultiPartInputFile file(path.c_str());
    const Imf::Header& header = file.header(0);
    ImageMetadata metadata;
    for (auto it = header.begin(); it != header.end(); ++it) {
      const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
      const std::string name = it.name();
      if (text == nullptr || isReserved(name)) continue;
      metadata.emplace_back(name.starts_with(kPrefix) ? name.substr(kPrefix.size()) : name,
                            text->value());
    }
    return metadata;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throwBadScene(path, std::string("not a valid OpenEXR image (") + e.what() + ")");
  }
}

}  // namespace whit
