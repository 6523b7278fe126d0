// H32 to H36 and H79: normals that disagree, and views along the surface.

#include "verify/bodies.h"

namespace whit::verify {

namespace {

constexpr std::size_t kSurfels = 4000;
const Vec3f kUp{0, 1, 0};

// Surfels whose geometric normal points up and whose shading normal is up to `tilt` radians off it.
// Rays arrive at elevations of 10^-e, with e up to `flattest`.
struct Tilted {
  std::vector<ProbeRay> rays;
  std::vector<Vec3f> normals;

  // Surfel i as text for a Finding.
  auto described(std::size_t i) const {
    return [d = rays[i].direction, ns = normals[i]] {
      return "direction " + hexText(d) + ", shading normal " + hexText(ns);
    };
  }
};

Tilted tilted(std::uint64_t seed, double tilt, double flattest) {
  Numbers numbers(seed);
  Tilted result;
  for (std::size_t i = 0; i < kSurfels; ++i) {
    const double elevation = std::pow(10, -numbers.in(0, flattest)), turn = numbers.in(0, 6.28);
    const Vec3d view = normalized(Vec3d{std::cos(turn), elevation, std::sin(turn)});
    const double angle = numbers.in(0, tilt), about = numbers.in(0, 6.28);

    result.rays.push_back({{0, 1, 0}, Vec3f(-view)});
    result.normals.emplace_back(Vec3d{std::sin(angle) * std::cos(about), std::cos(angle),
                                      std::sin(angle) * std::sin(about)});
  }
  return result;
}

Scene oneMaterial(const Material& material) { return sceneOf(floorAt(0, 1, 0), material); }

void fill(Probe& probe, const Tilted& surfels) {
  probe.load(surfels.rays);
  for (std::size_t i = 0; i < surfels.rays.size(); ++i) probe.surfel(i, 0, kUp, surfels.normals[i]);
}

// The distance of child rays below the least elevation, in units in the last place of 1.
Finding childrenStayOnTheirSide(const Setup& setup) {
  Finding finding(4);
  const Scene scene = oneMaterial(glassMaterial(1.5f));
  const Tilted surfels = tilted(32, 1.0, 3);

  Probe probe(scene, setup);
  fill(probe, surfels);
  for (const ProbeChild& child : probe.reflections()) {
    const double facing = -static_cast<double>(surfels.rays[child.parent].direction.y);
    const double least = std::min(0.9 * facing, 0.01);
    // Normalization lowers a direction that was raised, by up to the square of how far it was
    // raised.
    const double height = static_cast<double>(child.ray.direction.y);
    finding.note(std::max(0.0, least * 0.7 - height) / 0x1p-24, surfels.described(child.parent));
  }

  for (const ProbeChild& child : probe.refractions()) {
    const double height = static_cast<double>(child.ray.direction.y);
    finding.note(std::max(0.0, height) / 0x1p-24, surfels.described(child.parent));
  }
  return finding;
}

// If the normals agree, the rule for tilted normals must not change the mirrored direction.
Finding agreeingNormals(const Setup& setup) {
  Finding finding(4 * 0x1p-24);
  const Scene scene = oneMaterial(mirrorMaterial(1));
  const Tilted surfels = tilted(33, 0, 5);
  Probe probe(scene, setup);
  fill(probe, surfels);

  for (const ProbeChild& child : probe.reflections()) {
    const Vec3d in(surfels.rays[child.parent].direction), out(child.ray.direction);
    finding.note(maxComponent(abs(out - Vec3d{in.x, -in.y, in.z})),
                 surfels.described(child.parent));
  }
  return finding;
}

Material everything() {
  Material m = glassMaterial(1.5f);
  m.diffuse = m.specular = Rgb(0.5f);
  m.mirror = m.mirrorGrazing = Rgb(0.5f);
  return m;
}

// Views from behind the shading normal: weights in [0, 1], unit directions, no negative light.
Finding viewBehindTheNormal(const Setup& setup) {
  Finding finding(0);
  const Scene scene = oneMaterial(everything());
  const Tilted surfels = tilted(34, 3.1, 6);
  Probe probe(scene, setup);
  fill(probe, surfels);

  const auto check = [&](const std::vector<ProbeChild>& children) {
    for (const ProbeChild& child : children) {
      const double l = length(Vec3d(child.ray.direction));
      const bool fine = child.weight.x >= 0 && child.weight.x <= 1.5f && std::fabs(l - 1) < 1e-6;
      finding.count(!fine, surfels.described(child.parent));
    }
  };

  check(probe.reflections());
  check(probe.refractions());

  probe.light(lightAt({0.5f, 2, -0.3f}, 1));
  for (std::size_t i = 0; i < probe.size(); ++i) {
    const Rgb light = probe.visible(i) ? probe.unshadowed(i) : Rgb(0.0f);
    finding.count(!isFinite(light) || light.x < 0, surfels.described(i));
  }
  return finding;
}

// Where opposite corner normals cancel, the normal of the face replaces them.
Finding cancellingNormals(const Setup& setup) {
  Finding finding(4 * 0x1p-24);
  Mesh mesh = floorAt(0, 1, 0);
  mesh.normals = {{0, 0, 1}, {0, 0, -1}, {0, 0, 1}, {0, 0, -1}};
  const Scene scene = sceneOf(mesh, diffuseMaterial(1));

  Probe probe(scene, setup);
  constexpr std::uint32_t kSteps = 1001;
  probe.load(std::vector<ProbeRay>(kSteps, {{0, 1, 0}, {0, -1, 0}}));
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    probe.hit(i, 0, 1, 0.5f, static_cast<float>(i) * (0.5f / (kSteps - 1)));
  }
  probe.interpolate();

