// Textures painted by formulas over the unit square. Patterns repeat seamlessly: f(u + 1, v) = f(u,
// v) and the same in v; v points up.
#include <algorithm>
#include <cmath>
#include <memory>

#include "core/index.h"
#include "make/patterns/noise.h"
#include "make/shape.h"
#include "scene/generation_limit.h"

namespace whit {
namespace {

using namespace procedural;

// Returns a texture without texels. Every pattern has the parameter `size`, the texels of a side.
Texture blank(ShapeParameters& parameters, int fallback, TexelFormat format) {
  Texture texture;
  texture.format = format;
  texture.width = texture.height = parameters.integer("size", fallback, 1, 8192);

  GenerationLimit::charge(texture.texelCount(), sizeof(std::uint32_t));
  return texture;
}

double fractionOf(double x) { return x - std::floor(x); }

// Calls visit(u, v) at the texel centers, row by row from the top.
template <typename Visitor>
void forEachTexel(int side, Visitor&& visit) {
  for (int row = 0; row < side; ++row) {
    const double v = 1 - (row + 0.5) / side;
    for (int column = 0; column < side; ++column) visit((column + 0.5) / side, v);
  }
}

// Returns a texture that is painted when its texels are needed. `codeOf` encodes what the formula
// returns for u and v. The formula is copied for each painting, because its noise keeps the last
// cell.
template <typename Formula, typename Code>
Texture paint(Texture texture, const Formula& formula, const Code& codeOf) {
  texture.shared = std::make_shared<SharedTexels>([formula, codeOf, side = texture.width] {
    Formula own = formula;
    std::vector<std::uint32_t> texels;
    texels.reserve(std::size_t{1} * side * side);
    forEachTexel(side, [&](double u, double v) { texels.push_back(codeOf(own(u, v))); });
    return texels;
  });
  return texture;
}

// Paints linear colors in [0, 1].
template <typename Formula>
Texture paintColor(ShapeParameters& parameters, const Formula& color, int fallback = 512) {
  return paint(blank(parameters, fallback, TexelFormat::color), color,
               [](const Rgb& linear) { return encodeColorTexel(linear); });
}

// Encodes the normals of a surface whose heights over a square of `side` x `side` texels are given
// in units of the square's side.
std::vector<std::uint32_t> normalTexels(const std::vector<double>& heights, int side) {
  // The texture repeats, so texels on opposite edges are neighbors.
  const auto wrapped = [side](int i) {
    if (i < 0) return side - 1;
    return i < side ? i : 0;
  };
  const auto rowAt = [&](int row) { return &heights[cellsOf(wrapped(row), side)]; };

  const double reach = 2.0 / side;  // between the neighbors on both sides
  std::vector<std::uint32_t> texels;
  texels.reserve(heights.size());
  for (int row = 0; row < side; ++row) {
    // Rows run downwards and v points up.
    const double *above = rowAt(row - 1), *own = rowAt(row), *below = rowAt(row + 1);
    for (int column = 0; column < side; ++column) {
      const double du = own[wrapped(column + 1)] - own[wrapped(column - 1)];
      const double dv = above[column] - below[column];
      const Vec3d n = normalized(Vec3d{-du, -dv, reach});

      const auto code = [](double x) { return static_cast<float>(0.5 + 0.5 * x); };
      texels.push_back(encodeDataTexel(code(n.x), code(n.y), code(n.z), 1));
    }
  }
  return texels;
}

// Paints tangent-space normals (data, n / 2 + 1 / 2, +y up) of the surface whose height over the
// square, in units of the square's side, is `height`: (-dh/du, -dh/dv, 1), normalized.
template <typename Formula>
Texture paintNormals(ShapeParameters& parameters, const Formula& height) {
  Texture texture = blank(parameters, 512, TexelFormat::data);
  GenerationLimit::charge(texture.texelCount(), sizeof(double));

  texture.shared = std::make_shared<SharedTexels>([height, side = texture.width] {
    Formula own = height;
    std::vector<double> heights;
    heights.reserve(std::size_t{1} * side * side);
    forEachTexel(side, [&](double u, double v) { heights.push_back(own(u, v)); });
    return normalTexels(heights, side);
  });
  return texture;
}

// Paints the same value into r, g and b; a is 1.
template <typename Formula>
Texture paintScalar(ShapeParameters& parameters, const Formula& value, int fallback) {
  return paint(blank(parameters, fallback, TexelFormat::data), value, [](double level) {
    const auto x = static_cast<float>(level);
    return encodeDataTexel(x, x, x, 1);
  });
}

// Reads a linear color, which is clamped to [0, 1] when it is encoded.
Rgb colorOf(ShapeParameters& parameters, const std::string& key, const Vec3d& fallback) {
  return Rgb(parameters.color(key, fallback));
}

Rgb mix(const Rgb& a, const Rgb& b, double t) {
  const auto s = static_cast<float>(t);
  return a * (1 - s) + b * s;
}

// Returns a value like a signed distance to a pointed leaf that stands on v = 0: positive inside.
double leafShape(double u, double v, double fullness) {
  const double half = fullness * std::pow(std::sin(3.14159265358979 * std::pow(v, 0.75)), 0.8);
  return half - std::fabs(u - 0.5);
}

// Does the same for a feathered leaf, which has leaflets on both sides of a rib.
double frondShape(double u, double v, int leaflets) {
  const double s = std::fabs(u - 0.5) * 2;
  const double reach = 0.95 * std::pow(std::sin(3.14159265358979 * (0.06 + 0.93 * v)), 0.6);

  // The rib is solid and tapers towards the tip.
  if (s < 0.07 * (1 - 0.7 * v)) return 1;

  // Leaflets slant towards the tip, and narrow outwards.
  const double along = (v - 0.28 * s) * leaflets;
  const double across = std::fabs(fractionOf(along) - 0.5) * 2;
  return s < reach ? 0.86 - 0.62 * (s / reach) * (s / reach) - across : -1;
}

auto plasterHeight(int cells, std::uint32_t seed) {
  FractalNoise roughness(5, cells), stroke(1, cells);
  return [=](double u, double v) mutable {
    const double rough = roughness(seed, cells * u, cells * v);
    // One more layer of the lowest frequency stands for the strokes of the trowel.
    const double strokes = stroke(seed + 8, cells * u, 0.25 * cells * v * 4);
    return rough + 0.3 * strokes;
  };
}

// `columns` x `rows` squares of two colors; even numbers repeat without a seam.
Texture makeChecker(ShapeParameters& parameters) {
  const Rgb a = colorOf(parameters, "color", {0.8, 0.8, 0.8});
  const Rgb b = colorOf(parameters, "color2", {0.1, 0.1, 0.1});
  const int columns = parameters.integer("columns", 2, 1, 4096);
  const int rows = parameters.integer("rows", columns, 1, 4096);

  return paintColor(parameters, [=](double u, double v) {
    const int i = static_cast<int>(u * columns), j = static_cast<int>(v * rows);
    return (i + j) % 2 == 0 ? a : b;
  });
}

// Upright stripes of two colors; `share` is that of the first.
Texture makeStripes(ShapeParameters& parameters) {
  const Rgb a = colorOf(parameters, "color", {0.8, 0.8, 0.8});
  const Rgb b = colorOf(parameters, "color2", {0.5, 0.05, 0.05});
  const int count = parameters.integer("count", 4, 1, 4096);
  const double share = parameters.number("share", 0.5, 0, 1);

  return paintColor(parameters, [=](double u, double) {
    const double t = fractionOf(u * count);
    return t < share ? a : b;
  });
}

// Cloth with a woven diamond ornament and a border at the foot and head (v near 0 and 1).
Texture makeFabric(ShapeParameters& parameters) {
  const Rgb ground = colorOf(parameters, "color", {0.45, 0.03, 0.03});
  const Rgb figure = colorOf(parameters, "color2", {0.75, 0.5, 0.15});
  const int columns = parameters.integer("columns", 4, 1, 256);
  const int rows = parameters.integer("rows", columns, 1, 256);
  const double border = parameters.number("border", 0.06, 0, 0.5);
  const double contrast = parameters.number("contrast", 0.35, 0, 1);
  const std::uint32_t seed = parameters.seed();

  FractalNoise weaving(3, 32);

  return paintColor(parameters, [=](double u, double v) mutable {
    // Each cell of the weave has a diamond's outline and a small diamond in its middle.
    const double fu = fractionOf(u * columns) - 0.5;
    const double fv = fractionOf(v * rows) - 0.5;
    const double diamond = std::fabs(fu) + std::fabs(fv);
    const double weave = 0.92 + 0.08 * weaving(seed, 32 * u, 32 * v);
    const bool line = std::fabs(diamond - 0.36) < 0.035 || diamond < 0.10;
    Rgb color = mix(ground, figure, line ? contrast : 0.0);

    // The border is a stripe of the figure's color between two darker ones.
    const double edge = std::min(v, 1 - v);
    if (edge < border) {
      const double t = edge / border;
      color = t > 0.25 && t < 0.75 ? figure : mix(ground, Rgb(0.0f), 0.4);
    }
    return color * static_cast<float>(weave);
  });
}

// The mask's alpha is 1 inside one pointed leaf with its foot at v = 0.
Texture makeLeafMask(ShapeParameters& parameters) {
  const double fullness = parameters.number("fullness", 0.45, 0.01, 0.5);
  return paintScalar(
      parameters,
      [=](double u, double v) {
        // A ramp of a few texels puts the cut at the contour when it is sampled bilinearly.
        return 0.5 + 24 * leafShape(u, v, fullness);
      },
      128);
}

Texture makeFrondMask(ShapeParameters& parameters) {
  const int leaflets = parameters.integer("leaflets", 14, 1, 200);
  return paintScalar(
      parameters, [=](double u, double v) { return 0.5 + 4 * frondShape(u, v, leaflets); }, 256);
}

// The colors of a leaf: a paler rib and side veins.
Texture makeLeaf(ShapeParameters& parameters) {
  const Rgb blade = colorOf(parameters, "color", {0.08, 0.22, 0.04});
  const Rgb vein = colorOf(parameters, "color2", {0.25, 0.42, 0.12});
  const int veins = parameters.integer("veins", 7, 0, 100);
  const std::uint32_t seed = parameters.seed();

  FractalNoise patches(4, 4);

  return paintColor(
      parameters,
      [=](double u, double v) mutable {
        // Side veins leave the rib and slant towards the tip.
        const double s = std::fabs(u - 0.5) * 2;
        const double along = (v - 0.3 * s) * veins;
        const double across = std::fabs(along - std::round(along));
        const double rib = std::max(1 - s / 0.08, 0.6 * (1 - across / 0.1));

        const double patch = 0.5 + 0.5 * patches(seed, 4 * u, 4 * v);
        const Rgb color = mix(blade, vein, std::clamp(rib, 0.0, 1.0));
        return color * static_cast<float>(0.75 + 0.5 * patch);
      },
      128);
}

// Fractal noise between two colors; `contrast` sharpens it. For lawns, soil, clouds of any kind.
Texture makeNoise(ShapeParameters& parameters) {
  const Rgb a = colorOf(parameters, "color", {0.10, 0.22, 0.05});
  const Rgb b = colorOf(parameters, "color2", {0.22, 0.26, 0.09});
  const int cells = parameters.integer("cells", 8, 1, 1024);
  const int octaves = parameters.integer("octaves", 6, 1, 12);
  const double contrast = parameters.number("contrast", 1, 0, 100);
  const std::uint32_t seed = parameters.seed();

  FractalNoise noise(octaves, cells);

  return paintColor(parameters, [=](double u, double v) mutable {
    const double n = noise(seed, cells * u, cells * v);
    return mix(a, b, std::clamp(0.5 + contrast * n, 0.0, 1.0));
  });
}

Texture makePlaster(ShapeParameters& parameters) {
  const Rgb color = colorOf(parameters, "color", {0.66, 0.56, 0.42});
  const Rgb color2 = colorOf(parameters, "color2", {0.50, 0.40, 0.29});
  const int cells = parameters.integer("cells", 6, 1, 1024);
  const double stain = parameters.number("stain", 0.5, 0, 1);
  const std::uint32_t seed = parameters.seed();
  auto height = plasterHeight(cells, seed);

  FractalNoise clouds(5, 3);

  return paintColor(parameters, [=](double u, double v) mutable {
    const double cloud = 0.5 + 0.6 * clouds(seed + 40, 3 * u, 3 * v);
    const Rgb base = mix(color, color2, std::clamp(stain * cloud, 0.0, 1.0));
    return base * static_cast<float>(1 + 0.12 * height(u, v));
  });
}

Texture makePlasterNormals(ShapeParameters& parameters) {
  const int cells = parameters.integer("cells", 6, 1, 1024);
  const double depth = parameters.number("depth", 0.004, 0, 0.5);
  auto height = plasterHeight(cells, parameters.seed());
  return paintNormals(parameters, [=](double u, double v) mutable { return depth * height(u, v); });
}

// Veins run along the zero lines of warped noise.
Texture makeMarble(ShapeParameters& parameters) {
  const Rgb color = colorOf(parameters, "color", {0.80, 0.78, 0.74});
  const Rgb vein = colorOf(parameters, "color2", {0.32, 0.31, 0.32});
  const int cells = parameters.integer("cells", 3, 1, 256);
  const double sharpness = parameters.number("sharpness", 10, 0.1, 1000);
  const std::uint32_t seed = parameters.seed();

  FractalNoise warping(5, cells), coarseVeins(4, cells), fineVeins(4, 2 * cells);

  return paintColor(parameters, [=](double u, double v) mutable {
    const double x = cells * u, y = cells * v;
    const double warp = 0.7 * warping(seed + 20, x, y);

    // Coarse and fine veins lie where warped noise crosses zero, and a power narrows them.
    const double coarse = 1 - std::fabs(coarseVeins(seed, x + warp, y + 0.5 * warp));
    const double fine = 1 - std::fabs(fineVeins(seed + 60, 2 * x - warp, 2 * y + warp));

    const double depth = std::pow(std::clamp(coarse, 0.0, 1.0), sharpness) +
                         0.4 * std::pow(std::clamp(fine, 0.0, 1.0), 1.6 * sharpness);
    const Rgb cloudy = color * static_cast<float>(1 + 0.12 * warp);
    return mix(cloudy, vein, std::min(1.0, 0.8 * depth));
  });
}

// Boards run along u, each with its own grain.
Texture makeWood(ShapeParameters& parameters) {
  const Rgb color = colorOf(parameters, "color", {0.36, 0.20, 0.09});
  const Rgb color2 = colorOf(parameters, "color2", {0.19, 0.09, 0.035});
  const int boards = parameters.integer("boards", 4, 1, 256);
  const double rings = parameters.number("rings", 5, 0, 200);
  const std::uint32_t seed = parameters.seed();

  FractalNoise swaying(3, 2), fibres(3, 64);

  return paintColor(parameters, [=](double u, double v) mutable {
    // Each board has noise and a density of rings of its own.
    const int board = std::min(static_cast<int>(v * boards), boards - 1);
    const double y = v * boards - board, own = unitHash(seed, board);
    const auto boardSeed = seed + 100u * static_cast<std::uint32_t>(board);

    // Rings sway along the board, fibres are noise that is stretched along it.
    const double sway = swaying(boardSeed + 7, 2 * u, y);
    const double ring =
        0.5 + 0.5 * std::sin(6.283185307 * (rings * (y - 0.5) * (1 + own) + 2 * sway));
    const double fibre = 0.5 + 0.5 * fibres(boardSeed + 9, 4 * u, 64 * y);

    // Dark gaps separate the boards.
    const double gap = smoothStep(0, 0.015, std::min(y, 1 - y));

    const Rgb grain = mix(color, color2, std::clamp(0.65 * ring + 0.35 * fibre, 0.0, 1.0));
    return grain * static_cast<float>((0.85 + 0.3 * own) * (0.25 + 0.75 * gap));
  });
}

// The stone of a layout in which a point lies, and the point's position in it.
struct Stone {
  int column, row;    // place of the stone, wrapped
  double across, up;  // within the stone, 0 to 1
  double edge;        // distance to the stone's edge, in parts of the texture's side
};

struct Layout {
  int columns, rows;
  double bond;   // shift of every other row, in stones
  double joint;  // width of the joints, in parts of a row
  double bevel;  // width of the stones' rounded edge, in parts of a row

