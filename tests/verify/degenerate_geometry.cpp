// H23 to H29: triangles without area, of extreme sizes, and with coordinates that are not numbers.
#include <bit>
#include "pi.h"
#include "surfaces/intersect.h"
#include "verify/bodies.h"

namespace whit::verify {

namespace {

SceneDescription descriptionOf(const std::vector<Mesh>& meshes, const Material& material) {
  SceneDescription d;
  d.materials = {material};
  d.objects = {{"all", meshes}};
  d.instances = {{0, Affine{}}};
  d.lights = {lightAt({0.4f, 3, 0.3f}, 10)};
  return d;
}

template <typename... Input>
void finitePixels(Run& run, const Scene& scene, const Input&... input) {
  for (const Camera& camera : scene.cameras) {
    for (const Rgb& pixel : pictureOf(scene, camera, optionsOf(run, {33, 21})).pixels) {
      run.count(!isFinite(pixel) || pixel.x < 0, input...);
    }
  }
}

// Tests the position that shading uses, which comes from the weights and not from t.
void positionsOfNeedles(Run& run) {
  run.boundBy(0x1p-18);
  // The fan consists of needles of 0.09 degrees each.
  Mesh fan;
  constexpr std::uint32_t kNeedles = 4000;
  fan.positions.push_back({0, 0, 0});
  fan.normals.push_back({0, 1, 0});
  for (std::uint32_t i = 0; i <= kNeedles; ++i) {
    const double turn = 2 * kPi * i / kNeedles;
    fan.positions.emplace_back(Vec3d{std::cos(turn), 0, -std::sin(turn)});
    fan.normals.emplace_back(normalized(Vec3d{std::cos(turn), 3, -std::sin(turn)}));
    if (i > 0) fan.triangles.push_back({0, i, i + 1});
  }

  const Scene scene = sceneOf(fan, diffuseMaterial(1));

  // The rays hit points from 1e-4 to 1 away from the tip of the fan.
  const auto rays = randomRays(kNeedles, 25, [](Numbers& numbers, int) {
    const double turn = numbers.in(0, 6.28), r = std::pow(10, -numbers.in(0.001, 4));
    const Vec3f target(Vec3d{r * std::cos(turn), 0, r * std::sin(turn)});
    return rayThrough(target + Vec3f{0.1f, 1, 0.2f}, target);
  });

  Probe probe(scene, run, rays);
  for (const auto i : indices(rays)) {
    if (!probe.isHit(i)) continue;
    const float u = probe.hits().u[i], v = probe.hits().v[i];
    const float least = -0x1p-22f;
    const bool sound = u >= least && v >= least && u + v <= 1 - 2 * least;
    const double height = std::fabs(probe.position(i).y);
    const double unit = std::fabs(length(Vec3d(probe.ns(i))) - 1);
    run.note(sound ? std::max(height, unit) : 1, rays[i], ", u ", u, ", v ", v);
  }
}

// Triangles without area of each kind, and slivers, beside a valid floor.
void degenerateTriangles(Run& run) {
  Mesh mesh = floorAt(0, 1);
  // One triangle repeats a corner, two have collinear corners, and two are slivers.
  mesh.triangles.push_back({0, 0, 1});
  addTriangle(mesh, {{0, 0.1f, 0}, {0.5f, 0.1f, 0}, {1, 0.1f, 0}});
  addTriangle(mesh, {{-1113.45f, -79.049614f, -56.2431908f},
                     {-1113.45f, -87.0922699f, -56.2431908f},
                     {-1113.45f, -79.2090149f, -56.2431908f}});
  addTriangle(mesh, {{0, 0.2f, 0}, {1, 0.2f, 0}, {0.5f, 0.2f, 1e-20f}});
  addTriangle(mesh, {{0, 0.3f, 0}, {1, 0.3f, 0}, {0.5f, 0.3f, 1e-7f}});
  mesh.uvs.resize(mesh.positions.size());

  SceneDescription d = descriptionOf({mesh}, diffuseMaterial(1));
  // The slivers fill the middle row.
  d.cameras = {{.eye = {0.5f, 3, 0.02f}, .at = {0.5f, 0, 0}, .up = {0, 0, -1}, .fov = 2}};
  finitePixels(run, repaired(std::move(d)), "degenerate triangles and slivers");
}

// With edges from 1e-14 to 1e14, the normal is the normal of the plane.
void tinyAndHugeTriangles(Run& run) {
  run.boundBy(4 * 0x1p-24);
  Mesh mesh;
  for (int e = -14; e <= 14; ++e) {
    const float s = float(std::pow(10, e));
    addTriangle(mesh, {{0, 0, 0}, {s, 0, 0.5f * s}, {0, 0.75f * s, s}});
  }

  const Scene scene = sceneOf(mesh, diffuseMaterial(1));
  Probe probe(scene, run);
  probe.hitEach(size32(mesh.triangles));

  for (std::uint32_t i = 0; i < probe.size(); ++i) {
    const Corners c = worldCorners(scene, i, kNoHit);
    Vec3d n = normalized(cross(c[1] - c[0], c[2] - c[0]));
    if (n.z < 0) n = -n;
    run.note(maxComponent(abs(Vec3d(probe.ng(i)) - n)), "edge ", c[1].x);
  }
}

void hugeNextToTiny(Run& run) {
  for (const float half : {1e4f, 1e9f, 1e15f}) {
    SceneBuilder builder;
    const auto gray = builder.add(diffuseMaterial(1));
    builder.add(floorAt(0, half, gray));
    builder.add(sphereMesh(2, {0, 2, 0}, 1, gray));
    const Scene scene = builder.build();

    // From high above, and from just below.
    const auto down = randomRays(500, 26, [](Numbers& numbers, int) {
      const double x = numbers.in(2, 500), z = numbers.in(-500, 500);
      return ProbeRay{Vec3f(Vec3d{x, 120500, z}), {0, -1, 0}};
    });
    std::vector<ProbeRay> up = down;
    for (ProbeRay& ray : up) ray.origin.y = -1e-30f;

    const Probe probe(scene, run, down), phantom(scene, run, up);
    for (const auto i : indices(down)) {
      run.count(!probe.isHit(i) || probe.position(i).y != 0, down[i]);
      run.count(phantom.isHit(i), up[i]);
    }
  }
}

// The triangles of one bad corner are dropped and counted; the others stay.
void badVertices(Run& run) {
  for (const float bad : {kNan, kInf, -kInf, 1e19f, 3e38f}) {
    Mesh mesh = grid();
    mesh.positions[2000].y = bad;
    SceneDescription d = descriptionOf({mesh}, diffuseMaterial(1));

    Warnings warnings;
    const Scene scene = repaired(std::move(d), &warnings);
    const auto entries = warnings.entries();
    const auto dropped = entries.find("triangle with a non-finite or enormous corner dropped");

    // Six triangles share an inner corner of the grid.
    run.count(dropped == entries.end() || dropped->second.count != 6, "corner ", bad);
    run.count(!(length(scene.upper) < 100), "bounds with ", bad);
    finitePixels(run, scene, "corner ", bad);
  }
}

// An invalid ray in one lane of a packet does not change a bit of the other lanes.
void badRays(Run& run) {
  const Scene scene = sceneOf(sphereMesh(3, {}, 1), diffuseMaterial(1));
  const std::vector<ProbeRay> good = raysOnto({}, 1, 64, 28);
  Probe expected(scene, run, good);
  const ProbeRay bad[] = {{{kNan, 0, 0}, {0, 0, 1}},
                          {{0, kInf, 0}, {0, 0, 1}},
                          {{0, 0, 3}, {kNan, 0, -1}},
                          {{0, 0, 3}, {0, kInf, -1}},
                          {Vec3f(kNan), Vec3f(kNan)}};

  for (std::size_t lane = 0; lane < 16; lane += 5) {
    for (const ProbeRay& ray : bad) {
      std::vector<ProbeRay> rays = good;
      for (std::size_t i = lane; i < rays.size(); i += 16) rays[i] = ray;
      Probe probe(scene, run, rays);
      for (const auto i : indices(rays)) {
        const bool wrong = i % 16 == lane ? probe.isHit(i) : !probe.sameHit(expected, i);
        run.count(wrong, "lane ", i % 16, " beside ", ray);
      }
    }
  }
}

// Random bits as corners, normals, coordinates and indices.
void garbage(Run& run) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    std::mt19937_64 bits(seed);
    const auto number = [&] { return std::bit_cast<float>(std::uint32_t(bits())); };

