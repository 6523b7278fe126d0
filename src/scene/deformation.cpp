#include "scene/deformation.h"

#include <algorithm>

namespace whit {

namespace {

std::vector<Vec3d> widened(const std::vector<Vec3f>& all) { return {all.begin(), all.end()}; }

void add(const std::vector<Vec3f>& moved, double weight, std::vector<Vec3d>& to) {
  for (std::size_t i = 0; i < std::min(moved.size(), to.size()); ++i) {
    to[i] = to[i] + Vec3d(moved[i]) * weight;
  }
}

std::vector<Affine> poseJoints(const Deformation& deformation, double seconds) {
  const std::vector<Affine> poses = poseRig(*deformation.skeleton, seconds);
  std::vector<Affine> maps;
  for (const Deformation::Joint& joint : deformation.joints) {
    maps.push_back(poses[joint.node] * joint.fromMesh);
  }
  return maps;
}

Affine scaled(const Affine& map, double by) {
  return {map.x * by, map.y * by, map.z * by, map.p * by};
}

Affine blended(const std::vector<Affine>& joints, const Influence* begin, const Influence* end) {
  Affine map{{}, {}, {}, {}};
  double sum = 0;
  for (const Influence* i = begin; i != end; ++i) {
    const Affine& joint = joints[i->joint];
    const double w = i->weight;
    map = {map.x + joint.x * w, map.y + joint.y * w, map.z + joint.z * w, map.p + joint.p * w};
    sum += w;
  }
  return scaled(map, 1 / sum);
}

}  // namespace

bool Deformation::moves() const {
  if (movingWeights && !targets.empty()) return true;
  return hasSkin() && std::any_of(skeleton->begin(), skeleton->end(),
                                  [](const RigNode& node) { return node.motion != nullptr; });
}

bool turnsOver(const std::vector<double>& sides, const std::array<std::uint32_t, 3>& corners) {
  return !sides.empty() && sides[corners[0]] + sides[corners[1]] + sides[corners[2]] < 0;
}

DeformationPose poseAt(const Deformation& deformation, double seconds) {
  DeformationPose pose;
  pose.weights = deformation.movingWeights ? valueAt(*deformation.movingWeights, seconds)
                                           : deformation.weights;
  if (deformation.hasSkin()) pose.joints = poseJoints(deformation, seconds);
  return pose;
}

DeformedVertices deformVertices(const Deformation& deformation, const DeformationPose& pose) {
  std::vector<Vec3d> positions = widened(deformation.positions);
  std::vector<Vec3d> normals = widened(deformation.normals);
  for (std::size_t i = 0; i < std::min(pose.weights.size(), deformation.targets.size()); ++i) {
    if (pose.weights[i] == 0) continue;
    add(deformation.targets[i].positions, pose.weights[i], positions);
    add(deformation.targets[i].normals, pose.weights[i], normals);
  }
  DeformedVertices bent;
  if (deformation.hasSkin()) {
    bent.sides.assign(positions.size(), 1);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Influence* const all = deformation.influences.data();
      const Affine map = blended(pose.joints, all + deformation.firstInfluence[i],
                                 all + deformation.firstInfluence[i + 1]);
      positions[i] = map.point(positions[i]);
      if (i < normals.size()) normals[i] = map.normal(normals[i]);
      if (map.determinant() < 0) bent.sides[i] = -1;
    }
  }
  bent.positions.reserve(positions.size());
  for (const Vec3d& position : positions) bent.positions.emplace_back(position);
  bent.normals.reserve(normals.size());
  for (const Vec3d& normal : normals) bent.normals.emplace_back(normalized(normal, Vec3d()));
  return bent;
}

}  // namespace whit
