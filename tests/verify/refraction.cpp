// H37 to H44: Fresnel's and Snell's laws in the kernels, against long double.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "verify/bodies.h"
#include "verify/probe.h"
#include "verify/scene_builder.h"

namespace whit::verify {

namespace {

// Rays that hit a surfel whose normals both point up, at given cosines.
struct Incidence {
  std::vector<ProbeRay> rays;
  std::vector<double> cosines;  // cosines after rounding, which the kernel sees
};

// Results of the kernels for a dielectric: F, which is the reflected weight, or 0 where nothing is
// reflected; the refracted weight and direction, or 0.
struct Interfaces {
  std::vector<double> reflected, refracted;
  std::vector<Vec3d> direction;
};

using Real = long double;

Incidence raysAt(const std::vector<double>& cosines) {
  Incidence incidence;
  for (const double c : cosines) {
    // The vertical component is the cosine and is not changed.
    const auto down = static_cast<float>(c);
    const double rounded = static_cast<double>(down);
    const auto along = static_cast<float>(std::sqrt(std::max(0.0, (1 - rounded) * (1 + rounded))));
    incidence.rays.push_back({{0, 1, 0}, {along, -down, 0}});
    incidence.cosines.push_back(rounded);
  }
  return incidence;
}

// `from` is the index in front of the surface, `to` the index behind it.
Interfaces throughKernels(float from, float to, const Incidence& incidence, const Setup& setup) {
  SceneBuilder builder;
  const auto front = builder.add(glassMaterial(from)), behind = builder.add(glassMaterial(to));
  builder.add(floorAt(0, 1, front));
  builder.add(floorAt(1, 1, behind));
  const Scene scene = builder.build();

  Probe probe(scene, setup);
  std::vector<ProbeRay> rays = incidence.rays;
  for (ProbeRay& ray : rays) ray.media = probe.tables().materials[front].medium;
  probe.load(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) probe.surfel(i, behind, {0, 1, 0}, {0, 1, 0});

  Interfaces result;
  result.reflected.assign(rays.size(), 0);
  result.refracted.assign(rays.size(), 0);
  result.direction.resize(rays.size());

  for (const ProbeChild& child : probe.reflections()) {
    result.reflected[child.parent] = static_cast<double>(child.weight.x);
  }
  for (const ProbeChild& child : probe.refractions()) {
    result.refracted[child.parent] = static_cast<double>(child.weight.x);
    result.direction[child.parent] = Vec3d(child.ray.direction);
  }
  return result;
}

// Unpolarised reflectance in the textbook's form, in long double.
Real fresnel(Real n1, Real n2, Real c) {
  const Real s2 = (1 - c) * (1 + c) * n1 * n1 / (n2 * n2);
  if (s2 >= 1) return 1;

  const Real t = std::sqrt(1 - s2);
  const Real rs = (n1 * c - n2 * t) / (n1 * c + n2 * t), rp = (n2 * c - n1 * t) / (n2 * c + n1 * t);
  return (rs * rs + rp * rp) / 2;
}

constexpr double kUnit = 0x1p-24;  // unit round-off of float

auto describe(float from, float to, double c) {
  return [=] {
    return "n " + hexText(double{from}) + " to " + hexText(double{to}) + ", cosine " + hexText(c);
  };
}

// Cosines around the critical one, with a distance of one unit in the last place.
std::vector<double> aroundCritical(float from, float to) {
  const double eta = static_cast<double>(to) / static_cast<double>(from);
  auto c = static_cast<float>(std::sqrt((1 - eta) * (1 + eta)));
  for (int i = 0; i < 2000; ++i) c = std::nextafter(c, 0.0f);

  std::vector<double> cosines;
  for (int i = -2000; i <= 2000; ++i, c = std::nextafter(c, 1.0f)) {
    cosines.push_back(static_cast<double>(c));
  }
  return cosines;
}

Finding criticalFlag(const Setup& setup) {
  Finding finding(0);
  const float from = 1.5f, to = 1;
  const Incidence in = raysAt(aroundCritical(from, to));
  const Interfaces got = throughKernels(from, to, in, setup);

  for (std::size_t i = 0; i < in.cosines.size(); ++i) {
    const Real c = static_cast<Real>(in.cosines[i]);
    const Real g2 = (to - from) * (Real{to} + from) / (Real{from} * from) + c * c;
    // Within the rounding of g2 both answers are right: F is 1 to four digits.
    if (std::fabs(g2) < 2 * static_cast<Real>(kUnit)) continue;
    finding.count((got.refracted[i] == 0) != (g2 <= 0), describe(from, to, in.cosines[i]));
  }
  return finding;
}

Finding criticalReflectance(const Setup& setup) {
  // g^2 = k + c^2 is off by up to 4 roundings, g by their root, and 1 - F is
  // 2 (g / c) (1 + 1 / eta^2) to first order.
  Finding finding(8.7 * std::sqrt(4 * kUnit));
  const float from = 1.5f, to = 1;
  const Incidence in = raysAt(aroundCritical(from, to));
  const Interfaces got = throughKernels(from, to, in, setup);

  for (std::size_t i = 0; i < in.cosines.size(); ++i) {
    const Real exact = fresnel(from, to, static_cast<Real>(in.cosines[i]));
    finding.note(std::fabs(got.reflected[i] - static_cast<double>(exact)),
                 describe(from, to, in.cosines[i]));
  }
  return finding;
}

// Cosines away from grazing incidence, where the elevation rule changes directions.
std::vector<double> cosines(std::uint64_t seed, std::size_t n, double least) {
  Numbers numbers(seed);
  std::vector<double> result{1, 0.5547001962252291};  // normal incidence, Brewster's angle of 1.5

  while (result.size() < n) {
    result.push_back(numbers.in(0, 1) < 0.5 ? numbers.in(least, 1)
                                            : std::pow(10, numbers.in(std::log10(least), 0)));
  }
  return result;
}

Finding equalIndices(const Setup& setup) {
  Finding finding(0);
  std::vector<double> all = cosines(38, 2000, 1e-7);
  all.push_back(0);  // along the surface

  for (const float n : {1.0f, 1.5f, 1.3333f}) {
    const Incidence in = raysAt(all);
    const Interfaces got = throughKernels(n, n, in, setup);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool same = got.direction[i] == Vec3d(in.rays[i].direction);
      finding.count(got.reflected[i] != 0 || got.refracted[i] != 1 || !same,
                    describe(n, n, in.cosines[i]));
    }
  }
  return finding;
}

Finding reflectanceError(const std::vector<std::pair<float, float>>& pairs, double bound,
                         const Setup& setup) {
  Finding finding(bound);
  const Incidence in = raysAt(cosines(39, 4000, 1e-3));
  for (const auto& [from, to] : pairs) {
    const Interfaces got = throughKernels(from, to, in, setup);
    for (std::size_t i = 0; i < in.cosines.size(); ++i) {
      const Real c = static_cast<Real>(in.cosines[i]), exact = fresnel(from, to, c);

      // Near the critical angle the error of the root dominates (H37a).
      const Real eta = Real{to} / from;
      if (eta < 1 && std::fabs(c * c - (1 - eta * eta)) < 0.1L) continue;
      if (exact < 1e-30L) continue;
      finding.note(static_cast<double>(std::fabs(got.reflected[i] - exact) / exact),
                   describe(from, to, in.cosines[i]));
    }
  }
  return finding;
}

Finding nearlyEqualIndices(const Setup& setup) {
  // One unit in the last place of 1 is 1.2e-7.
  return reflectanceError({{1, 1.0001f}, {1, 1.00001f}, {1, 1 + 0x1p-23f}, {1.5f, 1.50001f}},
                          16 * kUnit, setup);
}

Finding fresnelTable(const Setup& setup) {
  return reflectanceError({{1, 1.33f}, {1, 1.5f}, {1, 2.42f}, {1, 4}}, 16 * kUnit, setup);
}

Finding grazing(const Setup& setup) {
  // The mean of two squares next to 1, each a product of rounded quotients.
  Finding finding(4 * kUnit);
  const Incidence in = raysAt({1e-4, 3e-5, 1e-5, 1e-6, 1e-9, 1e-20});
  const Interfaces got = throughKernels(1, 1.5f, in, setup);

  for (std::size_t i = 0; i < in.cosines.size(); ++i) {
    const Real exact = fresnel(1, 1.5L, static_cast<Real>(in.cosines[i]));
    finding.note(std::fabs(static_cast<double>(got.reflected[i] - exact)),
                 describe(1, 1.5f, in.cosines[i]));
  }
  return finding;
}

Finding fromTheDenserSide(const Setup& setup) {
  // F comes from the differences of cosines that nearly agree with their critical value; relative
  // to the 0.1 that is kept clear of it, ten times as many roundings count.
  return reflectanceError({{1.5f, 1}, {1.33f, 1}, {1.33f, 1.0f / 1.33f}, {2.42f, 1.33f}},
                          160 * kUnit, setup);
}

// Snell's invariant n sin: the sines on both sides, each by its own index.
Finding snell(const Setup& setup) {
  Finding finding(4 * kUnit);
  const Incidence in = raysAt(cosines(42, 4000, 0.05));
  for (const auto& [from, to] :
       std::array<std::pair<float, float>, 3>{{{1, 1.5f}, {1.33f, 1.5f}, {1, 1.0001f}}}) {
    const Interfaces got = throughKernels(from, to, in, setup);
    for (std::size_t i = 0; i < in.cosines.size(); ++i) {
      const double s1 = static_cast<double>(in.rays[i].direction.x), s2 = got.direction[i].x;
      finding.note(std::fabs(s2 - s1 * static_cast<double>(from) / static_cast<double>(to)),
                   describe(from, to, in.cosines[i]));
    }
  }
  return finding;
}

// A slab of thickness 1 moves a ray at 60 degrees by 0.512472013 to the side and does not turn it.
Finding slabShift(const Setup& setup) {
  // Each face moves the start of its ray by the offset: 2^-19 of coordinates of up to 8.
  Finding finding(2 * 8 * 0x1p-19 / 0.512);
  SceneBuilder builder;
  addSlab(builder, 0, -1, builder.add(glassMaterial(1.5f)), 4);
  const Scene scene = builder.build();
  Probe probe(scene, setup);

  const Vec3d d{std::sqrt(0.75), -0.5, 0};
  std::vector<ProbeRay> rays;
  rays.reserve(64);
  for (int i = 0; i < 64; ++i) {
    rays.push_back({Vec3f(Vec3d{-1 + i / 64.0, 1, i / 40.0 - 0.8}), Vec3f(d)});
  }

  const std::vector<ProbeRay> start = rays;
  for (int face = 0; face < 2; ++face) {
    probe.cast(rays);
    rays = raysOf(probe.refractions());
  }

  for (std::size_t i = 0; i < rays.size() && i < start.size(); ++i) {
    const Vec3d moved = Vec3d(rays[i].origin) - Vec3d(start[i].origin);
    const double sideways = length(moved - d * dot(moved, d));
    const double turned = length(Vec3d(rays[i].direction) - d);
    finding.note(std::max(std::fabs(sideways - 0.512472013047) / 0.512472013047, turned),
                 described(start[i]));
  }
  return finding;
}

// In a white room only the light that is still inside after d internal reflections is missing,
// which is R^d (1 - R).
Finding furnace(const Setup& setup) {
  Finding finding(1e-6);
  SceneBuilder builder;
  addSlab(builder, 0, -1, builder.add(glassMaterial(1.5f)), 50);
  builder.sky(1);
  const Scene scene = builder.build();
  const Camera camera{.eye = {0, 3, 0}, .up = {0, 0, -1}};

  for (const int inside : {1, 2, 3, 4, 12}) {
    RenderOptions options = optionsOf(setup);
    options.size = inside < 12 ? ImageSize{1, 1} : ImageSize{33, 21};
    options.depth = inside + 1;
    options.cutoff = 0;

    const double lost = inside < 12 ? std::pow(0.04, inside) * 0.96 : 0;
    for (const Rgb& pixel : pictureOf(scene, camera, options).pixels) {
      finding.note(std::fabs(static_cast<double>(pixel.x) - (1 - lost)),
                   [&] { return "depth " + std::to_string(inside + 1); });
    }
  }
  return finding;
}

Finding energyOfOneEvent(const Setup& setup) {
  Finding finding(2 * kUnit);
  const Incidence in = raysAt(cosines(44, 4000, 1e-6));
  for (const auto& [from, to] : std::array<std::pair<float, float>, 5>{
           {{1, 1.5f}, {1.5f, 1}, {1.33f, 1.5f}, {1, 1.00001f}, {2.42f, 1}}}) {
    const Interfaces got = throughKernels(from, to, in, setup);
    for (std::size_t i = 0; i < in.cosines.size(); ++i) {
      finding.note(std::fabs(got.reflected[i] + got.refracted[i] - 1),
                   describe(from, to, in.cosines[i]));
    }
  }
  return finding;
}

constexpr Case kRefractionCases[] = {
    {"H37", "total reflection begins at the critical angle",
     "cosines within 2000 ulp of it; disagreements with the sign in long double", Runs::targets,
     criticalFlag},
    {"H37a", "reflectance next to the critical angle", "the same cosines; absolute error of F",
     Runs::targets, criticalReflectance},
    {"H38", "equal indices: nothing reflected, directions bit for bit",
     "indices 1, 1.5 and 1.3333 on both sides, cosines down to 1e-7", Runs::targets, equalIndices},
    {"H39", "indices that differ by 1e-7 to 1e-4", "relative error of F for cosines from 1e-3",
     Runs::targets, nearlyEqualIndices},
    {"H40", "Fresnel's reflectance", "indices 1.33, 1.5, 2.42, 4; relative error of F",
     Runs::targets, fresnelTable},
    {"H40a", "grazing incidence", "cosines 1e-4 to 1e-20; absolute error of F", Runs::targets,
     grazing},
    {"H41", "from the denser side", "relative error of F away from the critical angle",
     Runs::targets, fromTheDenserSide},
    {"H42", "Snell's law", "n sin on both sides; absolute error of the sine", Runs::targets, snell},
    {"H42a", "a slab moves a ray sideways and does not turn it",
     "thickness 1, 60 degrees, index 1.5; relative error of the shift", Runs::packets, slabShift},
    {"H43", "white furnace through a slab", "closed form for every depth", Runs::packets, furnace},
    {"H44", "reflected and refracted weights add up to 1", "sums of the kernels' weights less 1",
     Runs::targets, energyOfOneEvent},
};

}  // namespace

std::span<const Case> refractionCases() { return kRefractionCases; }

}  // namespace whit::verify
