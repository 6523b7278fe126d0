// H80 to H83: coplanar faces as models often have them: boxes side by side, decals, glass that
// stands on a table, objects placed twice.
#include <array>

#include "verify/bodies.h"

namespace whit::verify {

namespace {

// Two corners on a grid of whole numbers, one unit or more apart on each axis.
std::array<Vec3f, 2> cornersOnGrid(Numbers& numbers) {
  std::array<Vec3f, 2> corners;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = std::floor(numbers.in(-2, 2));
    corners[0][axis] = float(low);
    corners[1][axis] = float(low + std::floor(numbers.in(1, 3)));
  }
  return corners;
}

// Blocks on a grid, whose faces, edges and corners coincide; decals on top of each other in the
// floor; coincident instances; sheets that cross. Scenes of odd seeds are turned and moved, so that
// planes agree only up to rounding.
Scene blocksOnGrid(std::uint64_t seed) {
  Numbers numbers(seed);
  SceneBuilder builder;
  const std::uint32_t all[] = {
      builder.add(diffuseMaterial(0.6f)),  builder.add(mirrorMaterial(0.7f)),
      builder.add(glassMaterial(1.5f, 1)), builder.add(glassMaterial(1.33f)),
      builder.add(diffuseMaterial(0.2f)),  builder.add(emittingMaterial(0.4f))};
  const auto any = [&] { return all[int(numbers.in(0, 6))]; };

  Object object;
  for (int i = 0; i < 8; ++i) {
    const auto [low, high] = cornersOnGrid(numbers);
    object.meshes.push_back(box(low, high, any()));
  }
  object.meshes.push_back(floorAt(-2, 6, all[0]));
  for (int i = 0; i < 3; ++i) {
    object.meshes.push_back(floorAt(-2, float(numbers.in(1, 5)), any()));
  }

  // The sheets cross in the middle.
  object.meshes.push_back(quad({-3, -3, -3}, {3, -3, 3}, {3, 3, 3}, {-3, 3, -3}, any()));
  object.meshes.push_back(quad({-3, -3, 3}, {3, -3, -3}, {3, 3, -3}, {-3, 3, 3}, any()));

  Affine place;
  if (seed % 2 != 0) {
    place = Affine::translation({300, 20, -100}) * Affine::rotation(numbers.direction(), 77);
  }
  builder.place(std::move(object), {place});

  // Two instances coincide and a third one overlaps them.
  Object twice;
  twice.meshes = {box({-1, 0, -1}, {1, 1, 1}, any())};
  builder.place(std::move(twice), {place, place, place * Affine::translation({1, 0, 0})});

  builder.description.lights = {lightAt(Vec3f(place.point({3.3, 7, 5.1})), 60)};
  builder.sky(0.3f);

  builder.lookFrom(Vec3f(place.point(numbers.direction() * 9.0)),
                   Vec3f(place.point({0.1, -0.2, 0.05})));

  Warnings warnings;  // coincident boxes of one material
  return Scene::finalize(builder.describe(), warnings);
}

RenderOptions fewPixels(const Setup& setup) {
  RenderOptions options = optionsOf(setup, {64, 48});
  options.depth = 6;
  return options;
}

// Calls visit(color, x, z) for every pixel of a picture that looks straight down from a parallel
// camera of this height, with the position that its center shows.
template <typename Visit>
void lookStraightDown(const Scene& scene, float height, const Setup& setup, const Visit& visit) {
  Camera camera = lookingDown();
  camera.orthographicHeight = height;

  for (const Image& image : picturesOf(scene, camera, fewPixels(setup))) {
    forEachRay(camera, image.width, image.height,
               [&](const Vec3d& start, const Vec3d&, int x, int y) {
                 visit(image.at(x, y).x, start.x, start.z);
               });
  }
}

// Compares pictures with packets of one ray, other tiles, queues, batches, threads and a crop.
void sameBits(Run& run) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Scene scene = blocksOnGrid(seed);
    const Image own = pictureOf(scene, scene.cameras[0], fewPixels(run));
    const auto check = [&](const char* how, const auto& change) {
      RenderOptions options = fewPixels(run);
      change(options);
      countOtherPixels(run, pictureOf(scene, scene.cameras[0], options), own,
                       concat("seed ", seed, ", ", how));
    };

    check("single rays", [](RenderOptions& options) { options.packet = 1; });
    check("other tiles and queues", [](RenderOptions& options) {
      options.tile = 7;
      options.queue = 40;
    });
    check("whole frames as batches", [&](RenderOptions& options) {
      options.batch = Batch::frame;
      options.threads = 1 + int(seed % 3);
    });
    check("a crop", [](RenderOptions& options) { options.crop = Crop{13, 11, 40, 31}; });
  }
}

// A block of glass with a face coincident with an opaque floor that hides something bright.
void glassOnTheFloor(Run& run) {
  for (const float height : {0.0f, 0.1f, 33.3f}) {
    SceneBuilder builder;
    builder.add(floorAt(height - 0.5f, 8), emittingMaterial(100));
    builder.add(floorAt(height, 8), emittingMaterial(0.5f));
    builder.add(box({-1, height, -1}, {1, height + 1, 1}), glassMaterial(1.5f));
    const Camera camera{.eye = {1.5f, height + 2.5f, 3}, .at = {0, height, 0}};

    for (const Image& image : picturesOf(builder.build(), camera, fewPixels(run))) {
      for (const Rgb& pixel : image.pixels) {
        run.count(!(maxComponent(pixel) <= 0.5f), "height ", height);
      }
    }
  }
}

