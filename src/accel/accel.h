// The acceleration structure: the only folder that includes Embree. Rays come in columns, go to
// Embree in packets of 1, 4, 8 or 16, and come back as hits in columns.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bake/scene.h"
#include "core/options.h"
#include "core/progress.h"
#include "stages/chunk.h"

namespace whit {

struct AccelOptions {
  bool robust = true;  // watertight traversal
  BvhQuality quality = BvhQuality::medium;
  bool alphaMasks = true;  // respect them (a filter on masked triangles only)
  bool instances = true;   // there at all
  bool spheres = true;     // likewise
  int threads = 0;         // for building; 0: all
  int packet = 0;          // 0: the widest the CPU runs natively
  std::string isa;         // "avx512", "avx2", "avx", "sse4.2"; empty: the CPU's best
};

// Rays as they went to Embree, for measuring the floor. Rays of one kind of call lie together, in
// the order in which they were traced.
class RayLog {
 public:
  struct Stream {
    bool anyHit = false;  // for calls that test for any hit, not for the closest one
    bool coherent = false;
    std::size_t count = 0;
    // Origin, direction, and tFar of any-hit rays; filled up to whole blocks.
    std::array<std::vector<float>, 7> columns;
  };
  // Takes n rays from columns in the order of Stream::columns; the last is null for closest hits.
  void append(bool anyHit, bool coherent, const std::array<const float*, 7>& rays, std::size_t n);
  const std::vector<Stream>& streams() const { return streams_; }

 private:
  std::vector<Stream> streams_;
};

// The hit of a single ray; the numbers are those of HitColumns.
struct Hit {
  std::uint32_t triangle = kMiss, instance = kMiss;
  float t = 0, u = 0, v = 0;
  bool found() const { return triangle != kMiss; }
};

class Accel {
 public:
  // `scene` must outlive the structure. Rays are packed by kernels of the SIMD target that is
  // chosen now (simd/kernels.h). Throws Error(limit) when memory runs out, Error(usage) when the
  // packet width or ISA is not there.
  Accel(const Scene& scene, const AccelOptions& options, Progress* progress = nullptr);
  ~Accel();
  Accel(const Accel&) = delete;
  Accel& operator=(const Accel&) = delete;

  // After moveScene(), of the scene that this was built from. What stands still keeps its BVH.
  // Throws as the constructor. Not while tracing.
  void sceneMoved();

  // The nearest hits of the chunk's rays, segment by segment; those behind the last are misses, up
  // to a whole block. A ray's hit does not depend on the rays beside it, but where two surfaces lie
  // in each other's place (settled afterwards: render/settle_coplanar.h) or cross at its very
  // distance (to the last bit): which of them it meets is then left to Embree. Rays of depth 0 do
  // not meet what their eye lies in.
  void findHits(Chunk& c) const noexcept;
  // visible[slot] = 1 for each of the chunk's shadow rays that meets nothing before tFar, else 0.
  void checkShadows(Chunk& c) const noexcept;

  // Robust traversal lets no ray through an edge, but about one in a thousand through a corner that
  // it meets exactly (hard case H14). In a scene that is closed around its cameras rays that find
  // nothing are therefore traced again, one by one, in directions a unit in the last place away:
  // there they are so rare that it costs nothing. They count once. Not while tracing.
  void setEnclosed(bool enclosed) { enclosed_ = enclosed; }
  bool enclosed() const { return enclosed_; }

  // Single rays, for the reference's candidates.
  Hit closest(const Vec3f& origin, const Vec3f& direction, float tNear = 0) const noexcept;
  bool occluded(const Vec3f& origin, const Vec3f& direction, float tFar) const noexcept;

  // True if an alpha mask cuts the triangle or sphere (its number in the scene) there.
  bool isCutAway(std::uint32_t triangle, double u, double v) const noexcept;

  // Returns the milliseconds that Embree needs for the rays of a log, in full packets.
  double replay(const RayLog& log) const;

  int packet() const;
  std::string description() const;  // "3.13.5 avx2"
  std::uint64_t memoryBytes() const;

  struct Parts;  // accel.cpp; no other folder sees Embree

 private:
  const Scene& scene_;
  std::unique_ptr<Parts> parts_;
  bool enclosed_ = false;
};

// Steps of a plan, by the frame's Accel.
void findHits(Chunk& c);
void checkShadows(Chunk& c);

}  // namespace whit
