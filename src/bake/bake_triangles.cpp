#include "bake/bake_triangles.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace whit {

namespace {

// From here on a float has 19 bits or fewer for the fraction: less than 1/32 texel at 16384 texels
// (hard case H68).
constexpr float kFarUv = 16;

void recenter(float* coordinate) {
  const auto [low, high] = std::minmax({coordinate[0], coordinate[2], coordinate[4]});
  if (!(low > kFarUv || high < -kFarUv)) return;
  const double whole = std::floor(static_cast<double>(low));
  for (int i = 0; i < 6; i += 2) coordinate[i] = static_cast<float>(coordinate[i] - whole);
}

float finiteOrZero(float x, std::uint64_t& repaired) {
  if (std::isfinite(x)) return x;
  ++repaired;
  return 0;
}

// Lengths that differ by less differ by rounding: of unit vectors in float, and of maps that turn
// and scale evenly but come from a file of floats.
constexpr double kSameLength = 1e-6;

// Carries unit normals n by the inverse transpose of `map`, up to a common factor: the unit normal
// m that n ends as has had the length 1 / |transpose(map) m|. Records of maps that keep angles are
// left as they are.
void giveLengths(const Affine& map, NormalRecord& record) {
  std::array<double, 3> inverse{};
  for (const auto i : indices(3)) {
    const float* m = record.normal + 3 * i;
    const Vec3d normal(m[0], m[1], m[2]);
    inverse[i] = length(Vec3d(dot(map.x, normal), dot(map.y, normal), dot(map.z, normal)));
  }

  const auto [least, most] = std::minmax({inverse[0], inverse[1], inverse[2]});
  if (!(least > 0) || !(most - least > kSameLength * most)) return;

  // Only ratios matter, so the longest normal keeps the length 1.
  for (const auto i : indices(9)) {
    const double component = static_cast<double>(record.normal[i]);
    record.normal[i] = static_cast<float>(component * (least / inverse[i / 3]));
  }
}

// Copies the texture coordinates of a triangle to the six numbers `to`.
void copyUvs(const std::vector<Vec2f>& uvs, const std::array<std::uint32_t, 3>& corners,
             const MaterialUse& use, float* to, std::uint64_t& repaired) {
  if (uvs.empty()) return;

  for (const auto i : indices(3)) {
    const Vec2f& uv = uvs[corners[i]];
    to[2 * i] = finiteOrZero(uv.x, repaired);
    to[2 * i + 1] = finiteOrZero(uv.y, repaired);
  }
  if (use.repeatU) recenter(to);
  if (use.repeatV) recenter(to + 1);
}

struct Dropped {
  Tally badIndex, badCorner, degenerate;
};

bool isUsable(const Vec3f& p) { return isFinite(p) && maxComponent(abs(p)) <= kLargestCoordinate; }

// Returns whether the triangle is to be dropped, and counts it. A triangle that bends may have an
// area at another time.
bool drop(const std::array<std::uint32_t, 3>& corners, const Vec3f* position, std::size_t vertices,
          std::size_t triangle, bool bends, Dropped& dropped) {
  const auto& [i, j, k] = corners;
  if (i >= vertices || j >= vertices || k >= vertices) {
    dropped.badIndex.add(triangle);
    return true;
  }

  const Vec3f &a = position[i], &b = position[j], &c = position[k];
  if (!isUsable(a) || !isUsable(b) || !isUsable(c)) {
    dropped.badCorner.add(triangle);
    return true;
  }

  if (!bends && areaVector(a, b, c) == Vec3d{}) {
    dropped.degenerate.add(triangle);
    return true;
  }
  return false;
}

}  // namespace

MaterialUse useOf(const Material& material, const std::vector<Texture>& textures) {
  MaterialUse use;
  const bool masked =
      !material.doubleSided || (material.alphaMap != kNoTexture && material.alphaCutoff > 0);
  use.triangleClass = static_cast<std::uint8_t>((material.castsShadow ? 0 : kNoShadowBit) |
                                                (masked ? kMaskedBit : 0));

  // Whole numbers may be subtracted along an axis only if every texture repeats along it.
  bool textured = false, u = true, v = true;
  for (const std::int32_t map : material.maps()) {
    if (map == kNoTexture) continue;

    const Texture& texture = entryOf(textures, map);
    textured = true;
    u = u && texture.wrapU == Wrap::repeat;
    v = v && texture.wrapV == Wrap::repeat;
  }

  use.repeatU = textured && u;
  use.repeatV = textured && v;
  return use;
}

