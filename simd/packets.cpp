// Rays between their columns and Embree's packets: parts of findIntersections and checkShadows.
#include "simd/kernels.h"
#include "stages/packet_words.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/packets.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// Vectors that lie in one packet.
template <size_t kWidth>
using PacketTag = hn::CappedTag<float, kWidth>;

template <size_t kWidth>
HWY_INLINE float* WordsOf(const PacketWords& packets, size_t ray) {
  return packets.first + ray / kWidth * packets.stride + ray % kWidth;
}

// What packets take of either kind of rays; tFar is null where rays have no end.
struct RaySource {
  const float *orgX, *orgY, *orgZ, *dirX, *dirY, *dirZ, *tFar;
};

// One sum, because nearly all rays are fine.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> Traceable(D d, V ox, V oy, V oz, V dx, V dy, V dz, float reach) {
  const V org = hn::Add(hn::Add(hn::Abs(ox), hn::Abs(oy)), hn::Abs(oz));
  const V sum = hn::Add(hn::Add(hn::Add(org, hn::Abs(dx)), hn::Abs(dy)), hn::Abs(dz));
  return hn::Le(sum, hn::Set(d, reach));
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

template <size_t kWidth>
HWY_INLINE void Unpack(const PacketWords& from, size_t n, const uint32_t* triangleBase,
                       const HitColumns& hits) {
  const PacketTag<kWidth> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const auto miss = hn::Set(du, kMiss);
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    const float* const words = WordsOf<kWidth>(from, i);
    const auto load = [&](size_t column) HWY_ATTR { return hn::LoadU(d, words + column * kWidth); };
    hn::StoreU(load(packet_column::tFar), d, hits.t + i);
    hn::StoreU(load(packet_column::u), d, hits.u + i);
    hn::StoreU(load(packet_column::v), d, hits.v + i);
    const auto geometry = hn::BitCast(du, load(packet_column::geometry));
    const auto primitive = hn::BitCast(du, load(packet_column::primitive));
    auto base = hn::Set(du, triangleBase[0]);
    for (uint32_t c = 1; c < kTriangleClasses; ++c) {
      const auto ofClass = hn::Eq(geometry, hn::Set(du, c));
      base = hn::IfThenElse(ofClass, hn::Set(du, triangleBase[c]), base);
    }
    const auto missed = hn::Eq(geometry, miss);
    hn::StoreU(hn::IfThenElse(missed, miss, hn::Add(base, primitive)), du, hits.triangle + i);
  }
}

template <size_t kWidth>
HWY_INLINE void Unpack(const PacketWords& from, size_t n, const uint32_t* slot, float* visible) {
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

void PackRays(const RayColumns& rays, size_t n, float reach, const PacketWords& to) {
  const RaySource from{rays.orgX, rays.orgY, rays.orgZ, rays.dirX, rays.dirY, rays.dirZ, nullptr};
  ForWidth(to.width, [&](auto width) HWY_ATTR { Pack<width()>(from, n, reach, to); });
}

void PackShadowRays(const ShadowColumns& rays, size_t n, float reach, const PacketWords& to) {
  const RaySource from{rays.orgX, rays.orgY, rays.orgZ, rays.dirX, rays.dirY, rays.dirZ, rays.tFar};
  ForWidth(to.width, [&](auto width) HWY_ATTR { Pack<width()>(from, n, reach, to); });
}

void UnpackHits(const PacketWords& from, size_t n, const uint32_t* triangleBase,
                const HitColumns& hits) {
  ForWidth(from.width, [&](auto width) HWY_ATTR { Unpack<width()>(from, n, triangleBase, hits); });
}

void UnpackVisibility(const PacketWords& from, size_t n, const uint32_t* slot, float* visible) {
  ForWidth(from.width, [&](auto width) HWY_ATTR { Unpack<width()>(from, n, slot, visible); });
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
HWY_EXPORT(PackRays);
void packRays(const RayColumns& rays, std::size_t n, float reach, const PacketWords& to) noexcept {
  HWY_DYNAMIC_DISPATCH(PackRays)(rays, n, reach, to);
}
HWY_EXPORT(PackShadowRays);
void packShadowRays(const ShadowColumns& rays, std::size_t n, float reach,
                    const PacketWords& to) noexcept {
  HWY_DYNAMIC_DISPATCH(PackShadowRays)(rays, n, reach, to);
}
HWY_EXPORT(UnpackHits);
void unpackHits(const PacketWords& from, std::size_t n, const std::uint32_t* triangleBase,
                const HitColumns& hits) noexcept {
  HWY_DYNAMIC_DISPATCH(UnpackHits)(from, n, triangleBase, hits);
}
HWY_EXPORT(UnpackVisibility);
void unpackVisibility(const PacketWords& from, std::size_t n, const std::uint32_t* slot,
                      float* visible) noexcept {
  HWY_DYNAMIC_DISPATCH(UnpackVisibility)(from, n, slot, visible);
}
}  // namespace whit::simd
#endif
