// H32 to H36 and H79: normals that disagree, and views along the surface.

#include "verify/bodies.h"

namespace whit::verify {

namespace {

constexpr int kSurfels = 4000;
const Vec3f kUp{0, 1, 0};

// A surfel whose geometric normal points up, and the ray that hits it.
struct Tilted {
  ProbeRay ray;
  Vec3f normal;  // for shading

  friend std::string textOf(const Tilted& surfel) {
    return "direction " + textOf(surfel.ray.direction) + ", shading normal " +
           textOf(surfel.normal);
  }
};

// Shading normals are up to `tilt` radians off the geometric one. Rays arrive at elevations of
// 10^-e, with e up to `flattest`.
std::vector<Tilted> tilted(std::uint64_t seed, double tilt, double flattest) {
  Numbers numbers(seed);
  std::vector<Tilted> result;
  for (int i = 0; i < kSurfels; ++i) {
    const double elevation = std::pow(10, -numbers.in(0, flattest)), turn = numbers.in(0, 6.28);
    const Vec3d view = normalized(Vec3d{std::cos(turn), elevation, std::sin(turn)});
    const double angle = numbers.in(0, tilt), about = numbers.in(0, 6.28);
    const Vec3d normal{std::sin(angle) * std::cos(about), std::cos(angle),
                       std::sin(angle) * std::sin(about)};
    result.push_back({{{0, 1, 0}, Vec3f(-view)}, Vec3f(normal)});
  }
  return result;
}

Scene oneMaterial(const Material& material) { return sceneOf(floorAt(0, 1), material); }

struct OneMaterial {
  Scene scene;
};

// A probe that has these surfels, of one material.
struct TiltedProbe : private OneMaterial, Probe {
  TiltedProbe(const Material& material, const Setup& setup, const std::vector<Tilted>& surfels)
      : OneMaterial{oneMaterial(material)}, Probe(scene, setup) {
    std::vector<ProbeRay> rays;
    for (const Tilted& surfel : surfels) rays.push_back(surfel.ray);
    load(rays);
    for (const auto i : indices(surfels)) surfel(i, 0, kUp, surfels[i].normal);
  }
};

// The distance of child rays below the least elevation, in units in the last place of 1.
void childrenStayOnTheirSide(Run& run) {
  run.boundBy(4);
  const std::vector<Tilted> surfels = tilted(32, 1.0, 3);

  TiltedProbe probe(glassMaterial(1.5f), run, surfels);
  for (const auto& [ray, weight, parent] : probe.reflections()) {
    const double facing = -surfels[parent].ray.direction.y, least = std::min(0.9 * facing, 0.01);
    // Normalization lowers a direction that was raised, by up to the square of how far it was
    // raised.
    run.note(std::max(0.0, least * 0.7 - ray.direction.y) / 0x1p-24, surfels[parent]);
  }

  for (const auto& [ray, weight, parent] : probe.refractions()) {
    run.note(std::max(0.0f, ray.direction.y) / 0x1p-24, surfels[parent]);
  }
}

// If the normals agree, the rule for tilted normals must not change the mirrored direction.
void agreeingNormals(Run& run) {
  run.boundBy(4 * 0x1p-24);
  const std::vector<Tilted> surfels = tilted(33, 0, 5);
  TiltedProbe probe(mirrorMaterial(1), run, surfels);

  for (const auto& [ray, weight, parent] : probe.reflections()) {
    const Vec3d in(surfels[parent].ray.direction), out(ray.direction);
    run.note(maxComponent(abs(out - Vec3d{in.x, -in.y, in.z})), surfels[parent]);
  }
}

Material everything() {
  Material m = glassMaterial(1.5f);
  m.diffuse = m.specular = Rgb(0.5f);
  m.mirror = m.mirrorGrazing = Rgb(0.5f);
  return m;
}

// Views from behind the shading normal: weights in [0, 1], unit directions, no negative light.
void viewBehindTheNormal(Run& run) {
  const std::vector<Tilted> surfels = tilted(34, 3.1, 6);
  TiltedProbe probe(everything(), run, surfels);

  for (const auto& children : {probe.reflections(), probe.refractions()}) {
    for (const auto& [ray, weight, parent] : children) {
      const double l = length(Vec3d(ray.direction));
      const bool fine = weight.x >= 0 && weight.x <= 1.5f && std::fabs(l - 1) < 1e-6;
      run.count(!fine, surfels[parent]);
    }
  }

  probe.light(lightAt({0.5f, 2, -0.3f}, 1));
  for (const auto i : indices(probe)) {
    const Rgb light = probe.visible(i) ? probe.unshadowed(i) : Rgb();
    run.count(!isFinite(light) || light.x < 0, surfels[i]);
  }
}

// Where opposite corner normals cancel, the normal of the face replaces them.
void cancellingNormals(Run& run) {
  run.boundBy(4 * 0x1p-24);
  Mesh mesh = floorAt(0, 1);
  mesh.normals = {{0, 0, 1}, {0, 0, -1}, {0, 0, 1}, {0, 0, -1}};
  const Scene scene = sceneOf(mesh, diffuseMaterial(1));

  Probe probe(scene, run);
  constexpr int kSteps = 1001;
  probe.load(std::vector<ProbeRay>(kSteps, {{0, 1, 0}, {0, -1, 0}}));
  for (const auto i : indices(kSteps)) {
    probe.hit(i, 0, 1, 0.5f, float(i) * (0.5f / (kSteps - 1)));
  }
  probe.interpolate();

  for (const auto i : indices(kSteps)) {
    const Vec3d n(probe.ns(i));
    const float v = probe.hits().v[i];
    run.note(v == 0 ? length(n - Vec3d(kUp)) : std::fabs(length(n) - 1), "u 0.5, v ", v);
  }
}

// Compares a sphere of facets with smooth normals, lit from the side, with the true sphere's cosine
// where that is below 0.3.
void terminator(Run& run) {
  run.boundBy(kNoBound);
  SceneBuilder builder;
  builder.add(diffuseMaterial(3.14159265f));
  builder.add(sphereMesh(2, {}, 1, 0, true));
  const Light light = lightAt({1000, 0, 0}, 1e6f);
  builder.description.lights = {light};
  const Scene scene = builder.build();

  Probe probe(scene, run, raysOnto({}, 1, kSurfels, 35));
  probe.light(light);
  double sum = 0;
  std::size_t n = 0;

  for (const auto i : indices(probe)) {
    const double cosine = normalized(Vec3d(probe.position(i))).x;
    if (!probe.isHit(i) || cosine <= 0 || cosine >= 0.3) continue;

    const double got = probe.visible(i) ? probe.unshadowed(i).x : 0;
    sum += (got - cosine) * (got - cosine);
    ++n;
  }
  run.note(std::sqrt(sum / double(n)), "RMS error over ", n, " points");
}

// Lights in front of one normal and behind the other.
void lightBetweenTheNormals(Run& run) {
  const std::vector<Tilted> surfels = tilted(36, 1.5, 1);
  TiltedProbe probe(everything(), run, surfels);

  Numbers numbers(36);
  for (int k = 0; k < 16; ++k) {
    const Vec3f l(numbers.direction() * 2.0);
    const std::size_t shadowRays = probe.light(lightAt(l, 1));

    std::size_t lit = 0;
    for (const auto i : indices(probe)) {
      const double g = l.y, s = dot(Vec3d(l), Vec3d(surfels[i].normal));
      lit += g >= 0 && s >= -1e-6;
      if (g > 0 && s > 0) continue;
      run.count(probe.visible(i) && s < -1e-6, surfels[i]);
      run.count(probe.visible(i) && g < 0, surfels[i]);
    }
    // The floor would occlude such a light; no shadow ray should be traced for it at all.
    run.count(shadowRays > lit, "light at ", l);
  }
}

// Elevations of 0.1 to 1e-6 radians over a flat mirror.
void grazingMirror(Run& run) {
  run.boundBy(4 * 0x1p-24);
  const Scene scene = oneMaterial(mirrorMaterial(1));
  Numbers numbers(79);
  for (int k = 0; k < 8; ++k) {
    // The plane has any tilt; the error is the absolute error of the angle.
    const Vec3d n = numbers.direction(), along = normalized(cross(n, numbers.direction()));

    std::vector<ProbeRay> rays;
    while (rays.size() < kSurfels / 8) {
      const double elevation = std::pow(10, -numbers.in(1, 6));
      rays.push_back({{0, 0, 0}, Vec3f(along * std::cos(elevation) - n * std::sin(elevation))});
    }

    Probe probe(scene, run);
    probe.load(rays);
    const Vec3f nf(n);
    for (const auto i : indices(rays)) probe.surfel(i, 0, nf, nf);

    for (const ProbeChild& child : probe.reflections()) {
      const Vec3d in(rays[child.parent].direction), out(child.ray.direction);
      const double down = -dot(in, Vec3d(nf)), up = dot(out, Vec3d(nf));
      if (down <= 0x1p-22) continue;  // below the rounding of the direction itself

      run.note(up > 0 ? std::fabs(up - down) : 1, "normal ", nf, ", direction ",
               rays[child.parent].direction);
    }
  }
}

}  // namespace

const Family kShadingNormalCases{
    "shading normals",
    {{"H32", "child rays stay on their side of the surface",
      "shading normals up to 57 degrees off, views down to 0.06 degrees; ulps below the least "
      "elevation",
      childrenStayOnTheirSide, Runs::targets},
     {"H32a", "normals that agree are left alone", "mirrored direction, absolute error",
      agreeingNormals, Runs::targets},
     {"H33", "views from behind the shading normal", "weights, directions and light all sound",
      viewBehindTheNormal, Runs::targets},
     {"H34", "corner normals that cancel", "the face's normal serves; unit length elsewhere",
      cancellingNormals, Runs::targets},
     {"H35", "shadow terminator of a low-polygon sphere (reported only)",
      "RMS error against the true sphere where the cosine is below 0.3", terminator, Runs::targets},
     {"H36", "no light from behind either normal", "16 lights around tilted normals",
      lightBetweenTheNormals, Runs::targets},
     {"H79", "mirrors seen at 0.1 to 1e-6 radians",
      "planes of any tilt; absolute error of the elevation", grazingMirror, Runs::targets}}};

}  // namespace whit::verify
