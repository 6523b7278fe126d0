// H71: exact spheres, of any size, from any distance and in any place, and ellipsoids.
#include <array>

#include "scene/camera.h"
#include "verify/balls.h"

namespace whit::verify {

namespace {

// Rays towards a sphere, and past it by up to a radius. From more than 1e6 radii away floats hardly
// aim; the chord shows where such a ray really goes.
std::vector<ProbeRay> raysTowards(const Ball& ball) {
  constexpr double kAway[] = {1.25, 10, 1e3, 1e5, 1e7};
  return randomRays(200, 71, [&](Numbers& numbers, int i) {
    const Vec3f from(ball.point(numbers.direction(), kAway[i / 40]));
    const double reach = std::sqrt(numbers.in(0, 4));
    return rayThrough(from, Vec3f(ball.point(numbers.direction(), reach)));
  });
}

// Casts the rays that makeRays(ball) returns at opaque spheres of all sizes, at these distances
// from the origin in radii, and calls visit(probe, ball, ray, number of the ray).
template <typename MakeRays, typename Visit>
void forAllSizes(std::initializer_list<double> distances, const MakeRays& makeRays,
                 const Setup& setup, const Visit& visit) {
  for (const Ball& ball : ballsOfAllSizes(distances)) {
    const Scene scene = ball.scene(diffuseMaterial(1));
    const Probe probe(scene, setup, makeRays(ball));
    for (const auto i : indices(probe)) visit(probe, ball, probe.ray(i), i);
  }
}

constexpr std::initializer_list<double> kDistances = {0, 1, 1e3, 1e6};

void silhouettes(Run& run) {
  std::size_t hits = 0, misses = 0;
  forAllSizes(kDistances, raysTowards, run,
              [&](const Probe& probe, const Ball& ball, const ProbeRay& ray, std::size_t i) {
                const BallChord chord = ball.chord(ray);
                if (chord.aside > 0.99L && chord.aside < 1.01L) return;
                const bool expected = chord.aside < 1 && chord.far > 0;
                ++(expected ? hits : misses);
                run.count(probe.isHit(i) != expected, ball, ray);
              });
  run.count(hits < 1000 || misses < 1000, "too few rays of a kind");
}

void pointsOnBalls(Run& run) {
  run.boundBy(1);
  forAllSizes(
      kDistances, raysTowards, run,
      [&](const Probe& probe, const Ball& ball, const ProbeRay& ray, std::size_t i) {
        const BallChord chord = ball.chord(ray);
        if (!probe.isHit(i) || chord.aside > 0.99L) return;

        const long double t = chord.ahead();
        const double over = ball.heightError();
        const double along = kWeightAngle * ball.r() + 2 * over;
        const Vec3l off = Vec3l(probe.position(i)) - (Vec3l(ray.origin) + Vec3l(ray.direction) * t);
        // The distance is rounded once; the double before it is off by less than a thousandth of
        // that rounding.
        const double far = double(probe.hits().t[i] / t - 1);

        run.note(std::max({std::fabs(ball.heightOf(probe.position(i))) / over,
                           double(length(off)) / along, std::fabs(far) / (1.001 * kBallRounding)}),
                 ball, ray);
      });
}

void offsetOnBalls(Run& run) {
  run.boundBy(1);
  forAllSizes(kDistances, raysTowards, run,
              [&](const Probe& probe, const Ball& ball, const ProbeRay& ray, std::size_t i) {
                if (!probe.isHit(i)) return;
                const double height = std::fabs(ball.heightOf(probe.position(i)));
                run.note(height / probe.surfels().offset[i], ball, ray);
              });
}

// Rays along the limb, off by up to 64 roundings; and rays along the axes, where nothing is rounded
// and the line touches the sphere in one point.
std::vector<ProbeRay> tangentRays(const Ball& ball) {
  std::vector<ProbeRay> rays = randomRays(1500, 72, [&](Numbers& numbers, int) {
    const Vec3d d = numbers.direction(), e = across(d, numbers);
    const double off = 1 + std::floor(numbers.in(-64, 65)) * kBallRounding;
    return ProbeRay{Vec3f(ball.point(e, off) - d * (4 * ball.r())), Vec3f(d)};
  });

  for (int i = 0; i < 24; ++i) {
    const int axis = i % 3, aside = (axis + 1 + i / 3 % 2) % 3;
    Vec3d from(ball.center), d;
    d[axis] = i < 12 ? 1 : -1;
    from[aside] += i / 6 % 2 == 0 ? ball.r() : -ball.r();
    from[axis] -= 4 * ball.r() * d[axis];
    rays.push_back({Vec3f(from), Vec3f(d)});
  }
  return rays;
}

// From four radii away a double's own roundings leave the silhouette in doubt by this much.
constexpr double kLimbDoubt = 0x1p-47;

// Returns, for a hit on the limb, the difference of its cosine from the chord's, relative to the
// bound on the error of the normal.
double limbError(const Probe& probe, const Ball& ball, std::size_t i) {
  const ProbeRay ray = probe.ray(i);
  const Vec3d n(probe.ng(i)), d(ray.direction);
  // A hit must have finite results, face the ray and lie on the sphere.
  if (!isFinite(probe.position(i)) || !isFinite(probe.ng(i))) return kNoBound;
  if (!std::isfinite(probe.hits().t[i]) || dot(n, d) > 4 * kBallRounding) return kNoBound;
  if (std::fabs(ball.heightOf(probe.position(i))) > ball.heightError()) return kNoBound;

  const double aside = ball.aside(ray);
  const double cosine = std::sqrt(std::max(0.0, (1 - aside) * (1 + aside)));
  const double outside = dot(n, Vec3d(probe.position(i)) - Vec3d(ball.center)) > 0 ? 1 : -1;
  const double bound = kWeightAngle + 8 * kBallRounding + std::sqrt(2 * kLimbDoubt);
  return std::fabs(outside * dot(n, d) + cosine * length(d)) / bound;
}

void tangentToBalls(Run& run) {
  run.boundBy(1);
  for (const Ball& ball : {Ball{}, Ball{{3, -2, 5}, 0.75f}, Ball{{0, 0, 0}, 1e5f}}) {
    const Scene scene = ball.scene(glassMaterial(1.5f));
    Probe probe(scene, run, tangentRays(ball));
    for (const auto i : indices(probe)) {
      const ProbeRay ray = probe.ray(i);
      const double inside = double(1 - ball.chord(ray).aside);
      const bool wrong = probe.isHit(i) ? inside < -kLimbDoubt : inside > kLimbDoubt;
      if (wrong) run.note(kNoBound, ball, ray);
      if (probe.isHit(i)) run.note(limbError(probe, ball, i), ball, ray);
    }

    for (const auto& children : {probe.reflections(), probe.refractions()}) {
      for (const auto& [ray, weight, parent] : children) {
        const bool finite = isFinite(ray.origin) && isFinite(ray.direction) && isFinite(weight);
        if (!finite) run.note(kNoBound, ball, ray);
      }
    }
  }
}

// Rays from points on the sphere, off by up to eight roundings to both sides, in any direction.
std::vector<ProbeRay> raysFromSurface(const Ball& ball) {
  return randomRays(400, 73, [&](Numbers& numbers, int) {
    const double off = 1 + std::floor(numbers.in(-8, 9)) * kBallRounding;
    const Vec3f from(ball.point(numbers.direction(), off));
    return ProbeRay{from, Vec3f(numbers.direction())};
  });
}

// For a line that passes the center by no more than kSlantest: how far, in radii, a double's
// roundings of 1 leave its intersection with the surface in doubt.
constexpr double kStartDoubt = 0x1p-45;
constexpr long double kSlantest = 0.999L;

// The error of the first intersection ahead; 1 is the rounding to float.
double startError(const Probe& probe, const Ball& ball, const BallChord& chord, std::size_t i) {
  const double t = double(chord.ahead());
  if (t <= 0) return probe.isHit(i) ? kNoBound : 0;
  if (!probe.isHit(i)) return kNoBound;
  return std::fabs(probe.hits().t[i] - t) / (1.001 * kBallRounding * t + kStartDoubt * ball.r());
}

void startsOnBalls(Run& run) {
  run.boundBy(1);
  forAllSizes({0, 1, 100}, raysFromSurface, run,
              [&](const Probe& probe, const Ball& ball, const ProbeRay& ray, std::size_t i) {
                const BallChord chord = ball.chord(ray);
                const double doubt = kStartDoubt * ball.r();
                // Neither a graze nor a start within the doubt has an answer.
                if (!(chord.aside < kSlantest)) return;
                if (std::fabs(chord.near) < doubt || std::fabs(chord.far) < doubt) return;
                run.note(startError(probe, ball, chord, i), ball, ray);
              });
}

// The map with the floats that the scene will hold.
Affine roundedMap(const Affine& map) {
  return {Vec3d(Vec3f(map.x)), Vec3d(Vec3f(map.y)), Vec3d(Vec3f(map.z)), Vec3d(Vec3f(map.p))};
}

// Needles and discs of 1 to 1000, turned, sheared, and all of them mirrored.
std::vector<Affine> ellipsoidMaps() {
  const Affine turned = Affine::translation({3, -1, 2}) * Affine::rotation({1, 2, -0.5}, 67);
  std::vector<Affine> maps;
  for (const Vec3d& scale : {Vec3d{1000, 1, 1}, Vec3d{1, 1000, 1000}, Vec3d{1, 30, 1000},
                             Vec3d{1e-3, 1, 1}, Vec3d{1e-3, 1e-3, 1}}) {
    for (const double mirror : {1.0, -1.0}) {
      const Affine scaled = Affine::scaling({scale.x, scale.y * mirror, scale.z});
      Affine sheared = scaled;
      sheared.y += scaled.x * 0.5;
      for (const Affine& map : {scaled, turned * scaled, turned * sheared}) {
        maps.push_back(roundedMap(map));
      }
    }
  }
  return maps;
}

// An ellipsoid as the quadric |A (p - center)|^2 = 1, where A is the inverse of the map.
struct Quadric {
  std::array<Vec3l, 3> rows;  // of A
  Vec3l center;
  // An entry of A is a difference of two products. This is the sum of the products of the lengths
  // that are multiplied, over the volume.
  long double products = 0;

