// Reading and writing OpenEXR.
#include <ImfChannelList.h>
#include <ImfEnvmap.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <ImfTileDescription.h>
#include <half.h>
#include <openexr.h>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/index.h"
#include "core/option_table.h"
#include "core/text.h"
#include "io/files.h"
#include "io/image/image_decoders.h"
#include "io/image/image_layers.h"
#include "io/image/texture_from_image.h"
#include "scene/members.h"

namespace whit {

namespace {

using Imath::Box2i;

std::int64_t widthOf(const Box2i& box) { return std::int64_t{box.max.x} - box.min.x + 1; }
std::int64_t heightOf(const Box2i& box) { return std::int64_t{box.max.y} - box.min.y + 1; }

// OpenEXR begins its messages with the path of the file, which may be long.
std::string endOfMessage(const std::string& message) {
  constexpr std::size_t kShown = 150;
  return message.size() > kShown ? "..." + message.substr(message.size() - kShown) : message;
}

// Returns whether a list of channels ends with its mark, an empty name, and there only.
bool endsWithItsMark(const std::string& list) {
  constexpr std::size_t kAfterName = 16;  // bytes of a channel behind the end of its name
  std::size_t at = 0;
  while (at < list.size() && list[at] != 0) {
    at = list.find('\0', at);
    if (at == std::string::npos) return false;
    at += 1 + kAfterName;
  }
  return at + 1 == list.size();
}

// Throws unless each list of channels ends where its attribute does. OpenEXR reads a list up to its
// mark and takes what follows for the next attribute, of any size; its core library goes by the
// sizes of attributes. It has checked these sizes.
void checkChannelLists(const std::string& path) {
  constexpr int kFlagsAt = 5, kAttributesAt = 8;  // bytes from the start of the file
  constexpr int kSeveralParts = 0x10;
  std::ifstream in(path, std::ios::binary);
  in.seekg(kFlagsAt);
  const bool hasSeveralParts = (in.get() & kSeveralParts) != 0;
  in.seekg(kAttributesAt);

  std::string name, type;
  while (std::getline(in, name, '\0')) {
    // An empty name ends a header, and an empty header ends those of several parts.
    if (name.empty()) {
      if (!hasSeveralParts || in.peek() == 0) return;
      continue;
    }

    std::uint8_t bytes[4] = {};
    std::getline(in, type, '\0');
    in.read(reinterpret_cast<char*>(bytes), sizeof(bytes));
    const std::uint32_t size =
        bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
    if (type != "chlist") {
      in.seekg(size, std::ios::cur);
      continue;
    }

    std::string list(size, '\0');
    in.read(list.data(), static_cast<std::streamsize>(size));
    if (!endsWithItsMark(list)) {
      throwBadScene(path + ": header", "expected the list of channels '" + printable(name) +
                                           "' to end where its attribute does");
    }
  }
}

// Checks the headers of all parts by OpenEXR's core library, because the library above it allocates
// whatever attributes and tables of chunks claim to take. Returns the lines of a chunk in the first
// part, 1 for tiles.
std::int32_t checkHeaders(const std::string& path) {
  static thread_local std::string message;
  exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
  settings.flags = EXR_CONTEXT_FLAG_STRICT_HEADER;
  settings.error_handler_fn = [](exr_const_context_t, exr_result_t, const char* text) {
    message = text;
  };

  exr_context_t file = nullptr;
  const bool valid = exr_start_read(&file, path.c_str(), &settings) == EXR_ERR_SUCCESS;
  int parts = 0;
  std::int32_t lines = 1, chunks = 0;
  std::uint64_t allChunks = 0;

  if (valid) {
    exr_get_count(file, &parts);
    exr_get_scanlines_per_chunk(file, 0, &lines);
    for (int i = 0; i < parts; ++i) {
      exr_get_chunk_count(file, i, &chunks);
      allChunks += static_cast<std::uint64_t>(std::max(chunks, 0));
    }
  }

  exr_finish(&file);
  if (!valid) {
    throwBadScene(path + ": header",
                  "expected valid OpenEXR data, found an error: " + endOfMessage(message));
  }

  checkChannelLists(path);

  const std::uint64_t most = std::filesystem::file_size(path) / sizeof(std::uint64_t);
  if (allChunks > most) {
    throwBadScene(path + ": header",
                  concat("expected at most the ", most,
                         " tiles or blocks of lines whose places the file can hold"));
  }

  return std::max(lines, 1);
}

// Names the channels to read, with the types that their values get.
using ExrChannels = std::vector<std::pair<std::string, Imf::PixelType>>;

// Moves `values`, which fill the box `from`, into the box `to`; the rest of that is 0.
template <typename Value>
void moveInto(const Box2i& to, const Box2i& from, std::size_t channels,
              std::vector<Value>& values) {
  if (to == from) return;
  const auto offset = [&](const Box2i& box, std::int64_t x, std::int64_t y) {
    return ((y - box.min.y) * widthOf(box) + x - box.min.x) * static_cast<std::int64_t>(channels);
  };
  std::vector<Value> moved(static_cast<std::size_t>(widthOf(to) * heightOf(to)) * channels);
  const int x0 = std::max(from.min.x, to.min.x), x1 = std::min(from.max.x, to.max.x);
  for (int y = std::max(from.min.y, to.min.y); y <= std::min(from.max.y, to.max.y); ++y) {
    std::copy(values.begin() + offset(from, x0, y),
              values.begin() + offset(from, std::int64_t{x1} + 1, y),
              moved.begin() + offset(to, x0, y));
  }
  values = std::move(moved);
}

// An open file with checked headers; its first part is a flat image.
class ExrFile {
 public:
  explicit ExrFile(const std::string& path)
      : path_(path), chunkLines_(checkHeaders(path)), file_(path.c_str()) {
    if (header().hasType() && !Imf::isImage(header().type())) {
      throwBadScene(path + ": header", "expected a flat image, found deep data");
    }
  }