  Stone at(double u, double v) const {
    const int row = std::min(static_cast<int>(v * rows), rows - 1);
    const double x = u * columns + (row % 2 == 1 ? bond : 0.0);
    const int column = static_cast<int>(std::floor(x));
    const double fu = fractionOf(x), fv = v * rows - row;

    const double edge = std::min(std::min(fu, 1 - fu) / columns, std::min(fv, 1 - fv) / rows);
    return {column % columns, row, fu, fv, edge};
  }

  // Returns 0 in the joint and 1 on the stone's face.
  double face(const Stone& s) const {
    const double half = 0.5 * joint / rows;
    return smoothStep(half, half + std::max(bevel, 1e-6) / rows, s.edge);
  }
};

Layout readLayout(ShapeParameters& parameters, int columns, int rows, double bond, double joint,
                  double bevel) {
  Layout layout{};
  layout.columns = parameters.integer("columns", columns, 1, 1024);
  layout.rows = parameters.integer("rows", rows, 1, 1024);
  layout.bond = parameters.number("bond", bond, 0, 1);
  layout.joint = parameters.number("joint", joint, 0, 0.9);
  layout.bevel = parameters.number("bevel", bevel, 0, 0.9);
  return layout;
}

// Heights are in parts of the texture's side. Joints lie `depth` deep, stones are a little uneven.
Texture masonryNormals(ShapeParameters& parameters, const Layout& layout, double depthFallback,
                       double roughFallback) {
  const double depth = parameters.number("depth", depthFallback, 0, 0.5);
  const double rough = parameters.number("rough", roughFallback, 0, 10);
  const std::uint32_t seed = parameters.seed();

  FractalNoise grains(4, 16);

  return paintNormals(parameters, [=](double u, double v) mutable {
    const Stone s = layout.at(u, v);
    const double grain = grains(seed + 11, 16 * u, 16 * v);

    // The face of each stone slopes at random, across and up.
    const double lean = (unitHash(seed + 5, s.column, s.row) - 0.5) * (s.across - 0.5) +
                        (unitHash(seed + 6, s.column, s.row) - 0.5) * (s.up - 0.5);
    return depth * layout.face(s) * (1 + 0.5 * rough * lean) + 0.35 * depth * rough * grain;
  });
}

Layout brickLayout(ShapeParameters& parameters) {
  return readLayout(parameters, 6, 12, 0.5, 0.10, 0.10);
}

Layout tileLayout(ShapeParameters& parameters) {
  return readLayout(parameters, 4, 4, 0, 0.02, 0.015);
}

Texture makeBricks(ShapeParameters& parameters) {
  const Layout layout = brickLayout(parameters);
  const Rgb color = colorOf(parameters, "color", {0.42, 0.17, 0.10});
  const Rgb color2 = colorOf(parameters, "color2", {0.28, 0.10, 0.07});
  const Rgb mortar = colorOf(parameters, "mortar", {0.45, 0.42, 0.38});
  const double stain = parameters.number("stain", 0.25, 0, 1);
  const std::uint32_t seed = parameters.seed();

  FractalNoise grains(5, 16), clouds(4, 3);

  return paintColor(parameters, [=](double u, double v) mutable {
    const Stone s = layout.at(u, v);
    const double grain = 0.5 + 0.5 * grains(seed + 11, 16 * u, 16 * v);
    const double cloud = 0.5 + 0.5 * clouds(seed + 3, 3 * u, 3 * v);

    const Rgb stone = mix(color, color2, unitHash(seed, s.column, s.row));
    const Rgb base = mix(mortar, stone, layout.face(s));

    // Stains darken the wall unevenly, by fine grain and by large clouds.
    return base * static_cast<float>((1 - 0.5 * stain + stain * (grain - 0.5)) *
                                     (1 - stain * (cloud - 0.5)));
  });
}

Texture makeBrickNormals(ShapeParameters& parameters) {
  return masonryNormals(parameters, brickLayout(parameters), 0.006, 0.8);
}

// Polished slabs in two colors, chequered, with veins that differ from slab to slab.
Texture makeTiles(ShapeParameters& parameters) {
  const Layout layout = tileLayout(parameters);
  const Rgb color = colorOf(parameters, "color", {0.62, 0.56, 0.48});
  const Rgb color2 = colorOf(parameters, "color2", {0.34, 0.16, 0.10});
  const Rgb joint = colorOf(parameters, "mortar", {0.10, 0.09, 0.08});
  const double variation = parameters.number("variation", 0.15, 0, 1);
  const double veins = parameters.number("veins", 0.35, 0, 1);
  const std::uint32_t seed = parameters.seed();

  FractalNoise warping(4), lines(4);

  return paintColor(
      parameters,
      [=](double u, double v) mutable {
        const Stone s = layout.at(u, v);
        const bool odd = (s.column + s.row) % 2 == 1;
        const double own = unitHash(seed, s.column, s.row);

        // Each slab is cut from another part of the block.
        const double x = s.across + 17 * own, y = s.up + 29 * unitHash(seed + 1, s.column, s.row);
        const double warp = warping(seed + 20, 1.5 * x, 1.5 * y);

        // Narrow veins lie where warped noise crosses zero.
        const double line = 1 - std::fabs(lines(seed + 30, 1.2 * x + warp, 1.6 * y));
        const double vein = std::pow(std::clamp(line, 0.0, 1.0), 14);
        const double cloud = 0.5 + 0.5 * warp;

        // Slabs of the second color have light veins, and those of the first dark ones.
        Rgb slab = odd ? color2 : color;
        slab = slab * static_cast<float>(1 + variation * (own - 0.5) + 0.5 * veins * (cloud - 0.5));
        slab = mix(slab, odd ? Rgb(0.6f) : slab * 0.45f, veins * vein);
        return mix(joint, slab, layout.face(s));
      },
      1024);
}

Texture makeTileNormals(ShapeParameters& parameters) {
  return masonryNormals(parameters, tileLayout(parameters), 0.002, 0.05);
}

Texture makeRoof(ShapeParameters& parameters) {
  const int columns = parameters.integer("columns", 8, 1, 1024);
  const int rows = parameters.integer("rows", 6, 1, 1024);
  const Rgb color = colorOf(parameters, "color", {0.45, 0.18, 0.09});
  const Rgb color2 = colorOf(parameters, "color2", {0.30, 0.13, 0.08});
  const std::uint32_t seed = parameters.seed();

  FractalNoise grains(4, 16);

  return paintColor(parameters, [=](double u, double v) mutable {
    const double fu = fractionOf(u * columns);
    const double fv = fractionOf(v * rows);
    const double own = unitHash(seed, static_cast<int>(u * columns), static_cast<int>(v * rows));
    const double grain = grains(seed + 2, 16 * u, 16 * v);

    // The gutters between columns and the strip below the next row lie in the shade.
    const double gutter = smoothStep(0, 0.14, std::min(fu, 1 - fu));
    const double shade = (0.45 + 0.55 * gutter) * (fv > 0.93 ? 0.6 : 1.0) * (1 + 0.2 * grain);
    return mix(color, color2, own) * static_cast<float>(shade);
  });
}

Texture makeRoofNormals(ShapeParameters& parameters) {
  const int columns = parameters.integer("columns", 8, 1, 1024);
  const int rows = parameters.integer("rows", 6, 1, 1024);
  const double depth = parameters.number("depth", 0.03, 0, 0.5);

  // Rounded pans lie in overlapping rows.
  return paintNormals(parameters, [=](double u, double v) {
    const double fu = fractionOf(u * columns), fv = fractionOf(v * rows);
    return depth * (std::sqrt(std::max(0.0, 1 - 4 * (fu - 0.5) * (fu - 0.5))) - 0.6 * fv);
  });
}

}  // namespace

const std::map<std::string, PatternGenerator*>& patternGenerators() {
  static const std::map<std::string, PatternGenerator*> generators{
      {"bricks", makeBricks},
      {"bricksNormals", makeBrickNormals},
      {"checker", makeChecker},
      {"fabric", makeFabric},
      {"frondMask", makeFrondMask},
      {"leaf", makeLeaf},
      {"leafMask", makeLeafMask},
      {"marble", makeMarble},
      {"noise", makeNoise},
      {"plaster", makePlaster},
      {"plasterNormals", makePlasterNormals},
      {"roof", makeRoof},
      {"roofNormals", makeRoofNormals},
      {"stripes", makeStripes},
      {"tiles", makeTiles},
      {"tilesNormals", makeTileNormals},
      {"wood", makeWood},
  };

  return generators;
}

}  // namespace whit
