// Records of floats fetched for every lane at once, four columns at a time: one 16-byte load a lane
// and a transposition instead of four gathers, which cost several times as much on AVX2.
#if defined(WHIT_SIMD_RECORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_RECORDS_INL_H_
#undef WHIT_SIMD_RECORDS_INL_H_
#else
#define WHIT_SIMD_RECORDS_INL_H_
#endif

#include "simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

struct V4 {
  VF x, y, z, w;
};

// Which record each lane reads, as addresses; dead lanes must name a valid record.
struct Records {
  const float* lane[16];
};

HWY_INLINE Records RecordsAt(const void* base, size_t strideInFloats, VI index) {
  const IntTag di;
  HWY_ALIGN int32_t indices[16];
  hn::Store(index, di, indices);
  Records records;
  for (size_t i = 0; i < hn::Lanes(di); ++i) {
    records.lane[i] = static_cast<const float*>(base) +
                      static_cast<size_t>(static_cast<uint32_t>(indices[i])) * strideInFloats;
  }
  return records;
}

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE V4 LoadColumns4(const Records& records, size_t column) {
  const FloatTag d;
  const float* p = records.lane[0] + column;
  return {hn::Set(d, p[0]), hn::Set(d, p[1]), hn::Set(d, p[2]), hn::Set(d, p[3])};
}

HWY_INLINE V4 LoadSquares(const uint32_t* words, size_t row, const int32_t* index) {
  const FloatTag d;
  const float* p = reinterpret_cast<const float*>(words) + index[0];
  return {hn::Set(d, p[0]), hn::Set(d, p[1]), hn::Set(d, p[row]), hn::Set(d, p[row + 1])};
}

#else

// Block b of the result is made of what block b + i of the lanes loads.
template <class D, class LoadBlock>
HWY_INLINE hn::Vec<D> LoadRows(D d, size_t lane, const LoadBlock& loadBlock) {
  if constexpr (hn::MaxLanes(d) == 4) {
    return loadBlock(d, lane);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, LoadRows(half, lane + hn::MaxLanes(half), loadBlock),
                       LoadRows(half, lane, loadBlock));
  }
}

// Four floats of every lane, transposed.
template <class LoadBlock>
HWY_INLINE V4 LoadTransposed(const LoadBlock& loadBlock) {
  const FloatTag d;
  const hn::Repartition<uint64_t, FloatTag> d64;
  const VF r0 = LoadRows(d, 0, loadBlock), r1 = LoadRows(d, 1, loadBlock);
  const VF r2 = LoadRows(d, 2, loadBlock), r3 = LoadRows(d, 3, loadBlock);
  const auto low01 = hn::BitCast(d64, hn::InterleaveLower(d, r0, r1));
  const auto low23 = hn::BitCast(d64, hn::InterleaveLower(d, r2, r3));
  const auto high01 = hn::BitCast(d64, hn::InterleaveUpper(d, r0, r1));
  const auto high23 = hn::BitCast(d64, hn::InterleaveUpper(d, r2, r3));
  return {hn::BitCast(d, hn::InterleaveLower(d64, low01, low23)),
          hn::BitCast(d, hn::InterleaveUpper(d64, low01, low23)),
          hn::BitCast(d, hn::InterleaveLower(d64, high01, high23)),
          hn::BitCast(d, hn::InterleaveUpper(d64, high01, high23))};
}

// Columns `column` to `column` + 3 of every lane's record.
HWY_INLINE V4 LoadColumns4(const Records& records, size_t column) {
  return LoadTransposed([&](auto d, size_t lane)
                            HWY_ATTR { return hn::LoadU(d, records.lane[lane] + column); });
}

// Squares of two by two words, the lower row first: of every lane, the one at `index` in rows of
// `row` words.
HWY_INLINE V4 LoadSquares(const uint32_t* words, size_t row, const int32_t* index) {
  return LoadTransposed([&](auto d, size_t lane) HWY_ATTR {
    const hn::Half<decltype(d)> pair;
    const float* lower = reinterpret_cast<const float*>(words) + index[lane];
    return hn::Combine(d, hn::LoadU(pair, lower + row), hn::LoadU(pair, lower));
  });
}

#endif

// A table read by an index that is often the same in all lanes (a packet on one surface): then one
// scalar load and a broadcast serve instead of a fetch for each lane.
class TableReader {
 public:
  HWY_INLINE TableReader(const void* base, size_t strideInFloats, VI index, MF live) {
    const FloatTag d;
    const IntTag di;
    HWY_ALIGN int32_t indices[16];
    hn::Store(index, di, indices);
    const intptr_t firstLive = hn::FindFirstTrue(d, live);
    const int32_t first = firstLive < 0 ? 0 : indices[firstLive];
    const MF same = hn::RebindMask(d, hn::Eq(index, hn::Set(di, first)));
    uniform_ = hn::AllFalse(d, hn::AndNot(same, live));
    if (uniform_) {
      records_.lane[0] = static_cast<const float*>(base) +
                         static_cast<size_t>(static_cast<uint32_t>(first)) * strideInFloats;
    } else {
      records_ =
          RecordsAt(base, strideInFloats, hn::IfThenElseZero(hn::RebindMask(di, live), index));
    }
  }

  HWY_INLINE V4 Columns4(size_t column) const {
    if (!uniform_) return LoadColumns4(records_, column);
    const FloatTag d;
    const float* p = records_.lane[0] + column;
    return {hn::Set(d, p[0]), hn::Set(d, p[1]), hn::Set(d, p[2]), hn::Set(d, p[3])};
  }

 private:
  Records records_;
  bool uniform_;
};

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
