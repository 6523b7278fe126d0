#include "cli/whole_image.h"

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "io/paths.h"

namespace whit::cli {

namespace {

constexpr std::uint64_t kLargestPixel = 4 * sizeof(float);  // in a file that might be whole

// The pixels are read as well: a file that was cut off still has its head.
ImageMetadata readThrough(const std::string& path, const Image& image) {
  if (extensionOf(path) == ".png") return readPngMetadata(path);
  Warnings warnings;
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
  const ImageLimits limits{kImageSideLimit, kLargestPixel * pixels};
  readImage(path, limits, warnings);
  return readExrMetadata(path);
}

// In an order that does not depend on the format; without what says nothing or may differ.
ImageMetadata comparable(ImageMetadata metadata, const RenderOptions& options) {
  std::erase_if(metadata, [&](const auto& entry) {
    return entry.second.empty() || (entry.first == "simd" && options.simd == "auto") ||
           (entry.first == "packet" && options.packet == 0);
  });
  std::sort(metadata.begin(), metadata.end());
  return metadata;
}

}  // namespace

bool isWhole(const std::string& path, const Image& image, const ImageMetadata& expected,
             const RenderOptions& options) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  try {
    return comparable(readThrough(path, image), options) == comparable(expected, options);
  } catch (const Error& broken) {
    if (broken.status() == ExitStatus::io) throw;
    return false;
  }
}

}  // namespace whit::cli
