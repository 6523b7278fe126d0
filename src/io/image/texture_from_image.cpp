#include "io/image/texture_from_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/display.h"
#include "core/index.h"

namespace whit {

namespace {

std::array<float, 4> valuesAt(const RawImage& raw, std::size_t i) {
  return {valueAt(raw, i, 0), valueAt(raw, i, 1), valueAt(raw, i, 2), valueAt(raw, i, 3)};
}

// Counts the pixels of a linear image with a color above the limit.
std::uint64_t countAbove(const RawImage& raw, float limit) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; raw.linear && i < raw.pixels(); ++i) {
    const auto [r, g, b, a] = valuesAt(raw, i);
    count += std::max({r, g, b}) > limit;
  }
  return count;
}

// Encodes an image of 8-bit codes, of which there are so few that a table holds all results.
void fillColors(const RawImage& raw, std::vector<std::uint32_t>& texels) {
  std::array<std::uint32_t, 256> encoded{};
  for (const auto code : indices(encoded)) {
    encoded[code] = encodeColorTexel(Rgb(linearOfCodes()[code]));
  }

  const std::size_t green = raw.channels < 3 ? 0 : 1, blue = 2 * green;
  const std::uint8_t* codes = raw.codes.data();
  for (std::uint32_t& texel : texels) {
    texel = (encoded[codes[0]] & 0x3ffu) | (encoded[codes[green]] & 0xffc00u) |
            (encoded[codes[blue]] & 0x3ff00000u);
    codes += raw.channels;
  }
}

// Data textures keep the codes of an image of 8-bit codes; see valueAt() for missing channels.
void fillData(const RawImage& raw, std::vector<std::uint32_t>& texels) {
  const bool hasAlpha = raw.channels % 2 == 0;
  const std::size_t green = raw.channels < 3 ? 0 : 1, blue = 2 * green;
  const std::size_t alpha = static_cast<std::size_t>(raw.channels) - 1;

  const std::uint8_t* codes = raw.codes.data();
  for (std::uint32_t& texel : texels) {
    const std::uint32_t opacity = hasAlpha ? codes[alpha] : 255u;
    texel = std::uint32_t{codes[0]} | std::uint32_t{codes[green]} << 8 |
            std::uint32_t{codes[blue]} << 16 | opacity << 24;
    codes += raw.channels;
  }
}

int cubeSide(const RawImage& raw) { return std::min(raw.width, raw.height / 6); }

// Looks a cube map (OpenEXR, "Environment Maps") up bilinearly in a direction.
Rgb cubePixel(const RawImage& raw, const Vec3d& direction) {
  const int last = cubeSide(raw) - 1;

  // The largest component of the direction selects the face, and the others give the place on it.
  const Vec3d size = abs(direction);
  const int axis = largestAxis(size);
  // Centers of pixels lie on the edges of the cube.
  const auto place = [&](int along) { return (direction[along] / size[axis] + 1) / 2 * last; };
  const double s = place(axis == 0 ? 1 : 0);
  const double t = place(axis == 2 ? 1 : 2);

  // Column and row within the faces in the file's order, x, -x, y, -y, z and -z.
  const bool isNegative = direction[axis] < 0;
  const double columns[] = {t, last - t, s, s, last - s, s};
  const double rows[] = {last - s, last - s, last - t, t, last - t, last - t};
  const int face = 2 * axis + (isNegative ? 1 : 0);
  const double column = std::clamp(columns[face], 0.0, double(last));
  const double row = std::clamp(rows[face], 0.0, double(last));

  // The four nearest pixels are weighted bilinearly.
  const int left = std::min(static_cast<int>(column), std::max(last - 1, 0));
  const int top = std::min(static_cast<int>(row), std::max(last - 1, 0));
  RgbD sum;
  for (int y = top; y <= std::min(top + 1, last); ++y) {
    for (int x = left; x <= std::min(left + 1, last); ++x) {
      const double weight = (1 - std::abs(column - x)) * (1 - std::abs(row - y));
      const std::size_t line = static_cast<std::size_t>(face) * (last + 1) + y;
      sum += RgbD(linearPixel(raw, line * static_cast<std::size_t>(raw.width) + x)) * weight;
    }
  }
  return Rgb(sum);
}

// Returns the direction of a pixel of a latitude-longitude image: z is in the middle, y is up.
Vec3d directionOf(int column, int row, const EnvironmentImage& image) {
  const double longitude = (0.5 - (column + 0.5) / image.width) * 2 * std::numbers::pi;
  const double latitude = (0.5 - (row + 0.5) / image.height) * std::numbers::pi;
  const double across = std::cos(latitude);
  return {std::sin(longitude) * across, std::sin(latitude), std::cos(longitude) * across};
}

}  // namespace

Texture makeTexture(const std::string& name, const RawImage& raw, TexelFormat format) {
  Texture texture = emptyTexture(name, format, raw.width, raw.height);
  if (format == TexelFormat::color && !raw.linear) {
    fillColors(raw, texture.texels);
    return texture;
  }
  if (format == TexelFormat::data && !raw.linear) {
    fillData(raw, texture.texels);
    return texture;
  }

  for (const auto i : indices(texture.texels)) {
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
  for (const auto i : indices(texture.texels)) {
    const float alpha = valueAt(raw, i, 3);
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
  const bool isCube = raw.isCube && cubeSide(raw) > 0;

  // A cube becomes a latitude-longitude image, which is as wide as four of its faces.
  EnvironmentImage environment;
  environment.width = isCube ? 4 * cubeSide(raw) : raw.width;
  environment.height = isCube ? 2 * cubeSide(raw) : raw.height;
  const std::size_t count = cellsOf(environment.width, environment.height);
  for (auto* plane : {&environment.r, &environment.g, &environment.b}) plane->resize(count);

  std::size_t i = 0;
  for (int row = 0; row < environment.height; ++row) {
    for (int column = 0; column < environment.width; ++column, ++i) {
      Rgb value;
      if (isCube) {
        value = cubePixel(raw, directionOf(column, row, environment));
      } else {
        value = linearPixel(raw, i);
      }
      environment.r[i] = value.x;
      environment.g[i] = value.y;
      environment.b[i] = value.z;
    }
  }

  return environment;
}

bool hasTranslucentAlpha(const RawImage& raw) {
  if (raw.channels != 2 && raw.channels != 4) return false;

  for (const auto i : indices(raw.pixels())) {
    if (valueAt(raw, i, 3) < 1.0f) return true;
  }
  return false;
}

bool looksLikeHeights(const RawImage& raw) {
  if (raw.channels < 3) return true;

  constexpr float kChromaNoise = 16.0f / 255.0f;  // in gray pictures stored as JPEG
  for (const auto i : indices(raw.pixels())) {
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
    return valueAt(raw, row * static_cast<std::size_t>(raw.width) + column, 0);
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
