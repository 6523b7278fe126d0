#include "accel/embree_scene.h"

#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "bake/facet.h"
#include "bake/scene.h"
#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "simd/kernels.h"

namespace whit {

namespace {

bool countMemory(void* user, ssize_t bytes, bool) {
  static_cast<std::atomic<std::uint64_t>*>(user)->fetch_add(static_cast<std::uint64_t>(bytes));
  return true;
}

constexpr const char* kBuilding = "building the BVH";

// Returns false where the progress callback ends the work: nothing may be thrown through Embree.
bool reportBuild(void* user, double fraction) {
  try {
    reportProgress(static_cast<Progress*>(user), kBuilding, fraction);
    return true;
  } catch (...) {
    return false;
  }
}

// A lane's hit in double precision, computed from the ray and the triangle in world space. `slope`
// is above 0 where the ray hits the triangle from behind.
struct ExactHit {
  double u, v, slope;
};

ExactHit exactHit(const RTCFilterFunctionNArguments& args, unsigned lane) {
  const auto& triangles = *static_cast<const FilteredTriangles*>(args.geometryUserPtr);
  const unsigned placed = args.context->instID[0];
  const std::uint32_t instance = instanceOf(placed);
  const std::uint32_t triangle = triangles.first + RTCHitN_primID(args.hit, args.N, lane);
  const Corners corners = worldCorners(triangles.scene, triangle, instance);

  const unsigned id = RTCRayN_id(args.ray, args.N, lane);
  const auto& r = raysOf(args.context);
  const Vec3d origin{r[0][id], r[1][id], r[2][id]}, direction{r[3][id], r[4][id], r[5][id]};

  // Cramer's rule gives the weights, as in Moeller and Trumbore 1997.
  const Vec3d e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
  const double slope = dot(cross(e1, e2), direction);
  const Vec3d moment = cross(direction, corners[0] - origin);

  const bool mirrored = isMirrored(triangles.scene, instance);
  return {-dot(e2, moment) / slope, dot(e1, moment) / slope, mirrored ? -slope : slope};
}

// True if the ray of this lane hits the triangle from behind. On an instance, Embree has ray and
// triangle in the space of its object.
bool isBehind(const RTCFilterFunctionNArguments& args, unsigned lane) {
  RTCHitN* const hit = args.hit;
  RTCRayN* const ray = args.ray;
  const unsigned n = args.N;
  const Vec3f terms{RTCHitN_Ng_x(hit, n, lane) * RTCRayN_dir_x(ray, n, lane),
                    RTCHitN_Ng_y(hit, n, lane) * RTCRayN_dir_y(ray, n, lane),
                    RTCHitN_Ng_z(hit, n, lane) * RTCRayN_dir_z(ray, n, lane)};

  // Where the terms nearly cancel, only double precision knows the sign.
  const Vec3f sizes = abs(terms);
  const float slope = terms.x + terms.y + terms.z;
  const bool close = std::abs(slope) <= 0x1p-12f * (sizes.x + sizes.y + sizes.z);
  return (close ? exactHit(args, lane).slope : double{slope}) > 0;
}

// False if the mask cuts the triangle where this lane hits it.
template <float Mask::*kCutoff>
bool isOpaque(const RTCFilterFunctionNArguments& args, unsigned lane) {
  const auto& triangles = *static_cast<const FilteredTriangles*>(args.geometryUserPtr);
  const unsigned primitive = RTCHitN_primID(args.hit, args.N, lane);
  const std::uint32_t number = triangles.first + primitive;
  const Mask& mask = triangles.maskOf(primitive);
  float u = RTCHitN_u(args.hit, args.N, lane), v = RTCHitN_v(args.hit, args.N, lane);
  float margin = marginAt<kCutoff>(mask, triangles.scene, number, u, v);

  // Embree reports the first corner for every hit where the product of the triangle's area vector
  // and the ray's direction is below 1e-18.
  const bool mayBeUnknown = u == 0 && v == 0;
  if (mayBeUnknown || std::abs(margin) < kCloseCall) {
    const ExactHit hit = exactHit(args, lane);
    u = static_cast<float>(hit.u);
    v = static_cast<float>(hit.v);
    margin = marginAt<kCutoff>(mask, triangles.scene, number, u, v);
  }
  return margin >= 0;
}

// Filters hits for rays that pass the backs of single-sided surfaces.
void filterBySide(const RTCFilterFunctionNArguments* args) {
  const auto& triangles = *static_cast<const FilteredTriangles*>(args->geometryUserPtr);
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (args->valid[lane] == 0) continue;
    const unsigned primitive = RTCHitN_primID(args->hit, args->N, lane);
    const bool passed = !triangles.maskOf(primitive).doubleSided && isBehind(*args, lane);
    if (passed || !isOpaque<&Mask::cutoff>(*args, lane)) args->valid[lane] = 0;
  }
}

// Called for each hit on a masked triangle, with as many lanes as Embree has at hand.
template <float Mask::*kCutoff>
void filterByAlpha(const RTCFilterFunctionNArguments* args) {
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (args->valid[lane] == 0) continue;

    // A product replaces a branch that no processor could predict.
    args->valid[lane] *= static_cast<int>(isOpaque<kCutoff>(*args, lane));
  }
}

