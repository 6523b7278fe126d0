// All that shadow rays pass through on their way from a receiver to a light, for leaving out boxes.
#pragma once

#include <array>

#include "core/box.h"
#include "verdicts/caster.h"

namespace whit {

// Eight boxes, tested together in single precision: centers and half widths.
struct alignas(64) BoxBlock {
  static constexpr std::size_t kBoxes = 8;
  float center[3][kBoxes] = {}, half[3][kBoxes] = {};

  // Rounded outwards.
  void set(std::size_t i, const Box& box);
};

class Shaft {
 public:
  // A directional light's shaft ends `length` away.
  Shaft(const Receiver& receiver, const LightPoint& light, double length);

  // Which of the boxes it does not surely pass by, a bit each.
  unsigned meets(const BoxBlock& boxes) const;
  // Whether it surely passes the box by, or the triangle by more than `distance`.
  bool misses(const Box& box) const;
  bool misses(const TriangleRecord& triangle, double distance) const;

 private:
  struct Plane {
    Vec3d outward;
    Vec3d size;  // its components without their signs
    double offset = 0;
  };
  void addPlane(const Vec3d& normal, const Vec3d& through, const Vec3d& inside);

  // In single precision, away from the shaft by what rounding may add.
  struct RoundedPlane {
    std::array<float, 3> outward, size;
    float offset;
  };
  void roundPlanes();

  std::array<Plane, Receiver::kMostCorners + 1> planes_;
  std::array<RoundedPlane, Receiver::kMostCorners + 4> rounded_;
  std::size_t count_ = 0;
  Vec3d lower_, upper_;
  std::array<float, 3> middle_, width_;  // of them
  double reach_;
};

}  // namespace whit
