#include "scene/motion.h"

#include <algorithm>
#include <cmath>
#include <span>

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
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = weightOfA * a[i] + weightOfB * b[i];
  return sum;
}

// Along the shorter of the two arcs; nearly parallel ones straight, where the arc's sine is lost.
std::vector<double> slerped(Values a, Values b, double t) {
  constexpr double kNearlyParallel = 1 - 1e-9;
  double cosine = 0;
  for (std::size_t i = 0; i < a.size(); ++i) cosine += a[i] * b[i];
  const double side = cosine < 0 ? -1 : 1;
  cosine = std::min(std::fabs(cosine), 1.0);
  if (cosine > kNearlyParallel) return blended(a, 1 - t, b, side * t);
  const double angle = std::acos(cosine), sine = std::sin(angle);
  return blended(a, std::sin((1 - t) * angle) / sine, b, side * std::sin(t * angle) / sine);
}

std::vector<double> splined(const Track& track, std::size_t key, double t) {
  const double span = track.times[key + 1] - track.times[key];
  const double t2 = t * t, t3 = t2 * t;
  const Values a = valueOf(track, key), behind = valuesOf(track, key, 2);
  const Values b = valueOf(track, key + 1), before = valuesOf(track, key + 1, 0);
  std::vector<double> sum(track.components);
  for (std::size_t i = 0; i < sum.size(); ++i) {
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
  return track.rotation ? slerped(a, b, t) : blended(a, 1 - t, b, t);
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

}  // namespace

std::vector<double> valueAt(const Track& track, double time) {
  const auto next = std::ranges::upper_bound(track.times, time);
  const auto after = static_cast<std::size_t>(next - track.times.begin());
  std::vector<double> value;
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
    if (node.parent != kNoNode) pose = poses[node.parent] * pose;
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace whit
