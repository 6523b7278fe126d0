// From decoded images to what shading reads.
#include <array>

#include "core/srgb.h"
#include "io/image_file.h"
#include "scene/texture.h"

namespace whit {

namespace {

// The channels of pixel `i` as r, g, b, a; `one` is what a missing alpha is.
template <typename Value>
std::array<Value, 4> channelsOf(const std::vector<Value>& values, int channels, std::size_t i,
                                Value one) {
  const Value* v = values.data() + i * static_cast<std::size_t>(channels);
  switch (channels) {
    case 1:
      return {v[0], v[0], v[0], one};
    case 2:
      return {v[0], v[0], v[0], v[1]};
    case 3:
      return {v[0], v[1], v[2], one};
    default:
      return {v[0], v[1], v[2], v[3]};
  }
}

// The 10 bits that a color texel keeps of each sRGB code: the same for every image, so the square
// roots are taken once.
const std::array<std::uint32_t, 256>& colorBitsOfCode() {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> bits{};
    for (int code = 0; code < 256; ++code) {
      bits[static_cast<std::size_t>(code)] = encodeColorTexel({linearOfCode(code), 0, 0}) & 1023u;
    }
    return bits;
  }();
  return table;
}

std::uint32_t texelOfCodes(const std::array<std::uint8_t, 4>& c, TexelFormat format) {
  if (format == TexelFormat::color) {
    const auto& bits = colorBitsOfCode();
    return bits[c[0]] | bits[c[1]] << 10 | bits[c[2]] << 20;
  }
  return std::uint32_t{c[0]} | std::uint32_t{c[1]} << 8 | std::uint32_t{c[2]} << 16 |
         std::uint32_t{c[3]} << 24;
}

std::uint32_t texelOfValues(const std::array<float, 4>& v, TexelFormat format) {
  if (format == TexelFormat::color) return encodeColorTexel({v[0], v[1], v[2]});
  return encodeDataTexel(v[0], v[1], v[2], v[3]);
}

}  // namespace

Texture makeTexture(const std::string& name, const RawImage& raw, TexelFormat format) {
  Texture texture;
  texture.name = name;
  texture.format = format;
  texture.width = raw.width;
  texture.height = raw.height;
  const std::size_t count =
      static_cast<std::size_t>(raw.width) * static_cast<std::size_t>(raw.height);
  texture.texels.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    texture.texels.push_back(
        raw.linear
            ? texelOfValues(channelsOf(raw.values, raw.channels, i, 1.0f), format)
            : texelOfCodes(channelsOf(raw.codes, raw.channels, i, std::uint8_t{255}), format));
  }
  return texture;
}

EnvironmentImage makeEnvironment(const RawImage& raw) {
  EnvironmentImage environment;
  environment.width = raw.width;
  environment.height = raw.height;
  const std::size_t count =
      static_cast<std::size_t>(raw.width) * static_cast<std::size_t>(raw.height);
  for (auto* plane : {&environment.r, &environment.g, &environment.b}) plane->resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 4> value{};
    if (raw.linear) {
      value = channelsOf(raw.values, raw.channels, i, 1.0f);
    } else {
      const auto codes = channelsOf(raw.codes, raw.channels, i, std::uint8_t{255});
      for (std::size_t c = 0; c < 3; ++c) value[c] = linearOfCode(codes[c]);
    }
    environment.r[i] = value[0];
    environment.g[i] = value[1];
    environment.b[i] = value[2];
  }
  return environment;
}

}  // namespace whit
