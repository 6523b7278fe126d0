// What the last frames in motion took, as a graph.
#pragma once

#include <array>
#include <cstddef>

namespace whit::view {

class FrameGraph {
 public:
  void add(double ms);
  // Between ImGui's Begin and End: the newest at the right, and a line at the time that a frame may
  // take when there are to be `rate` a second.
  void draw(double rate) const;

 private:
  std::array<float, 120> times_{};  // milliseconds, a ring
  std::size_t next_ = 0, count_ = 0;
};

}  // namespace whit::view