RTCBuildQuality buildQuality(BvhQuality quality) {
  if (quality == BvhQuality::low) return RTC_BUILD_QUALITY_LOW;
  return quality == BvhQuality::high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
}

// Embree gets the instruction set of the kernels' target, so that a picture does not depend on
// whether the target was named or chosen automatically (sanitized builds choose less than the
// processor's best).
std::string deviceConfiguration(int threads) {
  const std::string target = simd::chosenTarget();
  const char* isa = "";
  if (target == "avx3" || target == "avx3_dl") isa = ",max_isa=avx512";
  if (target == "avx2") isa = ",max_isa=avx2";
  if (target == "sse4") isa = ",max_isa=sse4.2";
  if (target == "sse2" || target == "scalar") isa = ",max_isa=sse2";
  return concat("threads=", threads, isa);
}

// A missing instruction set is the user's choice; every other failure means that a resource ran
// out.
[[noreturn]] void throwNoDevice(const std::string& configuration) {
  const RTCError error = rtcGetDeviceError(nullptr);
  const std::string what = "Embree has no device for '" + configuration + "'";
  if (error == RTC_ERROR_UNSUPPORTED_CPU || error == RTC_ERROR_INVALID_ARGUMENT) throwUsage(what);
  throwLimit(what + ": memory or threads ran out");
}

// Embree 3.13 ends the program if memory runs out while its threads start, instead of reporting it.
// Threads take addresses for their stacks and heaps, most of which they never touch.
void requireRoomForThreads(int threads) {
  constexpr std::size_t kMegabytes = 128, kMegabytesPerThread = 16;
  const std::size_t needed = kMegabytes + kMegabytesPerThread * static_cast<std::size_t>(threads);

  // The pointer is volatile, so that the compiler keeps the allocation.
  void* const volatile room = ::operator new(needed << 20, std::nothrow);
  ::operator delete(room);
  if (!room) {
    throwLimit(concat("Embree's threads need ", needed,
                      " MB of address space, more than is left (ulimit -v): use fewer --threads"));
  }
}

// Counts the threads that are building. A child that was forked meanwhile has copies of the locks
// that they held, and would wait for them.
class Building {
 public:
  Building() {
    if (count > 0 && process != getpid()) {
      throwUsage(
          "this process was forked while another thread built an acceleration structure, so it "
          "cannot build one: fork before, or start a new process");
    }
    process = getpid();
    ++count;
  }
  ~Building() { --count; }
  Building(const Building&) = delete;
  Building& operator=(const Building&) = delete;

 private:
  static inline std::atomic<int> count{0};
  static inline std::atomic<pid_t> process{0};
};

}  // namespace

DeviceHandle newDevice(int threads) {
  const Building building;
  requireRoomForThreads(threads);
  const std::string configuration = deviceConfiguration(threads);
  DeviceHandle device(rtcNewDevice(configuration.c_str()));
  if (!device) throwNoDevice(configuration);
  return device;
}

