#include "output/image_output.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "command_line/program.h"
#include "core/error.h"
#include "core/index.h"
#include "core/option_table.h"
#include "core/text.h"

namespace whit {

namespace {

constexpr int kFrameLimit = 10'000'000;

bool readFrameNumber(const std::string& text, int& value) {
  return readNumber(text, value) && value >= 0 && value <= kFrameLimit;
}

void writeDisplay(const std::string& path, const DisplayImage& image,
                  const ImageMetadata& metadata) {
  if (path != kStandardOutput) {
    writePng(path, image, metadata);
    return;
  }

  const std::string bytes = encodePng(image, metadata);
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() ||
      std::fflush(stdout) != 0) {
    throwIo(std::string("cannot write to standard output: ") + std::strerror(errno));
  }
}

constexpr std::uint64_t kLargestPixel = 4 * sizeof(float);  // bytes of a pixel that whit writes

// Reads all of a picture and returns its metadata. A file that was cut off still has its head, so
// the pixels are read as well.
ImageMetadata readThrough(const std::string& path, const Image& image) {
  if (extensionOf(path) == ".png") return readPngMetadata(path);

  const std::uint64_t pixels = cellsOf(image.width, image.height);
  // The limits keep a foreign file from taking more memory than this picture can need.
  const ImageLimits limits{kImageSideLimit, kLargestPixel * pixels};

  readImage(path, limits);
  return readExrMetadata(path);
}

// Returns the metadata sorted, without empty entries and without those that may differ between
// machines.
ImageMetadata comparable(ImageMetadata metadata, const RenderOptions& options) {
  std::erase_if(metadata, [&](const auto& entry) {
    return entry.second.empty() || (entry.first == "simd" && options.simd == "auto") ||
           (entry.first == "packet" && options.packet == 0);
  });
  std::ranges::sort(metadata);
  return metadata;
}

}  // namespace

bool isJpeg(const std::string& path) {
  return extensionOf(path) == ".jpg" || extensionOf(path) == ".jpeg";
}

void requireWritable(const std::string& path, const std::vector<std::string>& extensions) {
  if (!extensions.empty() && !contains(extensions, extensionOf(path))) {
    throwUsage("'" + path + "': expected a name that ends in " + joined(extensions, " or "));
  }

  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throwIo("cannot write '" + path + "': it is a folder");
  }
  if (std::filesystem::is_other(path, error)) return;  // a device or a pipe

  const std::filesystem::path file(linkTarget(path));
  const std::string place = file.has_parent_path() ? file.parent_path().string() : ".";
  if (!std::filesystem::is_directory(place, error)) {
    throwIo("cannot write '" + path + "': there is no folder '" + place + "'");
  }
  if (access(place.c_str(), W_OK) != 0) {
    throwIo("cannot write '" + path + "': the folder '" + place + "' is write-protected");
  }
  if (std::filesystem::exists(file, error) && access(file.c_str(), W_OK) != 0) {
    throwIo("cannot write '" + path + "': it is write-protected");
  }
}

void requireJsonWritable(const std::string& path) {
  if (!path.empty() && path != "-") requireWritable(path, {});
}

void makeFolder(const std::string& path, const std::vector<std::string>& files) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throwIo("cannot make the folder '" + path + "': " + error.message());

  for (const std::string& file : files) requireWritable(std::filesystem::path(path) / file, {});
}

ImageMetadata ownMetadata(const std::string& path, const ImageFormat& format) {
  if (format.channel) return {{"channel", std::string(infoOf(*format.channel).name)}};
  if (extensionOf(path) != ".exr") return {};

  ImageMetadata own = format.aboutChannels;
  if (format.exr != ExrStorage::zip) {
    own.emplace_back(kExrOption.name, formatValue(kExrOption, format.exr));
  }
  return own;
}

void writeImage(const std::string& path, const Film& film, const ImageMetadata& metadata,
                const ImageFormat& format) {
  const cli::WriteScope scope;
  ImageMetadata all = metadata;
  const ImageMetadata own = ownMetadata(path, format);
  all.insert(all.end(), own.begin(), own.end());

  if (extensionOf(path) == ".exr" && format.channel) {
    writeChannelExr(path, film.image, film.channels, *format.channel, all, format.exr,
                    format.threads);
  } else if (extensionOf(path) == ".exr") {
    writeExr(path, film.image, all, format.exr, format.threads, layersOf(film.channels));
  } else if (format.channel) {
    writeChannelPng(path, film.image, film.channels, *format.channel, all);
  } else if (isJpeg(path)) {
    writeTextFile(path, encodeJpeg(film.display));
  } else {
    writeDisplay(path, film.display, metadata);
  }
}

bool isWhole(const std::string& path, const Image& image, const ImageMetadata& expected,
             const RenderOptions& options) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;

  try {
    return comparable(readThrough(path, image), options) == comparable(expected, options);
  } catch (const Error& broken) {
    // An unreadable file is an error; a damaged one is merely not whole.
    if (broken.status() == ExitStatus::io) throw;
    return false;
  }
}

FrameRange parseFrameRange(const std::string& text) {
  FrameRange range;
  const std::size_t dots = text.find("..");

  const bool good = dots == std::string::npos
                        ? readFrameNumber(text, range.first)
                        : readFrameNumber(text.substr(0, dots), range.first) &&
                              readFrameNumber(text.substr(dots + 2), range.last);
  if (dots == std::string::npos) range.last = range.first;

  if (!good || range.last < range.first) {
    throwUsage("--frames: expected a frame number, or first..last as 0..47, found '" + text + "'");
  }
  return range;
}

std::string frameName(const std::string& pattern, int frame) {
  if (pattern == kStandardOutput) return pattern;

  const std::filesystem::path path(pattern);
  std::string name = path.filename().string();
  const std::size_t begin = name.find('#');
  if (begin == std::string::npos) {
    throwUsage("'" + pattern +
               "': --frames needs a place for the frame's number, as in out-####.exr");
  }

  const std::size_t end = std::min(name.find_first_not_of('#', begin), name.size());
  const int digits = static_cast<int>(end - begin);
  name.replace(begin, end - begin, formatted("%0*d", digits, frame));
  return (path.parent_path() / name).string();
}

void requireNoFrameName(const std::string& name) {
  if (std::filesystem::path(name).filename().string().find("##") == std::string::npos) return;
  throwUsage("'" + name + "': #### is the number of a frame, and there is no --frames A..B");
}

}  // namespace whit
