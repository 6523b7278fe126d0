// Textures painted by formulas over the unit square. Patterns repeat seamlessly: f(u + 1, v) = f(u,
// v) and the same in v; v points up.
#pragma once

#include <functional>
#include <string>

#include "make/shape.h"
#include "scene/texture.h"

namespace whit::procedural {

using ColorFormula = std::function<Rgb(double u, double v)>;
using ScalarFormula = std::function<double(double u, double v)>;

// Linear colors in [0, 1].
Texture paintColor(const std::string& name, int side, const ColorFormula& color);

// Tangent-space normals (data, n / 2 + 1 / 2, +y up) of the surface whose height over the square,
// in units of the square's side, is `height`: (-dh/du, -dh/dv, 1), normalized.
Texture paintNormals(const std::string& name, int side, const ScalarFormula& height);

// Paints the same value into r, g and b; a is 1.
Texture paintScalar(const std::string& name, int side, const ScalarFormula& value);

// Every pattern's `size`, texels a side.
int sideOf(ShapeParameters& parameters, int fallback = 512);
// Linear light, clamped to [0, 1] when it is encoded.
Rgb colorOf(ShapeParameters& parameters, const std::string& key, const Vec3d& fallback);
Rgb mix(const Rgb& a, const Rgb& b, double t);

}  // namespace whit::procedural