  const Imf::Header& header() const { return file_.header(0); }
  // The part of the data window inside the display window.
  Box2i visible() const {
    const Box2i &display = header().displayWindow(), &data = header().dataWindow();
    Box2i box{{std::max(display.min.x, data.min.x), std::max(display.min.y, data.min.y)},
              {std::min(display.max.x, data.max.x), std::min(display.max.y, data.max.y)}};
    if (box.isEmpty()) {
      throwBadScene(path_ + ": header", "expected a data window inside the display window");
    }
    return box;
  }

  void checkSizes(std::uint64_t channels, const ImageLimits& limits) const {
    const std::uint64_t bytes = channels * sizeof(float);
    for (const Box2i& box : {header().displayWindow(), header().dataWindow()}) {
      checkImageSize(path_, widthOf(box), heightOf(box), bytes, limits);
    }
    if (header().hasTileDescription()) {
      // Tiles are decoded whole, a row of them at a time.
      const Imf::TileDescription& tiles = header().tileDescription();
      checkImageSize(path_, widthOf(header().dataWindow()) + tiles.xSize, tiles.ySize, bytes,
                     ImageLimits{2 * limits.side, limits.bytes});
    }
  }

  // Returns the values of the channels in `box`, those of a pixel side by side; pixels outside the
  // data window have 0. The memory that OpenEXR takes meanwhile is held in the budget: of each
  // chunk what is stored, decoded, and twice that again while the compression is undone.
  template <typename Value>
  std::vector<Value> read(const Box2i& box, const ExrChannels& channels,
                          const ImageLimits& limits) {
    const Box2i& data = header().dataWindow();

    // The memory of the values, and that of OpenEXR.
    const MemoryHold held =
        holdImage(path_, widthOf(data), heightOf(data), channels.size() * sizeof(Value), limits);
    const auto width = static_cast<std::uint64_t>(widthOf(data));
    const bool isTiled = header().hasTileDescription();
    const std::uint64_t columns = width + (isTiled ? header().tileDescription().xSize : 0);
    const auto lines =
        isTiled ? std::uint64_t{header().tileDescription().ySize}
                : static_cast<std::uint64_t>(std::min<std::int64_t>(chunkLines_, heightOf(data)));
    std::uint64_t bytes = 0;
    for (auto it = header().channels().begin(); it != header().channels().end(); ++it) {
      bytes += it.channel().type == Imf::HALF ? 2 : 4;
    }
    const auto chunks = static_cast<std::uint64_t>(std::max(1, 2 * Imf::globalThreadCount()));
    const MemoryHold working(limits.budget, columns * lines * chunks, 4 * bytes, path_);

    std::vector<Value> values(width * static_cast<std::uint64_t>(heightOf(data)) * channels.size());
    const std::size_t stride = channels.size() * sizeof(Value);
    Imf::FrameBuffer frame;
    for (const auto c : indices(channels)) {
      const auto& [name, type] = channels[c];
      frame.insert(name, Imf::Slice::Make(type, &values[c], data, stride, stride * width));
    }

    Imf::InputPart part(file_, 0);
    part.setFrameBuffer(frame);
    part.readPixels(data.min.y, data.max.y);
    moveInto(box, data, channels.size(), values);
    return values;
  }

