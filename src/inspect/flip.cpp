// LDR-FLIP: P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. D.
// Fairchild, "FLIP: A Difference Evaluator for Alternating Images", HPG 2020. Section numbers are
// the paper's.
#include "core/index.h"
#include "inspect/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/display.h"
#include "core/vec3.h"

namespace whit {

namespace {

struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;  // row by row

  Plane() = default;
  Plane(int w, int h) : width(w), height(h), values(cellsOf(w, h)) {}
  float* row(int y) { return values.data() + cellAt(0, y, width); }
  const float* row(int y) const { return values.data() + cellAt(0, y, width); }
};

// Weights at -radius .. radius, so always an odd number of them.
using Taps = std::vector<float>;

// Innermost along x in both directions, which is what compilers turn into vector code.
void addScaled(float* sum, const float* values, float weight, int count) {
  for (int x = 0; x < count; ++x) sum[x] += weight * values[x];
}

// Each value is the sum of taps[i] * neighbor i; beyond the border the nearest value is repeated.
Plane filterAlongX(const Plane& plane, const Taps& taps) {
  const int radius = static_cast<int>(taps.size() / 2);
  Plane out(plane.width, plane.height);
  std::vector<float> padded(plane.width + 2 * taps.size());

  for (int y = 0; y < plane.height; ++y) {
    const float* row = plane.row(y);
    std::fill_n(padded.begin(), radius, row[0]);
    std::copy(row, row + plane.width, padded.begin() + radius);
    std::fill_n(padded.begin() + radius + plane.width, radius, row[plane.width - 1]);

    for (const auto i : indices(taps))
      addScaled(out.row(y), padded.data() + i, taps[i], plane.width);
  }
  return out;
}

Plane filterAlongY(const Plane& plane, const Taps& taps) {
  const int radius = static_cast<int>(taps.size() / 2);
  Plane out(plane.width, plane.height);

  for (int y = 0; y < plane.height; ++y) {
    for (const auto i : indices(taps)) {
      const int from = y - radius + static_cast<int>(i);
      addScaled(out.row(y), plane.row(std::clamp(from, 0, plane.height - 1)), taps[i], plane.width);
    }
  }
  return out;
}

constexpr double kPixelsPerDegree = 67;           // a 0.7 m wide 3840 pixel display seen from 0.7 m
constexpr double kColorExponent = 0.7;            // q_c
constexpr double kKnee = 0.4, kKneeError = 0.95;  // p_c, p_t
constexpr double kFeatureWidth = 0.082;           // w, degrees
constexpr float kFeatureExponent = 0.5f;          // q_f

// Linear sRGB to XYZ, the paper's exact fractions.
constexpr std::array<Vec3d, 3> kRgbToXyz{{
    {10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
    {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
    {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0},
}};

// Rows of a 3x3 matrix.
struct Matrix {
  std::array<Vec3f, 3> rows;
  Vec3f operator*(const Vec3f& v) const {
    return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
  }
};

// XYZ here is always relative to the white of (1, 1, 1), so that gray has X = Y = Z.
struct ColorSpace {
  Matrix toXyz, toRgb;
};
const ColorSpace& colorSpace() {
  static const ColorSpace space = [] {
    std::array<Vec3d, 3> m = kRgbToXyz;
    // Each row sums to 1, so that white becomes (1, 1, 1).
    for (Vec3d& row : m) row = row / (row.x + row.y + row.z);

    // The columns of the inverse are cross products of the rows, divided by the determinant.
    const Vec3d a = cross(m[1], m[2]), b = cross(m[2], m[0]), c = cross(m[0], m[1]);
    const double determinant = dot(m[0], a);

    ColorSpace s;
    for (const auto i : indices(3)) {
      const int k = static_cast<int>(i);
      s.toXyz.rows[i] = Vec3f(m[i]);
      s.toRgb.rows[i] = Vec3f(Vec3d(a[k], b[k], c[k]) / determinant);
    }

    return s;
  }();
  return space;
}

// 3.1: the opponent space, linear in XYZ.
Vec3f opponentOfXyz(const Vec3f& xyz) {
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}
Vec3f xyzOfOpponent(const Vec3f& o) {
  const float y = (o.x + 16) / 116;
  return {y + o.y / 500, y, y - o.z / 200};
}

using Planes = std::array<Plane, 3>;

Planes opponentPlanes(const DisplayImage& image) {
  const Matrix& toXyz = colorSpace().toXyz;
  Planes planes;
  planes.fill(Plane(image.width, image.height));

  for (const auto i : indices(planes[0].values)) {
    const std::uint8_t* code = image.rgba.data() + 4 * i;
    const Vec3f o = opponentOfXyz(
        toXyz * Rgb{linearOfCode(code[0]), linearOfCode(code[1]), linearOfCode(code[2])});
    for (int c = 0; c < 3; ++c) entryOf(planes, c).values[i] = o[c];
  }
  return planes;
}

// Returns weights whose positive ones sum to 1 and whose negative ones sum to -1.
Taps balanced(const std::vector<double>& weights) {
  double positive = 0, negative = 0;
  for (const double w : weights) {
    double& sum = w > 0 ? positive : negative;
    sum += std::abs(w);
  }

  Taps taps;
  for (const double w : weights)
    taps.push_back(static_cast<float>(w / (w > 0 ? positive : negative)));
  return taps;
}

// 3.1.1: a contrast sensitivity function, a sum of Gaussians a sqrt(pi/b) exp(-pi^2 d^2 / b) of the
// distance d in degrees, each of which is separable.
struct Gaussian {
  double a, b;
};
Plane filterContrast(const Plane& plane, const std::vector<Gaussian>& gaussians) {
  constexpr double kWidestB = 0.04;
  // The radius is three standard deviations of the widest Gaussian.
  const int radius = static_cast<int>(std::ceil(
      3 * std::sqrt(kWidestB / (2 * std::numbers::pi * std::numbers::pi)) * kPixelsPerDegree));

  Plane sum(plane.width, plane.height);
  std::vector<double> masses;
  std::vector<Taps> taps;
  double total = 0;

  // The weight of each Gaussian in the sum is its mass over the plane.
  for (const Gaussian& g : gaussians) {
    std::vector<double> weights;
    double line = 0;
    for (int i = -radius; i <= radius; ++i) {
      const double d = i / kPixelsPerDegree;
      weights.push_back(std::exp(-std::numbers::pi * std::numbers::pi * d * d / g.b));
      line += weights.back();
    }

    taps.push_back(balanced(weights));
    masses.push_back(g.a * std::sqrt(std::numbers::pi / g.b) * line * line);
    total += masses.back();
  }

  for (const auto k : indices(gaussians)) {
    const Plane part = filterAlongY(filterAlongX(plane, taps[k]), taps[k]);
    const float share = static_cast<float>(masses[k] / total);
    for (const auto i : indices(sum.values)) sum.values[i] += share * part.values[i];
  }

  return sum;
}

// 3.1.2: L*a*b* with Hunt's adjustment: colors lose their chroma with their lightness.
Vec3f huntLab(const Vec3f& rgb) {
  constexpr float kDelta = 6.0f / 29.0f;
  const auto f = [](float t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0f / 29.0f;
  };

  const Vec3f xyz = colorSpace().toXyz * rgb;
  const float x = f(xyz.x), y = f(xyz.y), z = f(xyz.z);
  const float lightness = 116 * y - 16;
  return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

float hyAb(const Vec3f& p, const Vec3f& q) {
  return std::abs(p.x - q.x) + std::hypot(p.y - q.y, p.z - q.z);
}

// 3.1.3: differences up to the knee fill [0, 0.95], those beyond, which only the gamut's corners
// reach, the rest.
float redistribute(float distance) {
  static const double largest =
      std::pow(double{hyAb(huntLab({0, 1, 0}), huntLab({0, 0, 1}))}, kColorExponent);
  const double powered = std::pow(double{distance}, kColorExponent);
  const double knee = kKnee * largest;
  return static_cast<float>(powered < knee ? powered * kKneeError / knee
                                           : kKneeError + (powered - knee) / (largest - knee) *
                                                              (1 - kKneeError));
}

std::vector<Vec3f> filteredLab(const Planes& opponent) {
  // Each opponent channel has a contrast sensitivity of its own.
  const Planes filtered{filterContrast(opponent[0], {{1, 0.0047}}),
                        filterContrast(opponent[1], {{1, 0.0053}}),
                        filterContrast(opponent[2], {{34.1, 0.04}, {13.5, 0.025}})};

  const Matrix& toRgb = colorSpace().toRgb;
  std::vector<Vec3f> lab;
  lab.reserve(filtered[0].values.size());
  for (const auto i : indices(filtered[0].values)) {
    const Vec3f rgb = toRgb * xyzOfOpponent({filtered[0].values[i], filtered[1].values[i],
                                             filtered[2].values[i]});
    lab.push_back(huntLab(min(max(rgb, Vec3f(0)), Vec3f(1))));
  }
  return lab;
}

// The filtered channels that FLIP computes from one image.
struct FlipSide {
  std::vector<Vec3f> lab;          // filtered, Hunt-adjusted
  std::vector<float> edge, point;  // magnitudes of the features
};

// 3.2: edges by the first derivative of a Gaussian, points by the second.
void findFeatures(const Plane& achromatic, FlipSide& side) {
  const double deviation = 0.5 * kFeatureWidth * kPixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  std::vector<double> gaussian, edge, point;

  for (int x = -radius; x <= radius; ++x) {
    const double square = x * x / (deviation * deviation);
    const double g = std::exp(-square / 2);
    gaussian.push_back(g);
    edge.push_back(-x * g);
    point.push_back((square - 1) * g);
  }

  // Features are detected on luminance from 0 to 1.
  Plane luminance = achromatic;
  for (float& value : luminance.values) value = (value + 16) / 116;
  const Taps smoothing = balanced(gaussian);
  const Plane smooth = filterAlongX(luminance, smoothing);

  // A feature's magnitude combines both axes, each filtered along it and smoothed across it.
  const auto magnitudesOf = [&](const Taps& taps) {
    const Plane x = filterAlongY(filterAlongX(luminance, taps), smoothing);
    const Plane y = filterAlongY(smooth, taps);
    std::vector<float> result(x.values.size());
    for (const auto i : indices(result))
      result[i] = std::sqrt(x.values[i] * x.values[i] + y.values[i] * y.values[i]);
    return result;
  };

  side.edge = magnitudesOf(balanced(edge));
  side.point = magnitudesOf(balanced(point));
}

FlipSide flipSide(const DisplayImage& image) {
  const Planes opponent = opponentPlanes(image);
  FlipSide side;
  side.lab = filteredLab(opponent);
  findFeatures(opponent[0], side);
  return side;
}

}  // namespace

std::vector<float> flipOfCodes(const DisplayImage& first, const DisplayImage& second) {
  const FlipSide a = flipSide(first), b = flipSide(second);
  std::vector<float> flip(a.lab.size());

  for (const auto i : indices(flip)) {
    const float color = redistribute(hyAb(a.lab[i], b.lab[i]));
    const float feature =
        std::max(std::abs(a.edge[i] - b.edge[i]), std::abs(a.point[i] - b.point[i]));
    const float scaled = std::pow(feature / std::sqrt(2.0f), kFeatureExponent);

    // 3.3: a difference in features amplifies the difference in color.
    flip[i] = std::pow(color, 1 - std::min(scaled, 1.0f));
  }
  return flip;
}

}  // namespace whit
