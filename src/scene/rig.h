// A hierarchy of frames of reference that move, each in the frame of its parent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/affine.h"

namespace whit {

// Where something is at a time, in the space that it moves in.
class Motion {
 public:
  virtual ~Motion() = default;
  virtual Affine at(double seconds) const = 0;
};

// At all times the same.
class FixedMotion : public Motion {
 public:
  explicit FixedMotion(const Affine& map) : map_(map) {}
  Affine at(double) const override { return map_; }

 private:
  Affine map_;
};

inline constexpr std::uint32_t kNoNode = 0xffffffffu;

struct RigNode {
  std::uint32_t parent = kNoNode;        // comes before it
  Affine toParent;                       // where its motion takes place
  std::shared_ptr<const Motion> motion;  // none: it stands still there
  std::string name = {};                 // of what is moved by hand: its place in the file
};

using Rig = std::vector<RigNode>;

// From each node's own space to that of the rig.
std::vector<Affine> poseRig(const Rig& rig, double seconds);

}  // namespace whit
