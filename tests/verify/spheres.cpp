// H71: exact spheres, of any size, from any distance and in any place, and ellipsoids.
#include <array>

#include "scene/camera.h"
#include "verify/balls.h"

namespace whit::verify {

namespace {

// Towards a sphere, and past it by up to a radius. Farther away than 1e6 radii floats hardly aim:
// where the rays really go is for the chord to say.
std::vector<ProbeRay> raysTowards(const Ball& ball, std::uint64_t seed) {
  Numbers numbers(seed);
  std::vector<ProbeRay> rays;
  const Vec3d center(ball.center);
  const auto radius = static_cast<double>(ball.radius);
  for (const double away : {1.25, 10.0, 1e3, 1e5, 1e7}) {
    for (int i = 0; i < 40; ++i) {
      const Vec3f from(center + numbers.direction() * (away * radius));
      const double reach = std::sqrt(numbers.in(0, 4)) * radius;
      rays.push_back(rayThrough(from, Vec3f(center + numbers.direction() * reach)));
    }
  }
  return rays;
}

// Calls visit(probe, ball, i) for rays towards spheres of all sizes.
template <typename Visit>
void forAllSizes(const Setup& setup, const Visit& visit) {
  for (const Ball& ball : ballsOfAllSizes({0, 1, 1e3, 1e6})) {
    const Scene scene = sceneOfBall(ball, diffuseMaterial(1));
    Probe probe(scene, setup);
    probe.cast(raysTowards(ball, 71));
    for (std::size_t i = 0; i < probe.size(); ++i) visit(probe, ball, i);
  }
}

Finding silhouettes(const Setup& setup) {
  Finding finding(0);
  std::size_t hits = 0, misses = 0;
  forAllSizes(setup, [&](const Probe& probe, const Ball& ball, std::size_t i) {
    const ProbeRay ray = probe.ray(i);
    const BallChord chord = chordOf(ball, ray);
    const bool ahead = chord.far > 0;
    if (chord.aside > 0.99L && chord.aside < 1.01L) return;
    const bool wanted = chord.aside < 1 && ahead;
    ++(wanted ? hits : misses);
    finding.count(probe.isHit(i) != wanted, describedOn(ball, ray));
  });
  finding.count(hits < 1000 || misses < 1000, [] { return "too few rays of a kind"; });
  return finding;
}

// By how much a hit is off, of what it may be off: over the sphere, along it, and in its distance,
// which is rounded once; that the double before is off is less than a thousandth of it.
double hitError(const Probe& probe, const Ball& ball, std::size_t i) {
  const ProbeRay ray = probe.ray(i);
  const BallChord chord = chordOf(ball, ray);
  const long double t = chord.near > 0 ? chord.near : chord.far;
  const double over = ballHeightError(ball);
  const double along = kWeightAngle * static_cast<double>(ball.radius) + 2 * over;
  const Vec3l off = Vec3l(probe.position(i)) - (Vec3l(ray.origin) + Vec3l(ray.direction) * t);
  const auto far = static_cast<double>(static_cast<long double>(probe.hits().t[i]) / t - 1);
  return std::max({std::fabs(heightOver(ball, probe.position(i))) / over,
                   static_cast<double>(length(off)) / along,
                   std::fabs(far) / (1.001 * kBallRounding)});
}

Finding pointsOnBalls(const Setup& setup) {
  Finding finding(1);
  forAllSizes(setup, [&](const Probe& probe, const Ball& ball, std::size_t i) {
    const ProbeRay ray = probe.ray(i);
    if (!probe.isHit(i) || chordOf(ball, ray).aside > 0.99L) return;
    finding.note(hitError(probe, ball, i), describedOn(ball, ray));
  });
  return finding;
}

Finding offsetOnBalls(const Setup& setup) {
  Finding finding(1);
  forAllSizes(setup, [&](const Probe& probe, const Ball& ball, std::size_t i) {
    if (!probe.isHit(i)) return;
    const double height = std::fabs(heightOver(ball, probe.position(i)));
    finding.note(height / static_cast<double>(probe.surfels().offset[i]),
                 describedOn(ball, probe.ray(i)));
  });
  return finding;
}

// A unit vector across `d`.
Vec3d acrossRay(const Vec3d& d, Numbers& numbers) {
  return normalized(cross(d, numbers.direction()));
}

// Along the limb, off by up to 64 roundings; and along the axes, where nothing is rounded and the
// line touches the sphere in one point.
std::vector<ProbeRay> tangentRays(const Ball& ball) {
  Numbers numbers(72);
  std::vector<ProbeRay> rays;
  const Vec3d center(ball.center);
  const auto radius = static_cast<double>(ball.radius);
  for (int i = 0; i < 1500; ++i) {
    const Vec3d d = numbers.direction(), e = acrossRay(d, numbers);
    const double off = 1 + std::floor(numbers.in(-64, 65)) * kBallRounding;
    rays.push_back({Vec3f(center + e * (radius * off) - d * (4 * radius)), Vec3f(d)});
  }
  for (int i = 0; i < 24; ++i) {
    const int axis = i % 3, aside = (axis + 1 + i / 3 % 2) % 3;
    Vec3d from = center, d;
    d[axis] = i < 12 ? 1 : -1;
    from[aside] += i / 6 % 2 == 0 ? radius : -radius;
    from[axis] -= 4 * radius * d[axis];
    rays.push_back({Vec3f(from), Vec3f(d)});
  }
  return rays;
}

// From four radii away a double's own roundings leave the silhouette in doubt by this much.
constexpr double kLimbDoubt = 0x1p-47;

// Of a hit on the limb: how far its cosine is from the chord's, of what the normal may be off by.
double limbError(const Probe& probe, const Ball& ball, std::size_t i) {
  const ProbeRay ray = probe.ray(i);
  const Vec3d n(probe.ng(i)), d(ray.direction);
  if (!isFinite(probe.position(i)) || !isFinite(probe.ng(i))) return kNoBound;
  if (!std::isfinite(probe.hits().t[i]) || dot(n, d) > 4 * kBallRounding) return kNoBound;
  if (std::fabs(heightOver(ball, probe.position(i))) > ballHeightError(ball)) return kNoBound;
  const auto aside = static_cast<double>(chordOf(ball, ray).aside);
  const double cosine = std::sqrt(std::max(0.0, (1 - aside) * (1 + aside)));
  const double outside = dot(n, Vec3d(probe.position(i)) - Vec3d(ball.center)) > 0 ? 1 : -1;
  const double bound = kWeightAngle + 8 * kBallRounding + std::sqrt(2 * kLimbDoubt);
  return std::fabs(outside * dot(n, d) + cosine * length(d)) / bound;
}

Finding tangentToBalls(const Setup& setup) {
  Finding finding(1);
  for (const Ball& ball : {Ball{}, Ball{{3, -2, 5}, 0.75f}, Ball{{0, 0, 0}, 1e5f}}) {
    const Scene scene = sceneOfBall(ball, glassMaterial(1.5f));
    Probe probe(scene, setup);
    probe.cast(tangentRays(ball));
    for (std::size_t i = 0; i < probe.size(); ++i) {
      const ProbeRay ray = probe.ray(i);
      const auto inside = static_cast<double>(1 - chordOf(ball, ray).aside);
      const bool wrong = probe.isHit(i) ? inside < -kLimbDoubt : inside > kLimbDoubt;
      if (wrong) finding.note(kNoBound, describedOn(ball, ray));
      if (probe.isHit(i)) finding.note(limbError(probe, ball, i), describedOn(ball, ray));
    }
    for (const auto& children : {probe.reflections(), probe.refractions()}) {
      for (const ProbeChild& child : children) {
        const bool finite = isFiniteRay(child.ray) && isFinite(child.weight);
        if (!finite) finding.note(kNoBound, describedOn(ball, child.ray));
      }
    }
  }
  return finding;
}

// On the sphere, off by up to eight roundings to both sides, in any direction.
std::vector<ProbeRay> raysFromSurface(const Ball& ball) {
  Numbers numbers(73);
  std::vector<ProbeRay> rays;
  for (int i = 0; i < 400; ++i) {
    const double off = 1 + std::floor(numbers.in(-8, 9)) * kBallRounding;
    const Vec3d out = numbers.direction() * (static_cast<double>(ball.radius) * off);
    rays.push_back({Vec3f(Vec3d(ball.center) + out), Vec3f(numbers.direction())});
  }
  return rays;
}

// In radii: what a double's roundings of 1 leave open where a line that passes the center by no
// more than kSlantest goes through the surface.
constexpr double kStartDoubt = 0x1p-45;
constexpr long double kSlantest = 0.999L;

// How far the first place ahead is wrong: 1 is what rounding to float may do.
double startError(const Probe& probe, const Ball& ball, std::size_t i) {
  const BallChord chord = chordOf(ball, probe.ray(i));
  const double doubt = kStartDoubt * static_cast<double>(ball.radius);
  const bool outside = chord.near > 0;
  const auto t = static_cast<double>(outside ? chord.near : chord.far);
  if (t <= 0) return probe.isHit(i) ? kNoBound : 0;
  if (!probe.isHit(i)) return kNoBound;
  const auto found = static_cast<double>(probe.hits().t[i]);
  return std::fabs(found - t) / (1.001 * kBallRounding * t + doubt);
}

Finding startsOnBalls(const Setup& setup) {
  Finding finding(1);
  for (const Ball& ball : ballsOfAllSizes({0, 1, 100})) {
    const Scene scene = sceneOfBall(ball, diffuseMaterial(1));
    Probe probe(scene, setup);
    probe.cast(raysFromSurface(ball));
    const long double doubt = kStartDoubt * static_cast<long double>(ball.radius);
    for (std::size_t i = 0; i < probe.size(); ++i) {
      const ProbeRay ray = probe.ray(i);
      const BallChord chord = chordOf(ball, ray);
      // Neither a graze nor a start within the doubt has an answer.
      if (!(chord.aside < kSlantest)) continue;
      if (std::fabs(chord.near) < doubt || std::fabs(chord.far) < doubt) continue;
      finding.note(startError(probe, ball, i), describedOn(ball, ray));
    }
  }
  return finding;
}

// The floats that the scene will hold.
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

// An ellipsoid as the quadric |A (p - center)|^2 = 1.
struct Quadric {
  std::array<Vec3l, 3> rows;  // of A
  Vec3l center;
  // A is made of differences of products; of the lengths that are multiplied, over the volume.
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
  // Half of it.
  Vec3l gradient(const Vec3l& p) const {
    const Vec3l q = linear(p - center);
    return rows[0] * q.x + rows[1] * q.y + rows[2] * q.z;
  }
  // Of all entries of A.
  long double norm() const {
    return std::sqrt(dot(rows[0], rows[0]) + dot(rows[1], rows[1]) + dot(rows[2], rows[2]));
  }
};

// The normal's error, of what it may be: the map of normals turns an error of the unit vector into
// up to its norm times as much. An entry of it is a difference of two products, off by three
// roundings of their size; its product with the vector, the sums and the length by six more.
double normalError(const Probe& probe, const Quadric& quadric, std::size_t i, bool entering) {
  const ProbeRay ray = probe.ray(i);
  const BallChord chord = quadric.chord(ray);
  const long double t = entering ? chord.near : chord.far;
  const Vec3l gradient = quadric.gradient(Vec3l(ray.origin) + Vec3l(ray.direction) * t);
  const long double size = length(gradient);
  const auto stretch = static_cast<double>(quadric.norm() / size);
  const auto products = static_cast<double>(quadric.products / size);
  const double bound = stretch * (kWeightAngle + 6 * kBallRounding) + products * 3 * kBallRounding;
  const auto cosine = static_cast<double>(dot(gradient, Vec3l(ray.direction)) / size);
  if (std::fabs(cosine) <= bound) return 0;  // either side may be met there
  if (enters(probe, i) != entering) return kNoBound;
  const Vec3l outwards = Vec3l(probe.ng(i)) * (entering ? 1.0L : -1.0L);
  return static_cast<double>(length(outwards - gradient / size)) / bound;
}

std::vector<ProbeRay> raysOntoEllipsoid(const Affine& map) {
  Numbers numbers(74);
  std::vector<ProbeRay> rays;
  const double reach = 2 * (length(map.x) + length(map.y) + length(map.z));
  for (int i = 0; i < 200; ++i) {
    const Vec3d target = map.point(numbers.direction() * numbers.in(0, 0.99));
    rays.push_back(rayThrough(Vec3f(target + numbers.direction() * reach), Vec3f(target)));
  }
  return rays;
}

std::string describeEllipsoid(const Affine& map, const ProbeRay& ray) {
  return hexText(Vec3f(map.x)) + ", " + hexText(Vec3f(map.y)) + ", " + hexText(Vec3f(map.z)) +
         ", " + describeRay(ray);
}

Finding ellipsoids(const Setup& setup) {
  Finding finding(1);
  for (const Affine& map : ellipsoidMaps()) {
    const Quadric quadric(map);
    // Straight through.
    const Scene scene = sceneOf(mappedSphere(map, 0), glassMaterial(1));
    Probe probe(scene, setup);
    std::vector<ProbeRay> rays = raysOntoEllipsoid(map);
    for (const bool entering : {true, false}) {
      probe.cast(rays);
      for (std::size_t i = 0; i < probe.size(); ++i) {
        const bool clear = quadric.chord(rays[i]).aside < 0.999L;
        const double error = probe.isHit(i) ? normalError(probe, quadric, i, entering)
                             : clear        ? kNoBound
                                            : 0;
        finding.note(error, [&] { return describeEllipsoid(map, rays[i]); });
      }
      rays = raysOf(probe.refractions());
    }
  }
  return finding;
}

// Of rays that look away. A rounded eye may lie below the surface by 2^-24 of its coordinates; at
// this cosine a ray is through it after 2^-15 of them, near enough to be passed over.
constexpr double kAway = 0x1p-9;

// Pixels that look away and are not the sky.
void lookAway(const Ball& ball, const Camera& camera, const Setup& setup, Finding& finding) {
  constexpr float kSky = 0.25f;
  SceneBuilder builder;
  builder.add(exactBall(ball, builder.add(emittingMaterial(1))));
  builder.sky(kSky);
  const Image image = pictureOf(builder.build(), camera, optionsOf(setup, {24, 18}));
  const CameraFrame frame = makeCameraFrame(camera, image.width, image.height);
  const Vec3d out = normalized(Vec3d(camera.eye) - Vec3d(ball.center));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Vec3d d = normalized(frame.forward + frame.right * (x + 0.5 - image.width / 2.0) -
                                 frame.up * (y + 0.5 - image.height / 2.0));
      if (dot(d, out) < kAway) continue;
      finding.count(image.at(x, y).x != kSky, [&] {
        return describeBall(ball, {camera.eye, Vec3f(d)});
      });
    }
  }
}

