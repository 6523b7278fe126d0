// Writing OpenEXR, and the text that was written with it.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/image_exr.h"
#include "io/image_file.h"

namespace whit {

namespace {

static_assert(sizeof(Rgb) == 3 * sizeof(float), "pixels are written as they lie in memory");

const std::string kPrefix = "whit.";

// Attributes that mean something to OpenEXR itself, and so cannot carry our text.
bool isReserved(const std::string& name) {
  constexpr std::array<const char*, 5> kReserved = {"chunkCount", "name", "type", "version",
                                                    "view"};
  return std::find(kReserved.begin(), kReserved.end(), name) != kReserved.end();
}

std::string attributeName(const Imf::Header& header, const std::string& name) {
  return isReserved(name) || header.find(name) != header.end() ? kPrefix + name : name;
}

Imf::Header makeHeader(const Image& image, const ImageMetadata& metadata) {
  const Crop& w = image.window;
  Imf::Header header(Imath::Box2i({0, 0}, {image.width - 1, image.height - 1}),
                     Imath::Box2i({w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}));
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  for (const auto& [name, text] : metadata)
    header.insert(attributeName(header, name), Imf::StringAttribute(text));
  return header;
}

}  // namespace

void writeExr(const std::string& path, const Image& image, const ImageMetadata& metadata) {
  if (image.pixels.empty()) throwUsage("cannot write '" + path + "': the image has no pixels");
  AtomicFile file(path);
  try {
    // The stream is ours, because OpenEXR keeps quiet about what fails while it closes a file.
    std::ofstream stream(file.temporaryPath(), std::ios::binary | std::ios::trunc);
    {
      Imf::StdOFStream out(stream, path.c_str());
      const Imf::Header header = makeHeader(image, metadata);
      Imf::OutputFile exr(out, header);
      const auto width = static_cast<std::size_t>(image.windowWidth());
      Imf::FrameBuffer frame;
      int channel = 0;
      for (const char* name : {"R", "G", "B"})
        frame.insert(name, Imf::Slice::Make(Imf::FLOAT, &image.pixels[0][channel++],
                                            header.dataWindow(), sizeof(Rgb), width * sizeof(Rgb)));
      exr.setFrameBuffer(frame);
      exr.writePixels(image.windowHeight());
    }
    stream.close();
    if (!stream) throwIo("cannot write '" + path + "': no space left, or the device failed");
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throwIo("cannot write '" + path + "': " + e.what());
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