Vec3d faceNormal(const TriangleRecord& record) {
  const float* p = record.position;
  return normalized(areaVector({p[0], p[1], p[2]}, {p[3], p[4], p[5]}, {p[6], p[7], p[8]}));
}

TriangleRecord makeTriangleRecord(const Mesh& mesh, std::size_t triangle,
                                  const std::vector<Vec3f>& position,
                                  const std::array<std::uint32_t, 3>& corners,
                                  const MaterialUse& use, std::uint64_t& repaired) {
  TriangleRecord record{};
  for (const auto i : indices(3)) {
    const Vec3f& p = position[corners[i]];
    std::copy_n(&p.x, 3, record.position + 3 * i);
  }

  copyUvs(mesh.uvs, mesh.triangles[triangle], use, record.uv, repaired);
  record.material = mesh.material(triangle);
  return record;
}

UvRecord makeSecondUvRecord(const Mesh& mesh, std::size_t triangle, const MaterialUse& use,
                            std::uint64_t& repaired) {
  UvRecord record{};
  copyUvs(mesh.secondUvs, mesh.triangles[triangle], use, record.uv, repaired);
  return record;
}

NormalRecord makeNormalRecord(const Mesh& mesh, std::size_t triangle, const TriangleRecord& record,
                              std::uint64_t& repaired) {
  NormalRecord result;
  // The normal of the face is computed when the first corner needs it.
  Vec3f face;
  for (const auto i : indices(3)) {
    Vec3f n;
    if (!mesh.normals.empty()) {
      n = mesh.normals[mesh.triangles[triangle][i]];
      repaired += n == Vec3f{} && !mesh.hasFlatFaces;
    }

    if (n == Vec3f{}) {
      if (face == Vec3f{}) face = Vec3f(faceNormal(record));
      n = face;
    }
    std::copy_n(&n.x, 3, result.normal + 3 * i);
  }

  if (!(mesh.fromModel == Affine())) giveLengths(mesh.fromModel, result);
  return result;
}

ColorRecord makeColorRecord(const Mesh& mesh, std::size_t triangle, std::uint64_t& repaired) {
  ColorRecord record;
  for (const auto i : indices(3)) {
    const Rgb given = mesh.colors.empty() ? Rgb(1.0f) : mesh.colors[mesh.triangles[triangle][i]];
    for (int channel = 0; channel < 3; ++channel) {
      // A NaN becomes 0. It differs from every number, so it counts as repaired.
      const float x = given[channel], inRange = x > 0 ? std::min(x, 1.0f) : 0.0f;
      repaired += !(x == inRange);
      record.color[3 * i + static_cast<std::size_t>(channel)] = inRange;
    }
  }
  return record;
}

TriangleClassification classifyTriangles(const Mesh& mesh, const Vec3f* position,
                                         std::size_t vertices, const std::vector<MaterialUse>& uses,
                                         Warnings& warnings) {
  Dropped dropped;
  TriangleClassification result;
  result.classes.resize(mesh.triangles.size());

  for (const auto i : indices(mesh.triangles)) {
    const bool out =
        drop(mesh.triangles[i], position, vertices, i, mesh.deformation != nullptr, dropped);
    result.classes[i] = out ? kDroppedClass : uses[mesh.material(i)].triangleClass;
    ++result.count[result.classes[i]];
  }

  dropped.badIndex.report(warnings, "triangle with a vertex index out of range dropped", mesh);
  dropped.badCorner.report(warnings, "triangle with a non-finite or enormous corner dropped", mesh);
  dropped.degenerate.report(warnings, "degenerate triangle dropped", mesh);

  const bool nothingLeft =
      !mesh.triangles.empty() && result.count[kDroppedClass] == mesh.triangles.size();
  if (nothingLeft) {
    warnings.add("mesh with nothing to draw: all its triangles were dropped",
                 "mesh '" + mesh.name + "'");
  }
  return result;
}

}  // namespace whit
