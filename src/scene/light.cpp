#include "scene/light.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <vector>

#include "core/index.h"
#include "core/machine_limits.h"
#include "core/worker_pool.h"

namespace whit {

namespace {

RgbD mix(const Rgb& a, const Rgb& b, double t) { return RgbD(a) * (1 - t) + RgbD(b) * t; }

RgbD texel(const EnvironmentImage& image, int x, int y) {
  const std::size_t i = cellAt(x, y, image.width);
  return {image.r[i], image.g[i], image.b[i]};
}

// Bilinear lookup in direction `d`. The image occupies `rows` rows from `first` on; its columns
// start at -z and its rows at the zenith.
RgbD lookUp(const EnvironmentImage& image, double rotation, const Vec3d& d, int first, int rows) {
  const double u = std::atan2(d.x, -d.z) / (2 * std::numbers::pi) + rotation / 360.0;
  // Unlike acos this keeps its precision near the poles.
  const double v = std::atan2(std::hypot(d.x, d.z), d.y) / std::numbers::pi;

  // Texel centers lie at half-integers. Columns wrap around, rows end at the poles.
  const double x = (u - std::floor(u)) * image.width - 0.5;
  const double y = first + std::clamp(v * rows - 0.5, 0.0, rows - 1.0);
  const double x0 = std::floor(x), y0 = std::floor(y);
  const int left = x0 < 0 ? image.width - 1 : static_cast<int>(x0);
  const int right = left + 1 < image.width ? left + 1 : 0;
  const int top = static_cast<int>(y0), bottom = std::min(top + 1, first + rows - 1);

  const double s = x - x0, t = y - y0;
  return (texel(image, left, top) * (1 - s) + texel(image, right, top) * s) * (1 - t) +
         (texel(image, left, bottom) * (1 - s) + texel(image, right, bottom) * s) * t;
}

// Radiance of a sky that is the same all around, at a sine of the elevation, without its scale.
RgbD evenRadiance(const Sky& sky, double sine) {
  if (sky.kind == Sky::Kind::none) return {};
  if (sky.kind == Sky::Kind::color) return RgbD(sky.zenith);
  return mix(sky.horizon, sine < 0 ? sky.ground : sky.zenith, std::abs(sine));
}

// The last bits of sines and cosines differ between C libraries and processors.
double rounded(double x) { return std::round(x * 0x1p40) * 0x1p-40; }
double sineOf(double angle) { return rounded(std::sin(angle)); }
double cosineOf(double angle) { return rounded(std::cos(angle)); }

double polarAngle(int row, int rows) { return std::numbers::pi * (row + 0.5) / rows; }

// A sky that is the same for every azimuth, as an image of one column.
EnvironmentImage columnOf(const Sky& sky) {
  EnvironmentImage column{1, 8 * kBlurRows, {}, {}, {}};
  for (int y = 0; y < column.height; ++y) {
    const Rgb radiance(evenRadiance(sky, cosineOf(polarAngle(y, column.height))));
    column.r.push_back(radiance.x);
    column.g.push_back(radiance.y);
    column.b.push_back(radiance.z);
  }
  return column;
}

// Shrinks a plane of the image. Texels are means over the solid angle that they cover.
std::vector<float> shrunk(const std::vector<float>& plane, const EnvironmentImage& image, int width,
                          int height) {
  std::vector<float> means;
  for (int y = 0; y < height; ++y) {
    const int top = y * image.height / height;
    const int bottom = std::max(top + 1, (y + 1) * image.height / height);

    for (int x = 0; x < width; ++x) {
      const int left = x * image.width / width;
      const int right = std::max(left + 1, (x + 1) * image.width / width);

      double sum = 0, weights = 0;
      for (int row = top; row < bottom; ++row) {
        const double weight = sineOf(polarAngle(row, image.height));
        const auto first = plane.begin() + std::ptrdiff_t{row} * image.width;
        sum += weight * std::accumulate(first + left, first + right, 0.0);
        weights += weight * (right - left);
      }
      means.push_back(static_cast<float>(sum / weights));
    }
  }
  return means;
}

// Appends to a plane of kBlurRows rows what lobes of each further roughness see of it: the mean
// weighted by D(h) cos(theta), for a view and a normal along the direction (Karis 2013, "Real
// Shading in Unreal Engine 4").
std::vector<float> blurs(std::vector<float> plane, int width) {
  std::vector<float> around;  // each row twice, for sums across the seam
  for (auto row = plane.begin(); row != plane.end(); row += width) {
    for (int turn = 0; turn < 2; ++turn) around.insert(around.end(), row, row + width);
  }

  std::vector<double> cosines(width);
  for (double turn = 0; double& cosine : cosines) {
    cosine = cosineOf(2 * std::numbers::pi * turn++ / width);
  }

  for (int level = 1; level < kSkyBlurs; ++level) {
    const double roughness = level / (kSkyBlurs - 1.0), alpha = roughness * roughness;
    const double a2 = alpha * alpha;

    for (int y = 0; y < kBlurRows; ++y) {
      const double polar = polarAngle(y, kBlurRows);
      std::vector<float> sums(width);
      double weights = 0;

      // Every texel of a row sees the same weights, shifted by its column, so the weights are
      // computed once a row.
      for (int from = 0; from < kBlurRows; ++from) {
        const double other = polarAngle(from, kBlurRows);
        const double toPole = cosineOf(polar) * cosineOf(other);
        const double aside = sineOf(polar) * sineOf(other), area = sineOf(other);

        for (int turn = 0; turn < width; ++turn) {
          const double cosine = toPole + aside * cosines[turn];
          if (!(cosine > 0)) continue;

          // The GGX distribution. The view is along the normal, so that the half vector's squared
          // cosine is (1 + cosine) / 2.
          const double spread = 1 - (1 - a2) * (1 + cosine) / 2;
          const double weight = area * cosine / (spread * spread);
          weights += weight;
          const float* row = around.data() + std::ptrdiff_t{2} * width * from + turn;
          for (float& sum : sums) sum += static_cast<float>(weight) * *row++;
        }
      }
      for (const float sum : sums) plane.push_back(sum / static_cast<float>(weights));
    }
  }
  return plane;
}

// The cosine-weighted mean over one hemisphere. A row between polar angles a and b weighs
// integral of 2 cos sin = sin^2 b - sin^2 a; the weights of a hemisphere's rows sum to 1.
RgbD hemisphereMean(const EnvironmentImage& image, bool upper) {
  RgbD sum;
  for (int y = 0; y < image.height; ++y) {
    // Polar angles are measured from the pole of the hemisphere and cut at the horizon.
    const int row = upper ? y : image.height - 1 - y;
    const double a = std::numbers::pi * y / image.height;
    const double b = std::min(std::numbers::pi * (y + 1) / image.height, std::numbers::pi / 2);
    if (a >= b) break;
    RgbD rowSum;
    for (int x = 0; x < image.width; ++x) rowSum += texel(image, x, row);
    const double sinA = std::sin(a), sinB = std::sin(b);
    sum += rowSum * ((sinB * sinB - sinA * sinA) / image.width);
  }
  return sum;
}

}  // namespace

Vec3d towards(const Light& light, const Vec3d& position) {
  if (light.kind == Light::Kind::directional) return -normalized(Vec3d(light.direction));
  return Vec3d(light.position) - position;
}

SpotCone coneOf(const Light& light) {
  const double inner = std::cos(light.innerConeAngle * std::numbers::pi / 180);
  const double outer = std::cos(light.outerConeAngle * std::numbers::pi / 180);

  // KHR_lights_punctual divides by at least 0.001. Narrow cones have a smaller limit, because that
  // one would dim them at their axis.
  const double least = std::min(0.001, 0.1 * (1 - outer));
  return {normalized(Vec3d(light.direction)), outer, 1 / std::max(least, inner - outer)};
}

double SpotCone::falloff(const Vec3d& unitToLight) const {
  const double s = std::clamp((-dot(axis, unitToLight) - cosOuter) * scale, 0.0, 1.0);
  return s * s;
}

std::string skyName(const Sky& sky) {
  if (!sky.name.empty()) return std::filesystem::path(sky.name).filename().string();
  constexpr const char* kKinds[] = {"none", "color", "gradient", "image"};
  return entryOf(kKinds, sky.kind);
}

RgbD skyRadiance(const Sky& sky, const Vec3d& d) {
  if (sky.kind != Sky::Kind::image) return evenRadiance(sky, d.y) * sky.scale;
  return lookUp(sky.image, sky.rotation, d, 0, sky.image.height) * sky.scale;
}

EnvironmentImage blurredSky(const Sky& sky) {
  constexpr int kWidth = 2 * kBlurRows;
  const EnvironmentImage source = sky.kind == Sky::Kind::image ? sky.image : columnOf(sky);
  EnvironmentImage blurred{kWidth, kBlurRows * kSkyBlurs, {}, {}, {}};

  constexpr std::array kPlanes{&EnvironmentImage::r, &EnvironmentImage::g, &EnvironmentImage::b};
  parallelFor(usableThreads(), kPlanes.size(), [&](std::size_t i, int) {
    const auto plane = kPlanes[i];
    blurred.*plane = blurs(shrunk(source.*plane, source, kWidth, kBlurRows), kWidth);
  });
  return blurred;
}

RgbD blurredRadiance(const Sky& sky, const EnvironmentImage& blurred, const Vec3d& d,
                     double roughness) {
  const double blur = roughness * (kSkyBlurs - 1);
  const int level = std::clamp(static_cast<int>(blur), 0, kSkyBlurs - 2);
  const auto at = [&](int k) {
    return lookUp(blurred, sky.rotation, d, k * kBlurRows, kBlurRows) * sky.scale;
  };
  const RgbD sharper = at(level);
  return sharper + (at(level + 1) - sharper) * (blur - level);
}

Ambient ambientFromSky(const Sky& sky, double strength, Ambient before) {
  // The cosine-weighted mean of the sine of the elevation: integral of 2 y * y over [0, 1].
  constexpr double kMeanSine = 2.0 / 3.0;

  RgbD up, down;
  switch (sky.kind) {
    case Sky::Kind::none:
      break;
    case Sky::Kind::color:
      up = down = RgbD(sky.zenith);
      break;
    case Sky::Kind::gradient:
      up = mix(sky.horizon, sky.zenith, kMeanSine);
      down = mix(sky.horizon, sky.ground, kMeanSine);
      break;
    case Sky::Kind::image:
      up = hemisphereMean(sky.image, true);
      down = hemisphereMean(sky.image, false);
  }

  const double factor = strength * sky.scale;
  before.up = Rgb(up * factor);
  before.down = Rgb(down * factor);
  before.ofSky = strength;
  return before;
}

}  // namespace whit
