// Pictures of all projections: packets against the reference and closed forms, and the same bits
// whatever the packet, tile, thread and target.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "inspect/reference_frame.h"
#include "reference/generate_rays.h"
#include "reference/small_scenes.h"
#include "render/pipeline_laws.h"
#include "render/shipped_scene.h"

namespace whit::test {
namespace {

// Makes a camera of each projection, looking from `eye` to `at` of the pose.
std::map<std::string, Camera> projectedCameras(const Camera& pose) {
  std::map<std::string, Camera> all;
  const auto add = [&](const char* name, Projection projection) -> Camera& {
    Camera& camera = all[name] = pose;
    camera.projection = projection;
    return camera;
  };

  const auto withMatrix = [](Camera& camera) {
    camera.k = {80, 70, 55, 30, 3};
    camera.kSize = {107, 67};
  };

  withMatrix(add("matrix", Projection::perspective));
  Camera& lens = add("distortion", Projection::perspective);
  withMatrix(lens);
  lens.distortion = {-0.2f, 0.05f, 0.002f, -0.003f, 0.01f, 0.02f, 0.01f, 0.003f};
  add("equidistant", Projection::equidistant);
  add("equisolid", Projection::equisolid).angle = 250;

  Camera& calibrated = add("fisheye", Projection::fisheye);
  calibrated.k = {25, 24, 52, 34};
  calibrated.kSize = {107, 67};
  calibrated.distortion = {0.05f, -0.01f, 0.002f, -0.0001f};
  add("panorama", Projection::panorama);

  Camera& table = add("directions", Projection::directions);
  for (int i = 0; i < 31; ++i) table.azimuths.push_back(static_cast<float>(3 * i - 45));
  for (int i = 0; i < 17; ++i) table.elevations.push_back(static_cast<float>(20 - 2 * i));
  add("cubeMap", Projection::cubeMap);
  Camera& both = add("stereo", Projection::perspective);
  both.stereo = Stereo::leftRight;
  both.eyeDistance = 0.3f;

  Camera& round = add("stereo panorama", Projection::panorama);
  round.stereo = Stereo::topBottom;
  round.eyeDistance = 0.3f;
  Camera& lidars = add("stereo directions", Projection::directions);
  lidars.azimuths = {-170, -60, 20, 175};
  lidars.elevations = {40, -30};
  lidars.stereo = Stereo::leftRight;
  lidars.eyeDistance = 0.3f;
  return all;
}

Scene whittedFrom(const Camera& camera) {
  Scene scene = load("whitted");
  scene.cameras = {camera};
  return scene;
}

// The rays of the eye alone depend on the projection.
RenderOptions projectedOptions() {
  RenderOptions o = smallOptions(kSmallSize);
  o.spp = 2;
  o.depth = 1;
  return o;
}

TEST(Projected, StagesAgreeWithTheReferenceOnEveryTarget) {
  for (const auto& [name, camera] : projectedCameras(load("whitted").cameras.front())) {
    SCOPED_TRACE(name);
    expectStagesAgreeOnEveryTarget(whittedFrom(camera), projectedOptions());
  }
}

TEST(Projected, EveryWayOfRenderingGivesTheSameBits) {
  const std::vector<Division> divisions{{"rays alone, tiles of 5",
                                         [](RenderOptions& o) {
                                           o.packet = 1;
                                           o.tile = 5;
                                         }},
                                        {"packets of 4, 3 threads",
                                         [](RenderOptions& o) {
                                           o.packet = 4;
                                           o.threads = 3;
                                         }},
                                        {"packets of 8", [](RenderOptions& o) { o.packet = 8; }},
                                        {"packets of 16", [](RenderOptions& o) { o.packet = 16; }}};

  for (const auto& [name, camera] : projectedCameras(load("whitted").cameras.front())) {
    SCOPED_TRACE(name);
    const Scene scene = whittedFrom(camera);
    RenderOptions o = projectedOptions();
    expectBitsWhateverTheQueues(scene, o, divisions);
    expectBitsOfTheWhole(scene, o, {50, 20, 60, 40});

    const Picture expected = render(scene, o);
    forEachTarget([&](const std::string& target) {
      o.simd = target;
      EXPECT_EQ(firstDifference(render(scene, o), expected), "");
    });
  }
}

// Where the size is no multiple of the number of views, the pixels that are left over continue the
// last view.
TEST(Projected, SizesThatTheViewsDoNotDivideShowTheSameViews) {
  struct Sizes {
    const char* camera;
    ImageSize even, odd;
  };
  constexpr Sizes kSizes[] = {{"cubeMap", {3, 2}, {5, 3}},
                              {"cubeMap", {12, 2}, {17, 2}},
                              {"stereo", {32, 7}, {33, 7}},
                              {"stereo", {2, 1}, {3, 1}},
                              {"stereo panorama", {33, 12}, {33, 13}}};
  const auto cameras = projectedCameras(load("whitted").cameras.front());
  for (const auto& [name, even, odd] : kSizes) {
    SCOPED_TRACE(std::string(name) + " " + std::to_string(odd.width));
    const Scene scene = whittedFrom(cameras.at(name));
    RenderOptions o = smallOptions(even);
    const Image views = render(scene, o).image;

    o.size = odd;
    expectStagesAgreeOnEveryTarget(scene, o);
    const Image more = render(scene, o).image;

    forEachPixel(views,
                 [&](int x, int y) { EXPECT_EQ(more.at(x, y), views.at(x, y)) << x << "," << y; });
  }
}

// The eyes are within a sphere.
TEST(Projected, DepthsAreTheClosedForm) {
  const Vec3d center{0.2, -0.1, 0.3};
  constexpr double kRadius = 4;
  Camera pose;
  pose.eye = {0, 0, 2};
  for (const auto& [name, camera] : projectedCameras(pose)) {
    SCOPED_TRACE(name);
    SceneBuilder builder;
    builder.add(exactSphere(0, Affine::translation(center) * Affine::scaling(Vec3d(kRadius))),
                emittingMaterial(1));
    builder.description.cameras = {camera};
    RenderOptions o = smallOptions(kSmallSize);
    o.channels = parseChannels("depth,alpha");
    auto [packets, reference] = renderBoth(builder.build(), o);
    const CameraFrame frame = makeCameraFrame(camera, kSmallSize.width, kSmallSize.height);

    int blind = 0;
    for (int i = 0; i < kSmallSize.width * kSmallSize.height; ++i) {
      SCOPED_TRACE(i);
      const double x = i % kSmallSize.width, y = i / kSmallSize.width;
      const Ray ray = reference::generateRay(frame, x + 0.5, y + 0.5);

      // Pixels beyond the image circle of a lens have no ray.
      const bool isBlind = ray.direction == Vec3d();
      blind += isBlind;
      for (Film* film : {&packets, &reference}) {
        const float* const depth = &film->channels.floats(Channel::depth)[2 * i];
        EXPECT_EQ(film->channels.floats(Channel::alpha)[i], isBlind ? 0 : 1);
        EXPECT_EQ(film->image.pixels[i], Rgb(isBlind ? 0.0f : 1.0f));
        if (isBlind) {
          EXPECT_TRUE(std::isinf(depth[0]));
          continue;
        }

        // The far root of |way + along * direction| = radius.
        const Vec3d way = ray.origin - center;
        const double b = dot(way, ray.direction);
        const double along = std::sqrt(b * b - dot(way, way) + kRadius * kRadius) - b;
        const double wanted[] = {along * dot(ray.direction, frame.forward), along};
        for (const int k : {0, 1}) {
          // Directions of packets are floats; the reference rounds its results alone.
          const double bound = film == &packets ? 1e-5 : std::fabs(wanted[k]) * 0x1p-23;
          EXPECT_NEAR(depth[k], wanted[k], bound);
        }
      }
    }

    // Rays of fisheyes exist only within their image circle.
    const bool round = name == "equidistant" || name == "equisolid" || name == "fisheye";
    EXPECT_EQ(blind > 500, round) << blind;
  }
}

}  // namespace
}  // namespace whit::test
