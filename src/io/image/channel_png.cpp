// Channels as 16-bit PNG.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/formatted.h"
#include "core/srgb.h"
#include "io/image/image_layers.h"

namespace whit {

namespace {

constexpr int kWhite16 = 65535;
constexpr double kCodesPerUnit = 1000;  // of depth

// `share` of 1.
std::uint16_t codeOfShare(double share) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * kWhite16));
}

std::uint16_t depthCode(const std::string& path, double z) {
  if (std::isinf(z)) return 0;
  const double code = std::round(z * kCodesPerUnit);
  if (!(code >= 0 && code <= kWhite16)) {
    throwLimit(
        formatted("'%s': a depth of %g does not fit into 16 bits, which hold thousandths of "
                  "a unit up to 65.535: write an EXR",
                  path.c_str(), z));
  }
  return static_cast<std::uint16_t>(code);
}

std::uint16_t numberCode(const std::string& path, Channel channel, std::uint32_t number) {
  const bool counts = channel == Channel::rays;
  if (number == kNoNumber && !counts) return kWhite16;
  if (number > static_cast<std::uint32_t>(counts ? kWhite16 : kWhite16 - 1)) {
    throwLimit(formatted("'%s': %s number %u does not fit into 16 bits: write an EXR", path.c_str(),
                         std::string(infoOf(channel).name).c_str(), number));
  }
  return static_cast<std::uint16_t>(number);
}

// Three codes a pixel from so many components.
template <typename CodeOf>
std::vector<std::uint16_t> colorCodes(std::span<const float> values, std::size_t components,
                                      CodeOf&& codeOfValue) {
  std::vector<std::uint16_t> codes;
  codes.reserve(values.size() / components * 3);
  for (std::size_t i = 0; i < values.size(); i += components) {
    for (std::size_t c = 0; c < 3; ++c) {
      codes.push_back(c < components ? codeOfValue(double{values[i + c]}) : 0);
    }
  }
  return codes;
}

// A normal of length 0 is none.
std::vector<std::uint16_t> normalCodes(std::span<const float> values) {
  std::vector<std::uint16_t> codes =
      colorCodes(values, 3, [](double n) { return codeOfShare((n + 1) / 2); });
  for (std::size_t i = 0; i < values.size(); i += 3) {
    if (values[i] != 0 || values[i + 1] != 0 || values[i + 2] != 0) continue;
    std::fill_n(codes.begin() + static_cast<std::ptrdiff_t>(i), 3, std::uint16_t{0});
  }
  return codes;
}

std::vector<std::uint16_t> codesOf(const std::string& path, const ChannelLayers& channels,
                                   Channel channel) {
  std::vector<std::uint16_t> codes;
  switch (channel) {
    case Channel::depth: {
      const std::span<const float> depth = channels.floats(channel);
      for (std::size_t i = 0; i < depth.size(); i += 2) {
        codes.push_back(depthCode(path, double{depth[i]}));
      }
      return codes;
    }
    case Channel::normal:
      return normalCodes(channels.floats(channel));
    case Channel::albedo:
      return colorCodes(channels.floats(channel), 3, [](double x) {
        return codeOfShare(linearToSrgb(std::clamp(x, 0.0, 1.0)));
      });
    case Channel::uv:
      return colorCodes(channels.floats(channel), 2,
                        [](double x) { return codeOfShare(x - std::floor(x)); });
    case Channel::position:
      throwUsage("'" + path + "': positions do not fit into a PNG: write an EXR");
    default:
      for (const std::uint32_t number : channels.numbers(channel)) {
        codes.push_back(numberCode(path, channel, number));
      }
      return codes;
  }
}

}  // namespace

void writeChannelPng(const std::string& path, const Image& image, const ChannelLayers& channels,
                     Channel channel, const ImageMetadata& metadata) {
  const bool isColor =
      channel == Channel::normal || channel == Channel::albedo || channel == Channel::uv;
  writePng(path,
           {image.windowWidth(), image.windowHeight(), isColor ? 3 : 1,
            codesOf(path, channels, channel)},
           channel == Channel::albedo, metadata);
}

}  // namespace whit
