// A scene made in memory: a sheet that waves, in the light of a lamp.
//   made OUT.png
#include <whit/whit.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace {

constexpr std::uint32_t kSide = 65;  // vertices

std::vector<float> wavingCorners() {
  std::vector<float> positions;
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (std::uint32_t column = 0; column < kSide; ++column) {
      const float x = static_cast<float>(column) / 32.0f - 1;
      const float z = static_cast<float>(row) / 32.0f - 1;
      positions.insert(positions.end(), {x, 0.25f * std::cos(7 * std::hypot(x, z)), z});
    }
  }
  return positions;
}

std::vector<std::uint32_t> twoTrianglesACell() {
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t row = 0; row + 1 < kSide; ++row) {
    for (std::uint32_t column = 0; column + 1 < kSide; ++column) {
      const std::uint32_t a = row * kSide + column, b = a + kSide;
      triangles.insert(triangles.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  }
  return triangles;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: made OUT.png\n");
    return 2;
  }
  try {
    const std::vector<float> positions = wavingCorners();
    const std::vector<std::uint32_t> triangles = twoTrianglesACell();

    whit::api::SceneBuilder builder;
    builder.addMesh("sheet", {.positions = positions, .triangles = triangles});

    whit::api::Material red;
    red.diffuse = {0.8, 0.2, 0.1};
    red.mirror = {0.1, 0.1, 0.1};
    builder.addMaterial("red", red);
    builder.addInstance("sheet", "red");
    builder.addLight({.position = {2, 4, 1}, .intensity = {60, 60, 60}});
    builder.addCamera("front", {.eye = {0, 2, 3}, .at = {0, 0, 0}});
    builder.set("/sky", R"({"color": [0.4, 0.5, 0.7]})").set("/ambient", R"({"fromSky": 0.5})");

    whit::api::Renderer renderer(builder.build());
    renderer.set("size", "160x100").set("spp", "4");
    renderer.render().write(argv[1]);
    std::printf("%llu triangles\n", static_cast<unsigned long long>(renderer.scene().triangles()));
  } catch (const whit::api::Error& error) {
    std::fprintf(stderr, "made: %s\n", error.what());
    return error.status();
  }
}
