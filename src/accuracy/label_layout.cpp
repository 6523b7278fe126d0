#include "accuracy/label_layout.h"

#include <algorithm>
#include <cmath>

namespace whit::accuracy {

namespace {

Box shifted(const Box& box, double dx, double dy) {
  return {box.left + dx, box.top + dy, box.right + dx, box.bottom + dy};
}

bool within(const Box& box, const Box& area) {
  return box.left >= area.left && box.right <= area.right && box.top >= area.top &&
         box.bottom <= area.bottom;
}

bool collides(const Box& box, const std::vector<Box>& taken) {
  return std::any_of(taken.begin(), taken.end(), [&](const Box& b) { return b.overlaps(box); });
}

// Right, left, above and below the point, then around it ever further away.
std::vector<Box> candidates(const LabelRequest& r, double gap) {
  const double w = r.width, h = r.height;
  std::vector<Box> boxes;
  const auto centered = [&](double x, double y) {
    boxes.push_back({x - w / 2, y - h / 2, x + w / 2, y + h / 2});
  };
  centered(r.x + gap + w / 2, r.y);
  centered(r.x - gap - w / 2, r.y);
  centered(r.x, r.y - gap - h / 2);
  centered(r.x, r.y + gap + h / 2);
  for (int ring = 0; ring < 24; ++ring) {
    const double away = gap + 4 + 6 * ring;
    for (int step = 0; step < 16; ++step) {
      const double angle = step * 3.14159265358979 / 8;
      const double c = std::cos(angle), s = std::sin(angle);
      centered(r.x + c * (away + w / 2), r.y + s * (away + h / 2));
    }
  }
  return boxes;
}

}  // namespace

std::vector<PlacedLabel> placeLabels(const std::vector<LabelRequest>& requests, const Box& area,
                                     double pointRadius, const std::vector<Box>& taken) {
  std::vector<Box> full = taken;
  full.reserve(taken.size() + 2 * requests.size());
  for (const LabelRequest& r : requests)
    full.push_back(shifted({-pointRadius, -pointRadius, pointRadius, pointRadius}, r.x, r.y));
  std::vector<PlacedLabel> placed;
  for (const LabelRequest& r : requests) {
    const double gap = pointRadius + 2;
    const std::vector<Box> boxes = candidates(r, gap);
    const auto found = std::find_if(boxes.begin(), boxes.end(), [&](const Box& box) {
      return within(box, area) && !collides(box, full);
    });
    PlacedLabel label;
    label.free = found != boxes.end();
    label.leader = found - boxes.begin() >= 20;  // beyond the first ring
    label.box = label.free ? *found : boxes.front();
    if (!label.free) label.leader = false;
    if (label.free) full.push_back(label.box);
    placed.push_back(label);
  }
  return placed;
}

}  // namespace whit::accuracy
