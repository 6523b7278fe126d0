// Which pixels are edges.
#include "pi.h"
#include "sampling/adaptive_pixels.h"

#include <gtest/gtest.h>

#include <cmath>

namespace whit::test {
namespace {

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
    PixelSurface a = pointOnFloor(0, 0), b = pointOnFloor(scale, 0);
    EXPECT_TRUE(onSameSurface(a, b));
    b.position.y = 0.08f * scale;
    EXPECT_TRUE(onSameSurface(a, b));
    b.position.y = 0.1f * scale;
    EXPECT_FALSE(onSameSurface(a, b));
    b.position.y = -0.1f * scale;
    EXPECT_FALSE(onSameSurface(a, b));
  }
}

struct Frame {
  Frame(int width, int height) {
    display.width = width;
    display.height = height;
    display.rgba.assign(static_cast<std::size_t>(4 * width * height), 100);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        surfaces.push_back(pointOnFloor(static_cast<float>(x), static_cast<float>(y)));
      }
    }
  }

  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * display.width + x); }

  std::vector<std::uint8_t> edges(int contrast = 8, int bands = 1) const {
    std::vector<std::uint8_t> found(surfaces.size(), 2);
    for (int i = 0; i < bands; ++i) {
      findEdges(display, surfaces, contrast, display.height * i / bands,
                display.height * (i + 1) / bands, found);
    }
    return found;
  }

  DisplayImage display;
  std::vector<PixelSurface> surfaces;
};

// A single pixel that is different marks itself and its eight neighbors, both inside the picture
// and in a corner.
TEST(FindEdges, MarkBothSides) {
  for (const auto& [cx, cy] : {std::pair(3, 2), std::pair(0, 0), std::pair(6, 4)}) {
    Frame bySurface(7, 5), byContrast(7, 5);
    bySurface.surfaces[bySurface.at(cx, cy)].material = 3;
    byContrast.display.rgba[4 * byContrast.at(cx, cy) + 1] = 109;
    const auto surface = bySurface.edges(), contrast = byContrast.edges();

    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 7; ++x) {
        const bool near = std::abs(x - cx) <= 1 && std::abs(y - cy) <= 1;
        EXPECT_EQ(surface[bySurface.at(x, y)], near) << x << "," << y;
        EXPECT_EQ(contrast[byContrast.at(x, y)], near) << x << "," << y;
      }
    }
  }
}

TEST(FindEdges, ContrastMustExceedTheThreshold) {
  Frame frame(3, 1);
  frame.display.rgba[4] = 108;
  EXPECT_EQ(frame.edges(8), (std::vector<std::uint8_t>{0, 0, 0}));
  EXPECT_EQ(frame.edges(7), (std::vector<std::uint8_t>{1, 1, 1}));

  // Opacity does not count as contrast.
  frame.display.rgba[4] = 100;
  frame.display.rgba[7] = 0;
  EXPECT_EQ(frame.edges(0), (std::vector<std::uint8_t>{0, 0, 0}));
}

TEST(FindEdges, BandsGiveWhatTheWholeGives) {
  Frame frame(13, 11);
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < frame.surfaces.size(); ++i) {
    state = state * 1664525u + 1013904223u;
    if (state >> 29 == 0) frame.surfaces[i].material = 2;
  }

  for (const int bands : {2, 3, 11}) EXPECT_EQ(frame.edges(8, bands), frame.edges());
}

TEST(Grown, StaysInsideTheImage) {
  EXPECT_EQ(grown({2, 3, 5, 6}, 1, 10, 10), (Crop{1, 2, 6, 7}));
  EXPECT_EQ(grown({1, 3, 5, 9}, 2, 10, 10), (Crop{0, 1, 7, 10}));
  EXPECT_EQ(grown({0, 0, 10, 10}, 2, 10, 10), (Crop{0, 0, 10, 10}));
}

}  // namespace
}  // namespace whit::test
