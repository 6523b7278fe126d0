// The dielectrics that a ray is inside of.
#pragma once

#include <vector>

#include "oracle/scene.h"

namespace oracle {

// What fills a solid. Solids of the same filling are one medium where they overlap, whatever their
// surfaces do.
struct Medium {
  double ior = 1;
  Color absorption;
  int priority = 0;

  bool operator==(const Medium& b) const {
    return ior == b.ior && priority == b.priority && absorption.x == b.absorption.x &&
           absorption.y == b.absorption.y && absorption.z == b.absorption.z;
  }
};

inline Medium mediumOf(const Material& m) { return {m.ior, m.absorption, m.priority}; }

class Media {
 public:
  void enter(const Medium& medium) { inside_.push_back(medium); }

  // The one of this kind that was entered last; none if there is none.
  void leave(const Medium& medium) {
    for (std::size_t i = inside_.size(); i-- > 0;) {
      if (!(inside_[i] == medium)) continue;
      inside_.erase(inside_.begin() + static_cast<std::ptrdiff_t>(i));
      return;
    }
  }

  bool empty() const { return inside_.empty(); }

  // The medium that counts: of the highest priority, among equals the one entered last; the
  // vacuum outside everything.
  Medium current() const {
    Medium best;
    for (std::size_t i = 0; i < inside_.size(); ++i) {
      if (i == 0 || inside_[i].priority >= best.priority) best = inside_[i];
    }
    return best;
  }

 private:
  std::vector<Medium> inside_;  // in the order in which they were entered
};

}  // namespace oracle
