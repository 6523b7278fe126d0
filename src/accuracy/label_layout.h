// Places for the labels of a chart, beside their points and apart from one another.
#pragma once

#include <vector>

namespace whit::accuracy {

struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
  bool overlaps(const Box& b) const {
    return left < b.right && b.left < right && top < b.bottom && b.top < bottom;
  }
};

struct PlacedLabel {
  Box box;
  bool leader = false;  // far enough from its point that a line should join them
  bool free = true;     // false: there was no place, it overlaps something
};

// A box of each label's size beside its point, `sizes[i]` = (width, height), overlapping neither
// another label nor a point nor what is `taken`, and within `area`. Earlier labels have the better
// places.
struct LabelRequest {
  double x = 0, y = 0, width = 0, height = 0;
};
std::vector<PlacedLabel> placeLabels(const std::vector<LabelRequest>& requests, const Box& area,
                                     double pointRadius, const std::vector<Box>& taken = {});

}  // namespace whit::accuracy
