// The kernels around Embree in checkShadows: shadow rays into packets, and visibility out of them.
#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/check_shadows.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/packets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

void PackShadowRays(const ShadowColumns& rays, size_t n, float reach, const PacketWords& to) {
  const RaySource from{rays.orgX, rays.orgY, rays.orgZ, rays.dirX, rays.dirY, rays.dirZ, rays.tFar};
  ForWidth(to.width, [&](auto width) HWY_ATTR { Pack<width()>(from, n, reach, to); });
}

template <size_t kWidth>
HWY_INLINE void UnpackVisibilityOf(const PacketWords& from, size_t n, const uint32_t* slot,
                                   float* visible) {
  const PacketTag<kWidth> d;
  const size_t lanes = hn::Lanes(d);
  HWY_ALIGN float clear[16];
  for (size_t i = 0; i < n; i += lanes) {
    // Embree marks an occluded ray with a tFar of minus infinity.
    const auto tFar = hn::LoadU(d, WordsOf<kWidth>(from, i) + packet_column::tFar * kWidth);
    hn::Store(hn::IfThenElseZero(hn::Ge(tFar, hn::Zero(d)), hn::Set(d, 1.0f)), d, clear);
    const size_t count = n - i < lanes ? n - i : lanes;
    for (size_t lane = 0; lane < count; ++lane) visible[slot[i + lane]] = clear[lane];
  }
}

void UnpackVisibility(const PacketWords& from, size_t n, const uint32_t* slot, float* visible) {
  ForWidth(from.width,
           [&](auto width) HWY_ATTR { UnpackVisibilityOf<width()>(from, n, slot, visible); });
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
