// H71, continued: paths that leave exact spheres and go through them, and spheres in one place.
#include "verify/balls.h"

namespace whit::verify {

namespace {

// From all around, as flat as it comes: the whole silhouette is aimed at.
std::vector<ProbeRay> raysOntoBall(const Ball& ball, std::size_t n, std::uint64_t seed) {
  Numbers numbers(seed);
  std::vector<ProbeRay> rays;
  const Vec3d center(ball.center);
  const auto radius = static_cast<double>(ball.radius);
  while (rays.size() < n) {
    const Vec3d out = numbers.direction();
    const Vec3d aside = normalized(cross(out, numbers.direction())) *
                        (radius * (1 - std::pow(10, numbers.in(-6, 0))));
    rays.push_back(rayThrough(Vec3f(center + out * (3 * radius)), Vec3f(center + aside)));
  }
  return rays;
}

constexpr std::size_t kRaysABall = 200;

Finding leavingBalls(const Setup& setup) {
  Finding finding(0);
  Material shinyBall = mirrorMaterial(1);
  shinyBall.diffuse = Rgb(1.0f);
  for (const Ball& ball : ballsOfAllSizes({0, 1, 1e3})) {
    const Scene scene = sceneOfBall(ball, shinyBall);
    Probe probe(scene, setup), next(scene, setup);
    probe.cast(raysOntoBall(ball, kRaysABall, 76));
    const std::vector<ProbeRay> children = raysOf(probe.reflections());
    next.cast(children);
    for (std::size_t i = 0; i < next.size(); ++i) {
      finding.count(next.isHit(i), describedOn(ball, children[i]));
    }
    const Vec3d aside = Vec3d{3, 2.5, -2} * static_cast<double>(ball.radius);
    probe.light(lightAt(Vec3f(Vec3d(ball.center) + aside), 1));
    for (std::size_t i = 0; i < probe.size(); ++i) {
      if (!probe.isHit(i) || maxComponent(probe.unshadowed(i)) <= 0) continue;
      finding.count(!probe.visible(i), [&] { return "shadow of " + describeRay(probe.ray(i)); });
    }
  }
  return finding;
}

// Whether a ray within the sphere meets the far side of it, once and where that is.
bool meetsFarSide(const Probe& probe, const Ball& ball, std::size_t i) {
  const BallChord chord = chordOf(ball, probe.ray(i));
  if (!probe.isHit(i) || enters(probe, i) || !(chord.near < 0)) return false;
  const auto off = static_cast<double>(static_cast<long double>(probe.hits().t[i]) / chord.far - 1);
  return std::fabs(off) <= 1.001 * kBallRounding;
}

Finding throughBalls(const Setup& setup) {
  Finding finding(0);
  for (const Ball& ball : ballsOfAllSizes({0, 1, 1e3})) {
    const Scene scene = sceneOfBall(ball, glassMaterial(1.5f));
    Probe probe(scene, setup), inside(scene, setup), after(scene, setup);
    probe.cast(raysOntoBall(ball, kRaysABall, 77));
    const auto allInside = [&](const std::vector<ProbeRay>& rays) {
      inside.cast(rays);
      for (std::size_t i = 0; i < inside.size(); ++i) {
        finding.count(!meetsFarSide(inside, ball, i), describedOn(ball, rays[i]));
      }
    };
    allInside(raysOf(probe.refractions()));
    const std::vector<ProbeRay> left = raysOf(inside.refractions());
    after.cast(left);
    for (std::size_t i = 0; i < after.size(); ++i) {
      finding.count(after.isHit(i) || left[i].media != 0, describedOn(ball, left[i]));
    }
    allInside(raysOf(inside.reflections()));
  }
  return finding;
}

// Of the outer radius.
constexpr double kShellGap = 1e-5;

struct Shell {
  Ball outer, inner;
  Scene scene;
};

// A shell of glass, and air in it, which takes the place of the glass.
Shell shellOf(float radius, float ior) {
  const Ball outer{{0, 0, 0}, radius};
  const Ball inner{{0, 0, 0}, static_cast<float>(double{radius} * (1 - kShellGap))};
  SceneBuilder builder;
  builder.add(exactBall(outer, builder.add(glassMaterial(ior, 0))));
  builder.add(exactBall(inner, builder.add(glassMaterial(1, 1))));
  return {outer, inner, builder.build()};
}

std::uint32_t mediaOn(std::uint32_t stack) {
  std::uint32_t count = 0;
  for (; stack != 0; stack >>= 8) count += (stack & 0xFFu) != 0;
  return count;
}

struct ShellCrossing {
  std::uint32_t material;
  bool entering;
  std::uint32_t media;  // so many on the stack before it
};
constexpr ShellCrossing kThroughShell[] = {
    {0, true, 0}, {1, true, 1}, {1, false, 2}, {0, false, 1}};

// Sends rays through all four boundaries; each must meet them in their order. `visit` sees the rays
// that have left, one for each at the start.
template <typename Visit>
void crossShell(const Shell& shell, const Setup& setup, std::vector<ProbeRay> rays,
                Finding& finding, const Visit& visit) {
  Probe probe(shell.scene, setup);
  const std::vector<ProbeRay> start = rays;
  for (const ShellCrossing& c : kThroughShell) {
    probe.cast(rays);
    for (std::size_t i = 0; i < probe.size(); ++i) {
      const bool met = probe.isHit(i) && probe.surfels().material[i] == c.material &&
                       enters(probe, i) == c.entering && mediaOn(rays[i].media) == c.media;
      if (!met) finding.note(kNoBound, describedOn(shell.outer, rays[i]));
    }
    rays = raysOf(probe.refractions());
    if (rays.size() == start.size()) continue;
    finding.note(kNoBound, [] { return "some rays ended within the shell"; });
    return;
  }
  probe.cast(rays);
  for (std::size_t i = 0; i < probe.size(); ++i) {
    const bool gone = !probe.isHit(i) && rays[i].media == 0;
    finding.note(gone ? visit(start[i], rays[i]) : kNoBound, describedOn(shell.outer, start[i]));
  }
}

// Of index 1: whatever the angle, not a bit of the direction changes. Rays between the silhouettes
// of both spheres stay out of the inner one: what each face's offset, below 2^-19 of the radius,
// moves a ray by, is left out around there.
Finding straightThroughShell(const Setup& setup) {
  Finding finding(0);
  for (const float radius : {1e-3f, 1.0f, 1e3f}) {
    const Shell shell = shellOf(radius, 1);
    std::vector<ProbeRay> rays;
    for (const ProbeRay& ray : raysOntoBall(shell.outer, 600, 78)) {
      if (chordOf(shell.inner, ray).aside < 1 - 0x1p-17L) rays.push_back(ray);
    }
    crossShell(shell, setup, rays, finding, [](const ProbeRay& before, const ProbeRay& after) {
      return before.direction == after.direction ? 0.0 : 1.0;
    });
  }
  return finding;
}

// Through the center nothing is refracted, but for what the normals are off by: into glass a third
// of it, out of it a half, at two faces each; and the roundings of four directions.
Finding glassShell(const Setup& setup) {
  Finding finding(1);
  for (const float radius : {1e-3f, 1.0f, 1e3f}) {
    const Shell shell = shellOf(radius, 1.5f);
    Numbers numbers(79);
    std::vector<ProbeRay> rays;
    for (int i = 0; i < 400; ++i) {
      const Vec3f from(numbers.direction() * (3 * static_cast<double>(radius)));
      rays.push_back(rayThrough(from, {0, 0, 0}));
    }
    crossShell(shell, setup, rays, finding, [&](const ProbeRay& before, const ProbeRay& after) {
      const auto aside = static_cast<double>(chordOf(shell.outer, before).aside);
      const double bound =
          2 * (1.0 / 3 + 1.0 / 2) * 1.01 * (kWeightAngle + aside) + 4 * 4 * kBallRounding;
      return length(Vec3d(after.direction) - Vec3d(before.direction)) / bound;
    });
  }
  return finding;
}

// Rays within a ball of glass, which meet its surface at sines of 0.68 to 0.9999: beyond the
// critical one, 2/3.
std::vector<ProbeRay> galleryRays(const Ball& ball, std::uint32_t medium) {
  Numbers numbers(80);
  std::vector<ProbeRay> rays;
  for (int i = 0; i < 64; ++i) {
    const double sine = i % 2 == 0 ? numbers.in(0.68, 1) : 1 - std::pow(10, numbers.in(-4, -1));
    const Vec3d aside = numbers.direction();
    const Vec3d d = normalized(cross(aside, numbers.direction()));
    const Vec3d from = aside * (sine * static_cast<double>(ball.radius));
    rays.push_back({Vec3f(Vec3d(ball.center) + from), Vec3f(d), medium});
  }
  return rays;
}

// What a bounce may change of the sine: a ray starts so far off the surface and so far back, the
// hit's weights turn the normal, and the direction takes a few roundings.
double driftAt(const Probe& probe, const Ball& ball, std::size_t i) {
  const auto offset = static_cast<double>(probe.surfels().offset[i]);
  const auto retreat = static_cast<double>(probe.surfels().retreat[i]);
  return (offset + retreat + ballHeightError(ball)) / static_cast<double>(ball.radius) +
         kWeightAngle + 8 * kBallRounding;
}

// The sine of a chord is the same at all of its ends, so that the error after k bounces is k times
// that of one: reported is its part of that.
Finding whisperingGallery(const Setup& setup) {
  Finding finding(1);
  constexpr int kDepth = 64;
  for (const Ball& ball : {Ball{}, Ball{{0, 0, 0}, 1e-5f}, Ball{{2, -1, 3}, 1}}) {
    const Scene scene = sceneOfBall(ball, glassMaterial(1.5f));
    Probe probe(scene, setup);
    std::vector<ProbeRay> rays = galleryRays(ball, probe.tables().materials[0].medium);
    std::vector<double> sine, drift(rays.size());
    for (const ProbeRay& ray : rays) sine.push_back(static_cast<double>(chordOf(ball, ray).aside));
    for (int bounce = 0; bounce < kDepth; ++bounce) {
      probe.cast(rays);
      const std::vector<ProbeChild> reflected = probe.reflections();
      const bool total = reflected.size() == rays.size() && probe.refractions().empty();
      if (!total) finding.note(kNoBound, [&] { return std::to_string(bounce) + " bounces"; });
      if (!total) break;
      for (const ProbeChild& child : reflected) {
        const std::size_t i = child.parent;
        drift[i] += driftAt(probe, ball, i);
        const Vec3d n(probe.ng(i)), d(rays[i].direction);
        const double off = length(cross(n, d)) / length(d) - sine[i];
        const bool whole = child.weight == Rgb(1.0f) && !enters(probe, i);
        finding.note(whole ? std::fabs(off) / drift[i] : kNoBound, describedOn(ball, rays[i]));
      }
      rays = raysOf(reflected);
    }
  }
  return finding;
}

// Where a ray that came along an axis through the center crosses it again, in radii behind the
// center: twice it is turned by the difference of both angles, and it leaves as far beside the
// center as it came.
double ballFocus(double height, double ior) {
  return height / std::sin(2 * (std::asin(height) - std::asin(height / ior)));
}

// Of the paraxial focal length: the aberration of a ball of 1.5 in third order, 5/18 of the squared
// height, and a hundredth for higher orders at heights of up to 0.1.
constexpr double kAberration = 1.01 * 5 / 18;

// In radii, the point of `ray` that is nearest to the axis.
double crossingOf(const Ball& ball, const ProbeRay& ray, const Vec3d& axis) {
  const Vec3d from = Vec3d(ray.origin) - Vec3d(ball.center), d(ray.direction);
  const Vec3d side = d - axis * dot(d, axis);
  const double t = -dot(from, side) / dot(side, side);
  return dot(from + d * t, axis) / static_cast<double>(ball.radius);
}

Finding ballLens(const Setup& setup) {
  Finding finding(1);
  constexpr double kIor = 1.5, kFocus = kIor / (2 * (kIor - 1));
  for (const Ball& ball : {Ball{}, Ball{{0, 0, 0}, 1e4f}, Ball{{1, 0.5f, -1}, 1}}) {
    const Scene scene = sceneOfBall(ball, glassMaterial(static_cast<float>(kIor)));
    Numbers numbers(81);
    std::vector<ProbeRay> start;
    for (int i = 0; i < 300; ++i) {
      const Vec3d d = numbers.direction(), e = normalized(cross(d, numbers.direction()));
      const Vec3d from = e * std::pow(10, numbers.in(-3, -1)) - d * 2.0;
      start.push_back(
          {Vec3f(Vec3d(ball.center) + from * static_cast<double>(ball.radius)), Vec3f(d)});
    }
    Probe probe(scene, setup);
    probe.cast(start);
    const std::vector<ProbeRay> within = raysOf(probe.refractions());
    probe.cast(within);
    const std::vector<ProbeRay> out = raysOf(probe.refractions());
    if (out.size() != start.size()) finding.note(kNoBound, [] { return "some never left"; });
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto height = static_cast<double>(chordOf(ball, start[i]).aside);
      const double found = crossingOf(ball, out[i], normalized(Vec3d(start[i].direction)));
      // Both points of the path are off by so many radii, and each of the two directions.
      const double off =
          2 * (kWeightAngle + 2 * ballHeightError(ball) / static_cast<double>(ball.radius));
      const double room = 2 * off / (2 * (1 - 1 / kIor) * height);
      const double exact = std::fabs(found / ballFocus(height, kIor) - 1) / room;
      const double paraxial =
          std::fabs(found / kFocus - 1) / (kAberration * height * height + room);
      finding.note(std::max(exact, paraxial), describedOn(ball, start[i]));
    }
  }
  return finding;
}

// Which of two spheres in one place is met, of these two in this order.
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

// `apart`: each in an object of its own that is used twice, behind a sphere of the other kind, so
// that they have other numbers there.
Scene sceneOfRivals(const Rivals& two, const Ball& ball, bool apart) {
  SceneBuilder builder;
  const std::uint32_t materials[] = {builder.add(two.first), builder.add(two.second)};
  const Ball elsewhere{{ball.center.x + 50, ball.center.y, ball.center.z}, 0.5f};
  for (const int i : {0, 1}) {
    Object object;
    if (apart) object.meshes.push_back(exactBall(elsewhere, materials[1 - i]));
    object.meshes.push_back(exactBall(ball, materials[i]));
    if (!apart) builder.add(object.meshes[0]);
    if (apart) builder.place(std::move(object), {Affine{}, Affine::translation({0, 8, 0})});
  }
  return builder.build();
}

Finding ballsInOnePlace(const Setup& setup) {
  Finding finding(0);
  const Ball ball{{0.3f, -0.2f, 0.7f}, 0.9f};
  const std::vector<ProbeRay> rays = raysOntoBall(ball, 300, 82);
  for (const Rivals& two : rivals()) {
    for (const bool apart : {false, true}) {
      const Scene scene = sceneOfRivals(two, ball, apart);
      Probe probe(scene, setup);
      probe.cast(rays);
      for (std::size_t i = 0; i < probe.size(); ++i) {
        const bool right = probe.isHit(i) && probe.surfels().material[i] == two.winner;
        finding.count(!right && chordOf(ball, rays[i]).aside < 1, [&] {
          return (apart ? "instances, " : "one object, ") + describeRay(rays[i]);
        });
      }
    }
  }
  return finding;
}

// Spheres that overlap at random, with others in the very place of some, within some, and touching
// some; the last of them in instances.
SceneBuilder manyBalls() {
  SceneBuilder builder;
  const std::uint32_t materials[] = {
      builder.add(diffuseMaterial(0.7f)), builder.add(glassMaterial(1.5f)),
      builder.add(mirrorMaterial(0.8f)), builder.add(glassMaterial(1.2f, 2))};
  Numbers numbers(83);
  Object object;
  for (std::uint32_t i = 0; i < 24; ++i) {
    const Ball ball{Vec3f(numbers.direction() * 2.0), static_cast<float>(numbers.in(0.2, 0.9))};
    const Vec3f beside(Vec3d(ball.center) + Vec3d{2 * static_cast<double>(ball.radius), 0, 0});
    const Ball others[] = {ball, {ball.center, ball.radius * 0.75f}, {beside, ball.radius}};
    Mesh one = exactBall(ball, materials[i % 4]);
    Mesh other = exactBall(others[i % 3], materials[i / 4 % 4]);
    for (Mesh* mesh : {&one, &other}) {
      if (i < 16) builder.add(std::move(*mesh));
      if (i >= 16) object.meshes.push_back(std::move(*mesh));
    }
  }
  builder.place(std::move(object), {Affine{}, Affine::translation({0.5, 0.25, -0.5})});
  builder.description.lights = {lightAt({4, 6, 5}, 60)};
  builder.sky(0.3f);
  return builder;
}

// Rays from outside and inside, and some along the planes in which spheres touch.
std::vector<ProbeRay> raysIntoMany() {
  Numbers numbers(84);
  std::vector<ProbeRay> rays;
  for (int i = 0; i < 1500; ++i) {
    const Vec3f target(numbers.direction() * numbers.in(0, 3));
    rays.push_back(rayThrough(Vec3f(numbers.direction() * (i % 2 == 0 ? 8 : 1)), target));
  }
  return rays;
}

Finding ballsInPackets(const Setup& setup) {
  Finding finding(0);
  const Scene scene = manyBalls().build();
  Probe single(scene, {setup.simd, 1}), probe(scene, setup);
  const std::vector<ProbeRay> rays = raysIntoMany();
  single.cast(rays);
  probe.cast(rays);
  for (std::size_t i = 0; i < probe.size(); ++i) {
    const HitColumns a = single.hits(), b = probe.hits();
    const bool same = a.triangle[i] == b.triangle[i] &&
                      (!single.isHit(i) || (a.t[i] == b.t[i] && a.u[i] == b.u[i] &&
                                            a.v[i] == b.v[i] && a.instance[i] == b.instance[i]));
    finding.count(!same, described(rays[i]));
  }
  const Camera camera{.eye = {1, 2, 7}, .at = {0, 0, 0}};
  const Image expected = pictureOf(scene, camera, optionsOf({setup.simd, 1}, {40, 30}));
  for (const int tile : {7, 8, 64}) {
    RenderOptions options = optionsOf(setup, {40, 30});
    options.tile = tile;
    const Image image = pictureOf(scene, camera, options);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      finding.count(!(image.pixels[i] == expected.pixels[i]), [&] {
        return "pixel " + std::to_string(i) + ", tiles of " + std::to_string(tile);
      });
    }
  }
  return finding;
}

