#include "io/image/texture_from_image.h"

#include <algorithm>

namespace whit {

namespace {

// Counts the pixels of a linear image with a color above the limit.
std::uint64_t countAbove(const RawImage& raw, float limit) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; raw.linear && i < raw.pixels(); ++i) {
    const auto [r, g, b, a] = valuesAt(raw, i);
    count += std::max({r, g, b}) > limit;
  }
  return count;
}

}  // namespace

std::array<float, 4> valuesAt(const RawImage& raw, std::size_t i) {
  const std::size_t first = i * static_cast<std::size_t>(raw.channels);
  const auto value = [&](std::size_t c) {
    return raw.linear ? raw.values[first + c] : static_cast<float>(raw.codes[first + c]) / 255.0f;
  };
  if (raw.channels < 3) {
    return {value(0), value(0), value(0), raw.channels == 2 ? value(1) : 1.0f};
  }
  return {value(0), value(1), value(2), raw.channels == 4 ? value(3) : 1.0f};
}

Texture makeTexture(const std::string& name, const RawImage& raw, TexelFormat format) {
  Texture texture = emptyTexture(name, format, raw.width, raw.height);
  for (std::size_t i = 0; i < texture.texels.size(); ++i) {
    if (format == TexelFormat::data) {
      const auto [r, g, b, a] = valuesAt(raw, i);
      texture.texels[i] = encodeDataTexel(r, g, b, a);
    } else {
      texture.texels[i] = encodeTexel(linearPixel(raw, i), format);
    }
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
    const std::size_t row = static_cast<std::size_t>(wrapTexel(y, raw.height, wrapV));
    const std::size_t column = static_cast<std::size_t>(wrapTexel(x, raw.width, wrapU));
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
