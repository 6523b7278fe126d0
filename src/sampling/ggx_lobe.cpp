#include "sampling/ggx_lobe.h"

#include <cmath>
#include <numbers>

#include "core/index.h"
#include "core/machine_limits.h"
#include "core/worker_pool.h"

namespace whit {

namespace {

struct Albedo {
  double all = 0, grazing = 0;
};

// The mean weight of samples at the midpoints of a grid over the half of the lobe on one side of
// the plane of incidence. Facets that reflect close to the horizon are sampled more densely, since
// the weight has a kink where reflected rays end in the surface.
Albedo integrate(double cosine, double roughness) {
  constexpr int kTurns = 12, kFalls = 24;
  static const auto turns = [] {
    std::array<std::array<double, 2>, kTurns> list{};
    for (int i = 0; i < kTurns; ++i) {
      const double angle = std::numbers::pi * (i + 0.5) / kTurns;
      entryOf(list, i) = {std::cos(angle), std::sin(angle)};
    }
    return list;
  }();

  const double alpha = roughness * roughness;
  const Vec3d view{std::sqrt(1 - cosine * cosine), 0, cosine};
  Albedo sum;

  for (int k = 0; k < kFalls; ++k) {
    const double x = (k + 0.5) / kFalls, v = x * (2 - x), density = 2 * (1 - x);
    for (const auto& [c, s] : turns) {
      const Vec3d facet = visibleNormal(view, alpha, c, s, v);
      const double vh = dot(view, facet), nl = 2 * vh * facet.z - cosine;
      if (!(nl > 0)) continue;

      const double weight = density * passingShare(cosine, nl, alpha) / (kTurns * kFalls);
      sum.all += weight;

      const double away = 1 - vh, squared = away * away;
      sum.grazing += weight * squared * squared * away;
    }
  }

  return sum;
}

LobeTable makeTable() {
  LobeTable table;
  parallelFor(usableThreads(), kLobeSteps, [&](std::size_t row, int) {
    const double roughness = static_cast<double>(row) / (kLobeSteps - 1);
    for (int column = 0; column < kLobeSteps; ++column) {
      const double root = column / (kLobeSteps - 1.0);
      const double cosine = std::max(root * root, kLeastCosine);
      const Albedo albedo = integrate(cosine, roughness);
      const std::size_t i = row * kLobeSteps + column;
      table.all[i] = static_cast<float>(albedo.all);
      table.grazing[i] = static_cast<float>(albedo.grazing);
    }
  });
  return table;
}

}  // namespace

Vec3d visibleNormal(const Vec3d& view, double alpha, double cosine, double sine, double v) {
  // The view for a unit sphere instead of the stretched one: facets that mirror the view into the
  // cap above the plane that it grazes.
  const Vec3d seen = normalized(Vec3d(view.x * alpha, view.y * alpha, view.z));
  const double fall = v * (1 + seen.z);  // how far below the pole
  const double radius = std::sqrt(std::max(0.0, fall * (2 - fall)));
  const Vec3d halfway{radius * cosine + seen.x, radius * sine + seen.y, (1 - v) * (1 + seen.z)};
  return normalized(Vec3d(halfway.x * alpha, halfway.y * alpha, halfway.z), {0, 0, 1});
}

double passingShare(double nv, double nl, double alpha) {
  const double a2 = alpha * alpha;
  const double maskV = std::sqrt(nv * nv * (1 - a2) + a2);
  const double maskL = std::sqrt(nl * nl * (1 - a2) + a2);
  return nl * (nv + maskV) / (nl * maskV + nv * maskL);
}

double seenShare(double cosine, double alpha) {
  const double a2 = alpha * alpha;
  return 2 * cosine / (cosine + std::sqrt(cosine * cosine * (1 - a2) + a2));
}

const LobeTable& lobeTable() {
  static const LobeTable table = makeTable();
  return table;
}

RgbD lobeAlbedo(const RgbD& f0, double f90, double cosine, double roughness) {
  const LobeTable& table = lobeTable();
  const double row = std::clamp(roughness, 0.0, 1.0) * (kLobeSteps - 1);
  const double column = std::sqrt(std::clamp(cosine, 0.0, 1.0)) * (kLobeSteps - 1);

  // The entry above and to the left of the place, between whose neighbors values are interpolated.
  const int top = std::min(static_cast<int>(row), kLobeSteps - 2);
  const int first = std::min(static_cast<int>(column), kLobeSteps - 2);
  const std::size_t at = cellAt(first, top, kLobeSteps);
  const auto lookUp = [&](const auto& plane) {
    const auto inRow = [&](std::size_t i) {
      const double left = plane[i], right = plane[i + 1];
      return left + (right - left) * (column - first);
    };
    return inRow(at) + (inRow(at + kLobeSteps) - inRow(at)) * (row - top);
  };

  const double grazing = lookUp(table.grazing);
  return f0 * (lookUp(table.all) - grazing) + RgbD(f90 * grazing);
}

}  // namespace whit
