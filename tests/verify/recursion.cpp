// H62 to H64: deep recursion and its limits.
#include "verify/bodies.h"

namespace whit::verify {

namespace {

// In a closed box of mirrors that emit 1 the radiance is the sum of R^k up to the greatest depth.
void hallOfMirrors(Run& run) {
  run.boundBy(0x1p-23);
  for (const float reflectance : {0.5f, 0.9f, 1.0f}) {
    Material mirror = mirrorMaterial(reflectance);
    mirror.emission = Rgb(1.0f);
    const Scene scene = sceneOf(box({-4, -4, -4}, {4, 4, 4}), mirror);
    for (const int depth : {0, 8, 64}) {
      RenderOptions options = optionsOf(run, {17, 11});
      options.depth = depth;
      options.cutoff = 0;

      double wanted = 0;
      for (int k = 0; k <= depth; ++k) wanted += std::pow(double{reflectance}, k);
      for (const Rgb& pixel : pictureOf(scene, lookingDown(), options).pixels) {
        const double error = std::fabs(pixel.x / wanted - 1) / (depth + 1);
        run.note(error, "R ", reflectance, ", depth ", depth);
      }
    }
  }
}

Scene plates() {
  SceneBuilder builder;
  const auto glass = builder.add(glassMaterial(1.5f));
  for (int i = 0; i < 10; ++i) {
    const float top = 1 - 0.2f * float(i);
    addSlab(builder, top, top - 0.1f, glass, 50);
  }
  builder.sky(1);
  return builder.build();
}

// Renders reflections and refractions of twenty faces at depth 64. Memory must not exceed one queue
// per depth, and pixels must be the same with queues of 16 rays and of one tile.
void boundedMemory(Run& run) {
  const Scene scene = plates();

  RenderOptions options = optionsOf(run, {16, 8});
  options.cutoff = 1e-3f;
  options.depth = 64;
  const Image wide = pictureOf(scene, lookingDown(), options);
  options.queue = 16;

  const auto bytes = [&](int depth, Image& image) {
    options.depth = depth;
    Renderer renderer(scene, options);
    Film film = makeFilm(scene, options);
    renderer.render(lookingDown(), film);
    const std::uint64_t first = renderer.memoryBytes();
    // A second frame must not take more memory than the first one.
    renderer.render(lookingDown(), film);
    image = film.image;
    run.count(renderer.memoryBytes() != first, "memory grows from frame to frame");
    return first;
  };

  Image shallow, deep;
  constexpr std::uint64_t kQueue = 16 * 1024;  // bytes of 16 rays and their children, all columns
  const std::uint64_t eight = bytes(8, shallow), most = bytes(64, deep);
  run.count(most > eight + 56 * kQueue, most, " bytes");

  for (const auto i : indices(deep.pixels)) {
    run.count(!(deep.pixels[i] == wide.pixels[i]), "pixel ", i);
  }
}

// A cutoff of X loses at most X per ray that is cut; a throughput of NaN ends the path.
void cutoffBias(Run& run) {
  run.boundBy(1);
  const Scene scene = plates();
  RenderOptions options = optionsOf(run, {8, 8});
  options.depth = 24;
  options.cutoff = 1e-5f;
  FrameStats exactStats, stats;
  const Image exact = pictureOf(scene, lookingDown(), options, &exactStats);

  for (const float cutoff : {3e-4f, 3e-3f}) {
    options.cutoff = cutoff;
    const Image image = pictureOf(scene, lookingDown(), options, &stats);
    const double cut = double(exactStats.allRays() - stats.allRays());
    const double allowed = cut * cutoff / 64;
    double lost = 0;
    for (const auto i : indices(image.pixels)) {
      lost += double{exact.pixels[i].x - image.pixels[i].x} / 64;
    }
    run.note(lost < -1e-6 ? 2 : lost / allowed, "cutoff ", cutoff);
  }

  const Scene mirror = sceneOf(floorAt(0, 1), mirrorMaterial(1));
  Probe probe(mirror, run);
  probe.load({{{0, 1, 0}, {0, -1, 0}}});
  probe.surfel(0, 0, {0, 1, 0}, {0, 1, 0});
  probe.rays().throughput[0] = kNan;
  run.note(probe.reflections().empty() ? 0 : 2, "throughput NaN");
}

}  // namespace

const Family kRecursionCases{
    "recursion",
    {{"H62", "a box of mirrors is a geometric series",
      "reflectance 0.5, 0.9, 1; depths to 64; "
      "relative error a bounce",
      hallOfMirrors},
     {"H63", "memory is bounded at depth 64 with both impulses",
      "ten plates of glass; bytes, and bits of queues of 16 against one tile", boundedMemory,
      Runs::targets},
     {"H64", "the cutoff loses no more than it says",
      "ten plates; mean loss over rays cut times cutoff", cutoffBias, Runs::targets}}};

}  // namespace whit::verify
