// The queries of whit.h: rays come as the program's numbers, are answered by accel/ray_queries.h on
// all threads, and go back in columns.
#pragma once

#include <vector>

#include "accel/ray_queries.h"
#include "library/whit.h"

namespace whit::api {

struct Queried {
  const whit::Scene& scene;
  const RayQueries& queries;
  int threads;
  whit::Progress* progress;
};

RayHits closest(const Queried& at, const Rays& rays);
RayHits allHits(const Queried& at, const Rays& rays, std::size_t limit);
RayAnswers occluded(const Queried& at, const Rays& rays);
RayAnswers visible(const Queried& at, const Numbers& from, const Numbers& to,
                   const Numbers& fromNormals, const Numbers& toNormals);
std::vector<float> ambientOcclusion(const Queried& at, const Numbers& points,
                                    const Numbers& normals, double radius, int samples);

}  // namespace whit::api
