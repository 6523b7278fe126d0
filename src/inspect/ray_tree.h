// The rays of one pixel as the tree that Whitted drew (1980, figure 2): the hit, the radiance and
// the end of each. Observers write it down, so that frames pay nothing for it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/vec3.h"
#include "render/renderer.h"
#include "stages/ray_kinds.h"

namespace whit {

// The contribution of a light, or of one of its samples, to a surfel's radiance.
struct LightContribution {
  std::uint32_t light = 0, sample = 0;
  Vec3d origin, toLight;  // the shadow ray reaches from `origin` to their sum
  bool traced = false;    // else no shadow was looked for
  bool visible = true;
  RgbD radiance;
};

// Why a surface sends on less than its material would.
enum class PathEnd { none, depth, cutoff, roulette, limit, totalReflection };

struct RayNode {
  RayKind kind = RayKind::primary;
  std::size_t parent = 0;  // itself for a primary ray
  int depth = 0;
  Vec3d origin, direction;
  RgbD weight{1, 1, 1};     // what it brings back, times this, is part of the parent's radiance
  std::uint32_t media = 0;  // around it, a byte each (surfaces/initial_media.h)
  std::uint32_t triangle = kMiss;  // kMiss: it left the scene
  std::uint32_t instance = kNoInstance;
  std::uint32_t material = kMiss;
  double u = 0, v = 0;  // barycentric coordinates of the hit
  double distance = kInfinity;
  Vec3d position;
  std::uint32_t alsoCrossed = 0;  // as hits have it
  bool hidden = false;            // a surface inside a dielectric of higher priority: not there
  RgbD emitted;  // with the reflective ambient; of rays that left the scene the sky
  std::vector<LightContribution> lights;
  RgbD local;     // radiance from emission, ambient light and lights
  RgbD radiance;  // with what its children brought back
  // The end of the path for each kind of impulse. For sampled lobes it is set if no sample goes on.
  std::array<PathEnd, kRayKindCount> ends{};
  std::vector<std::size_t> children;

  PathEnd& endOf(RayKind of) { return entryOf(ends, of); }
  PathEnd endOf(RayKind of) const { return entryOf(ends, of); }
};

// Parents come before their children.
struct RayTree {
  std::vector<RayNode> nodes;
  std::vector<std::size_t> primaries;  // a node for each sample of the pixel
  std::vector<Vec2f> samples;          // their places in the pixel
  Rgb pixel;                           // as the film has it
  bool narrowed = false;               // a sample was traced again (sampling/ray_limit.h)

  std::size_t shadowRays() const;  // number of those that were traced
};

// Traces the tree by the pipeline. The pixel is the mean, over the samples, of a primary ray's
// weight times its radiance. The radiance is the local radiance of a node, then child by child the
// weight times theirs: the same sums in the same order, to the last bit. With --adaptive on the
// samples are those of the picture.
RayTree traceRayTree(Renderer& renderer, const Camera& camera, const Film& film, int x, int y);

// Traces the samples of a tree by the scalar reference. `local` and `emitted` stay 0, and weights
// do not hold absorption on the way, which is in the radiance.
RayTree traceReferenceTree(Renderer& renderer, const Camera& camera, const Film& film, int x, int y,
                           const std::vector<Vec2f>& samples);

// The factor by which a node's own radiance counts at the eye: the product of the weights along the
// path. The mean over the samples is not part of it.
RgbD weightAtEye(const RayTree& tree, std::size_t node);

// Returns for each node of `a` its counterpart in `b`, by kind and order among siblings, or
// kNoCounterpart.
inline constexpr std::size_t kNoCounterpart = std::numeric_limits<std::size_t>::max();
std::vector<std::size_t> counterparts(const RayTree& a, const RayTree& b);

bool hitsSameSurface(const RayNode& a, const RayNode& b);  // true if neither hits any, too
bool seesSameLights(const RayNode& a, const RayNode& b);   // those that are visible
// True if both nodes hit and see the same surfaces and lights and send the same number of impulses.
bool agree(const RayNode& a, const RayNode& b);

}  // namespace whit
