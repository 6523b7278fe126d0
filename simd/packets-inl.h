// Rays between their columns and Embree's packets, of either kind: parts of findIntersections and
// checkShadows.
#if defined(WHIT_SIMD_PACKETS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_PACKETS_INL_H_
#undef WHIT_SIMD_PACKETS_INL_H_
#else
#define WHIT_SIMD_PACKETS_INL_H_
#endif

#include <type_traits>

#include "simd/vec3-inl.h"
#include "stages/columns.h"
#include "stages/packet_words.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// Vectors that lie in one packet.
template <size_t kWidth>
using PacketTag = hn::CappedTag<float, kWidth>;

template <size_t kWidth>
HWY_INLINE float* WordsOf(const PacketWords& packets, size_t ray) {
  return packets.first + ray / kWidth * packets.stride + ray % kWidth;
}

// The columns that packets read for either kind of rays; tFar is null where rays have no end.
struct RaySource {
  const float *orgX, *orgY, *orgZ, *dirX, *dirY, *dirZ, *tFar;
};

// One sum, because nearly all rays are fine. A direction of 0 belongs to a pixel that sees nothing.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> Traceable(D d, V ox, V oy, V oz, V dx, V dy, V dz, float reach) {
  const V org = hn::Add(hn::Add(hn::Abs(ox), hn::Abs(oy)), hn::Abs(oz));
  const V way = hn::Add(hn::Add(hn::Abs(dx), hn::Abs(dy)), hn::Abs(dz));
  return hn::And(hn::Le(hn::Add(org, way), hn::Set(d, reach)), hn::Gt(way, hn::Zero(d)));
}

template <size_t kWidth>
HWY_INLINE void Pack(const RaySource& from, size_t n, float reach, const PacketWords& to) {
  const PacketTag<kWidth> d;
  const size_t end = (n + kWidth - 1) / kWidth * kWidth;
  for (size_t i = 0; i < end; i += hn::Lanes(d)) {
    const auto load = [&](const float* column) HWY_ATTR { return hn::LoadU(d, column + i); };
    const auto store = [&](auto v, size_t column)
                           HWY_ATTR { hn::StoreU(v, d, WordsOf<kWidth>(to, i) + column * kWidth); };
    auto ox = load(from.orgX), oy = load(from.orgY), oz = load(from.orgZ);
    auto dx = load(from.dirX), dy = load(from.dirY), dz = load(from.dirZ);
    auto tFar = from.tFar ? load(from.tFar) : hn::Inf(d);
    const auto there = hn::FirstN(d, i < n ? n - i : 0);
    const auto good = hn::And(there, Traceable(d, ox, oy, oz, dx, dy, dz, reach));
    if (HWY_UNLIKELY(!hn::AllTrue(d, good))) {
      // Empty rays, which find nothing. Those of bad ones start where none can: where Embree splits
      // a packet that is wider than the CPU, it looks at their coordinates all the same.
      const auto place = hn::IfThenElseZero(there, hn::Set(d, 0.25f * reach));
      ox = hn::IfThenElse(good, ox, place);
      oy = hn::IfThenElse(good, oy, place);
      oz = hn::IfThenElse(good, oz, place);
      dx = hn::IfThenElseZero(good, dx);
      dy = hn::IfThenElseZero(good, dy);
      dz = hn::IfThenElse(good, dz, hn::Set(d, 1.0f));
      tFar = hn::IfThenElse(good, tFar, hn::Set(d, -1.0f));
    }
    store(ox, packet_column::orgX);
    store(oy, packet_column::orgY);
    store(oz, packet_column::orgZ);
    store(dx, packet_column::dirX);
    store(dy, packet_column::dirY);
    store(dz, packet_column::dirZ);
    store(tFar, packet_column::tFar);
  }
}

// `call` with the width as a constant.
template <class Call>
HWY_INLINE void ForWidth(size_t width, const Call& call) {
  switch (width) {
    case 16:
      return call(std::integral_constant<size_t, 16>());
    case 8:
      return call(std::integral_constant<size_t, 8>());
    default:
      return call(std::integral_constant<size_t, 4>());
  }
}

// The kernels of both stages, for findPacketKernels: the first two are in find_intersections.cpp,
// the others in check_shadows.cpp.
void PackRays(const RayColumns& rays, size_t n, float reach, const PacketWords& to);
void UnpackHits(const PacketWords& from, size_t n, const uint32_t* triangleBase,
                const HitColumns& hits);
void PackShadowRays(const ShadowColumns& rays, size_t n, float reach, const PacketWords& to);
void UnpackVisibility(const PacketWords& from, size_t n, const uint32_t* slot, float* visible);

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
