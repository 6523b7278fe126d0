// H71, continued: paths that leave exact spheres and go through them, and coincident spheres.
#include <optional>
#include <utility>

#include "scene/camera.h"
#include "verify/balls.h"

namespace whit::verify {

namespace {

// Rays from all around that are aimed at the whole silhouette, many of them close to the limb.
std::vector<ProbeRay> raysOntoBall(const Ball& ball, int n, std::uint64_t seed) {
  return randomRays(n, seed, [&](Numbers& numbers, int) {
    const Vec3d out = numbers.direction(), e = across(out, numbers);
    const double aside = 1 - std::pow(10, numbers.in(-6, 0));
    return rayThrough(Vec3f(ball.point(out, 3)), Vec3f(ball.point(e, aside)));
  });
}

constexpr int kRaysABall = 200;

void leavingBalls(Run& run) {
  for (const Ball& ball : ballsOfAllSizes({0, 1, 1e3})) {
    const Scene scene = ball.scene(shinyMaterial());
    Probe probe(scene, run, raysOntoBall(ball, kRaysABall, 76));

    const Probe next(scene, run, raysOf(probe.reflections()));
    for (const auto i : indices(next)) {
      run.count(next.isHit(i), ball, next.ray(i));
    }

    probe.light(lightAt(Vec3f(ball.point({3, 2.5, -2}, 1)), 1));
    for (const auto i : indices(probe)) {
      if (!probe.isHit(i) || maxComponent(probe.unshadowed(i)) <= 0) continue;
      run.count(!probe.visible(i), "shadow of ", probe.ray(i));
    }
  }
}

// Returns true if a ray within the sphere hits its far side at the right distance.
bool hitsFarSide(const Probe& probe, const Ball& ball, std::size_t i) {
  const BallChord chord = ball.chord(probe.ray(i));
  if (!probe.isHit(i) || enters(probe, i) || !(chord.near < 0)) return false;
  return std::fabs(probe.hits().t[i] / chord.far - 1) <= 1.001 * kBallRounding;
}

void throughBalls(Run& run) {
  for (const Ball& ball : ballsOfAllSizes({0, 1, 1e3})) {
    const Scene scene = ball.scene(glassMaterial(1.5f));
    Probe probe(scene, run, raysOntoBall(ball, kRaysABall, 77)), inside(scene, run);
    const auto castInside = [&](const std::vector<ProbeRay>& rays) {
      inside.cast(rays);
      for (const auto i : indices(inside)) {
        run.count(!hitsFarSide(inside, ball, i), ball, rays[i]);
      }
    };

    castInside(raysOf(probe.refractions()));
    const Probe after(scene, run, raysOf(inside.refractions()));
    for (const auto i : indices(after)) {
      run.count(after.isHit(i) || after.ray(i).media != 0, ball, after.ray(i));
    }
    castInside(raysOf(inside.reflections()));
  }
}

// Thickness of a shell, relative to its outer radius.
constexpr double kShellGap = 1e-5;

struct Shell {
  Ball outer, inner;
  Scene scene;
};

// A shell of glass filled with air, whose priority is above that of the glass.
Shell shellOf(float radius, float ior) {
  const Ball outer{{0, 0, 0}, radius};
  const Ball inner{{0, 0, 0}, float(radius * (1 - kShellGap))};

  SceneBuilder builder;
  builder.add(outer.mesh(), glassMaterial(ior, 0));
  builder.add(inner.mesh(), glassMaterial(1, 1));
  return {outer, inner, builder.build()};
}

struct ShellCrossing {
  std::uint32_t material;
  bool entering;
  int media;  // number of media on the stack before the crossing
};
constexpr ShellCrossing kThroughShell[] = {
    {0, true, 0}, {1, true, 1}, {1, false, 2}, {0, false, 1}};

// Sends rays through all four boundaries; each ray must hit them in order. errorOf(start, end) is
// the error of a ray that has left the shell.
template <typename ErrorOf>
void crossShell(Run& run, const Shell& shell, std::vector<ProbeRay> rays, const ErrorOf& errorOf) {
  Probe probe(shell.scene, run);
  const std::vector<ProbeRay> start = rays;
  for (const ShellCrossing& c : kThroughShell) {
    probe.cast(rays);

    for (const auto i : indices(probe)) {
      const bool met = probe.isHit(i) && probe.surfels().material[i] == c.material &&
                       enters(probe, i) == c.entering && mediaCount(rays[i].media) == c.media;
      if (!met) run.note(kNoBound, shell.outer, rays[i]);
    }

    rays = raysOf(probe.refractions());
    if (rays.size() == start.size()) continue;
    run.note(kNoBound, "some rays ended within the shell");
    return;
  }

  probe.cast(rays);
  for (const auto i : indices(probe)) {
    const bool gone = !probe.isHit(i) && rays[i].media == 0;
    const double error = gone ? errorOf(start[i], rays[i]) : kNoBound;
    run.note(error, shell.outer, start[i]);
  }
}

// The index is 1: at no angle does a bit of the direction change. Rays between the silhouettes of
// both spheres miss the inner one. An offset, which is below 2^-19 of the radius, may move a ray
// across its silhouette, so rays next to it are left out.
void straightThroughShell(Run& run) {
  for (const float radius : {1e-3f, 1.0f, 1e3f}) {
    const Shell shell = shellOf(radius, 1);

    std::vector<ProbeRay> rays;
    for (const ProbeRay& ray : raysOntoBall(shell.outer, 600, 78)) {
      if (shell.inner.chord(ray).aside < 1 - 0x1p-17L) rays.push_back(ray);
    }
    crossShell(run, shell, rays, [](const ProbeRay& before, const ProbeRay& after) {
      return before.direction == after.direction ? 0.0 : 1.0;
    });
  }
}

// Rays through the center are refracted only as far as the normals are off: into glass by a third
// of that error, out of glass by a half, at two faces each. Four directions are rounded as well.
void glassShell(Run& run) {
  run.boundBy(1);
  for (const float radius : {1e-3f, 1.0f, 1e3f}) {
    const Shell shell = shellOf(radius, 1.5f);

    const auto rays = randomRays(400, 79, [&](Numbers& numbers, int) {
      const Vec3f from(shell.outer.point(numbers.direction(), 3));
      return rayThrough(from, {0, 0, 0});
    });
    crossShell(run, shell, rays, [&](const ProbeRay& before, const ProbeRay& after) {
      const double normalsError = kWeightAngle + shell.outer.aside(before);
      const double bound = 2 * (1.0 / 3 + 1.0 / 2) * 1.01 * normalsError + 4 * 4 * kBallRounding;
      return length(Vec3d(after.direction) - Vec3d(before.direction)) / bound;
    });
  }
}

// Rays within a ball of glass that hit its surface at sines of 0.68 to 0.9999; the critical sine is
// 2/3.
std::vector<ProbeRay> galleryRays(const Ball& ball, std::uint32_t medium) {
  return randomRays(64, 80, [&](Numbers& numbers, int i) {
    const double sine = i % 2 == 0 ? numbers.in(0.68, 1) : 1 - std::pow(10, numbers.in(-4, -1));
    const Vec3d aside = numbers.direction(), d = across(aside, numbers);
    return ProbeRay{Vec3f(ball.point(aside, sine)), Vec3f(d), medium};
  });
}

// Upper bound on the change of the sine at a bounce: the ray starts at an offset from the surface
// and behind the hit, the hit's weights turn the normal, and the direction takes a few roundings.
double driftAt(const Probe& probe, const Ball& ball, std::size_t i) {
  const double offset = probe.surfels().offset[i], viewOffset = probe.surfels().viewOffset[i];
  return (offset + viewOffset + ball.heightError()) / ball.r() + kWeightAngle + 8 * kBallRounding;
}

// The sine of a chord is the same at both ends, so that the bounds of all bounces so far add up.
// The finding is the error of the sine relative to their sum.
void whisperingGallery(Run& run) {
  run.boundBy(1);
  constexpr int kDepth = 64;
  for (const Ball& ball : {Ball{}, Ball{{0, 0, 0}, 1e-5f}, Ball{{2, -1, 3}, 1}}) {
    const Scene scene = ball.scene(glassMaterial(1.5f));
    Probe probe(scene, run);
    std::vector<ProbeRay> rays = galleryRays(ball, probe.tables().materials[0].medium);

    std::vector<double> sine, drift(rays.size());
    for (const ProbeRay& ray : rays) sine.push_back(ball.aside(ray));
    for (int bounce = 0; bounce < kDepth; ++bounce) {
      probe.cast(rays);

      const std::vector<ProbeChild> reflected = probe.reflections();
      if (reflected.size() != rays.size() || !probe.refractions().empty()) {
        run.note(kNoBound, bounce, " bounces");
        break;
      }

      for (const ProbeChild& child : reflected) {
        const std::size_t i = child.parent;
        drift[i] += driftAt(probe, ball, i);
        const Vec3d n(probe.ng(i)), d(rays[i].direction);
        const double off = length(cross(n, d)) / length(d) - sine[i];
        const bool whole = child.weight == Rgb(1.0f) && !enters(probe, i);
        run.note(whole ? std::fabs(off) / drift[i] : kNoBound, ball, rays[i]);
      }
      rays = raysOf(reflected);
    }
  }
}

// The distance behind the center, in radii, at which a ray parallel to an axis crosses that axis.
// The ray is turned twice by the difference of both angles, and leaves at the distance from the
// center at which it came.
double ballFocus(double height, double ior) {
  return height / std::sin(2 * (std::asin(height) - std::asin(height / ior)));
}

// Spherical aberration relative to the paraxial focal length and the squared height, for an index
// of 1.5: 5/18 in third order, and a hundredth more for higher orders at heights of up to 0.1.
constexpr double kAberration = 1.01 * 5 / 18;

// The position along the axis, in radii, of the point of `ray` that is nearest to the axis.
double crossingOf(const Ball& ball, const ProbeRay& ray, const Vec3d& axis) {
  const Vec3d from = Vec3d(ray.origin) - Vec3d(ball.center), d(ray.direction);
  const Vec3d side = d - axis * dot(d, axis);
  const double t = -dot(from, side) / dot(side, side);
  return dot(from + d * t, axis) / ball.r();
}

void ballLens(Run& run) {
  run.boundBy(1);
  constexpr double kIor = 1.5, kFocus = kIor / (2 * (kIor - 1));
  for (const Ball& ball : {Ball{}, Ball{{0, 0, 0}, 1e4f}, Ball{{1, 0.5f, -1}, 1}}) {
    const Scene scene = ball.scene(glassMaterial(float(kIor)));

    const auto start = randomRays(300, 81, [&](Numbers& numbers, int) {
      const Vec3d d = numbers.direction(), e = across(d, numbers);
      const Vec3d from = e * std::pow(10, numbers.in(-3, -1)) - d * 2.0;
      return ProbeRay{Vec3f(ball.point(from, 1)), Vec3f(d)};
    });

    Probe probe(scene, run, start);
    probe.cast(raysOf(probe.refractions()));
    const std::vector<ProbeRay> out = raysOf(probe.refractions());
    if (out.size() != start.size()) run.note(kNoBound, "some never left");
    for (const auto i : indices(out)) {
      const double height = ball.aside(start[i]);
      const double found = crossingOf(ball, out[i], normalized(Vec3d(start[i].direction)));
      // Upper bound on the error, in radii, of both points of the path, and of the two directions.
      const double off = 2 * (kWeightAngle + 2 * ball.heightError() / ball.r());
      const double room = 2 * off / (2 * (1 - 1 / kIor) * height);
      const double exact = std::fabs(found / ballFocus(height, kIor) - 1) / room;
      const double paraxial =
          std::fabs(found / kFocus - 1) / (kAberration * height * height + room);
      run.note(std::max(exact, paraxial), ball, start[i]);
    }
  }
}

// Two coincident spheres in the order of the scene, and which of them a ray must hit.
struct Rivals {
  Material first, second;
  std::uint32_t winner;
};

std::vector<Rivals> rivals() {
  const Material opaque = diffuseMaterial(1), glass = glassMaterial(1.5f),
                 oil = glassMaterial(1.4f, 1);
  return {{opaque, opaque, 1}, {opaque, glass, 0}, {glass, opaque, 1},
          {glass, glass, 1},   {glass, oil, 1},    {oil, glass, 0}};
}

// With `apart`, each sphere is in an object of its own that has two instances. A sphere of the
// other material comes first in that object, so that the two have other numbers there. With
// `turned`, the second sphere is turned, by its instances if it has some.
Scene sceneOfRivals(const Rivals& two, const Ball& ball, bool apart, bool turned) {
  SceneBuilder builder;
  const std::uint32_t materials[] = {builder.add(two.first), builder.add(two.second)};
  const Ball elsewhere{{ball.center.x + 50, ball.center.y, ball.center.z}, 0.5f};
  const Affine toCenter = Affine::translation(Vec3d(ball.center));
  const Affine turn = Affine::rotation({1, -2, 0.5}, 77);

  for (const int i : {0, 1}) {
    Object object;
    if (apart) object.meshes.push_back(elsewhere.mesh(materials[1 - i]));
    object.meshes.push_back(ball.mesh(materials[i]));

    Affine& map = object.meshes.back().spheres[0];
    Affine place;
    if (turned && i == 1 && apart) {
      place = toCenter * turn * Affine::translation(-Vec3d(ball.center));
    } else if (turned && i == 1) {
      map = map * turn;
    }

    if (!apart) builder.add(object.meshes[0]);
    if (apart) builder.place(std::move(object), {place, Affine::translation({0, 8, 0}) * place});
  }
  return builder.build();
}

void ballsInOnePlace(Run& run) {
  const Ball ball{{0.3f, -0.2f, 0.7f}, 0.9f};
  const std::vector<ProbeRay> rays = raysOntoBall(ball, 300, 82);
  for (const Rivals& two : rivals()) {
    for (const int arrangement : {0, 1, 2, 3}) {
      const bool apart = arrangement % 2 == 1, turned = arrangement >= 2;
      const Scene scene = sceneOfRivals(two, ball, apart, turned);
      Probe probe(scene, run, rays);

      for (const auto i : indices(probe)) {
        const bool right = probe.isHit(i) && probe.surfels().material[i] == two.winner;
        run.count(!right && ball.chord(rays[i]).aside < 1, apart ? "instances, " : "one object, ",
                  turned ? "turned, " : "", rays[i]);
      }
    }
  }
}

// Spheres that overlap at random. Each has a second one that is coincident with it, inside it or
// touches it. The last spheres are in instances.
SceneBuilder manyBalls() {
  SceneBuilder builder;
  const std::uint32_t materials[] = {
      builder.add(diffuseMaterial(0.7f)), builder.add(glassMaterial(1.5f)),
      builder.add(mirrorMaterial(0.8f)), builder.add(glassMaterial(1.2f, 2))};
  Numbers numbers(83);
  Object object;

  for (std::uint32_t i = 0; i < 24; ++i) {
    const Ball ball{Vec3f(numbers.direction() * 2.0), float(numbers.in(0.2, 0.9))};
    const Vec3f beside(ball.point({1, 0, 0}, 2));
    const Ball others[] = {ball, {ball.center, ball.radius * 0.75f}, {beside, ball.radius}};
    for (const Mesh& mesh :
         {ball.mesh(materials[i % 4]), others[i % 3].mesh(materials[i / 4 % 4])}) {
      if (i < 16) builder.add(mesh);
      if (i >= 16) object.meshes.push_back(mesh);
    }
  }

  builder.place(std::move(object), {Affine{}, Affine::translation({0.5, 0.25, -0.5})});
  builder.description.lights = {lightAt({4, 6, 5}, 60)};
  builder.sky(0.3f);
  return builder;
}

// Rays from outside and from inside.
std::vector<ProbeRay> raysIntoMany() {
  return randomRays(1500, 84, [](Numbers& numbers, int i) {
    const Vec3d towards = numbers.direction();
    const Vec3f target(towards * numbers.in(0, 3));
    return rayThrough(Vec3f(numbers.direction() * (i % 2 == 0 ? 8 : 1)), target);
  });
}

void ballsInPackets(Run& run) {
  const Scene scene = manyBalls().build();
  const std::vector<ProbeRay> rays = raysIntoMany();
  const Probe single(scene, {run.simd, 1}, rays), probe(scene, run, rays);
  for (const auto i : indices(probe)) {
    run.count(!single.sameHit(probe, i), rays[i]);
  }

  const Camera camera{.eye = {1, 2, 7}, .at = {0, 0, 0}};
  const Image expected = pictureOf(scene, camera, optionsOf({run.simd, 1}, {40, 30}));
  for (const int tile : {7, 8, 64}) {
    RenderOptions options = optionsOf(run, {40, 30});
    options.tile = tile;
    countOtherPixels(run, pictureOf(scene, camera, options), expected,
                     "tiles of " + std::to_string(tile));
  }
}

// Pairs of spheres that are mirror images of each other about the plane x = 0 and cross there,
// among others that do not reach the plane, all in random order. The distances from a point of the
// plane to both of a pair are the same, bit for bit.
std::vector<Ball> mirroredBalls() {
  Numbers numbers(85);
  std::vector<Ball> balls;
  for (int i = 0; i < 40; ++i) {
    const float radius = float(numbers.in(0.3, 0.9)), x = radius * float(numbers.in(0.1, 0.9));
    const Vec3f center{x, float(numbers.in(-3, 3)), float(numbers.in(-3, 3))};
    balls.push_back({center, radius});
    balls.push_back({{-x, center.y, center.z}, radius});
    balls.push_back({{i % 2 == 0 ? 1.0f : -1.0f, center.z, center.y}, 0.75f});
  }

  // The order of the balls is shuffled, the same way on every machine.
  for (std::size_t i = balls.size() - 1; i > 0; --i) {
    std::swap(balls[i], balls[std::size_t(numbers.in(0, double(i + 1)))]);
  }
  return balls;
}

constexpr float kGlow = 0x1p-7f;  // Ball i emits i + 1 times as much.

enum class Placement : std::uint8_t { world, oneObject, objects };

Scene sceneOfMirrored(const std::vector<Ball>& balls, Placement placement) {
  const std::vector<Affine> twice{Affine{}, Affine::translation({0, 50, 0})};
  SceneBuilder builder;
  Object object;
  for (const Ball& ball : balls) {
    const float number = float(builder.description.materials.size() + 1);
    const std::uint32_t material = builder.add(emittingMaterial(number * kGlow));

    if (placement == Placement::world) builder.add(ball.mesh(material));
    if (placement == Placement::oneObject) object.meshes.push_back(ball.mesh(material));
    if (placement == Placement::objects) {
      const Affine toCenter = Affine::translation(Vec3d(ball.center));
      builder.place({"ball", {Ball{{}, ball.radius}.mesh(material)}},
                    {twice[0] * toCenter, twice[1] * toCenter});
    }
  }

  if (placement == Placement::oneObject) builder.place(std::move(object), twice);
  return builder.build();
}

// The ball that the ray hits first, of two at the same distance the later one. None where roundings
// decide which ball that is, and where the ray hits no ball.
std::optional<std::size_t> firstHit(const std::vector<Ball>& balls, const ProbeRay& ray) {
  constexpr long double kDoubt = 1e-4L;
  long double nearest = kNoBound, next = kNoBound;
  std::optional<std::size_t> first;

  for (const auto i : indices(balls)) {
    const BallChord chord = balls[i].chord(ray);
    if (chord.aside > 1 + kDoubt) continue;
    const long double least = std::min(std::fabs(chord.near), std::fabs(chord.far));
    if (chord.aside > 1 - kDoubt || least < kDoubt) return std::nullopt;
    const long double t = chord.near > 0 ? chord.near : chord.far;
    // A ball that is further away only matters as the second one.
    if (t < 0 || t > nearest) {
      if (t > 0) next = std::min(next, t);
      continue;
    }
    if (t < nearest) next = nearest;
    nearest = t;
    first = i;
  }
  return next - nearest < kDoubt ? std::nullopt : first;
}

void mirroredInAnyOrder(Run& run) {
  const std::vector<Ball> balls = mirroredBalls();
  const Camera camera{.eye = {0, 1, 9}, .at = {0, 0, 0}, .fov = 50};

  const std::vector<ProbeRay> rays = randomRays(800, 86, [](Numbers& numbers, int i) {
    const auto inPlane = [&](double size) {
      return Vec3f(Vec3d{0, numbers.in(-size, size), numbers.in(-size, size)});
    };
    const Vec3f from = inPlane(i % 2 == 0 ? 9 : 3);
    return rayThrough(from, inPlane(3));
  });

  int seen = 0;
  for (const Placement placement : {Placement::world, Placement::oneObject, Placement::objects}) {
    const Scene scene = sceneOfMirrored(balls, placement);
    const auto expect = [&](const ProbeRay& ray, const auto& shown) {
      const std::optional<std::size_t> first = firstHit(balls, ray);
      if (!first) return;
      ++seen;
      run.count(!shown(*first), ray);
    };

    const Probe probe(scene, run, rays);
    for (const auto i : indices(probe)) {
      expect(rays[i], [&](std::size_t first) {
        return probe.isHit(i) && probe.surfels().material[i] == first;
      });
    }
    // The middle column of pixels lies in the plane.
    for (const Image& image : picturesOf(scene, camera, optionsOf(run, {3, 256}))) {
      forEachRay(camera, 3, 256, [&](const Vec3d&, const Vec3d& d, int x, int y) {
        if (x != 1) return;
        expect({camera.eye, Vec3f(d)},
               [&](std::size_t first) { return image.at(1, y).x == float(first + 1) * kGlow; });
      });
    }
  }

  run.count(seen < 1500, "too few rays that hit two spheres");
}

}  // namespace

const Family kSpherePathCases{
    "paths through spheres",
    {{"H71g", "no ray that leaves a sphere hits it again",
      "reflected and shadow rays, from radii of 1e-6 to 1e6 and up to the limb", leavingBalls},
     {"H71h", "a ray that enters a sphere hits its far side once",
      "rays in balls of glass, refracted and reflected, and rays that leave; against the chord",
      throughBalls},
     {"H71i", "two spheres with 1e-5 of their radius between them",
      "index 1: every boundary in its order, directions bit for bit", straightThroughShell},
     {"H71j", "a shell of glass, thin as 1e-5 of its radius",
      "rays through the center: boundaries, media, and how far they turn, over the bound",
      glassShell},
     {"H71k", "the whispering gallery: 64 total reflections at one angle",
      "drift of the sine over that of as many bounces", whisperingGallery},
     {"H71l", "the focus of a ball lens",
      "heights of 0.001 to 0.1 radii; against the closed form, and the paraxial focus", ballLens},
     {"H71m", "which of two coincident spheres is hit",
      "opaque before glass, then by priority, then the later; as one object and as instances, "
      "turned",
      ballsInOnePlace},
     {"H71n", "spheres that overlap, touch, coincide, and lie inside one another",
      "hits and pictures that differ from those of single rays and of other tiles", ballsInPackets},
     {"H71o", "of two spheres at the same distance the later one is hit",
      "40 pairs of mirror images that cross, in random order among others, seen from the plane of "
      "the mirror; in the world, in one object, in objects of their own; rays and pixels",
      mirroredInAnyOrder}}};

}  // namespace whit::verify
