#include "reference/update_image.h"

#include <cmath>

#include "core/display.h"

namespace whit::reference {

std::uint32_t displayCode(const Rgb& pixel, double exposureScale, ToneCurve curve,
                          SrgbEncoding encoding) {
  const auto codes = displayCodes(pixel, exposureScale, curve, encoding);
  return codes[0] | std::uint32_t{codes[1]} << 8 | std::uint32_t{codes[2]} << 16;
}

std::uint32_t updateImage(const RenderOptions& options, const Rgb& pixel) {
  return displayCode(pixel * std::exp2(options.exposure.ev), 1, options.toneCurve, options.srgb);
}

}  // namespace whit::reference
