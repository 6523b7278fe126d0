#include "make/patterns/paint.h"

#include "scene/generation_limit.h"

namespace whit::procedural {
namespace {

std::size_t texelsOf(int side) {
  return static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
}

Texture blank(const std::string& name, int side, TexelFormat format) {
  GenerationLimit::charge(texelsOf(side), sizeof(std::uint32_t));
  return emptyTexture(name, format, side, side);
}

// Calls visit(u, v) at the texel centers, row by row from the top.
template <typename Visitor>
void forEachTexel(int side, Visitor&& visit) {
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      visit((column + 0.5) / side, 1 - (row + 0.5) / side);
    }
  }
}

}  // namespace

Texture paintColor(const std::string& name, int side, const ColorFormula& color) {
  Texture texture = blank(name, side, TexelFormat::color);
  std::uint32_t* to = texture.texels.data();
  forEachTexel(side, [&](double u, double v) { *to++ = encodeColorTexel(color(u, v)); });
  return texture;
}

Texture paintNormals(const std::string& name, int side, const ScalarFormula& height) {
  Texture texture = blank(name, side, TexelFormat::data);
  std::vector<double> heights;
  GenerationLimit::charge(texelsOf(side), sizeof(double));
  heights.reserve(texelsOf(side));
  forEachTexel(side, [&](double u, double v) { heights.push_back(height(u, v)); });
  const auto at = [&](int row, int column) {
    const int r = row < 0 ? side - 1 : row < side ? row : 0;
    const int c = column < 0 ? side - 1 : column < side ? column : 0;
    return heights[static_cast<std::size_t>(r) * static_cast<std::size_t>(side) +
                   static_cast<std::size_t>(c)];
  };
  const double reach = 2.0 / side;  // between the neighbors on both sides
  std::uint32_t* to = texture.texels.data();
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const double du = at(row, column + 1) - at(row, column - 1);
      const double dv = at(row - 1, column) - at(row + 1, column);
      const Vec3d n = normalized(Vec3d{-du, -dv, reach});
      const auto code = [](double x) { return static_cast<float>(0.5 + 0.5 * x); };
      *to++ = encodeDataTexel(code(n.x), code(n.y), code(n.z), 1);
    }
  }
  return texture;
}

Texture paintScalar(const std::string& name, int side, const ScalarFormula& value) {
  Texture texture = blank(name, side, TexelFormat::data);
  std::uint32_t* to = texture.texels.data();
  forEachTexel(side, [&](double u, double v) {
    const auto x = static_cast<float>(value(u, v));
    *to++ = encodeDataTexel(x, x, x, 1);
  });
  return texture;
}

int sideOf(ShapeParameters& parameters, int fallback) {
  return parameters.integer("size", fallback, 1, 8192);
}

Rgb colorOf(ShapeParameters& parameters, const std::string& key, const Vec3d& fallback) {
  return Rgb(parameters.vector(key, fallback));
}

Rgb mix(const Rgb& a, const Rgb& b, double t) {
  const auto s = static_cast<float>(t);
  return a * (1 - s) + b * s;
}

}  // namespace whit::procedural
