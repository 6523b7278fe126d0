// H37 to H44: Fresnel's and Snell's laws in the kernels, against long double.
#include <algorithm>
#include <cmath>
#include <vector>

#include "textbook_fresnel.h"
#include "verify/bodies.h"

namespace whit::verify {

namespace {

// Results of the kernels for a ray that meets a dielectric.
struct Interface {
  ProbeRay ray;
  double cosine = 0;                    // after rounding, which the kernel sees
  double reflected = 0, refracted = 0;  // weights: F, or 0 where nothing is reflected; 1 - F, or 0
  Vec3d direction;                      // of the refracted ray
};

using Real = long double;
constexpr double kUnit = 0x1p-24;  // unit round-off of float

// Rays that hit a surfel whose normals both point up, at these cosines. `from` is the index in
// front of the surface, `to` the index behind it.
std::vector<Interface> throughKernels(float from, float to, const std::vector<double>& cosines,
                                      const Setup& setup) {
  SceneBuilder builder;
  const auto front = builder.add(glassMaterial(from)), behind = builder.add(glassMaterial(to));
  builder.add(floorAt(0, 1, front));
  builder.add(floorAt(1, 1, behind));
  const Scene scene = builder.build();

  Probe probe(scene, setup);
  std::vector<Interface> interfaces;
  std::vector<ProbeRay> rays;
  for (const double c : cosines) {
    // The vertical component is the cosine and is not changed.
    const float down = float(c);
    const double rounded = down;
    const float along = float(std::sqrt(std::max(0.0, (1 - rounded) * (1 + rounded))));
    rays.push_back({{0, 1, 0}, {along, -down, 0}, probe.tables().materials[front].medium});
    interfaces.push_back({rays.back(), rounded, 0, 0, {}});
  }

  probe.load(rays);
  for (const auto i : indices(rays)) probe.surfel(i, behind, {0, 1, 0}, {0, 1, 0});
  for (const auto& [ray, weight, parent] : probe.reflections()) {
    interfaces[parent].reflected = weight.x;
  }
  for (const auto& [ray, weight, parent] : probe.refractions()) {
    interfaces[parent].refracted = weight.x;
    interfaces[parent].direction = Vec3d(ray.direction);
  }
  return interfaces;
}

using Pair = std::pair<float, float>;  // indices in front of a surface and behind it

// Notes errorOf(interface, from, to) at these cosines, between each pair of indices, but for
// interfaces for which it is negative.
template <typename ErrorOf>
void errorsAt(Run& run, const std::vector<double>& cosines, const std::vector<Pair>& pairs,
              const ErrorOf& errorOf) {
  for (const auto& [from, to] : pairs) {
    for (const Interface& got : throughKernels(from, to, cosines, run)) {
      const double error = errorOf(got, Real{from}, Real{to});
      if (error < 0) continue;
      run.note(error, "n ", from, " to ", to, ", cosine ", got.cosine);
    }
  }
}

// Cosines around the critical one, with a distance of one unit in the last place.
std::vector<double> aroundCritical(double from, double to) {
  const double eta = to / from;
  float c = float(std::sqrt((1 - eta) * (1 + eta)));
  for (int i = 0; i < 2000; ++i) c = std::nextafter(c, 0.0f);

  std::vector<double> cosines;
  for (; cosines.size() <= 4000; c = std::nextafter(c, 1.0f)) cosines.push_back(c);
  return cosines;
}

void criticalFlag(Run& run) {
  const float from = 1.5f, to = 1;
  for (const Interface& got : throughKernels(from, to, aroundCritical(from, to), run)) {
    const Real c = got.cosine;
    const Real g2 = (to - from) * (Real{to} + from) / (Real{from} * from) + c * c;
    // Within the rounding of g2 both answers are right: F is 1 to four digits.
    if (std::fabs(g2) < 2 * Real{kUnit}) continue;
    run.count((got.refracted == 0) != (g2 <= 0), "cosine ", got.cosine);
  }
}

// The absolute error of F.
double reflectanceError(const Interface& got, Real from, Real to) {
  return std::fabs(got.reflected - double(test::fresnelOf<Real>(from, to, got.cosine)));
}

void criticalReflectance(Run& run) {
  // g^2 = k + c^2 is off by up to 4 roundings, g by their root, and 1 - F is
  // 2 (g / c) (1 + 1 / eta^2) to first order.
  run.boundBy(8.7 * std::sqrt(4 * kUnit));
  errorsAt(run, aroundCritical(1.5, 1), {{1.5f, 1}}, reflectanceError);
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

void equalIndices(Run& run) {
  std::vector<double> all = cosines(38, 2000, 1e-7);
  all.push_back(0);  // along the surface

  for (const float n : {1.0f, 1.5f, 1.3333f}) {
    for (const Interface& got : throughKernels(n, n, all, run)) {
      const bool same = got.direction == Vec3d(got.ray.direction);
      run.count(got.reflected != 0 || got.refracted != 1 || !same, "n ", n, ", cosine ",
                got.cosine);
    }
  }
}

// The relative error of F away from the critical angle.
void relativeReflectanceError(Run& run, const std::vector<Pair>& pairs) {
  errorsAt(run, cosines(39, 4000, 1e-3), pairs, [](const Interface& got, Real from, Real to) {
    const Real c = got.cosine, exact = test::fresnelOf(from, to, c), eta = to / from;
    // Near the critical angle the error of the root dominates (H37a).
    const bool critical = eta < 1 && std::fabs(c * c - (1 - eta * eta)) < 0.1L;
    if (critical || exact < 1e-30L) return -1.0;
    return double(std::fabs(got.reflected - exact) / exact);
  });
}

void nearlyEqualIndices(Run& run) {
  run.boundBy(16 * kUnit);
  // One unit in the last place of 1 is 1.2e-7.
  relativeReflectanceError(run, {{1, 1.0001f}, {1, 1.00001f}, {1, 1 + 0x1p-23f}, {1.5f, 1.50001f}});
}

void fresnelTable(Run& run) {
  run.boundBy(16 * kUnit);
  relativeReflectanceError(run, {{1, 1.33f}, {1, 1.5f}, {1, 2.42f}, {1, 4}});
}

void grazing(Run& run) {
  // The mean of two squares next to 1, each a product of rounded quotients.
  run.boundBy(4 * kUnit);
  errorsAt(run, {1e-4, 3e-5, 1e-5, 1e-6, 1e-9, 1e-20}, {{1, 1.5f}}, reflectanceError);
}

void fromTheDenserSide(Run& run) {
  // F comes from the differences of cosines that nearly agree with their critical value; relative
  // to the 0.1 that is kept clear of it, ten times as many roundings count.
  run.boundBy(160 * kUnit);
  relativeReflectanceError(run, {{1.5f, 1}, {1.33f, 1}, {1.33f, 1.0f / 1.33f}, {2.42f, 1.33f}});
}

// Snell's invariant n sin: the sines on both sides, each by its own index.
void snell(Run& run) {
  run.boundBy(4 * kUnit);
  errorsAt(run, cosines(42, 4000, 0.05), {{1, 1.5f}, {1.33f, 1.5f}, {1, 1.0001f}},
           [](const Interface& got, Real from, Real to) {
             const double s1 = got.ray.direction.x, n1 = double(from), n2 = double(to);
             return std::fabs(got.direction.x - s1 * n1 / n2);
           });
}

// A slab of thickness 1 moves a ray at 60 degrees by 0.512472013 to the side and does not turn it.
void slabShift(Run& run) {
  // Each face moves the start of its ray by the offset: 2^-19 of coordinates of up to 8.
  run.boundBy(2 * 8 * 0x1p-19 / 0.512);
  SceneBuilder builder;
  addSlab(builder, 0, -1, glassMaterial(1.5f), 4);
  const Scene scene = builder.build();
  Probe probe(scene, run);

  const Vec3d d{std::sqrt(0.75), -0.5, 0};
  std::vector<ProbeRay> rays;
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
    run.note(std::max(std::fabs(sideways - 0.512472013047) / 0.512472013047, turned), start[i]);
  }
}

// The faces of a slab with a coat reflect R = m + (1 - m) F. In a white room only the light that is
// still inside after d internal reflections is missing, which is R^d (1 - R) along the normal.
void furnace(Run& run) {
  run.boundBy(1e-6);
  const Camera camera{.eye = {0, 3, 0}, .up = {0, 0, -1}};

  for (const float mirror : {0.0f, 0.05f, 0.2f, 0.5f, 1.0f}) {
    SceneBuilder builder;
    Material coated = glassMaterial(1.5f);
    coated.mirror = coated.mirrorGrazing = Rgb(mirror);
    addSlab(builder, 0, -1, coated, 50);
    builder.sky(1);
    const Scene scene = builder.build();
    const double reflected = double{mirror} * 0.96 + 0.04;

    // So deep, the loss is none at any angle.
    constexpr int kDeep = 31;
    for (const int inside : {1, 2, 3, 4, kDeep}) {
      RenderOptions options = optionsOf(run, inside < kDeep ? ImageSize{1, 1} : ImageSize{33, 21});
      options.depth = inside + 1;
      options.cutoff = 0;

      const double lost = std::pow(reflected, inside) * (1 - reflected);
      for (const Rgb& pixel : pictureOf(scene, camera, options).pixels) {
        run.note(std::fabs(pixel.x - (1 - lost)), "mirror ", mirror, ", depth ", inside + 1);
      }
    }
  }
}

void energyOfOneEvent(Run& run) {
  run.boundBy(2 * kUnit);
  errorsAt(run, cosines(44, 4000, 1e-6),
           {{1, 1.5f}, {1.5f, 1}, {1.33f, 1.5f}, {1, 1.00001f}, {2.42f, 1}},
           [](const Interface& got, Real, Real) {
             return std::fabs(got.reflected + got.refracted - 1);
           });
}

}  // namespace

const Family kRefractionCases{
    "refraction",
    {{"H37", "total reflection begins at the critical angle",
      "cosines within 2000 ulp of it; disagreements with the sign in long double", criticalFlag,
      Runs::targets},
     {"H37a", "reflectance next to the critical angle", "the same cosines; absolute error of F",
      criticalReflectance, Runs::targets},
     {"H38", "equal indices: nothing reflected, directions bit for bit",
      "indices 1, 1.5 and 1.3333 on both sides, cosines down to 1e-7", equalIndices, Runs::targets},
     {"H39", "indices that differ by 1e-7 to 1e-4", "relative error of F for cosines from 1e-3",
      nearlyEqualIndices, Runs::targets},
     {"H40", "Fresnel's reflectance", "indices 1.33, 1.5, 2.42, 4; relative error of F",
      fresnelTable, Runs::targets},
     {"H40a", "grazing incidence", "cosines 1e-4 to 1e-20; absolute error of F", grazing,
      Runs::targets},
     {"H41", "from the denser side", "relative error of F away from the critical angle",
      fromTheDenserSide, Runs::targets},
     {"H42", "Snell's law", "n sin on both sides; absolute error of the sine", snell,
      Runs::targets},
     {"H42a", "a slab moves a ray sideways and does not turn it",
      "thickness 1, 60 degrees, index 1.5; relative error of the shift", slabShift},
     {"H43", "white furnace through a slab", "closed form for every coat and depth", furnace},
     {"H44", "reflected and refracted weights add up to 1", "sums of the kernels' weights less 1",
      energyOfOneEvent, Runs::targets}}};

}  // namespace whit::verify
