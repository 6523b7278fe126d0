// Embree's device and scenes, built from a frozen Scene.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <type_traits>
#include <vector>

#include "accel/accel.h"
#include "accel/alpha_filter.h"
#include "accel/embree_calls.h"
#include "accel/sphere_geometry.h"

namespace whit {

// Ray masks: shadow rays do not see triangles that cast no shadow.
inline constexpr unsigned kSeenMask = 1, kShadowMask = 2;

// Owner of an object whose references Embree counts; it releases its reference.
template <auto release>
struct Release {
  template <typename T>
  void operator()(T* held) const {
    release(held);
  }
};
using DeviceHandle = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release<rtcReleaseDevice>>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, Release<rtcReleaseScene>>;
using GeometryHandle =
    std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Release<rtcReleaseGeometry>>;

// Both throw as Accel's constructor.
DeviceHandle newDevice(int threads);
void commitScene(RTCDevice device, RTCScene scene, Progress* progress);

class EmbreeScene {
 public:
  // Takes the same arguments and throws the same errors as Accel's constructor.
  EmbreeScene(const Scene& scene, const RenderOptions& options, EffectSet effects, int threads,
              Progress* progress);
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  // Follows moveScene() of the scene that this was built from.
  void update(const Scene& scene);

  RTCScene top() const { return (top_ ? top_ : scenes_[0]).get(); }
  RTCDevice device() const { return device_.get(); }
  std::uint64_t memoryBytes() const { return bytes_ + sphereBytes(); }
  std::uint64_t sphereBytes() const {
    std::uint64_t bytes = 0;
    for (const SphereGeometry& spheres : spheres_) bytes += spheres.memoryBytes();
    return bytes;
  }

  // Returns the number of the first triangle in each class's Embree geometry, for the world (0) or
  // an instance (1 + instance).
  const std::uint32_t* triangleBase(std::size_t placed) const {
    return &triangleBase_[placed * kTriangleClasses];
  }
  std::uint32_t triangleOf(unsigned id, unsigned geometry, unsigned primitive) const {
    const std::size_t placed = isInWorld(id) ? 0 : 1 + instanceOf(id);
    return triangleBase(placed)[geometry] + primitive;
  }
  // Rays with an origin or a direction beyond this are not traced (see instanceReach).
  float reach() const { return reach_; }
  // The widest packets that the processor runs natively.
  int widestPacket() const { return widestPacket_; }
  // The width of packets that Embree leads through its BVH several at a time when their rays are
  // coherent (rtcIntersectNM), 0: none. That takes packets as wide as the CPU, and was measured on
  // AVX2 only: without it, frames take 7 to 16 % longer.
  int streamWidth() const { return QueryContext::kStreams && widestPacket_ == 8 ? 8 : 0; }
  // True if rtcOccluded16 may never return for rays that are declared coherent. For AVX-512 and
  // scenes of instances, Debian's Embree 3.13.5 is compiled such that the mask of rays left to
  // trace is stored in 16 bits and read in 64 (BVHNIntersectorKHybrid::occludedCoherent): if the
  // stack was not zero there, its loop has no end. Packets of 8 are safe, and so are rays that are
  // not declared coherent.
  bool coherentAnyHitMayHang(int packet) const { return packet == 16 && mayHang_; }

 private:
  void addGeometry(std::size_t index, const Scene& scene);
  void addSpheres(std::size_t index, const Scene& scene);
  void setFilters(const Scene& scene, std::uint32_t first, std::uint32_t count,
                  RTCGeometry geometry);
  void addInstance(std::uint32_t geometry, const Affine& toWorld, unsigned id);
  void numberTriangles(const Scene& scene);
  void addInstances(const Scene& scene);
  void placeInstance(RTCGeometry geometry, const Affine& toWorld) const;
  void moveInstances(const Scene& scene);
  void bendMeshes(const Scene& scene);
  void commit(RTCScene scene, Progress* progress) { commitScene(device(), scene, progress); }

  std::atomic<std::uint64_t> bytes_{0};  // outlives the device, which counts here to its end
  std::vector<Mask> masks_;
  std::deque<FilteredTriangles> filtered_;  // Embree keeps pointers to them
  std::deque<SphereGeometry> spheres_;      // Embree keeps pointers to them
  std::vector<std::uint32_t> triangleBase_;
  DeviceHandle device_;
  std::vector<SceneHandle> scenes_;  // a scene for each of Scene::geometries
  // The top-level scene of a scene that moves. The world is an instance in it, so that it is not
  // built again with the other instances.
  SceneHandle top_;
  std::vector<std::uint32_t> instanced_;  // geometry of each instance in the top-level scene
  bool instances_ = true;
  float reach_ = kLargestCoordinate;
  int widestPacket_ = 4;
  bool mayHang_ = false;
};

}  // namespace whit
