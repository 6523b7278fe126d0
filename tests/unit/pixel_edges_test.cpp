// Which pixels are edges.
#include "pi.h"
#include "sampling/adaptive_pixels.h"

#include <gtest/gtest.h>

#include <cmath>

namespace whit::test {
namespace {

using Marks = std::vector<std::uint8_t>;

constexpr double kDegree = kPi / 180;

PixelSurface pointOnFloor(float x, float z) { return {1, 7, {x, 0, z}, {0, 1, 0}}; }

TEST(OnSameSurface, MaterialInstanceAndNothing) {
  const PixelSurface a = pointOnFloor(0, 0);
  PixelSurface b = pointOnFloor(1, 0);
  EXPECT_TRUE(onSameSurface(a, b));
  b.material = 2;
  EXPECT_FALSE(onSameSurface(a, b));
  b = pointOnFloor(1, 0);
  b.instance = 8;
  EXPECT_FALSE(onSameSurface(a, b));

  EXPECT_FALSE(onSameSurface(a, PixelSurface{}));
  EXPECT_TRUE(onSameSurface(PixelSurface{}, PixelSurface{}));
}

TEST(OnSameSurface, NormalsMayTurnByFiveDegrees) {
  const auto turned = [](double degrees) {
    PixelSurface s = pointOnFloor(1, 0);
    s.normal = Vec3f(Vec3d(std::sin(degrees * kDegree), std::cos(degrees * kDegree), 0));
    return s;
  };
  EXPECT_TRUE(onSameSurface(pointOnFloor(0, 0), turned(4.9)));
  EXPECT_FALSE(onSameSurface(pointOnFloor(0, 0), turned(5.1)));
}

// Parallel planes of the same material are two surfaces, at any scale.
TEST(OnSameSurface, ParallelPlanesAreTwoSurfaces) {
  for (const float scale : {1e-6f, 1.0f, 1e6f}) {
    const PixelSurface a = pointOnFloor(0, 0);
    PixelSurface b = pointOnFloor(scale, 0);
    for (const float height : {0.0f, 0.08f, 0.1f, -0.1f}) {
      b.position.y = height * scale;
      EXPECT_EQ(onSameSurface(a, b), std::abs(height) < 0.09f) << height;
    }
  }
}

struct Frame {
  Frame(int width, int height) {
    display.width = width;
    display.height = height;
    display.rgba.assign(4 * width * height, 100);
    for (int i = 0; i < width * height; ++i) {
      surfaces.push_back(
          pointOnFloor(static_cast<float>(i % width), static_cast<float>(i / width)));
    }
  }

  Marks edges(int contrast = 8) const {
    Marks found(surfaces.size(), 2);
    findEdges(display, surfaces, contrast, 0, display.height, found);
    return found;
  }

  DisplayImage display;
  std::vector<PixelSurface> surfaces;
};

// A single pixel that is different marks itself and its eight neighbors, both inside the picture
// and in a corner.
TEST(FindEdges, MarkBothSides) {
  for (const auto& [cx, cy] : {std::pair(3, 2), {0, 0}, {6, 4}}) {
    Frame bySurface(7, 5), byContrast(7, 5);
    bySurface.surfaces[7 * cy + cx].material = 3;
    byContrast.display.rgba[4 * (7 * cy + cx) + 1] = 109;

    Marks expected;
    for (int i = 0; i < 7 * 5; ++i) {
      expected.push_back(std::abs(i % 7 - cx) <= 1 && std::abs(i / 7 - cy) <= 1);
    }
    EXPECT_EQ(bySurface.edges(), expected);
    EXPECT_EQ(byContrast.edges(), expected);
  }
}

TEST(FindEdges, ContrastMustExceedTheThreshold) {
  Frame frame(3, 1);
  frame.display.rgba[4] = 108;
  EXPECT_EQ(frame.edges(8), (Marks{0, 0, 0}));
  EXPECT_EQ(frame.edges(7), (Marks{1, 1, 1}));

  // Opacity does not count as contrast.
  frame.display.rgba[4] = 100;
  frame.display.rgba[7] = 0;
  EXPECT_EQ(frame.edges(0), (Marks{0, 0, 0}));
}

TEST(Grown, StaysInsideTheImage) {
  EXPECT_EQ(grown({2, 3, 5, 6}, 1, 10, 10), (Crop{1, 2, 6, 7}));
  EXPECT_EQ(grown({1, 3, 5, 9}, 2, 10, 10), (Crop{0, 1, 7, 10}));
  EXPECT_EQ(grown({0, 0, 10, 10}, 2, 10, 10), (Crop{0, 0, 10, 10}));
}

}  // namespace
}  // namespace whit::test
