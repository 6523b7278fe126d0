// H59 to H61: laws that hold bit for bit and need no oracle.
#include <cstdint>

#include "verify/bodies.h"
#include "verify/scaled_scene.h"

namespace whit::verify {

namespace {

// A room with most effects: mirror, glass, smooth normals, texture, two lights.
SceneDescription room() {
  SceneBuilder builder;
  Material checked = diffuseMaterial(1);
  checked.diffuseMap = builder.add(
      makeTexture(TexelFormat::color, 2, 2, {0x3fffffffu, 0x000003ffu, 0x0ff00000u, 0x3fffffffu}));
  checked.mirror = Rgb(0.125f);

  Material shiny = diffuseMaterial(0.5f);
  shiny.specular = Rgb(0.25f);
  const auto floor = builder.add(checked), wall = builder.add(diffuseMaterial(0.5f));
  const auto mirror = builder.add(mirrorMaterial(0.75f)), glass = builder.add(glassMaterial(1.5f));
  const auto glossy = builder.add(shiny);

  builder.add(floorAt(0, 4, floor));
  builder.add(box({-4, -1, -4}, {4, 5, 4}, wall));
  builder.add(sphereMesh(3, {-1, 1, -0.5}, 0.9, mirror, true));
  builder.add(sphereMesh(3, {1.1, 0.8, 0.4}, 0.75, glass, true));
  builder.add(sphereMesh(2, {0.2, 0.5, 1.4}, 0.4, glossy));

  Light second = lightAt({2.5f, 4.25f, 2}, 20);
  second.intensity = {20, 15, 10};
  builder.description.lights = {lightAt({-2.2f, 4, 2.7f}, 30), second};

  builder.description.sky.kind = Sky::Kind::gradient;
  builder.description.sky.zenith = {0.2f, 0.3f, 0.6f};
  builder.description.cameras = {{.eye = {0.4f, 2, 3.9f}, .at = {0, 0.8f, 0}, .fov = 60}};
  return builder.describe();
}

RenderOptions small(const Setup& setup) { return optionsOf(setup, {49, 31}); }

Image pictureOfRoom(const RenderOptions& options, SceneDescription description = room()) {
  const Scene scene = repaired(std::move(description));
  return pictureOf(scene, scene.cameras[0], options);
}

// Counts the pixels of the room that another description or other options change.
void changes(Run& run, const std::string& what, SceneDescription description) {
  countOtherPixels(run, pictureOfRoom(small(run), std::move(description)),
                   pictureOfRoom(small(run)), what);
}
void changes(Run& run, const std::string& what, const RenderOptions& options) {
  countOtherPixels(run, pictureOfRoom(options), pictureOfRoom(small(run)), what);
}

// Compares pixels of pictures of odd sizes with the same pixels traced alone.
void partialPackets(Run& run) {
  const Scene scene = repaired(room());

  for (const ImageSize& size : {ImageSize{1, 1}, {15, 1}, {17, 3}, {1, 257}, {16, 16}}) {
    RenderOptions options = optionsOf(run, size);
    const Image whole = pictureOf(scene, scene.cameras[0], options);

    Numbers numbers(59);
    for (int k = 0; k < 6; ++k) {
      const int x = int(numbers.in(0, size.width)), y = int(numbers.in(0, size.height));
      options.crop = Crop{x, y, x + 1, y + 1};
      countOtherPixels(run, pictureOf(scene, scene.cameras[0], options), whole,
                       concat(size.width, "x", size.height));
    }
  }
}

// Traces queues of 1 to 33 rays with poison behind the last one.
void poisonedLanes(Run& run) {
  const Scene scene = repaired(room());
  std::vector<ProbeRay> rays = raysOnto({0, 1.5, 0}, 1, 33, 60);
  for (ProbeRay& ray : rays) ray.origin = {0, 2.5f, 0.25f};

  Probe whole(scene, run, rays);
  const std::vector<ProbeChild> expected = whole.reflections();
  constexpr std::uint32_t kPoison = 0x7fc00000u;  // a NaN, and an index far out of range

  for (std::size_t n = 1; n <= rays.size(); ++n) {
    Probe probe(scene, run);
    // Fills the block behind the rays that follow with other rays.
    probe.cast(std::vector<ProbeRay>(48, rays[n - 1]));
    probe.poison(kPoison);
    probe.cast({rays.begin(), rays.begin() + std::ptrdiff_t(n)});

    for (const auto i : indices(n)) {
      const bool same = probe.hits().triangle[i] == whole.hits().triangle[i] &&
                        probe.hits().t[i] == whole.hits().t[i] && probe.ns(i) == whole.ns(i) &&
                        probe.position(i) == whole.position(i);
      run.count(!same, n, " rays: ", rays[i]);
    }

    const std::vector<ProbeChild> got = probe.reflections();
    for (const auto i : indices(got)) {
      const bool same = i < expected.size() && got[i].parent == expected[i].parent &&
                        got[i].ray.direction == expected[i].ray.direction &&
                        got[i].weight == expected[i].weight;
      run.count(!same, "child ", i, " of ", n);
    }
  }
}

void packetWidths(Run& run) { changes(run, "packets", small({run.simd, 1})); }

void schedule(Run& run) {
  const Scene scene = repaired(room());
  const Image expected = pictureOf(scene, scene.cameras[0], small(run));

  const auto check = [&](const std::string& what, const auto& change) {
    RenderOptions options = small(run);
    change(options);
    countOtherPixels(run, pictureOf(scene, scene.cameras[0], options), expected, what);
  };

  check("second run", [](const RenderOptions&) {});
  for (const int n : {2, 3, 8}) {
    check(std::to_string(n) + " threads", [n](RenderOptions& options) { options.threads = n; });
  }
  for (const int n : {7, 8, 64}) {
    check("tile " + std::to_string(n), [n](RenderOptions& options) { options.tile = n; });
  }
  for (const int n : {16, 1000, 65536}) {
    check("queue " + std::to_string(n), [n](RenderOptions& options) { options.queue = n; });
  }
  check("whole frames", [](RenderOptions& options) {
    options.batch = Batch::frame;
    options.threads = 2;
  });
}

void scaling(Run& run) {
  const Image expected = pictureOfRoom(small(run));
  for (const int k : {-20, -3, 1, 20}) {
    countOtherPixels(run, pictureOfRoom(small(run), scaled(room(), k)), expected,
                     concat("times 2^", k));
  }
}

// The room has no glass here, because the winding decides whether a ray enters a surface or leaves
// it.
void mirroring(Run& run) {
  const auto opaque = [] {
    SceneDescription d = room();
    for (Material& m : d.materials) m.transmission = Rgb(0.0f);
    return d;
  };

  SceneDescription d = opaque();
  for (Mesh& mesh : d.objects[0].meshes) {
    for (Vec3f& p : mesh.positions) p.x = -p.x;
    for (Vec3f& n : mesh.normals) n = {n.x, -n.y, -n.z};  // the winding has turned as well
  }
  for (Light& light : d.lights) light.position.x = -light.position.x;
  d.cameras[0].eye.x = -d.cameras[0].eye.x;
  d.cameras[0].at.x = -d.cameras[0].at.x;

  countOtherPixels(run, pictureOfRoom(small(run), opaque()),
                   pictureOfRoom(small(run), std::move(d)), "mirrored", true);
}

void lightOrder(Run& run) {
  // At each surface of a path one sum is in another order.
  run.boundBy(16 * 0x1p-24);
  SceneDescription d = room();
  std::swap(d.lights[0], d.lights[1]);

  const Image a = pictureOfRoom(small(run)), b = pictureOfRoom(small(run), std::move(d));
  for (const auto i : indices(a.pixels)) {
    const double largest = std::max(1e-6, double{maxComponent(a.pixels[i])});
    run.note(maxComponent(abs(a.pixels[i] - b.pixels[i])) / largest, "pixel ", i);
  }
}

void meshOrder(Run& run) {
  SceneDescription d = room();
  std::ranges::reverse(d.objects[0].meshes);
  for (Mesh& mesh : d.objects[0].meshes) std::ranges::reverse(mesh.triangles);
  changes(run, "reversed", std::move(d));
}

void unreachableObject(Run& run) {
  SceneDescription d = room();
  d.objects[0].meshes.push_back(sphereMesh(3, {30, 20, -10}, 2, 1));
  changes(run, "with a far sphere", std::move(d));
}

void superfluousEffects(Run& run) {
  RenderOptions all = small(run);
  all.effects = EffectChoice::all;
  changes(run, "all effects", all);
}

}  // namespace

const Family kInvarianceCases{
    "exact laws",
    {{"H59", "a pixel traced alone has the bits of the whole image",
      "images of 1x1, 15x1, 17x3, 1x257, 16x16", partialPackets},
     {"H59a", "dead lanes do not matter", "queues of 1 to 33 rays with NaN behind them",
      poisonedLanes},
     {"H59b", "every packet width gives the bits of single rays", "room with mirror and glass",
      packetWidths},
     {"H60", "the same bits for any threads, tiles, queues, batches", "room with mirror and glass",
      schedule, Runs::targets},
     {"H61", "scaled by a power of two: the same bits", "2^-20 to 2^20", scaling},
     {"H61b", "mirrored: the mirrored picture, bit for bit", "x negated, without glass", mirroring},
     {"H61d", "lights in another order", "relative change", lightOrder, Runs::targets},
     {"H61e", "meshes and triangles in another order: the same bits", "both reversed", meshOrder},
     {"H61f", "an object that no ray reaches: the same bits", "far sphere behind a wall",
      unreachableObject},
     {"H61g", "effects that the scene has none of: the same bits", "a plan with every effect",
      superfluousEffects}}};

}  // namespace whit::verify
