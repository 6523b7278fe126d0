#include "accuracy/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace whit::accuracy {

std::vector<std::size_t> paretoFront(const std::vector<CostAndError>& points) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::isfinite(points[i].cost) && std::isfinite(points[i].error)) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (points[a].cost != points[b].cost) return points[a].cost < points[b].cost;
    return points[a].error < points[b].error;
  });
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order) {
    if (points[i].error >= least) continue;
    least = points[i].error;
    front.push_back(i);
  }
  return front;
}

namespace {

// Those of a front, in order, whose time may be that of the one before or behind.
void markCovering(const std::vector<Point*>& front) {
  for (std::size_t i = 0; i + 1 < front.size(); ++i) {
    Point &a = *front[i], &b = *front[i + 1];
    a.coversNeighbor |= a.timing.reaches(b.timing);
    b.coversNeighbor |= b.timing.reaches(a.timing);
  }
}

}  // namespace

void markFronts(std::vector<Point>& points) {
  std::vector<CostAndError> total, same;
  std::vector<Point*> timed, withSame;
  for (Point& point : points) {
    point.onFront = point.onFrontSameSamples = point.coversNeighbor = false;
    if (!point.timing.hasSpread()) continue;
    total.push_back({point.timing.settledMs, point.total.flipMean});
    timed.push_back(&point);
    if (!point.sameSamples) continue;
    same.push_back({point.timing.settledMs, point.sameSamples->flipMean});
    withSame.push_back(&point);
  }
  std::vector<Point*> front;
  for (const std::size_t i : paretoFront(total)) front.push_back(timed[i]);
  for (Point* point : front) point->onFront = true;
  markCovering(front);
  for (const std::size_t i : paretoFront(same)) withSame[i]->onFrontSameSamples = true;
}

}  // namespace whit::accuracy