 private:
  const std::string& path_;
  std::int32_t chunkLines_;
  Imf::MultiPartInputFile file_;
};

// Opens the file and runs `use`; reports what OpenEXR throws as our own errors.
template <typename Use>
auto reading(const std::string& path, Use&& use) {
  try {
    ExrFile file(path);
    return use(file);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throwLimit(path + ": not enough memory for this image");
  } catch (const std::exception& e) {
    throwBadScene(path + ": pixels",
                  "expected valid OpenEXR data, found an error: " + endOfMessage(e.what()));
  }
}

// Returns the beginning of the names of the color channels: empty, or a layer with its dot.
std::string colorLayer(const Imf::ChannelList& list) {
  std::string layer;
  for (auto it = list.begin(); it != list.end(); ++it) {
    const std::string name = it.name();
    const std::size_t end = name.rfind('.') + 1;  // 0 without a dot
    const std::string channel = name.substr(end);
    const bool isColor = channel == "R" || channel == "G" || channel == "B";
    if (end == 0 && (isColor || channel == "Y")) return "";
    if (end == 0 || !isColor) continue;
    const std::string found = name.substr(0, end);
    const bool isCombined = found.ends_with("Combined.") && !layer.ends_with("Combined.");
    if (layer.empty() || isCombined) layer = found;
  }
  return layer;
}

bool hasChroma(const Imf::ChannelList& list) {
  return list.findChannel("Y") && (list.findChannel("RY") || list.findChannel("BY")) &&
         !list.findChannel("R");
}

// Returns the 1 to 4 color channels to read. OpenEXR stores 0 where the file lacks one of R, G and
// B.
ExrChannels colorChannels(const std::string& path, const Imf::ChannelList& list) {
  const std::string layer = colorLayer(list);
  const auto has = [&](const char* name) { return list.findChannel(layer + name) != nullptr; };
  ExrChannels channels;
  if (has("R") || has("G") || has("B")) {
    for (const char* name : {"R", "G", "B"}) channels.emplace_back(layer + name, Imf::FLOAT);
  } else if (has("Y")) {
    channels = {{layer + "Y", Imf::FLOAT}};
  } else {
    std::string found;
    for (auto it = list.begin(); it != list.end(); ++it) found += std::string(" ") + it.name();
    throwBadScene(path + ": header", "expected the channels R, G and B, or Y, found" +
                                         (found.empty() ? " none" : excerpt(found)));
  }
  if (has("A")) channels.emplace_back(layer + "A", Imf::FLOAT);
  return channels;
}

// Reads R, G, B and A of an image of luminance and chroma, whose chroma OpenEXR interpolates.
std::vector<float> readChroma(const std::string& path, const Box2i& box,
                              const ImageLimits& limits) {
  Imf::RgbaInputFile file(path.c_str());
  const Box2i data = file.dataWindow();
  const std::size_t width = widthOf(data);
  const std::size_t height = heightOf(data);
  // The library keeps the same again while it works.
  const MemoryHold held = holdImage(path, widthOf(data), heightOf(data),
                                    4 * (sizeof(float) + 2 * sizeof(half)), limits);
  std::vector<Imf::Rgba> pixels(width * height);
  const std::int64_t origin = data.min.x + data.min.y * static_cast<std::int64_t>(width);
  file.setFrameBuffer(pixels.data() - origin, 1, width);
  file.readPixels(data.min.y, data.max.y);

  std::vector<float> values;
  values.reserve(4 * pixels.size());
  for (const Imf::Rgba& p : pixels) {
    values.insert(values.end(), {float{p.r}, float{p.g}, float{p.b}, float{p.a}});
  }
  moveInto(box, data, 4, values);
  return values;
}

Imf::PixelType typeOf(const ImageLayer& layer) {
  return layer.countsThings ? Imf::UINT : Imf::FLOAT;
}

ExrChannels layerChannels(const std::string& path, const Imf::ChannelList& list) {
  constexpr const char* kColors[] = {"R", "G", "B", "Y", "RY", "BY"};
  ExrChannels channels;
  for (auto it = list.begin(); it != list.end(); ++it) {
    const std::string name = it.name();
    if (contains(kColors, name)) continue;
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
      throwBadScene(path + ": header",
                    "expected a value a pixel of channel " + excerpt(name) + ", found fewer");
    }
    channels.emplace_back(name, it.channel().type == Imf::UINT ? Imf::UINT : Imf::FLOAT);
  }
  return channels;
}

static_assert(sizeof(Rgb) == 3 * sizeof(float), "pixels are written as they lie in memory");
static_assert(sizeof(float) == sizeof(std::uint32_t), "layers have one stride");

// The prefix of the attributes that hold our text: OpenEXR's own attributes do not have it.
const std::string kPrefix = "whit:";
constexpr std::array<const char*, 3> kRadianceLayers = {"R", "G", "B"};

// Adds the matrices of the camera that the metadata describe, as OpenEXR defines them: row vectors
// are multiplied from the left, camera space has x to the right, y up and z forwards, and NDC (0,
// 0) is the upper left corner of the picture.
void addCamera(const ImageMetadata& metadata, const Image& image, Imf::Header& header) {
  RenderOptions options;
  bool isLinear = true;  // false: more than the options decides where points are seen
  for (const auto& [name, text] : metadata) {
    const bool isOfCamera = name == "eye" || name == "at" || name == "up" || name == "fov";
    if (isOfCamera || name == "ortho") setOption(options, name, text);
    if (name == "projection") isLinear = false;
  }

  if (!options.eye || !options.at) return;
  // The frame of a far view has the eye in its origin, because single precision would round it.
  const bool isFar = optionOf<Vec3d>(Vec3f(*options.eye), Vec3d()) != *options.eye;
  const Vec3d origin = isFar ? *options.eye : Vec3d();

  Camera camera;
  forEachCameraOption([&](auto option, auto member) {
    if (options.*option) camera.*member = memberOf(*(options.*option), origin);
  });

  const CameraFrame frame = makeCameraFrame(camera, image.width, image.height);
  const double pixel = length(frame.up);
  const Vec3d axes[] = {frame.right * (1 / pixel), frame.up * (1 / pixel), frame.forward};

  Imath::M44f toCamera, toNdc;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) toCamera[k][i] = static_cast<float>(axes[i][k]);
    toCamera[3][i] = static_cast<float>(-dot(frame.eye + origin, axes[i]));
  }
  Imf::addWorldToCamera(header, toCamera);

  if (!isLinear) return;
  toNdc[0][0] = static_cast<float>(1 / (pixel * image.width));
  toNdc[1][1] = static_cast<float>(-1 / (pixel * image.height));

  // A perspective camera divides by the depth.
  const int offset = frame.orthographic ? 3 : 2;
  toNdc[2][2] = toNdc[3][3] = frame.orthographic ? 1 : 0;
  toNdc[2][3] = toNdc[3][2] = frame.orthographic ? 0 : 1;
  toNdc[offset][0] = toNdc[offset][1] = 0.5f;

  Imf::addWorldToNDC(header, toCamera * toNdc);
}

