// Normals of meshes whose files have none.
#include <cmath>
#include <numbers>

#include "core/vec3.h"
#include "io/smooth_normals.h"
#include "scene_files.h"

namespace whit {
namespace {

// The corners of a regular prism of height 2 about the y axis, and its faces, whose sides are
// quads and whose ends are polygons of n corners.
struct Prism {
  std::vector<Vec3d> corners;
  std::vector<std::vector<int>> faces;
};

Prism prism(int n) {
  Prism made;
  made.faces.resize(2);
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    for (const double y : {-1.0, 1.0})
      made.corners.emplace_back(std::cos(angle), y, std::sin(angle));
    const int a = 2 * i, b = 2 * ((i + 1) % n);
    made.faces.push_back({a, a + 1, b + 1, b});
    made.faces[0].push_back(a);
    made.faces[1].insert(made.faces[1].begin(), a + 1);
  }
  return made;
}

class SmoothNormals : public SceneFileTest {
 protected:
  Mesh loadPly(const Prism& p) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(p.corners.size()) +
                       "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                       std::to_string(p.faces.size()) +
                       "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const Vec3d& c : p.corners) text += line({c.x, c.y, c.z});
    for (const auto& face : p.faces) {
      text += std::to_string(face.size());
      for (const int corner : face) text += " " + std::to_string(corner);
      text += "\n";
    }
    return load(save("m.ply", text)).objects.at(0).meshes.at(0);
  }

  Mesh loadObjOf(const Prism& p, const std::string& smoothing) {
    std::string text = smoothing;
    for (const Vec3d& c : p.corners) text += "v " + line({c.x, c.y, c.z});
    for (const auto& face : p.faces) {
      text += "f";
      for (const int corner : face) text += " " + std::to_string(corner + 1);
      text += "\n";
    }
    return loadObj(text).objects.at(0).meshes.at(0);
  }

  static std::string line(const std::vector<double>& numbers) {
    std::string text;
    for (const double x : numbers) text += std::to_string(x) + " ";
    return text + "\n";
  }
};

// The sides of a prism of 12 corners meet at 30 degrees: their normals point away from the axis,
// whichever way the quads were split. The ends meet them at 90 degrees and stay flat.
void expectRound(const Mesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), 4u * 12u) << "each corner is split once";
  ASSERT_EQ(mesh.positions.size(), mesh.normals.size());
  EXPECT_FALSE(mesh.hasFlatFaces);
  constexpr double kBound = 3e-6;  // corners are written with six digits
  for (const auto& t : mesh.triangles) {
    const auto at = [&](std::size_t i) { return Vec3d(mesh.positions[t[i]]); };
    const bool isEnd = at(0).y == at(1).y && at(0).y == at(2).y;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d expected = isEnd ? Vec3d{0, at(i).y, 0} : Vec3d{at(i).x, 0, at(i).z};
      EXPECT_LT(length(Vec3d(mesh.normals[t[i]]) - expected), kBound);
    }
  }
}

TEST_F(SmoothNormals, OfARoundPrismPointAwayFromTheAxis) {
  expectRound(loadPly(prism(12)));
  expectRound(loadObjOf(prism(12), ""));
  EXPECT_EQ(kinds(), "");
}

// 45 degrees are an edge.
TEST_F(SmoothNormals, OfAnAngularPrismAreThoseOfItsFaces) {
  EXPECT_TRUE(loadPly(prism(8)).normals.empty());
  EXPECT_TRUE(loadObjOf(prism(8), "").normals.empty());
  EXPECT_EQ(loadPly(prism(8)).positions.size(), 16u);
}

TEST_F(SmoothNormals, GiveWayToWhatTheFileSays) {
  EXPECT_TRUE(loadObjOf(prism(12), "s off\n").normals.empty());
  EXPECT_TRUE(loadObjOf(prism(12), "vn 0 1 0\n").normals.empty());
}

// Vertices at the same place count as one: each face has its own here.
TEST_F(SmoothNormals, LookBeyondSharedVertices) {
  Mesh mesh;
  const Prism made = prism(12);
  for (std::size_t f = 2; f < made.faces.size(); ++f) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const int corner : made.faces[f]) {
      mesh.positions.emplace_back(made.corners[static_cast<std::size_t>(corner)]);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }

  MemoryBudget budget(1 << 20);
  smoothNormals(mesh, "test", budget);
  ASSERT_EQ(mesh.normals.size(), 48u);
  for (std::size_t i = 0; i < 48; ++i) {
    const Vec3f& p = mesh.positions[i];
    EXPECT_LT(length(mesh.normals[i] - Vec3f{p.x, 0, p.z}), 1e-6f);
  }

  MemoryBudget small(100);
  EXPECT_THROW(smoothNormals(mesh, "test", small), Error);
}

}  // namespace
}  // namespace whit
