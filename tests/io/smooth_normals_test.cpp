// Normals of meshes whose files have none.
#include "io/smooth_normals.h"

#include "solids.h"

namespace whit {
namespace {

class SmoothNormals : public SceneFileTest {
 protected:
  Mesh loadPly(const Solid& solid) {
    return meshOf(
        load(save("m.ply", joined("ply\nformat ascii 1.0\nelement vertex ", solid.corners.size(),
                                  "\nproperty double x\nproperty double y\nproperty double z\n"
                                  "element face ",
                                  solid.faces.size(),
                                  "\nproperty list uchar int vertex_indices\nend_header\n",
                                  linesOf(solid)))));
  }

  Mesh loadObjOf(const Solid& solid, const std::string& smoothing = "") {
    return meshOf(loadObj(smoothing + objOf(solid)));
  }

  const Solid round_ = prism(12, 1), angular_ = prism(8, 1);
};

// The sides of a prism of 12 corners meet at 30 degrees: their normals point away from the axis,
// whichever way the quads were split. The ends meet them at 90 degrees and stay flat.
void expectRound(const Mesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), 4u * 12u) << "each corner is split once";
  ASSERT_EQ(mesh.positions.size(), mesh.normals.size());
  EXPECT_FALSE(mesh.hasFlatFaces);
  constexpr double kBound = 3e-6;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](std::size_t i) { return Vec3d(mesh.positions[t[i]]); };
    const bool isEnd = at(0).y == at(1).y && at(0).y == at(2).y;
    for (const auto i : indices(3)) {
      const Vec3d expected = isEnd ? Vec3d{0, at(i).y, 0} : Vec3d{at(i).x, 0, at(i).z};
      EXPECT_LT(length(Vec3d(mesh.normals[t[i]]) - expected), kBound);
    }
  }
}

TEST_F(SmoothNormals, OfARoundPrismPointAwayFromTheAxis) {
  expectRound(loadPly(round_));
  expectRound(loadObjOf(round_));
  expectNoWarnings();
}

// 45 degrees are an edge.
TEST_F(SmoothNormals, OfAnAngularPrismAreThoseOfItsFaces) {
  EXPECT_TRUE(loadPly(angular_).normals.empty());
  EXPECT_TRUE(loadObjOf(angular_).normals.empty());
  EXPECT_EQ(loadPly(angular_).positions.size(), 16u);
}

TEST_F(SmoothNormals, GiveWayToWhatTheFileSays) {
  EXPECT_TRUE(loadObjOf(round_, "s off\n").normals.empty());
  EXPECT_TRUE(loadObjOf(round_, "vn 0 1 0\n").normals.empty());
}

// Vertices at the same place count as one: each face has its own here.
TEST_F(SmoothNormals, LookBeyondSharedVertices) {
  Mesh mesh;
  for (std::size_t f = 2; f < round_.faces.size(); ++f) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const int corner : round_.faces[f]) {
      mesh.positions.emplace_back(round_.corners[static_cast<std::size_t>(corner)]);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }

  MemoryBudget budget(1 << 20);
  smoothNormals(mesh, "test", budget);
  ASSERT_EQ(mesh.normals.size(), 48u);
  for (const auto i : indices(48)) {
    const Vec3f& p = mesh.positions[i];
    EXPECT_LT(length(mesh.normals[i] - Vec3f{p.x, 0, p.z}), 1e-6f);
  }

  MemoryBudget small(100);
  EXPECT_THROW(smoothNormals(mesh, "test", small), Error);
}

}  // namespace
}  // namespace whit
