// The rays of each projection against formulas that lead from a direction to a place in the
// picture.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <vector>

#include "core/index.h"
#include "pi.h"
#include "reference/generate_rays.h"
#include "rounding.h"

namespace whit::reference {
namespace {

constexpr int kWide = 320, kTall = 200;

Camera askew() {
  Camera camera;
  camera.eye = {1, 2, 3};
  camera.at = {4, -1, -7};
  camera.up = {0.2f, 1, 0.1f};
  camera.kSize = {kWide, kTall};
  return camera;
}

// Converts a direction to OpenCV's axes: x to the right, y down, z forward.
Vec3d inCamera(const CameraFrame& frame, const Vec3d& direction) {
  const Vec3d right = normalized(cross(frame.forward, Vec3d(askew().up)));
  return {dot(direction, right), -dot(direction, cross(right, frame.forward)),
          dot(direction, frame.forward)};
}

// Checks that the formula leads each pixel's direction back to the pixel, with an error of at most
// `worst` pixels. Returns how many of the tested pixels see nothing.
template <typename ImageOf>
int expectImaged(const Camera& camera, double worst, const ImageOf& imageOf) {
  const CameraFrame frame = makeCameraFrame(camera, kWide, kTall);
  int blind = 0;

  for (int y = 0; y < kTall; y += 3) {
    for (int x = 0; x < kWide; x += 3) {
      const Ray ray = generateRay(frame, x + 0.25, y + 0.75);
      EXPECT_EQ(ray.origin, frame.eye);

      if (ray.direction == Vec3d()) {
        ++blind;
        continue;
      }

      EXPECT_NEAR(length(ray.direction), 1, 1e-15);
      expectNear(imageOf(inCamera(frame, ray.direction)), {x + 0.25, y + 0.75, 0}, worst);
    }
  }
  return blind;
}

constexpr double kPlace = 1e-9;  // rounding of a place below 512

TEST(Projections, AMatrixImagesAsInOpenCv) {
  Camera camera = askew();
  camera.k = {310, 290, 140.5f, 110.25f, 12};

  const auto image = [](const Vec3d& d) {
    const double x = d.x / d.z, y = d.y / d.z;
    // The center of OpenCV's first pixel is at 0.
    return Vec3d(310 * x + 12 * y + 140.5 + 0.5, 290 * y + 110.25 + 0.5, 0);
  };

  EXPECT_EQ(expectImaged(camera, kPlace, image), 0);

  // A picture of twice the size shows the same view.
  const Ray small = generateRay(makeCameraFrame(camera, kWide, kTall), 40, 30);
  const Ray large = generateRay(makeCameraFrame(camera, 2 * kWide, 2 * kTall), 80, 60);
  expectNear(small.direction, large.direction, 1e-15);
  EXPECT_NEAR(pixelCone(makeCameraFrame(camera, kWide, kTall)).spread, 1 / 290.0, 1e-15);
}

TEST(Projections, ALensDistortsAsInOpenCv) {
  Camera camera = askew();
  camera.k = {310, 290, 140.5f, 110.25f};

  // Barrel, pincushion and rational models.
  for (const std::vector<float>& c : {std::vector<float>{-0.25f, 0.06f, 0.002f, -0.003f, 0.01f},
                                      {0.3f, 0.1f},
                                      {0.6f, -0.2f, -0.001f, 0.004f, 0.05f, 0.9f, 0.1f, 0.02f}}) {
    camera.distortion = c;
    std::vector<double> k(c.begin(), c.end());
    k.resize(8);

    const auto image = [&](const Vec3d& d) {
      const double x = d.x / d.z, y = d.y / d.z, r2 = x * x + y * y, r4 = r2 * r2;
      const double radial = (1 + k[0] * r2 + k[1] * r4 + k[4] * r4 * r2) /
                            (1 + k[5] * r2 + k[6] * r4 + k[7] * r4 * r2);
      const double u = x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x);
      const double v = y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y;
      return Vec3d(310 * u + 141, 290 * v + 110.75, 0);
    };

    EXPECT_EQ(expectImaged(camera, kPlace, image), 0) << c[0];
  }
}

// x (1 - 0.3 x^2) has its largest value, 2/3 x, where 0.9 x^2 = 1. No direction is imaged further
// out.
TEST(Projections, BeyondTheFoldOfALensThereIsNothing) {
  Camera camera = askew();
  camera.k = {100, 100, 159.5f, 99.5f};
  camera.distortion = {-0.3f};

  const CameraFrame frame = makeCameraFrame(camera, kWide, kTall);
  const double fold = 100 * 2 / (3 * std::sqrt(0.9));
  EXPECT_NE(generateRay(frame, 160 + fold - 1, 100).direction, Vec3d());
  for (const double beyond : {1.0, 10.0, 80.0}) {
    EXPECT_EQ(generateRay(frame, 160 + fold + beyond, 100).direction, Vec3d()) << beyond;
  }
}

// Checks a fisheye whose distance from the center, in focal lengths, is `radiusOf` the angle to the
// axis.
template <typename RadiusOf>
void expectFisheye(Camera camera, double angle, double focal, const RadiusOf& radiusOf) {
  camera.angle = static_cast<float>(angle);
  const auto image = [&](const Vec3d& d) {
    const double off = std::hypot(d.x, d.y), theta = std::atan2(off, d.z);
    EXPECT_LE(theta, angle * kPi / 360 + 1e-12);
    const double scale = off > 0 ? focal * radiusOf(theta) / off : 0;
    return Vec3d(d.x * scale + kWide / 2.0, d.y * scale + kTall / 2.0, 0);
  };

  // The circle of the picture touches the upper and the lower side.
  const int blind = expectImaged(camera, kPlace, image);
  const double circle = kPi * kTall * kTall / 4.0 / (kWide * kTall);
  EXPECT_NEAR(blind / (107.0 * 67), 1 - circle, 0.01);
}

TEST(Projections, FisheyesImageAnglesAsDistances) {
  for (const double angle : {120.0, 180.0, 300.0}) {
    const double limit = angle * kPi / 360;
    Camera camera = askew();
    camera.projection = Projection::equidistant;
    expectFisheye(camera, angle, 100 / limit, [](double theta) { return theta; });

    camera.projection = Projection::equisolid;
    expectFisheye(camera, angle, 100 / (2 * std::sin(limit / 2)),
                  [](double theta) { return 2 * std::sin(theta / 2); });

    camera.projection = Projection::fisheye;
    camera.distortion = {0.03f, -0.005f, 0.0007f, -0.00002f};

    const auto radius = [&](double theta) {
      double sum = theta, power = theta;
      for (const float factor : camera.distortion) {
        power *= theta * theta;
        sum += double{factor} * power;
      }
      return sum;
    };

    const auto focal = static_cast<float>(100 / radius(limit));
    camera.k = {focal, focal, kWide / 2 - 0.5f, kTall / 2 - 0.5f};
    expectFisheye(camera, angle, double{focal}, radius);
  }
}

TEST(Projections, AFisheyeHasAMatrix) {
  Camera camera = askew();
  camera.projection = Projection::fisheye;
  camera.k = {150, 160, 150.5f, 90.5f, 4};
  const auto image = [](const Vec3d& d) {
    const double off = std::hypot(d.x, d.y), scale = std::atan2(off, d.z) / off;
    return Vec3d(151 + 150 * d.x * scale + 4 * d.y * scale, 91 + 160 * d.y * scale, 0);
  };
  EXPECT_EQ(expectImaged(camera, kPlace, image), 0);
}

TEST(Projections, APanoramaShowsAllDirections) {
  Camera camera = askew();
  camera.projection = Projection::panorama;
  const auto image = [](const Vec3d& d) {
    return Vec3d(kWide * (0.5 + std::atan2(d.x, d.z) / (2 * kPi)),
                 kTall * (0.5 + std::asin(d.y) / kPi), 0);
  };
  EXPECT_EQ(expectImaged(camera, kPlace, image), 0);
  EXPECT_NEAR(pixelCone(makeCameraFrame(camera, kWide, kTall)).spread, kPi / kTall, 1e-15);
}

TEST(Projections, ATableStatesTheDirectionsOfRowsAndColumns) {
  Camera camera = askew();
  camera.projection = Projection::directions;
  camera.azimuths = {-90, 10, 25.5f, 180};
  camera.elevations = {15, -2, -30};
  const CameraFrame frame = makeCameraFrame(camera, 4, 3);

  const auto expectAngles = [&](double x, double y, double azimuth, double elevation) {
    const Vec3d d = inCamera(frame, generateRay(frame, x, y).direction);
    const double a = azimuth * kPi / 180, e = elevation * kPi / 180;
    const Vec3d wanted{std::sin(a) * std::cos(e), -std::sin(e), std::cos(a) * std::cos(e)};
    expectNear(d, wanted, 1e-15);
  };

  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      expectAngles(column + 0.5, row + 0.5, double{entryOf(camera.azimuths, column)},
                   double{entryOf(camera.elevations, row)});
    }
  }
  expectAngles(1.75, 0.75, 10 + 15.5 / 4, 15 - 17 / 4.0);  // between its neighbors
  expectAngles(0.25, 2.9, -90, -30);                       // the first and the last hold beyond
}