  for (std::uint32_t i = 0; i < kSteps; ++i) {
    const Vec3d n(probe.ns(i));
    const bool none = i == 0 && probe.hits().v[0] == 0;
    const double error = none ? length(n - Vec3d(kUp)) : std::fabs(length(n) - 1);
    finding.note(error, [&] { return "u 0.5, v " + hexText(double{probe.hits().v[i]}); });
  }
  return finding;
}

// Compares a sphere of facets with smooth normals, lit from the side, with the true sphere's cosine
// where that is below 0.3.
Finding terminator(const Setup& setup) {
  Finding finding(kNoBound);
  SceneBuilder builder;
  builder.add(diffuseMaterial(3.14159265f));
  builder.add(sphereMesh(2, {}, 1, 0, true));
  const Light light = lightAt({1000, 0, 0}, 1e6f);
  builder.description.lights = {light};
  const Scene scene = builder.build();

  Probe probe(scene, setup, raysOnto({}, 1, kSurfels, 35));
  probe.light(light);
  double sum = 0;
  std::size_t n = 0;

  for (std::size_t i = 0; i < probe.size(); ++i) {
    const double cosine = normalized(Vec3d(probe.position(i))).x;
    if (!probe.isHit(i) || cosine <= 0 || cosine >= 0.3) continue;

    const double got = probe.visible(i) ? static_cast<double>(probe.unshadowed(i).x) : 0;
    sum += (got - cosine) * (got - cosine);
    ++n;
  }
  finding.note(std::sqrt(sum / static_cast<double>(n)),
               [&] { return "RMS error over " + std::to_string(n) + " points"; });
  return finding;
}

// Lights in front of one normal and behind the other.
Finding lightBetweenTheNormals(const Setup& setup) {
  Finding finding(0);
  const Scene scene = oneMaterial(everything());
  const Tilted surfels = tilted(36, 1.5, 1);
  Probe probe(scene, setup);
  fill(probe, surfels);

  Numbers numbers(36);
  for (int k = 0; k < 16; ++k) {
    const Vec3f l(numbers.direction() * 2.0);
    const std::size_t shadowRays = probe.light(lightAt(l, 1));

    std::size_t lit = 0;
    for (std::size_t i = 0; i < probe.size(); ++i) {
      const double g = static_cast<double>(l.y), s = dot(Vec3d(l), Vec3d(surfels.normals[i]));
      lit += g >= 0 && s >= -1e-6;
      if (g > 0 && s > 0) continue;
      finding.count(probe.visible(i) && s < -1e-6, surfels.described(i));
      finding.count(probe.visible(i) && g < 0, surfels.described(i));
    }
    // The floor would occlude such a light; no shadow ray should be traced for it at all.
    finding.count(shadowRays > lit, [&] { return "light at " + hexText(l); });
  }
  return finding;
}

// Elevations of 0.1 to 1e-6 radians over a flat mirror.
Finding grazingMirror(const Setup& setup) {
  Finding finding(4 * 0x1p-24);
  const Scene scene = oneMaterial(mirrorMaterial(1));
  Numbers numbers(79);
  for (int k = 0; k < 8; ++k) {
    // The plane has any tilt; the error is the absolute error of the angle.
    const Vec3d n = numbers.direction(), along = normalized(cross(n, numbers.direction()));

    std::vector<ProbeRay> rays;
    for (std::size_t i = 0; i < kSurfels / 8; ++i) {
      const double elevation = std::pow(10, -numbers.in(1, 6));
      rays.push_back({{0, 0, 0}, Vec3f(along * std::cos(elevation) - n * std::sin(elevation))});
    }

    Probe probe(scene, setup);
    probe.load(rays);
    const Vec3f nf(n);
    for (std::size_t i = 0; i < rays.size(); ++i) probe.surfel(i, 0, nf, nf);

    for (const ProbeChild& child : probe.reflections()) {
      const Vec3d in(rays[child.parent].direction), out(child.ray.direction);
      const double down = -dot(in, Vec3d(nf)), up = dot(out, Vec3d(nf));
      if (down <= 0x1p-22) continue;  // below the rounding of the direction itself

      const double error = up > 0 ? std::fabs(up - down) : 1;
      finding.note(error, [&] {
        return "normal " + hexText(nf) + ", direction " + hexText(rays[child.parent].direction);
      });
    }
  }
  return finding;
}

constexpr Case kShadingNormalCases[] = {
    {"H32", "child rays stay on their side of the surface",
     "shading normals up to 57 degrees off, views down to 0.06 degrees; ulps below the least "
     "elevation",
     Runs::targets, childrenStayOnTheirSide},
    {"H32a", "normals that agree are left alone", "mirrored direction, absolute error",
     Runs::targets, agreeingNormals},
    {"H33", "views from behind the shading normal", "weights, directions and light all sound",
     Runs::targets, viewBehindTheNormal},
    {"H34", "corner normals that cancel", "the face's normal serves; unit length elsewhere",
     Runs::targets, cancellingNormals},
    {"H35", "shadow terminator of a low-polygon sphere (reported only)",
     "RMS error against the true sphere where the cosine is below 0.3", Runs::targets, terminator},
    {"H36", "no light from behind either normal", "16 lights around tilted normals", Runs::targets,
     lightBetweenTheNormals},
    {"H79", "mirrors seen at 0.1 to 1e-6 radians",
     "planes of any tilt; absolute error of the elevation", Runs::targets, grazingMirror},
};

}  // namespace

std::span<const Case> shadingNormalCases() { return kShadingNormalCases; }

}  // namespace whit::verify
