// Reading WebP, by libwebp where the build has it.
#ifdef WHIT_WEBP
#include <webp/decode.h>

#include "io/image/image_decoders.h"

namespace whit {

RawImage decodeWebp(const std::string& path, FileBytes file, const ImageLimits& limits) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(file.data(), file.size(), &features) != VP8_STATUS_OK) {
    throwBadScene(path, "expected a WebP image, found a damaged header");
  }
  if (features.has_animation) throwBadScene(path, "expected one WebP image, found an animation");

  const bool alpha = features.has_alpha;
  RawImage image = startImage(path, features.width, features.height, alpha ? 4 : 3, false, limits);

  // The decoder keeps a picture of its own, of four bytes a pixel at the most.
  const MemoryHold working(limits.budget, image.pixels(), 4, path);
  image.codes.resize(image.pixels() * static_cast<std::size_t>(image.channels));

  const auto* const decoded = (alpha ? WebPDecodeRGBAInto : WebPDecodeRGBInto)(
      file.data(), file.size(), image.codes.data(), image.codes.size(),
      image.width * image.channels);
  if (!decoded) throwBadScene(path, "expected a WebP image, found damaged or missing data");
  return image;
}

}  // namespace whit
#endif