void commitScene(RTCDevice device, RTCScene scene, Progress* progress) {
  const Building building;
  rtcSetSceneProgressMonitorFunction(scene, progress ? reportBuild : nullptr, progress);
  rtcCommitScene(scene);
  const RTCError error = rtcGetDeviceError(device);

  // Where the progress callback has ended the build, it throws here, outside Embree.
  if (error == RTC_ERROR_CANCELLED) reportProgress(progress, kBuilding, 1);
  if (error == RTC_ERROR_NONE) return;

  const std::string what = std::string("Embree failed while ") + kBuilding;
  if (error == RTC_ERROR_OUT_OF_MEMORY) throwLimit(what + ": out of memory");

  // An unknown error is an exception in Embree's tasking system. The geometry has been validated,
  // so some resource has run out.
  if (error == RTC_ERROR_UNKNOWN) throwLimit(what + ": memory or threads ran out");

  throw std::runtime_error(concat(what, " (error ", static_cast<int>(error), ")"));
}

EmbreeScene::EmbreeScene(const Scene& scene, const RenderOptions& options, EffectSet effects,
                         int threads, Progress* progress)
    : masks_(makeMasks(scene, effects)), instances_(effects.has(Effect::instances)) {
  device_ = newDevice(threads);
  const auto has = [this](RTCDeviceProperty what) {
    return rtcGetDeviceProperty(device(), what) != 0;
  };
  if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED)) widestPacket_ = 8;
  if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) widestPacket_ = 16;

  const bool moves = scene.motion.ofGeometry;
  mayHang_ = WHIT_EMBREE_MAJOR == 3 && widestPacket_ == 16 && (moves || !scene.instances.empty());
  rtcSetDeviceMemoryMonitorFunction(device(), countMemory, &bytes_);

  const auto newScene = [&] {
    SceneHandle made(rtcNewScene(device()));
    rtcSetSceneFlags(made.get(), options.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    rtcSetSceneBuildQuality(made.get(), buildQuality(options.bvh));
    return made;
  };

  // A scene that stands still has its instances in the world's Embree scene, which is committed
  // last.
  for (const auto i : indices(scene.geometries)) {
    scenes_.push_back(newScene());
    addGeometry(i, scene);
    if (effects.has(Effect::spheres)) addSpheres(i, scene);
    if (i != 0 || moves) commit(scenes_[i].get(), progress);
  }

  // In a scene that moves, the world is an instance as well, so that its BVH is kept.
  if (moves) {
    top_ = newScene();
    addInstance(0, Affine(), kWorldId);
  }

  addInstances(scene);
  commit(top(), progress);
}

void EmbreeScene::addInstance(std::uint32_t geometry, const Affine& toWorld, unsigned id) {
  const GeometryHandle held(rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(held.get(), scenes_[geometry].get());
  placeInstance(held.get(), toWorld);
  rtcAttachGeometryByID(top(), held.get(), id);
}

void EmbreeScene::numberTriangles(const Scene& scene) {
  triangleBase_.clear();
  const auto add = [&](const Geometry& source) {
    for (unsigned c = 0; c < kTriangleClasses; ++c) {
      triangleBase_.push_back(source.firstTriangle + source.classBegin[c]);
    }
  };

  // The world comes first; the instances follow in their order.
  add(scene.geometries[0]);
  for (const InstanceRecord& instance : scene.instances) add(scene.geometries[instance.geometry]);
}

void EmbreeScene::addGeometry(std::size_t index, const Scene& scene) {
  const Geometry& source = scene.geometries[index];
  for (unsigned c = 0; c < kTriangleClasses; ++c) {
    const std::uint32_t first = source.classBegin[c], end = source.classBegin[c + 1];
    if (first == end) continue;

    const GeometryHandle held(rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE));
    RTCGeometry geometry = held.get();

    // Embree reads the vertices and indices where they are.
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               source.position.data(), 0, sizeof(Vec3f), source.position.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               source.index.data(), first * sizeof(source.index[0]),
                               sizeof(source.index[0]), end - first);

    rtcSetGeometryMask(geometry, (c & kNoShadowBit) != 0 ? kSeenMask : kSeenMask | kShadowMask);
    if ((c & kMaskedBit) != 0) {
      setFilters(scene, source.firstTriangle + first, end - first, geometry);
    }

    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scenes_[index].get(), geometry, c);
  }
}

