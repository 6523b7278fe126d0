#include "scene/motion.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/index.h"

namespace whit {
namespace {

using Values = std::span<const double>;

Values valuesOf(const Track& track, std::size_t key, std::size_t part) {
  const std::size_t each = track.interpolation == Track::Interpolation::cubic ? 3 : 1;
  return Values(track.values).subspan((key * each + part) * track.components, track.components);
}

Values valueOf(const Track& track, std::size_t key) {
  return valuesOf(track, key, track.interpolation == Track::Interpolation::cubic ? 1 : 0);
}

std::vector<double> blended(Values a, double weightOfA, Values b, double weightOfB) {
  std::vector<double> sum(a.size());
  for (const auto i : indices(sum)) sum[i] = weightOfA * a[i] + weightOfB * b[i];
  return sum;
}

// Spherical linear interpolation along the shorter arc (Shoemake 1985). Nearly parallel quaternions
// are interpolated linearly, because the sine of their arc is lost in rounding.
std::vector<double> slerped(Values a, Values b, double t) {
  constexpr double kNearlyParallel = 1 - 1e-9;
  double cosine = 0;
  for (const auto i : indices(a)) cosine += a[i] * b[i];

  // A quaternion and its negative are the same rotation; `side` chooses the nearer one.
  const double side = cosine < 0 ? -1 : 1;
  cosine = std::min(std::fabs(cosine), 1.0);
  if (cosine > kNearlyParallel) return blended(a, 1 - t, b, side * t);

  const double angle = std::acos(cosine), sine = std::sin(angle);
  return blended(a, std::sin((1 - t) * angle) / sine, b, side * std::sin(t * angle) / sine);
}

// Cubic Hermite spline between two keys. Tangents are per second and are scaled by the time between
// the keys.
std::vector<double> splined(const Track& track, std::size_t key, double t) {
  const double span = track.times[key + 1] - track.times[key];
  const double t2 = t * t, t3 = t2 * t;

  const Values a = valueOf(track, key), behind = valuesOf(track, key, 2);
  const Values b = valueOf(track, key + 1), before = valuesOf(track, key + 1, 0);

  std::vector<double> sum(track.components);
  for (const auto i : indices(sum)) {
    sum[i] = (2 * t3 - 3 * t2 + 1) * a[i] + span * (t3 - 2 * t2 + t) * behind[i] +
             (3 * t2 - 2 * t3) * b[i] + span * (t3 - t2) * before[i];
  }
  return sum;
}

std::vector<double> between(const Track& track, std::size_t key, double time) {
  const double t = (time - track.times[key]) / (track.times[key + 1] - track.times[key]);
  const Values a = valueOf(track, key), b = valueOf(track, key + 1);
  if (track.interpolation == Track::Interpolation::step) return {a.begin(), a.end()};
  if (track.interpolation == Track::Interpolation::cubic) return splined(track, key, t);
  if (track.rotation) return slerped(a, b, t);
  return blended(a, 1 - t, b, t);
}

void normalize(std::vector<double>& quaternion) {
  double square = 0;
  for (const double x : quaternion) square += x * x;
  if (!(square > 0) || !std::isfinite(square)) {
    quaternion = {0, 0, 0, 1};
    return;
  }
  for (double& x : quaternion) x /= std::sqrt(square);
}

std::vector<Vec3d> widened(const std::vector<Vec3f>& all) { return {all.begin(), all.end()}; }

void add(const std::vector<Vec3f>& moved, double weight, std::vector<Vec3d>& to) {
  for (const auto i : indices(std::min(moved.size(), to.size()))) {
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

// Linear blend skinning: the mean of the joints' transforms, weighted by the influences.
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

std::vector<double> valueAt(const Track& track, double time) {
  // Files keep the times of keys in single precision. A key that is meant for the time of a frame
  // may be later by that, and a value that jumps would be one frame late.
  const bool jumps = track.interpolation == Track::Interpolation::step;
  const auto isBefore = [&](double a, double b) {
    return jumps ? static_cast<float>(a) < static_cast<float>(b) : a < b;
  };
  const auto next = std::ranges::upper_bound(track.times, time, isBefore);
  const std::size_t after = next - track.times.begin();

  std::vector<double> value;
  // Before the first key and after the last one the value is constant.
  if (after == 0 || after == track.times.size()) {
    const Values end = valueOf(track, after == 0 ? 0 : after - 1);
    value.assign(end.begin(), end.end());
  } else {
    value = between(track, after - 1, time);
  }

  if (track.rotation) normalize(value);
  return value;
}

std::vector<Affine> poseRig(const Rig& rig, double seconds) {
  std::vector<Affine> poses;
  poses.reserve(rig.size());
  for (const RigNode& node : rig) {
    Affine pose = node.toParent;
    if (node.motion) pose = pose * (*node.motion)(seconds);
    // Parents come before their children, so their poses are known.
    if (node.parent != kNoNode) pose = poses[node.parent] * pose;
    poses.push_back(pose);
  }
  return poses;
}

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

  // Morph targets come first, as in glTF. All sums are in double and are rounded once, at the end.
  for (const auto i : indices(std::min(pose.weights.size(), deformation.targets.size()))) {
    if (pose.weights[i] == 0) continue;
    add(deformation.targets[i].positions, pose.weights[i], positions);
    add(deformation.targets[i].normals, pose.weights[i], normals);
  }

  DeformedVertices bent;
  if (deformation.hasSkin()) {
    bent.sides.assign(positions.size(), 1);
    for (const auto i : indices(positions)) {
      const Influence* const all = deformation.influences.data();
      const Affine map = blended(pose.joints, all + deformation.firstInfluence[i],
                                 all + deformation.firstInfluence[i + 1]);
      positions[i] = map.point(positions[i]);
      if (i < normals.size()) normals[i] = map.normal(normals[i]);
      if (map.determinant() < 0) bent.sides[i] = -1;
    }
  }

  bent.positions.reserve(positions.size());
  for (const Vec3d& position : positions)
    bent.positions.emplace_back(position - deformation.origin);
  bent.normals.reserve(normals.size());
  for (const Vec3d& normal : normals) bent.normals.emplace_back(normalized(normal, Vec3d()));
  return bent;
}

}  // namespace whit