constexpr Case kSpherePathCases[] = {
    {"H71g", "nothing that leaves a sphere meets it again",
     "reflected and shadow rays, from radii of 1e-6 to 1e6 and up to the limb", Runs::packets,
     leavingBalls},
    {"H71h", "what enters a sphere meets its far side, once",
     "rays in balls of glass, refracted and reflected, and those that leave again; against the "
     "chord",
     Runs::packets, throughBalls},
    {"H71i", "two spheres with 1e-5 of their radius between them",
     "index 1: every boundary in its order, directions bit for bit", Runs::packets,
     straightThroughShell},
    {"H71j", "a shell of glass, thin as 1e-5 of its radius",
     "rays through the center: boundaries, media, and how far they turn, over the bound",
     Runs::packets, glassShell},
    {"H71k", "the whispering gallery: 64 total reflections at one angle",
     "drift of the sine over that of as many bounces", Runs::packets, whisperingGallery},
    {"H71l", "the focus of a ball lens",
     "heights of 0.001 to 0.1 radii; against the closed form, and the paraxial focus",
     Runs::packets, ballLens},
    {"H71m", "which of two spheres in one place is met",
     "opaque before glass, then by priority, then the later; as one object and as instances",
     Runs::packets, ballsInOnePlace},
    {"H71n", "spheres that overlap, touch, and lie in one place and in one another",
     "hits and pictures that differ from those of single rays and of other tiles", Runs::packets,
     ballsInPackets},
};

}  // namespace

std::span<const Case> spherePathCases() { return kSpherePathCases; }

}  // namespace whit::verify
