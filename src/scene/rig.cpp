#include "scene/rig.h"

namespace whit {

std::vector<Affine> poseRig(const Rig& rig, double seconds) {
  std::vector<Affine> poses;
  poses.reserve(rig.size());
  for (const RigNode& node : rig) {
    Affine pose = node.toParent;
    if (node.motion) pose = pose * node.motion->at(seconds);
    if (node.parent != kNoNode) pose = poses[node.parent] * pose;
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace whit