bool inHalf(ExrStorage storage) {
  return storage == ExrStorage::half || storage == ExrStorage::dwaa;
}

// The nearest half floats; a NaN stays a NaN.
std::vector<half> inHalf(const Image& image) {
  constexpr auto kLargest = static_cast<float>(HALF_MAX);
  std::vector<half> values;
  for (const Rgb& pixel : image.pixels) {
    for (int c = 0; c < 3; ++c) values.emplace_back(std::clamp(pixel[c], -kLargest, kLargest));
  }
  return values;
}

// Starts the library's threads; if there is no room for them, it does without. A single thread is
// the caller's: a forked child does not have the library's threads, and would wait for them.
void letCompress(int threads) {
  try {
    if (threads > 1 && threads > Imf::globalThreadCount()) Imf::setGlobalThreadCount(threads);
  } catch (const std::system_error&) {
  }
}

Imf::Header makeHeader(const Image& image, const ImageMetadata& metadata, ExrStorage storage,
                       const std::vector<ImageLayer>& layers) {
  const Crop& w = image.window;
  Imf::Header header(Imath::Box2i({0, 0}, {image.width - 1, image.height - 1}),
                     Imath::Box2i({w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}));
  header.compression() = Imf::ZIP_COMPRESSION;
  if (storage == ExrStorage::none) header.compression() = Imf::NO_COMPRESSION;
  if (storage == ExrStorage::dwaa) header.compression() = Imf::DWAA_COMPRESSION;

  if (!image.pixels.empty()) {
    const Imf::Channel channel(inHalf(storage) ? Imf::HALF : Imf::FLOAT);
    for (const char* name : kRadianceLayers) header.channels().insert(name, channel);
  }
  for (const ImageLayer& layer : layers) {
    header.channels().insert(layer.name, Imf::Channel(typeOf(layer)));
  }
  for (const auto& [name, text] : metadata)
    header.insert(kPrefix + name, Imf::StringAttribute(text));
  Imf::addChromaticities(header, Imf::Chromaticities());  // those of Rec. 709
  addCamera(metadata, image, header);
  return header;
}