void EmbreeScene::addSpheres(std::size_t index, const Scene& scene) {
  if (scene.geometries[index].spheres == 0) return;

  SphereGeometry& spheres = spheres_.emplace_back(scene, masks_, scene.geometries[index]);
  const GeometryHandle held(rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_USER));
  RTCGeometry geometry = held.get();
  spheres.attachTo(geometry);
  rtcSetGeometryMask(geometry, kSeenMask | kShadowMask);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scenes_[index].get(), geometry, kSpheresId);
}

// Sets the callbacks that masks and single-sided surfaces need. Shadows are cast by both sides.
void EmbreeScene::setFilters(const Scene& scene, std::uint32_t first, std::uint32_t count,
                             RTCGeometry geometry) {
  filtered_.push_back({scene, first, masks_.data()});
  FilteredTriangles& triangles = filtered_.back();
  bool anyMask = false, anySingleSided = false;
  for (std::uint32_t i = 0; i < count; ++i) {
    anyMask = anyMask || triangles.maskOf(i).map;
    anySingleSided = anySingleSided || !triangles.maskOf(i).doubleSided;
  }

  rtcSetGeometryUserData(geometry, &triangles);
  if (anySingleSided) {
    rtcSetGeometryIntersectFilterFunction(geometry, filterBySide);
  } else if (anyMask) {
    rtcSetGeometryIntersectFilterFunction(geometry, filterByAlpha<&Mask::cutoff>);
  }
  if (anyMask) rtcSetGeometryOccludedFilterFunction(geometry, filterByAlpha<&Mask::shadowCutoff>);
}

void EmbreeScene::placeInstance(RTCGeometry geometry, const Affine& m) const {
  const Vec3f columns[4] = {Vec3f(m.x), Vec3f(m.y), Vec3f(m.z), Vec3f(m.p)};
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
  rtcSetGeometryMask(geometry, kSeenMask | kShadowMask);
  rtcCommitGeometry(geometry);
}

void EmbreeScene::addInstances(const Scene& scene) {
  numberTriangles(scene);
  reach_ = kLargestCoordinate;
  instanced_.clear();
  if (!instances_) return;

  for (const InstanceRecord& instance : scene.instances) {
    reach_ = std::min(reach_, instanceReach(instance.toWorld));
    addInstance(instance.geometry, instance.toWorld,
                kFirstInstanceId + static_cast<unsigned>(instanced_.size()));
    instanced_.push_back(instance.geometry);
  }
}

void EmbreeScene::update(const Scene& scene) {
  bendMeshes(scene);
  moveInstances(scene);
  commit(top(), nullptr);
}

// Builds the BVHs of bent meshes anew rather than refitting them: the picture then cannot depend on
// where the vertices were before.
void EmbreeScene::bendMeshes(const Scene& scene) {
  std::uint32_t built = 0;
  for (const BentVertices& bent : scene.motion.bent) {
    if (bent.geometry == built) continue;  // built with the mesh before
    built = bent.geometry;

    RTCScene own = scenes_[built].get();
    const Geometry& source = scene.geometries[built];
    for (unsigned c = 0; c < kTriangleClasses; ++c) {
      if (source.classBegin[c] == source.classBegin[c + 1]) continue;
      RTCGeometry geometry = rtcGetGeometry(own, c);
      rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0);
      rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
      rtcCommitGeometry(geometry);
    }

    commit(own, nullptr);
  }
}

// Makes new instances only where their list of geometries has changed.
void EmbreeScene::moveInstances(const Scene& scene) {
  const bool same =
      std::ranges::equal(scene.instances, instanced_,
                         [](const InstanceRecord& i, std::uint32_t g) { return i.geometry == g; });
  if (!same || !instances_) {
    for (unsigned k = 0; k < instanced_.size(); ++k) rtcDetachGeometry(top(), kFirstInstanceId + k);
    addInstances(scene);
    return;
  }

  reach_ = kLargestCoordinate;
  for (unsigned k = 0; k < instanced_.size(); ++k) {
    reach_ = std::min(reach_, instanceReach(scene.instances[k].toWorld));
    placeInstance(rtcGetGeometry(top(), kFirstInstanceId + k), scene.instances[k].toWorld);
  }
}

}  // namespace whit
