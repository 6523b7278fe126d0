// Pictures of all projections: packets against the reference and closed forms, and the same bits
// whatever the packet, tile, thread and target.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
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
  RenderOptions o = smallOptions();
  o.size = kSmallSize;
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
  for (const auto& [name, camera] : projectedCameras(load("whitted").cameras.front())) {
    SCOPED_TRACE(name);
    const Scene scene = whittedFrom(camera);
    const RenderOptions usual = projectedOptions();
    const Image expected = render(scene, usual).image;
    const auto expectSame = [&](const RenderOptions& o, const std::string& what) {
      EXPECT_EQ(firstDifference(render(scene, o).image, expected), "") << what;
    };

    for (const int packet : {1, 4, 8, 16}) {
      RenderOptions o = usual;
      o.packet = packet;
      expectSame(o, "packets of " + std::to_string(packet));
    }

    RenderOptions tiled = usual;
    tiled.tile = 5;
    tiled.threads = 3;
    expectSame(tiled, "tiles of 5");

    for (const std::string& target : simd::availableTargets()) {
      RenderOptions o = usual;
      o.simd = target;
      expectSame(o, target);
    }
    simd::chooseTarget("auto");

    RenderOptions cropped = usual;
    cropped.crop = Crop{50, 20, 60, 40};
    const Image part = render(scene, cropped).image;
    for (int y = 20; y < 40; ++y) {
      for (int x = 50; x < 60; ++x) EXPECT_EQ(part.at(x, y), expected.at(x, y)) << x << "," << y;
    }
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
    RenderOptions o = smallOptions();
    o.size = even;
    const Image views = render(scene, o).image;

    o.size = odd;
    expectStagesAgreeOnEveryTarget(scene, o);
    const Image more = render(scene, o).image;

    for (int y = 0; y < even.height; ++y) {
      for (int x = 0; x < even.width; ++x) {
        EXPECT_EQ(more.at(x, y), views.at(x, y)) << x << "," << y;
      }
    }
  }
}

// A sphere of radius 1.5 about the origin is seen from (0, 0, 4); there is a wall at z = -2.
Scene ballAndWall(const Camera& camera) {
  SceneBuilder builder;
  builder.description.cameras = {camera};
  builder.add(exactSphere(builder.add(diffuseMaterial(0.5f)), Affine::scaling(Vec3d(1.5))));
  builder.add(quad({-90, -90, -2}, {90, -90, -2}, {90, 90, -2}, {-90, 90, -2},
                   builder.add(diffuseMaterial(0.5f))));

  builder.sky(1);
  return builder.build();
}

// Returns the distance to the nearer of the two along the ray, or infinity.
double ballOrWall(const Ray& ray) {
  const double b = dot(ray.origin, ray.direction);
  const double root = b * b - (dot(ray.origin, ray.origin) - 2.25);
  if (root >= 0 && b < 0) return -b - std::sqrt(root);

  const double way = (-2 - ray.origin.z) / ray.direction.z;
  const Vec3d at = ray.origin + ray.direction * way;
  const bool hit = way > 0 && std::fabs(at.x) < 90 && std::fabs(at.y) < 90;
  return hit ? way : std::numeric_limits<double>::infinity();
}

double unitsInTheLastPlace(float value, double wanted) {
  const float near = std::fabs(static_cast<float>(wanted));
  const float next = std::nextafter(near, std::numeric_limits<float>::infinity());
  return std::fabs(double{value} - wanted) / (double{next} - double{near});
}

TEST(Projected, DepthsOfASphereAndAPlaneAreTheClosedForm) {
  Camera pose;
  pose.eye = {0, 0, 4};
  pose.at = {0, 0, 0};
  for (const auto& [name, camera] : projectedCameras(pose)) {
    SCOPED_TRACE(name);
    const Scene scene = ballAndWall(camera);
    RenderOptions o = smallOptions();
    o.size = kSmallSize;
    o.channels = parseChannels("depth,alpha");
    Renderer renderer(scene, o);
    Film packets = makeFilm(scene, o), reference = makeFilm(scene, o);
    renderer.render(camera, packets);
    renderReference(renderer, camera, reference);
    const CameraFrame frame = makeCameraFrame(camera, 107, 67);

    int blind = 0, hits = 0, apart = 0;
    for (std::size_t i = 0; i < 107 * 67; ++i) {
      const int x = static_cast<int>(i % 107), y = static_cast<int>(i / 107);
      const Ray ray = reference::generateRay(frame, x + 0.5, y + 0.5);
      const auto values = [&](Film& film, std::size_t k) {
        return film.channels.floats(Channel::depth)[2 * i + k];
      };
      const auto alpha = [&](Film& film) { return film.channels.floats(Channel::alpha)[i]; };

      // Pixels beyond the image circle of a lens have no ray.
      if (ray.direction == Vec3d()) {
        ++blind;
        for (Film* film : {&packets, &reference}) {
          EXPECT_EQ(film->image.at(x, y), Rgb(0.0f)) << x << "," << y;
          EXPECT_EQ(alpha(*film), 0);
          EXPECT_TRUE(std::isinf(values(*film, 0)));
        }
        continue;
      }

      const double wanted = ballOrWall(ray);
      if (std::isinf(wanted)) {
        EXPECT_TRUE(std::isinf(values(reference, 1))) << x << "," << y;
        EXPECT_EQ(reference.image.at(x, y), Rgb(1.0f));
        continue;
      }

      ++hits;
      EXPECT_LE(unitsInTheLastPlace(values(reference, 1), wanted), 2) << x << "," << y;
      const double z = wanted * dot(ray.direction, frame.forward);
      EXPECT_LE(unitsInTheLastPlace(values(reference, 0), z), 2) << x << "," << y;

      // The packets' directions are floats; at grazing angles their rounding moves the hit.
      apart += !(std::fabs(double{values(packets, 1)} / wanted - 1) < 1e-4);
      EXPECT_EQ(alpha(packets), 1) << x << "," << y;
    }

    EXPECT_GT(hits, 200);
    EXPECT_LE(apart, 6);

    // Rays of fisheyes exist only within their image circle.
    const bool round = name == "equidistant" || name == "equisolid" || name == "fisheye";
    EXPECT_EQ(blind > 500, round) << blind;
  }
}

}  // namespace
}  // namespace whit::test
