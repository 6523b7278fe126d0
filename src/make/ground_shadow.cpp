#include "make/ground_shadow.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <vector>

#include "core/index.h"
#include "core/machine_limits.h"
#include "core/worker_pool.h"
#include "make/patterns/noise.h"
#include "make/placed_triangles.h"

namespace whit {
namespace {

constexpr int kSide = 256;  // texels
constexpr std::size_t kDirections = 256;
constexpr std::uint64_t kMostTriangles = 1'000'000;
// The shadow fades out over this share of the sheet's half width.
constexpr double kFade = 0.3;
// Distance of the sheet from the lowest point of the model, over the model's radius.
constexpr double kBelow = 1.0e-3;

// One number for each texel, in rows along z.
using TexelCounts = std::vector<int>;

// Returns the map that moves points along the i-th direction onto the sheet, in texels; `texels` is
// their number in a unit of length. The directions lie on a spiral in a disk (Vogel 1979), lifted
// to the hemisphere above it, where they are as dense as the cosine of their angle to the vertical.
Affine ontoSheet(std::size_t i, double texels) {
  constexpr double kGoldenAngle = 2.399963229728653;
  const double square = (static_cast<double>(i) + 0.5) / kDirections;
  const double slope = std::sqrt(square / (1 - square)),
               angle = kGoldenAngle * static_cast<double>(i);

  // Centers of texels are at whole numbers.
  constexpr double kMiddle = (kSide - 1) / 2.0;
  const Vec3d lean{texels * slope * std::cos(angle), 0, texels * slope * std::sin(angle)};
  return {{texels, 0, 0}, lean, {0, 0, texels}, {kMiddle, 0, kMiddle}};
}

// Sets the texels whose centers the triangle holds.
void cover(const Corners& t, TexelCounts& silhouette) {
  const auto [left, right] = std::minmax({t[0].x, t[1].x, t[2].x});
  const auto [top, bottom] = std::minmax({t[0].z, t[1].z, t[2].z});
  const auto within = [](double x) { return static_cast<int>(std::clamp<double>(x, 0, kSide)); };

  for (int z = within(std::ceil(top)); z < within(std::floor(bottom) + 1); ++z) {
    for (int x = within(std::ceil(left)); x < within(std::floor(right) + 1); ++x) {
      // Centers on an edge belong to both of its triangles, so that there is no gap between them.
      const Vec3d center(x, 0, z);
      const auto side = [&](const Vec3d& a, const Vec3d& b) { return cross(b - a, center - a).y; };
      const auto [least, most] =
          std::minmax({side(t[0], t[1]), side(t[1], t[2]), side(t[2], t[0])});
      if (least >= 0 || most <= 0) silhouette[z * kSide + x] = 1;
    }
  }
}

// Counts the directions in which each texel sees the model above it. `center` is that of the sheet.
TexelCounts countCovered(const SceneDescription& scene, const Vec3d& center, double texels) {
  std::vector<Corners> triangles;
  forEachPlacedTriangle(scene, kMostTriangles, [&](const Corners& t) {
    triangles.push_back({t[0] - center, t[1] - center, t[2] - center});
  });

  TexelCounts counts(std::size_t{kSide} * kSide);
  std::mutex mutex;
  parallelFor(usableThreads(), kDirections, [&](std::size_t i, int) {
    const Affine map = ontoSheet(i, texels);
    TexelCounts silhouette(counts.size());
    for (const auto& [a, b, c] : triangles) {
      cover({map.point(a), map.point(b), map.point(c)}, silhouette);
    }

    const std::lock_guard lock(mutex);
    std::ranges::transform(counts, silhouette, counts.begin(), std::plus());
  });
  return counts;
}

Texture shadowOf(const TexelCounts& counts) {
  Texture texture = emptyTexture(kGroundShadowName, TexelFormat::data, kSide, kSide);
  texture.wrapU = texture.wrapV = Wrap::clamp;
  for (int i = 0; i < kSide * kSide; ++i) {
    constexpr double kHalf = kSide / 2.0;
    const int column = i % kSide, row = i / kSide;
    const double across = (column + 0.5) / kHalf - 1, along = (row + 0.5) / kHalf - 1;
    const double fade = procedural::smoothStep(0, kFade, 1 - std::hypot(across, along));
    const std::size_t texel = i;
    const auto opacity = static_cast<float>(fade * counts[texel] / kDirections);
    texture.texels[texel] = encodeDataTexel(opacity, 0, 0, 1);
  }
  return texture;
}

}  // namespace

void addGroundShadow(SceneDescription& scene) {
  BoxOf<Vec3d> box;
  forEachPlacedCorner(scene, kEveryTriangle, [&](const Vec3d& corner) { box.add(corner); });
  const Vec3d size = box.half();
  const double radius = length(size);
  if (box.empty() || !(radius > 0)) return;

  const double half = std::hypot(size.x, size.z) + radius;
  const Vec3d center = box.center() - Vec3d{0, size.y + kBelow * radius, 0};
  Texture shadow = shadowOf(countCovered(scene, center, kSide / (2 * half)));

  Material material;
  material.name = kGroundShadowName;
  material.diffuse = Rgb(0.0f);
  material.coverageMap = static_cast<std::int32_t>(scene.textures.size());
  material.passClearTexels();
  material.castsShadow = material.doubleSided = false;

  // The rows of the texture begin at v = 1, where z is least.
  Mesh mesh;
  for (const Vec2f& uv : {Vec2f{0, 0}, Vec2f{1, 0}, Vec2f{1, 1}, Vec2f{0, 1}}) {
    const Vec3d way{2.0 * double{uv.x} - 1, 0, 1 - 2.0 * double{uv.y}};
    mesh.positions.emplace_back(center + way * half);
    mesh.uvs.push_back(uv);
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.materials = {static_cast<std::uint32_t>(scene.materials.size())};

  // The sheet is the last item of the scene.
  Instance instance;
  instance.object = static_cast<std::uint32_t>(scene.objects.size());
  instance.firstItem = scene.items;
  if (scene.itemNames.size() == scene.items) scene.itemNames.emplace_back(kGroundShadowName);
  ++scene.items;

  scene.textures.push_back(std::move(shadow));
  scene.materials.push_back(std::move(material));
  scene.objects.push_back({kGroundShadowName, {std::move(mesh)}});
  scene.instances.push_back(instance);
}

}  // namespace whit
