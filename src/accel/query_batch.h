// Rays that Embree traces together for the ray queries, and the hits of each.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "accel/embree_calls.h"
#include "accel/query_scene.h"
#include "accel/ray_queries.h"

namespace whit {

enum class QueryKind { closest, any, all };

class RayBatch {
 public:
  static constexpr std::size_t kRays = 256;

  RayBatch(const QueryScene& scene, QueryKind kind) : scene_(scene), kind_(kind) {}

  // Traces at most kRays rays.
  void trace(std::span<const QueryRay> rays);
  // Returns what is known about a ray of the last trace().
  const Blocked& answer(std::size_t ray) const { return answers_[ray]; }
  // Returns the nearest hit of the ray, if the query is for closest hits. While hasOthers(), hits()
  // may hold some that are as near, because their distances are not exact.
  const QueryHit& best(std::size_t ray) const { return best_[ray]; }
  bool hasOthers() const { return !others_.empty(); }
  std::vector<QueryHit>& hits(std::size_t ray);

  // Decides about a candidate of a ray. Returns true if the ray ends there, at Embree's distance
  // `tFar`.
  bool test(unsigned ray, PlacedTriangleId id, float& tFar);
  // Accepts a triangle that is surely hit at `tFar`, and leaves its exact hit for later, when
  // nothing nearer is found. Returns false if that is not possible.
  bool postpone(unsigned ray, PlacedTriangleId id, float& tFar);

 private:
  // A ray in Embree's space.
  struct Start {
    Vec3f origin, direction;
    double perT = 1, shift = 0;  // Embree's distance is t * perT - shift
    float tFar = -1;             // below 0: the ray hits nothing
    float end = 0;               // tFar before any hit
    // The nearest postponed triangle, and Embree's distance of its hit.
    PlacedTriangleId postponed{kMiss, kNoInstance};
    float at = 0;
  };

  using Other = std::pair<std::uint32_t, QueryHit>;  // a ray's number and a hit of it

  bool start(const QueryRay& ray, Start& to) const;
  bool keep(unsigned ray, const QueryHit& hit, float& tFar);
  template <typename Packet>
  static Packet packetOf(std::span<const Start> starts, std::size_t first);
  template <typename Single, typename Packet>
  void traceAs();

  const QueryScene& scene_;
  QueryKind kind_;
  std::span<const QueryRay> rays_;
  std::array<Start, kRays> starts_;
  std::array<Blocked, kRays> answers_;
  std::array<QueryHit, kRays> best_;  // each ray's nearest hit; of QueryKind::all any hit
  std::vector<Other> others_;
  std::vector<QueryHit> hits_;
};

// Embree's callbacks: `geometryUserPtr` are EnlargedTriangles or QuerySpheres.
void filterCandidates(const RTCFilterFunctionNArguments* args);
void intersectSpheres(const RTCIntersectFunctionNArguments* args);
void occludeSpheres(const RTCOccludedFunctionNArguments* args);

}  // namespace whit
