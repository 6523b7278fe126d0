// The kernels that bend meshes, against their scalar reference, bit for bit.
#include "simd/deform_vertices.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "simd/kernels.h"

namespace whit::test {
namespace {

// Any mesh, with some joints that mirror.
class AnyDeformation {
 public:
  AnyDeformation(std::uint32_t seed, std::size_t count) : random_(seed), count_(count) {}

  Deformation make(bool normals, bool skin) {
    Deformation d;
    d.positions = vectors();
    if (normals) d.normals = vectors();
    for (int i = 0; i < 3; ++i) {
      d.targets.push_back({vectors(), normals ? vectors() : std::vector<Vec3f>()});
    }
    d.targets[1].positions.resize(count_ / 2);
    if (skin) addSkin(d);
    return d;
  }

  DeformationPose pose(const Deformation& d) {
    DeformationPose pose;
    pose.weights = {number(), 0, number()};
    for (std::size_t i = 0; i < d.joints.size(); ++i) {
      pose.joints.push_back({vector(), vector(), vector(), vector()});
    }
    return pose;
  }

 private:
  static constexpr std::uint32_t kJoints = 5;

  double number() { return std::uniform_real_distribution<double>(-2, 2)(random_); }
  Vec3d vector() { return {number(), number(), number()}; }
  std::vector<Vec3f> vectors() {
    std::vector<Vec3f> all;
    for (std::size_t i = 0; i < count_; ++i) all.emplace_back(vector());
    return all;
  }
  void addSkin(Deformation& d) {
    d.skeleton = std::make_shared<const Rig>(Rig(1));
    d.joints.resize(kJoints);
    d.firstInfluence = {0};
    for (std::size_t i = 0; i < count_; ++i) {
      for (auto k = 1 + random_() % 6; k > 0; --k) {
        d.influences.push_back({static_cast<std::uint32_t>(random_() % kJoints), number() + 2.5});
      }
      d.firstInfluence.push_back(static_cast<std::uint32_t>(d.influences.size()));
    }
  }

  std::mt19937 random_;
  std::size_t count_;
};

void expectReference(const Deformation& deformation, const DeformationPose& pose) {
  const DeformedVertices scalar = deformVertices(deformation, pose);
  const DeformedVertices bent = simd::deformVertices(deformation, pose);
  EXPECT_EQ(bent.positions, scalar.positions);
  EXPECT_EQ(bent.normals, scalar.normals);
  EXPECT_EQ(bent.sides, scalar.sides);
}

class DeformKernels : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { simd::chooseTarget(GetParam()); }
  void TearDown() override { simd::chooseTarget("auto"); }
};

TEST_P(DeformKernels, BendAsTheirReference) {
  for (const std::size_t count : {0u, 1u, 7u, 8u, 9u, 200u}) {
    for (const bool normals : {false, true}) {
      for (const bool skin : {false, true}) {
        AnyDeformation any(static_cast<std::uint32_t>(count), count);
        const Deformation deformation = any.make(normals, skin);
        SCOPED_TRACE(std::to_string(count) + (normals ? " normals" : "") + (skin ? " skin" : ""));
        expectReference(deformation, any.pose(deformation));
      }
    }
  }
}

// Where squares of components leave the range of numbers, and where there is no direction.
TEST_P(DeformKernels, KeepNormalsThatAreTinyOrHuge) {
  AnyDeformation any(3, 40);
  const Deformation deformation = any.make(true, true);
  for (const double size :
       {1e-190, 1e-90, 0.0, 1e60, 1e150, std::numeric_limits<double>::infinity()}) {
    DeformationPose pose = any.pose(deformation);
    for (Affine& joint : pose.joints) {
      joint = {joint.x * size, joint.y * size, joint.z * size, joint.p};
    }
    SCOPED_TRACE(size);
    const DeformedVertices scalar = deformVertices(deformation, pose);
    EXPECT_EQ(simd::deformVertices(deformation, pose).normals, scalar.normals);
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, DeformKernels, testing::ValuesIn(simd::availableTargets()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace whit::test