  explicit Quadric(const Affine& map) : center(map.p) {
    const Vec3l x(map.x), y(map.y), z(map.z);
    const long double volume = dot(x, cross(y, z));
    rows = {cross(y, z) / volume, cross(z, x) / volume, cross(x, y) / volume};
    const long double a = length(x), b = length(y), c = length(z);
    products = (b * c + c * a + a * b) / std::fabs(volume);
  }
  Vec3l linear(const Vec3l& v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
  BallChord chord(const ProbeRay& ray) const {
    return chordOf(linear(Vec3l(ray.origin) - center), linear(Vec3l(ray.direction)), 1);
  }
  // Half of the gradient.
  Vec3l gradient(const Vec3l& p) const {
    const Vec3l q = linear(p - center);
    return rows[0] * q.x + rows[1] * q.y + rows[2] * q.z;
  }
  // Frobenius norm of A.
  long double norm() const {
    return std::sqrt(dot(rows[0], rows[0]) + dot(rows[1], rows[1]) + dot(rows[2], rows[2]));
  }
};

// The error of the normal relative to its bound. The map of normals turns an error of the unit
// vector into up to its norm times as much. An entry of the map is a difference of two products,
// off by three roundings of their size; its product with the vector, the sums and the length add
// six more.
double normalError(const Probe& probe, const Quadric& quadric, std::size_t i, bool entering) {
  const ProbeRay ray = probe.ray(i);
  const BallChord chord = quadric.chord(ray);
  const long double t = entering ? chord.near : chord.far;
  const Vec3l gradient = quadric.gradient(Vec3l(ray.origin) + Vec3l(ray.direction) * t);
  const long double size = length(gradient);

  const double stretch = double(quadric.norm() / size);
  const double products = double(quadric.products / size);
  const double bound = stretch * (kWeightAngle + 6 * kBallRounding) + products * 3 * kBallRounding;

  const double cosine = double(dot(gradient, Vec3l(ray.direction)) / size);
  if (std::fabs(cosine) <= bound) return 0;  // the ray may hit either side there
  if (enters(probe, i) != entering) return kNoBound;
  const Vec3l outwards = Vec3l(probe.ng(i)) * (entering ? 1.0L : -1.0L);
  return double(length(outwards - gradient / size)) / bound;
}

std::vector<ProbeRay> raysOntoEllipsoid(const Affine& map) {
  const double reach = 2 * (length(map.x) + length(map.y) + length(map.z));
  return randomRays(200, 74, [&](Numbers& numbers, int) {
    const Vec3d direction = numbers.direction();
    const Vec3d target = map.point(direction * numbers.in(0, 0.99));
    return rayThrough(Vec3f(target + numbers.direction() * reach), Vec3f(target));
  });
}

void ellipsoids(Run& run) {
  run.boundBy(1);
  for (const Affine& map : ellipsoidMaps()) {
    const Quadric quadric(map);
    // Rays pass straight through glass of index 1 and hit both faces.
    const Scene scene = sceneOf(exactSphere(0, map), glassMaterial(1));

    Probe probe(scene, run);
    std::vector<ProbeRay> rays = raysOntoEllipsoid(map);
    for (const bool entering : {true, false}) {
      probe.cast(rays);
      for (const auto i : indices(probe)) {
        const bool clear = quadric.chord(rays[i]).aside < 0.999L;
        double error = clear ? kNoBound : 0;
        if (probe.isHit(i)) error = normalError(probe, quadric, i, entering);
        run.note(error, map.x, ", ", map.y, ", ", map.z, ", ", rays[i]);
      }
      rays = raysOf(probe.refractions());
    }
  }
}

// Least cosine of a ray that looks away from the surface. A rounded eye may lie below the surface
// by 2^-24 of its coordinates; at this cosine the ray has left the surface after 2^-15 of them,
// which is near enough to be passed over.
constexpr double kAway = 0x1p-9;

// Counts the pixels that look away from the ball and do not show the sky.
void lookAway(Run& run, const Ball& ball, const Camera& camera) {
  constexpr float kSky = 0.25f;
  const Scene scene = sceneOf(ball.mesh(), emittingMaterial(1), kSky);
  const Image image = pictureOf(scene, camera, optionsOf(run, {24, 18}));
  const Vec3d out = normalized(Vec3d(camera.eye) - Vec3d(ball.center));

  forEachRay(camera, image.width, image.height, [&](const Vec3d&, const Vec3d& d, int x, int y) {
    if (dot(d, out) < kAway) return;
    run.count(image.at(x, y).x != kSky, ball, ProbeRay{camera.eye, Vec3f(d)});
  });
}

void eyeOnABall(Run& run) {
  Numbers numbers(75);
  for (const Ball& ball : {Ball{}, Ball{{0.3f, -7, 4}, 0.7f}, Ball{{0, -6e6f, 0}, 6e6f},
                           Ball{{200, 100, -300}, 0.5f}, Ball{{0, 0, 0}, 1e-4f}}) {
    for (int i = 0; i < 4; ++i) {
      const Vec3d out = numbers.direction(), along = across(out, numbers);
      const Vec3f eye(ball.point(out, 1));
      const double step = std::max(ball.r(), length(Vec3d(eye)));
      for (const Vec3d& towards : {out + along * 0.1, along + out * 0.1}) {
        const Vec3f at(Vec3d(eye) + towards * step);
        lookAway(run, ball, {.eye = eye, .at = at, .up = Vec3f(out), .fov = 90});
      }
    }
  }
}

}  // namespace

const Family kSphereCases{
    "exact spheres",
    {{"H71", "exact spheres of any size are hit from any distance, and not beside",
      "radii of 1e-6 to 1e6, up to 1e6 radii from the origin, seen from up to 1e7 radii; rays "
      "within 0.99 of the silhouette that miss and beyond 1.01 that hit",
      silhouettes},
     {"H71a", "points on spheres and their distance",
      "the same spheres; height over the sphere, way along it and distance, over their bounds",
      pointsOnBalls},
     {"H71b", "on spheres the offset bounds the error of the hit point",
      "the same spheres; height over the sphere by the offset", offsetOnBalls},
     {"H71c", "rays along the limb of a sphere",
      "64 roundings to both sides, and touching in one point; the cosine's error over its bound",
      tangentToBalls},
     {"H71d", "rays that start on a sphere, or next to it",
      "up to eight roundings to both sides; error of the first distance ahead over its bound",
      startsOnBalls},
     {"H71e", "normals of ellipsoids, turned, sheared and mirrored",
      "1 to 1000; both faces against the gradient of the quadric, over the bound", ellipsoids},
     {"H71f", "an eye in the surface of a sphere does not see it",
      "looking away and along; pixels that are not the sky", eyeOnABall}}};

}  // namespace whit::verify
