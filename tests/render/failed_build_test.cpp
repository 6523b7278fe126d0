// A BVH that cannot be built leaves no Embree objects behind. Functions of this program stand
// before Embree's own and make Embree fail.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include "accel/accel.h"
#include "core/error.h"
#include "shipped_scene.h"

namespace {

constexpr int kOutOfMemory = 4;  // RTC_ERROR_OUT_OF_MEMORY

// Number of devices, scenes and geometries that have been made and not released.
int heldReferences = 0;

// Number of calls of rtcGetDeviceError() that report no error before one fails; below 0, none
// fails.
int errorFreeAnswers = -1;

template <typename Result, typename... Arguments>
Result embree(const char* name, Arguments... arguments) {
  return reinterpret_cast<Result (*)(Arguments...)>(dlsym(RTLD_NEXT, name))(arguments...);
}

}  // namespace

extern "C" {
void* rtcNewDevice(const char* configuration) {
  ++heldReferences;
  return embree<void*>("rtcNewDevice", configuration);
}
void* rtcNewScene(void* device) {
  ++heldReferences;
  return embree<void*>("rtcNewScene", device);
}
void* rtcNewGeometry(void* device, int type) {
  ++heldReferences;
  return embree<void*>("rtcNewGeometry", device, type);
}
void rtcReleaseDevice(void* device) {
  --heldReferences;
  embree<void>("rtcReleaseDevice", device);
}
void rtcReleaseScene(void* scene) {
  --heldReferences;
  embree<void>("rtcReleaseScene", scene);
}
void rtcReleaseGeometry(void* geometry) {
  --heldReferences;
  embree<void>("rtcReleaseGeometry", geometry);
}
int rtcGetDeviceError(void* device) {
  if (device != nullptr && errorFreeAnswers >= 0 && errorFreeAnswers-- == 0) return kOutOfMemory;
  return embree<int>("rtcGetDeviceError", device);
}
}

namespace whit {
namespace {

TEST(FailedBuild, GivesBackWhatEmbreeCounts) {
  const Scene scene = test::load("mirrors");  // has instances: several Embree scenes
  const int before = heldReferences;
  {
    const Accel whole(scene, RenderOptions{});
    EXPECT_GE(heldReferences - before, 3) << "this test's functions are not those that are called";
  }
  EXPECT_EQ(heldReferences, before);

  for (const int built : {0, 1}) {
    errorFreeAnswers = built;
    try {
      const Accel failed(scene, RenderOptions{});
      ADD_FAILURE() << "built after " << built << " scenes";
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::limit);
    }
    EXPECT_EQ(heldReferences, before) << built;
  }
  errorFreeAnswers = -1;
}

}  // namespace
}  // namespace whit