// A glowing floor under two slabs, one on the other: the picture shows the light that none of the
// three interfaces reflects, first order only.
void slabOnSlab(Run& run) {
  // About two dozen roundings lie between the floor's radiance and the pixel.
  run.boundBy(24 * 0x1p-24);
  for (const float below : {1.5f, 1.33f, 2.0f}) {
    SceneBuilder builder;
    addSlab(builder, 1, 0, glassMaterial(1.5f, 1), 50);
    addSlab(builder, 0, -1, glassMaterial(below), 50);
    builder.add(floorAt(-2, 50), emittingMaterial(1));

    Camera camera = lookingDown();
    camera.orthographicHeight = 1;

    RenderOptions options = fewPixels(run);
    options.depth = 3;
    options.cutoff = 0;

    // The transmittance of Fresnel's equations at normal incidence.
    const auto passes = [](double a, double b) { return 1 - std::pow((a - b) / (a + b), 2); };
    const double n = below;
    const double wanted = passes(1, 1.5) * passes(1.5, n) * passes(n, 1);

    for (const Image& image : picturesOf(builder.build(), camera, options)) {
      for (const Rgb& pixel : image.pixels) {
        run.note(std::fabs(pixel.x / wanted - 1), "index ", n);
      }
    }
  }
}

// Among coincident squares an opaque one is seen rather than glass, and the later one of two in the
// scene.
void whichIsSeen(Run& run) {
  for (const bool glassFirst : {false, true}) {
    SceneBuilder builder;
    const auto lower = builder.add(emittingMaterial(0.25f)),
               upper = builder.add(emittingMaterial(0.75f));
    const auto glass = builder.add(glassMaterial(1.5f, 9));

    if (glassFirst) builder.add(floorAt(0, 2, glass));
    builder.add(floorAt(0, 3, lower));
    builder.add(floorAt(0, 2.5f, upper));
    if (!glassFirst) builder.add(floorAt(0, 2, glass));

    for (const Image& image : picturesOf(builder.build(), lookingDown(), fewPixels(run))) {
      for (const Rgb& pixel : image.pixels) {
        run.count(pixel.x != 0.75f && pixel.x != 0.25f && pixel.x != 0,
                  "something else: ", pixel.x);
      }
      run.count(image.at(32, 24).x != 0.75f, "not the later one");
    }
  }
}

// Ways in which a square may be stored apart from others: in the world, in an instance, with the
// meshes that cast no shadow, with the meshes that have holes.
constexpr int kWaysOfStoring = 4;

void addStored(int way, float half, float radiance, SceneBuilder& builder) {
  Material material = emittingMaterial(radiance);
  std::vector<Affine> places{Affine()};
  if (way == 1) places.push_back(Affine::translation({100, 0, 0}));
  if (way == 2) material.castsShadow = false;
  if (way == 3) {
    material.alphaMap = builder.add(makeTexture(TexelFormat::data, 1, 1, {0xffffffffu}));
  }

  builder.place({"square", {floorAt(0, half, builder.add(material))}}, places);
}

// The later one of two coincident squares is seen up to its edges, in whatever order they are
// stored.
void laterHoweverStored(Run& run) {
  for (int early = 0; early < kWaysOfStoring; ++early) {
    for (int late = 0; late < kWaysOfStoring; ++late) {
      SceneBuilder builder;
      addStored(early, 1.7f, 0.25f, builder);
      addStored(late, 1.3f, 0.75f, builder);

      lookStraightDown(builder.build(), 3, run, [&](float color, double x, double z) {
        if (std::fabs(x) > 1.3 || std::fabs(z) > 1.3) return;
        run.count(color != 0.75f, "stored ", early, " and ", late, ", at ", x, " ", z);
      });
    }
  }
}

// A decal in the corner of a floor, with one corner or an edge in common, covers exactly its own
// area.
void decalInACorner(Run& run) {
  for (const float side : {1.0f, 4.0f}) {
    SceneBuilder builder;
    const auto floor = builder.add(emittingMaterial(0.25f)),
               decal = builder.add(emittingMaterial(0.75f));

    builder.add(floorAt(0, 2, floor));
    builder.add(quad({-2, 0, 2}, {side - 2, 0, 2}, {side - 2, 0, 1}, {-2, 0, 1}, decal));

    lookStraightDown(builder.build(), 3.9f, run, [&](float color, double x, double z) {
      if (std::fabs(x) > 2) return;
      const bool covered = x < double{side} - 2 && z > 1;
      run.count(color != (covered ? 0.75f : 0.25f), "side ", side, ", at ", x, " ", z);
    });
  }
}

}  // namespace

const Family kCoplanarFaceCases{
    "coplanar faces",
    {{"H80", "the same bits with coplanar faces",
      "random blocks, decals, instances in one place, crossing sheets, also turned; against single "
      "rays, other tiles, queues, batches, threads, a crop",
      sameBits},
     {"H81", "glass on an opaque floor does not leak",
      "pixels that show what is under the floor, at three heights", glassOnTheFloor},
     {"H82", "slab on slab, with coincident faces",
      "light through three interfaces, against Fresnel; equal and other indices", slabOnSlab},
     {"H83", "which of several coincident faces is seen",
      "the opaque one, the later one, in any order with glass", whichIsSeen},
     {"H83a", "a decal in the corner of a floor covers what it covers",
      "two triangles of one plane with one corner or an edge in common", decalInACorner},
     {"H83b", "the later of two faces is seen, however they are stored",
      "in the world, as an instance, without a shadow, with holes: all pairs",
      laterHoweverStored}}};

}  // namespace whit::verify