void writePixels(Imf::OutputFile& exr, Imf::PixelType type, const Image& image, const void* colors,
                 const std::vector<ImageLayer>& layers) {
  const Box2i& data = exr.header().dataWindow();
  const std::size_t bytes = type == Imf::HALF ? sizeof(half) : sizeof(float);
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < kRadianceLayers.size() && !image.pixels.empty(); ++c) {
    frame.insert(kRadianceLayers[c],
                 Imf::Slice::Make(type, static_cast<const char*>(colors) + c * bytes, data,
                                  kRadianceLayers.size() * bytes));
  }
  for (const ImageLayer& layer : layers) {
    frame.insert(layer.name, Imf::Slice::Make(typeOf(layer), layer.words.data(), data));
  }
  exr.setFrameBuffer(frame);
  exr.writePixels(image.windowHeight());
}

// Writes a whole file.
void writeTo(Imf::OStream& out, const Image& image, const Imf::Header& header, ExrStorage storage,
             int threads, const std::vector<ImageLayer>& layers) {
  Imf::OutputFile exr(out, header, threads);
  if (inHalf(storage)) {
    const std::vector<half> values = inHalf(image);
    writePixels(exr, Imf::HALF, image, values.data(), layers);
  } else {
    writePixels(exr, Imf::FLOAT, image, image.pixels.data(), layers);
  }
}

// Colors mean Rec. 709 unless an attribute says otherwise.
bool hasOtherPrimaries(const Imf::Header& header) {
  constexpr float kTolerance = 2e-3f;  // files round the numbers to three digits
  if (!Imf::hasChromaticities(header)) return false;
  const Imf::Chromaticities found = Imf::chromaticities(header), rec709;
  const auto differ = [](const Imath::V2f& a, const Imath::V2f& b) {
    return !a.equalWithAbsError(b, kTolerance);
  };
  return differ(found.red, rec709.red) || differ(found.green, rec709.green) ||
         differ(found.blue, rec709.blue) || differ(found.white, rec709.white);
}

