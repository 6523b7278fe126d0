// The argument of all steps of a frame: a chunk of one depth's queue of rays, its columns, and the
// constants of the frame. Kernels, calls into Embree and the functions of the scalar reference
// depend on it and on nothing else.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/channels.h"
#include "core/options.h"
#include "scene/camera.h"
#include "stages/columns.h"
#include "stages/ray_kinds.h"
#include "stages/shading_tables.h"
#include "stages/stage.h"

namespace whit {

class Accel;
struct EarlierView;
class Scene;
struct Film;

// Destination of the channels of a picture's pixels, and the sample that they belong to. Each pixel
// is written by one worker. Without layers no channels are kept.
struct ChannelTarget {
  ChannelLayers* layers = nullptr;
  Crop window;  // pixels beside it are left out
  std::uint32_t sample = 0;
  const EarlierView* earlier = nullptr;  // where motion begins; null: nothing moves
};

// Constants of a frame, which all chunks share; read-only while it is rendered.
struct FrameConstants {
  const Scene* scene = nullptr;
  const ShadingTables* tables = nullptr;
  const Accel* accel = nullptr;
  EffectSet effects;  // effects of the plan, for what the reference finds
  FeatureSet features;
  RenderOptions options;
  CameraFrame camera;
  ChannelTarget channels;
  std::uint32_t seed = 0;  // seed of the random numbers
};

// A range of a queue that holds rays of one kind; packets for Embree never mix kinds.
struct Segment {
  RayKind kind = RayKind::primary;
  std::size_t begin = 0, end = 0;
};
// A queue of depth 0 holds primary rays; deeper ones hold the kinds of kImpulseKinds, in that
// order.
inline constexpr std::size_t kSegmentLimit = kRayKindCount;

struct RayTally {
  std::uint64_t rays = 0;   // traced
  std::uint64_t lanes = 0;  // lanes sent to Embree for them: packets times width
};

// Stands for the ambient light in place of a light's number.
inline constexpr std::uint32_t kAmbientLight = 0xffffffffu;

// Counters and times of tracing.
struct TraceMeter {
  std::array<RayTally, kRayKindCount> tally{};
  double embreeMs = 0;  // inside Embree's calls alone
};

// State of a ray in a narrowed tree (sampling/ray_limit.h): its width, the product of the
// branchings before it, and how many children its surface has.
struct Narrowing {
  std::uint64_t width = 1, children = 0;
  double weights = 0;  // sum of the largest channels of the children's weights
  double passed = 0;   // the part of it that belongs to children which have been looked at
};

struct Chunk {
  const FrameConstants* frame = nullptr;
  std::span<const std::uint32_t> pixels;  // pixels of the queue of depth 0, packed (core/image.h)
  // The sample's position in the pixel, and its number in the pattern.
  Vec2f sample{0.5f, 0.5f};
  std::uint32_t sampleNumber = 0;

  int depth = 0;
  bool coherent = true;          // the rays travel so close together that Embree should know
  std::size_t first = 0, n = 0;  // the chunk's place in its queue
  std::array<Segment, kSegmentLimit> segments{};  // kinds of the chunk's rays, in order
  std::size_t segmentCount = 0;
  RayColumns rays;
  HitColumns hits;
  SurfelColumns surfels;
  std::uint32_t materialFlags = 0;  // kMaterial flags that the material of some surfel has
  RadianceColumns radiance;

  // From findRadianceAndShadowRays to addShading.
  const Light* light = nullptr;                     // null: none, or the ambient light
  std::uint32_t lightNumber = 0;                    // number in the tables, or kAmbientLight
  std::uint32_t lightSample = 0, lightSamples = 1;  // which part of it, of how many
  UnshadowedColumns unshadowed;
  ShadowColumns shadows;
  std::size_t shadowCount = 0;

  // Impulses are appended behind the `childCount` children that exist already.
  RayColumns children;
  std::size_t childCount = 0;
  std::array<Segment, kSegmentLimit> childSegments{};  // kinds of the children, in order
  std::size_t childSegmentCount = 0;
  // Radiance of the chunk whose children these rays are.
  RadianceColumns parentRadiance;

  // Where rays are counted, the number of rays in the tree that begins with each ray; and the same
  // for the chunk whose children these rays are.
  std::uint32_t *rayCounts = nullptr, *parentRayCounts = nullptr;

  // Plans that bound the rays of a sample have the slot at depth 0 that each ray and each child is
  // traced for, and the number of impulses that the samples there have followed. While samples are
  // traced again as narrower trees, `narrowings` and `childNarrowings` are not null.
  std::uint32_t *pixelSlots = nullptr, *childPixelSlots = nullptr, *followed = nullptr;
  Narrowing *narrowings = nullptr, *childNarrowings = nullptr;

  std::uint32_t* codes = nullptr;  // display codes, a pixel each
  Film* film = nullptr;            // where the pixels go
  TraceMeter* meter = nullptr;     // never null where rays are traced

  bool has(Feature feature) const { return frame->features.has(feature); }
  const ShadingTables& tables() const { return *frame->tables; }
  const RenderOptions& options() const { return frame->options; }

  // True if the sample at this slot of depth 0 has too many rays, so that it is traced again.
  bool isGivenUp(std::size_t slot) const {
    return followed && !narrowings && followed[slot] > static_cast<unsigned>(options().maxRays);
  }

  bool lightIsAmbient() const { return lightNumber == kAmbientLight; }
  // True if rays are traced to find the visible part of the current light.
  bool tracesShadows() const { return lightIsAmbient() || has(Feature::shadows); }

  // Rays to one light are coherent; those of ambient light scatter about the normals.
  bool shadowsAreCoherent() const { return coherent && !lightIsAmbient(); }

  // True if nothing has changed the ray's direction since it left the camera.
  bool isStraight(std::size_t slot) const { return depth == 0 || rays.straight[slot] != 0; }

  // Makes a light the current one, with the sample that is due of the light's `samples`.
  void turnTo(std::size_t number, std::uint32_t sample, std::uint32_t samples) {
    light = number == kAmbientLight ? nullptr : &tables().lights[number];
    lightNumber = static_cast<std::uint32_t>(number);
    lightSample = sample;
    lightSamples = samples;
  }
};

using StepFunction = void (*)(Chunk&);

}  // namespace whit
