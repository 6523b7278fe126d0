#include "io/image/texture_from_image.h"

#include <algorithm>
#include <array>

#include "core/display.h"

namespace whit {

namespace {

int wrapped(int i, int size, Wrap wrap) {
  return wrap == Wrap::repeat ? (i + size) % size : std::clamp(i, 0, size - 1);
}

// The channels of pixel `i` as r, g, b, a; `one` replaces a missing alpha.
template <typename Value>
std::array<Value, 4> channelsOf(const std::vector<Value>& values, int channels, std::size_t i,
                                Value one) {
  const Value* v = values.data() + i * static_cast<std::size_t>(channels);
  if (channels < 3) return {v[0], v[0], v[0], channels == 2 ? v[1] : one};
  return {v[0], v[1], v[2], channels == 4 ? v[3] : one};
}

// The 10 bits of a color texel for each sRGB code, computed once because they need square roots.
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
  if (format == TexelFormat::data) return encodeDataTexel(v[0], v[1], v[2], v[3]);
  return encodeTexel({v[0], v[1], v[2]}, format);
}

// Counts the pixels of a linear image with a color above the limit.
std::uint64_t countAbove(const RawImage& raw, float limit) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; raw.linear && i < raw.pixels(); ++i) {
    const auto c = channelsOf(raw.values, raw.channels, i, 1.0f);
    count += std::max({c[0], c[1], c[2]}) > limit;
  }
  return count;
}

}  // namespace

std::array<float, 4> valuesAt(const RawImage& raw, std::size_t i) {
  if (raw.linear) return channelsOf(raw.values, raw.channels, i, 1.0f);
  const auto codes = channelsOf(raw.codes, raw.channels, i, std::uint8_t{255});
  std::array<float, 4> values{};
  for (std::size_t c = 0; c < 4; ++c) values[c] = static_cast<float>(codes[c]) / 255.0f;
  return values;
}

Texture emptyTexture(const std::string& name, TexelFormat format, int width, int height) {
  Texture texture;
  texture.name = name;
  texture.format = format;
  texture.width = width;
  texture.height = height;
  texture.texels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  return texture;
}

Texture makeTexture(const std::string& name, const RawImage& raw, TexelFormat format) {
  Texture texture = emptyTexture(name, format, raw.width, raw.height);
  for (std::size_t i = 0; i < texture.texels.size(); ++i) {
    texture.texels[i] =
        raw.linear
            ? texelOfValues(channelsOf(raw.values, raw.channels, i, 1.0f), format)
            : texelOfCodes(channelsOf(raw.codes, raw.channels, i, std::uint8_t{255}), format);
  }
  return texture;
}

Texture makeAlphaTexture(const std::string& name, const RawImage& raw) {
  Texture texture = emptyTexture(name, TexelFormat::data, raw.width, raw.height);
  for (std::size_t i = 0; i < texture.texels.size(); ++i) {
    const float alpha = valuesAt(raw, i)[3];
    texture.texels[i] = encodeDataTexel(alpha, alpha, alpha, 1);
  }
  return texture;
}

TexelFormat emissionFormat(const RawImage& raw) {
  return countAbove(raw, 1) > 0 ? TexelFormat::radiance : TexelFormat::color;
}

std::uint32_t encodeTexel(const Rgb& linear, TexelFormat format) {
  return format == TexelFormat::radiance ? encodeRadianceTexel(linear) : encodeColorTexel(linear);
}

void warnOfClampedColors(const std::string& name, const RawImage& raw, Warnings& warnings) {
  warnings.add("color texel above 1 clamped", name, countAbove(raw, 1));
}

Texture makeEmissionTexture(const std::string& name, const RawImage& raw, Warnings& warnings) {
  warnings.add("emission texel above 65408 clamped", name, countAbove(raw, kLargestRadianceTexel));
  return makeTexture(name, raw, emissionFormat(raw));
}

EnvironmentImage makeEnvironment(const RawImage& raw) {
  EnvironmentImage environment;
  environment.width = raw.width;
  environment.height = raw.height;
  const std::size_t count = raw.pixels();
  for (auto* plane : {&environment.r, &environment.g, &environment.b}) plane->resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Rgb value = linearPixel(raw, i);
    environment.r[i] = value.x;
    environment.g[i] = value.y;
    environment.b[i] = value.z;
  }
  return environment;
}

bool hasTranslucentAlpha(const RawImage& raw) {
  const bool hasAlpha = raw.channels == 2 || raw.channels == 4;
  for (std::size_t i = 0; hasAlpha && i < raw.pixels(); ++i) {
    if (valuesAt(raw, i)[3] < 1.0f) return true;
  }
  return false;
}

bool looksLikeHeights(const RawImage& raw) {
  if (raw.channels < 3) return true;
  constexpr float kChromaNoise = 16.0f / 255.0f;  // in gray pictures stored as JPEG
  for (std::size_t i = 0; i < raw.pixels(); ++i) {
    const auto [r, g, b, a] = valuesAt(raw, i);
    if (std::max({r, g, b}) - std::min({r, g, b}) > kChromaNoise) return false;
  }
  return true;
}

Texture normalsFromHeights(const std::string& name, const RawImage& raw, float bumpScale,
                           Wrap wrapU, Wrap wrapV) {
  Texture texture = emptyTexture(name, TexelFormat::data, raw.width, raw.height);
  const auto height = [&](int x, int y) {
    const std::size_t row = static_cast<std::size_t>(wrapped(y, raw.height, wrapV));
    const std::size_t column = static_cast<std::size_t>(wrapped(x, raw.width, wrapU));
    return valuesAt(raw, row * static_cast<std::size_t>(raw.width) + column)[0];
  };
  // Slopes per tile width, so that the relief does not depend on the resolution.
  const float scaleX = bumpScale / kTileHeights * static_cast<float>(raw.width) / 2;
  const float scaleY = bumpScale / kTileHeights * static_cast<float>(raw.height) / 2;
  std::size_t i = 0;
  for (int y = 0; y < raw.height; ++y) {
    for (int x = 0; x < raw.width; ++x, ++i) {
      // Row 0 is the top: v grows as y falls.
      const float slopeU = (height(x + 1, y) - height(x - 1, y)) * scaleX;
      const float slopeV = (height(x, y - 1) - height(x, y + 1)) * scaleY;
      const Vec3f n = normalized(Vec3f{-slopeU, -slopeV, 1.0f}, Vec3f{0, 0, 1});
      texture.texels[i] =
          encodeDataTexel(n.x * 0.5f + 0.5f, n.y * 0.5f + 0.5f, n.z * 0.5f + 0.5f, 1.0f);
    }
  }
  return texture;
}

}  // namespace whit