// In a row, and in two rows, each face is seen as when one turns there from the forward view.
TEST(Projections, TheFacesOfACubeMapAreViewsToAllSides) {
  // Right, left, up, down, forward and backward, in OpenCV's axes.
  struct Face {
    Vec3d middle, right, down;
  };
  const std::vector<Face> faces{
      {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
      {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
      {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}};
  Camera camera = askew();
  camera.projection = Projection::cubeMap;

  for (const auto& [columns, rows] : {std::pair{6, 1}, {3, 2}}) {
    const CameraFrame frame = makeCameraFrame(camera, 100 * columns, 100 * rows);
    for (int face = 0; face < 6; ++face) {
      const auto& [middle, right, down] = entryOf(faces, face);
      for (const auto& [x, y] : {std::pair{50.0, 50.0}, {0.0, 10.0}, {13.0, 71.0}, {99.0, 99.0}}) {
        const int column = face % columns, row = face / columns;
        const Ray ray = generateRay(frame, column * 100 + x, row * 100 + y);
        const Vec3d wanted = middle + right * (x / 50 - 1) + down * (y / 50 - 1);
        expectNear(inCamera(frame, ray.direction), normalized(wanted), 1e-15);
      }
    }
  }
}

TEST(Projections, AStereoPairLooksThroughTwoEyes) {
  Camera camera = askew();
  camera.eyeDistance = 0.5f;
  const CameraFrame one = makeCameraFrame(camera, 100, 80);
  const Vec3d aside = normalized(one.right) * 0.25;
  const Ray wanted = generateRay(one, 30.5, 20.5);

  // The second picture lies this many pixels beside or below the first one.
  for (const auto& [stereo, x, y] :
       {std::tuple{Stereo::leftRight, 100, 0}, {Stereo::topBottom, 0, 80}}) {
    camera.stereo = stereo;
    const CameraFrame two = makeCameraFrame(camera, 100 + x, 80 + y);
    const Ray left = generateRay(two, 30.5, 20.5), right = generateRay(two, x + 30.5, y + 20.5);

    EXPECT_EQ(left.direction, wanted.direction);
    EXPECT_EQ(right.direction, wanted.direction);
    expectNear(left.origin, one.eye - aside, 1e-15);
    expectNear(right.origin, one.eye + aside, 1e-15);
  }
}

// The eyes stand side by side for every azimuth. By trigonometry, they see a point at distance D at
// azimuths that differ by 2 asin(e / 2D), in front, aside and behind.
TEST(Projections, AStereoPanoramaHasItsParallaxAllAround) {
  constexpr double kDistance = 2, kEyes = 0.5;
  Camera camera;
  camera.eye = {3, 1, -2};
  camera.at = {3, 1, -7};
  camera.eyeDistance = static_cast<float>(kEyes);
  camera.stereo = Stereo::topBottom;

  Camera table = camera;
  camera.projection = Projection::panorama;
  table.projection = Projection::directions;
  table.azimuths = {-179.5f, 179.5f};
  table.elevations = {89.5f, -89.5f};

  const CameraFrame panorama = makeCameraFrame(camera, 360, 360);
  const CameraFrame lidar = makeCameraFrame(table, 360, 360);
  const Vec3d eye(camera.eye);
  const double parallax = std::asin(kEyes / 2 / kDistance);

  for (const double degrees : {-170.0, -90.0, 0.0, 45.0, 90.0, 170.0}) {
    const double azimuth = degrees * kPi / 180;
    const Vec3d point = eye + Vec3d{std::sin(azimuth), 0, -std::cos(azimuth)} * kDistance;
    for (const double side : {-1.0, 1.0}) {
      // The left eye sees the point further to the right.
      const double x = 180 + (azimuth - side * parallax) * 180 / kPi;
      const double y = side < 0 ? 90 : 270;

      const Ray ray = generateRay(panorama, x, y);
      EXPECT_NEAR(length(ray.origin - eye), kEyes / 2, 1e-12);
      EXPECT_LT(length(cross(point - ray.origin, ray.direction)), 1e-12) << degrees << " " << side;
      EXPECT_GT(dot(point - ray.origin, ray.direction), 0) << degrees;
    }
  }

  // The table has the same angles. Its rows are 180 degrees high and its columns 2 wide.
  for (const double x : {40.5, 180.5, 300.5}) {
    const Ray ray = generateRay(lidar, x, 90.5);
    const Vec3d across = ray.origin - eye;
    EXPECT_NEAR(length(across), kEyes / 2, 1e-12);
    EXPECT_NEAR(dot(across, ray.direction), 0, 1e-12);
  }
}

}  // namespace
}  // namespace whit::reference