// Returns the alpha of an image in another format, if it has some.
std::vector<ImageLayer> alphaLayer(const std::string& path, const ImageLimits& limits) {
  const RawImage raw = decodeAllBits(path, limits);
  if (raw.channels % 2 != 0) return {};

  ImageLayer alpha{"A", false, {}};
  for (const auto i : indices(raw.pixels())) {
    alpha.words.push_back(std::bit_cast<std::uint32_t>(valueAt(raw, i, 3)));
  }
  return {alpha};
}

}  // namespace

ExrImage decodeExr(const std::string& path, bool wholeDisplay, const ImageLimits& limits) {
  return reading(path, [&](ExrFile& file) {
    const ExrChannels channels = colorChannels(path, file.header().channels());
    const bool isChroma = hasChroma(file.header().channels());
    const std::size_t count = isChroma ? 4 : channels.size();
    file.checkSizes(count, limits);

    const Box2i& display = file.header().displayWindow();
    const Box2i visible = file.visible(), kept = wholeDisplay ? display : visible;
    ExrImage image;
    image.width = static_cast<int>(widthOf(display));
    image.height = static_cast<int>(heightOf(display));
    // The sizes have been checked, so these differences fit.
    image.window = {kept.min.x - display.min.x, kept.min.y - display.min.y,
                    kept.max.x - display.min.x + 1, kept.max.y - display.min.y + 1};

    image.raw =
        startImage(path, widthOf(kept), heightOf(kept), static_cast<int>(count), true, limits);
    if (isChroma) {
      image.raw.values = readChroma(path, kept, limits);
    } else {
      image.raw.values = file.read<float>(kept, channels, limits);
    }

    const Imf::Header& header = file.header();
    image.raw.isCube = Imf::hasEnvmap(header) && Imf::envmap(header) == Imf::ENVMAP_CUBE;
    if (hasOtherPrimaries(header)) image.raw.leftOut = kOtherPrimaries;
    return image;
  });
}

std::vector<ImageLayer> readLayers(const std::string& path, const ImageLimits& limits) {
  if (!isExrFile(path)) return alphaLayer(path, limits);
  return reading(path, [&](ExrFile& file) {
    std::vector<ImageLayer> layers;
    const ExrChannels channels = layerChannels(path, file.header().channels());
    if (channels.empty()) return layers;
    file.checkSizes(channels.size(), limits);

    // The channels are read side by side and become layers one after the other.
    const auto words = file.read<std::uint32_t>(file.visible(), channels, limits);
    for (const auto c : indices(channels)) {
      ImageLayer& layer = layers.emplace_back();
      layer.name = channels[c].first;
      layer.countsThings = channels[c].second == Imf::UINT;
      for (std::size_t i = c; i < words.size(); i += channels.size()) {
        layer.words.push_back(words[i]);
      }
    }
    return layers;
  });
}

ImageMetadata readExrMetadata(const std::string& path) {
  return reading(path, [&](const ExrFile& file) {
    ImageMetadata metadata;
    for (auto it = file.header().begin(); it != file.header().end(); ++it) {
      const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
      const std::string name = it.name();
      if (text == nullptr || !name.starts_with(kPrefix)) continue;
      metadata.emplace_back(name.substr(kPrefix.size()), text->value());
    }
    return metadata;
  });
}

std::string encodeExr(const Image& image, const ImageMetadata& metadata,
                      const std::vector<ImageLayer>& layers) {
  Imf::StdOSStream out;
  const Imf::Header header = makeHeader(image, metadata, ExrStorage::zip, layers);
  writeTo(out, image, header, ExrStorage::zip, 1, layers);
  return out.str();
}

void writeExr(const std::string& path, const Image& image, const ImageMetadata& metadata,
              ExrStorage storage, int threads, const std::vector<ImageLayer>& layers) {
  if (image.pixels.empty() && layers.empty())
    throwUsage("cannot write '" + path + "': the image has no pixels");
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
      const Imf::Header header = makeHeader(image, metadata, storage, layers);
      writeTo(out, image, header, storage, threads, layers);
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

}  // namespace whit