Finding eyeOnABall(const Setup& setup) {
  Finding finding(0);
  Numbers numbers(75);
  for (const Ball& ball : {Ball{}, Ball{{0.3f, -7, 4}, 0.7f}, Ball{{0, -6e6f, 0}, 6e6f},
                           Ball{{200, 100, -300}, 0.5f}, Ball{{0, 0, 0}, 1e-4f}}) {
    const auto radius = static_cast<double>(ball.radius);
    for (int i = 0; i < 4; ++i) {
      const Vec3d out = numbers.direction(), along = acrossRay(out, numbers);
      Camera camera;
      camera.eye = Vec3f(Vec3d(ball.center) + out * radius);
      camera.up = Vec3f(out);
      camera.fov = 90;
      for (const Vec3d& towards : {out + along * 0.1, along + out * 0.1}) {
        const double step = std::max(radius, length(Vec3d(camera.eye)));
        camera.at = Vec3f(Vec3d(camera.eye) + towards * step);
        lookAway(ball, camera, setup, finding);
      }
    }
  }
  return finding;
}

constexpr Case kSphereCases[] = {
    {"H71", "exact spheres of any size are hit from any distance, and not beside",
     "radii of 1e-6 to 1e6, up to 1e6 radii from the origin, seen from up to 1e7 radii; rays "
     "within "
     "0.99 of the silhouette that miss and beyond 1.01 that hit",
     Runs::packets, silhouettes},
    {"H71a", "points on spheres and their distance",
     "the same spheres; height over the sphere, way along it and distance, over their bounds",
     Runs::packets, pointsOnBalls},
    {"H71b", "on spheres the offset bounds the error of the hit point",
     "the same spheres; height over the sphere by the offset", Runs::packets, offsetOnBalls},
    {"H71c", "rays along the limb of a sphere",
     "64 roundings to both sides, and touching in one point; the cosine's error over its bound",
     Runs::packets, tangentToBalls},
    {"H71d", "rays that start on a sphere, or next to it",
     "up to eight roundings to both sides; error of the first distance ahead over its bound",
     Runs::packets, startsOnBalls},
    {"H71e", "normals of ellipsoids, turned, sheared and mirrored",
     "1 to 1000; both faces against the gradient of the quadric, over the bound", Runs::packets,
     ellipsoids},
    {"H71f", "an eye in the surface of a sphere does not see it",
     "looking away and along; pixels that are not the sky", Runs::packets, eyeOnABall},
};

}  // namespace

std::span<const Case> sphereCases() { return kSphereCases; }

}  // namespace whit::verify
