// A hierarchy of frames of reference that move, each in the frame of its parent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/affine.h"

namespace whit {

// Where something is at a time in seconds, in the space that it moves in.
using Motion = std::function<Affine(double seconds)>;

inline constexpr std::uint32_t kNoNode = 0xffffffffu;

struct RigNode {
  std::uint32_t parent = kNoNode;  // comes before it
  Affine toParent;                 // where its motion takes place
  Motion motion;                   // none: it stands still there
};

using Rig = std::vector<RigNode>;

// From each node's own space to that of the rig.
std::vector<Affine> poseRig(const Rig& rig, double seconds);

}  // namespace whit
