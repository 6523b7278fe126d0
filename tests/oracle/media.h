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

  bool operator==(const Medium&) const = default;
};

inline Medium mediumOf(const Material& m) { return {m.ior, m.absorption, m.priority}; }

class Media {
 public:
  void enter(const Medium& medium) { inside_.push_back(medium); }

  // The one of this kind that was entered last; none if there is none.
  void leave(const Medium& medium) {
    const auto last = std::find(inside_.rbegin(), inside_.rend(), medium);
    if (last != inside_.rend()) inside_.erase(std::next(last).base());
  }

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
