// Progress of long work, for people. The implementation that draws it lives with the programs.
#pragma once

#include <string>

namespace whit {

class Progress {
 public:
  virtual ~Progress() = default;
  // `fraction` in [0, 1]; `phase` is what is going on ("decoding textures"). May come from any
  // thread. What it throws ends the work and reaches the caller; it has to throw again at each
  // later report of the same work, because some of it is done where nothing can be thrown.
  virtual void report(const std::string& phase, double fraction) = 0;
};

inline void reportProgress(Progress* progress, const std::string& phase, double fraction) {
  if (progress) progress->report(phase, fraction);
}

}  // namespace whit