    Mesh mesh;
    mesh.materials = {0};
    for (int i = 0; i < 60; ++i) {
      // Every second corner is valid, so that some triangles remain.
      const bool sound = i % 2 == 0;
      const auto coordinate = [&] { return sound ? float(bits() % 200) * 0.01f - 1 : number(); };
      mesh.positions.push_back({coordinate(), coordinate(), coordinate()});
      mesh.normals.push_back({number(), number(), number()});
      mesh.uvs.push_back({number(), number()});
    }

    for (int i = 0; i < 200; ++i) {
      const auto index = [&] { return std::uint32_t(bits() % 31) * 2; };
      mesh.triangles.push_back({index(), index(), index()});
    }

    Material material = glassMaterial(1.5f);
    material.diffuse = material.specular = Rgb(0.5f);
    SceneDescription d = descriptionOf({mesh}, material);
    d.cameras = {Camera{}};
    d.sky.kind = Sky::Kind::color;
    d.sky.zenith = Rgb(1.0f);
    finitePixels(run, repaired(std::move(d)), "seed ", seed);
  }
}

}  // namespace

const Family kDegenerateGeometryCases{
    "degenerate geometry",
    {{"H23", "degenerate triangles and slivers shade to finite pixels",
      "repeated corner, collinear corners, heights 1e-20 and 1e-7", degenerateTriangles},
     {"H24", "normals of triangles from 1e-14 to 1e14", "absolute error against double",
      tinyAndHugeTriangles, Runs::targets},
     {"H25", "needles: weights within the triangle, position on it, unit normals",
      "fan of 4000 needles; the largest of the errors", positionsOfNeedles},
     {"H26", "a ground of 1e4 to 1e15 is where it is", "from 120500 above, and from just below",
      hugeNextToTiny},
     {"H27", "corners that are not finite or enormous are dropped and counted",
      "one such corner in a grid of 4225", badVertices},
     {"H28", "an invalid ray misses, and does not change its neighbors",
      "NaN and infinity in one lane", badRays},
     {"H29", "random bits as geometry", "12 scenes; pixels that are not finite", garbage}}};

}  // namespace whit::verify
