// Records fetched for every lane at once, four floats at a time: one 16-byte load a lane and a
// transposition instead of four gathers, which cost several times as much on AVX2. The offsets of
// the record's members choose the four.
#if defined(WHIT_SIMD_RECORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_RECORDS_INL_H_
#undef WHIT_SIMD_RECORDS_INL_H_
#else
#define WHIT_SIMD_RECORDS_INL_H_
#endif

#include <span>

#include "simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

struct V4 {
  VF x, y, z, w;
};

template <class Record>
constexpr size_t kFloatsOf = sizeof(Record) / sizeof(float);

// Returns the index of a member in a record of floats. Asserts that the four floats from there on
// lie in the record, and that the last of them is the member at `kLast`.
template <class Record, size_t kFirst, size_t kLast>
constexpr size_t FourFloatsAt() {
  static_assert(kFirst % sizeof(float) == 0 && kFirst + 4 * sizeof(float) <= sizeof(Record));
  static_assert(kLast == kFirst + 3 * sizeof(float));
  return kFirst / sizeof(float);
}

// Returns an index of one of `count` records, whatever bits the lane holds. Indices from columns
// are clamped, because columns may hold anything behind their last slot; indices from records of
// the scene are valid.
HWY_INLINE VI Clamped(VI index, size_t count) {
  const UintTag du;
  const VU last = Set(static_cast<uint32_t>(count - 1));
  return BitCast(IntTag(), Min(BitCast(du, index), last));
}

HWY_INLINE const float* RecordAt(const void* base, size_t floats, int32_t index) {
  return static_cast<const float*>(base) +
         static_cast<size_t>(static_cast<uint32_t>(index)) * floats;
}

// Addresses of the records that the lanes read.
struct LaneAddresses {
  const float* lane[16];
};

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE V4 LoadFourFloats(const LaneAddresses& records, size_t column) {
  const float* p = records.lane[0] + column;
  return {Set(p[0]), Set(p[1]), Set(p[2]), Set(p[3])};
}

HWY_INLINE V4 LoadSquares(const uint32_t* words, size_t row, const int32_t* index) {
  const float* p = reinterpret_cast<const float*>(words) + index[0];
  return {Set(p[0]), Set(p[1]), Set(p[row]), Set(p[row + 1])};
}

#else

// Loads blocks of four floats of the lanes `lane`, `lane` + 4 and so on, one after the other.
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

  // Row b holds the floats of lanes b, b + 4, b + 8 and b + 12, four of each.
  const VF r0 = LoadRows(d, 0, loadBlock), r1 = LoadRows(d, 1, loadBlock);
  const VF r2 = LoadRows(d, 2, loadBlock), r3 = LoadRows(d, 3, loadBlock);

  const auto low01 = BitCast(d64, hn::InterleaveLower(d, r0, r1));
  const auto low23 = BitCast(d64, hn::InterleaveLower(d, r2, r3));
  const auto high01 = BitCast(d64, hn::InterleaveUpper(d, r0, r1));
  const auto high23 = BitCast(d64, hn::InterleaveUpper(d, r2, r3));
  return {BitCast(d, hn::InterleaveLower(d64, low01, low23)),
          BitCast(d, hn::InterleaveUpper(d64, low01, low23)),
          BitCast(d, hn::InterleaveLower(d64, high01, high23)),
          BitCast(d, hn::InterleaveUpper(d64, high01, high23))};
}

// Floats `column` to `column` + 3 of every lane's record.
HWY_INLINE V4 LoadFourFloats(const LaneAddresses& records, size_t column) {
  return LoadTransposed([&](auto d, size_t lane)
                            HWY_ATTR { return LoadU(d, records.lane[lane] + column); });
}

// Loads for every lane the square of two by two words at its `index`, in rows of `row` words, the
// lower row first.
HWY_INLINE V4 LoadSquares(const uint32_t* words, size_t row, const int32_t* index) {
  return LoadTransposed([&](auto d, size_t lane) HWY_ATTR {
    const hn::Half<decltype(d)> pair;
    const float* lower = reinterpret_cast<const float*>(words) + index[lane];
    return hn::Combine(d, LoadU(pair, lower + row), LoadU(pair, lower));
  });
}

#endif

// One record of a table for each lane; inactive lanes need a valid index as well.
template <class Record>
class Records {
 public:
  HWY_INLINE Records(const Record* table, VI index) : Records(table, kFloatsOf<Record>, index) {}

  // `stride` is the distance of records in floats; if it is 0, all lanes read the first record.
  HWY_INLINE Records(const Record* table, size_t stride, VI index) {
    const IntTag di;
    HWY_ALIGN int32_t indices[16];
    Store(index, di, indices);
    for (size_t i = 0; i < Lanes(di); ++i) {
      addresses_.lane[i] = RecordAt(table, stride, indices[i]);
    }
  }

  // The float at `kFirst` bytes and the three behind it.
  template <size_t kFirst, size_t kLast = kFirst + 3 * sizeof(float)>
  HWY_INLINE V4 Load4() const {
    return LoadFourFloats(addresses_, FourFloatsAt<Record, kFirst, kLast>());
  }

 private:
  LaneAddresses addresses_;
};

// Loads records where lanes often read the same one (a packet on one surface): one scalar load and
// a broadcast then replace a fetch for each lane. Dead lanes receive some record.
template <class Record>
class SharedRecords {
 public:
  HWY_INLINE SharedRecords(const Record* table, VI index, MF live) {
    const FloatTag d;
    const IntTag di;
    HWY_ALIGN int32_t indices[16];
    Store(index, di, indices);

    const intptr_t firstLive = hn::FindFirstTrue(d, live);
    const int32_t first = firstLive < 0 ? 0 : indices[firstLive];
    const MF same = RebindMask(d, Eq(index, Set(first)));
    uniform_ = AllFalse(AndNot(same, live));

    if (uniform_) {
      addresses_.lane[0] = RecordAt(table, kFloatsOf<Record>, first);
    } else {
      Store(IfThenElseZero(RebindMask(di, live), index), di, indices);
      for (size_t i = 0; i < Lanes(di); ++i) {
        addresses_.lane[i] = RecordAt(table, kFloatsOf<Record>, indices[i]);
      }
    }
  }

  template <size_t kFirst, size_t kLast = kFirst + 3 * sizeof(float)>
  HWY_INLINE V4 Load4() const {
    constexpr size_t kColumn = FourFloatsAt<Record, kFirst, kLast>();
    if (!uniform_) return LoadFourFloats(addresses_, kColumn);

    const float* p = addresses_.lane[0] + kColumn;
    return {Set(p[0]), Set(p[1]), Set(p[2]), Set(p[3])};
  }

 private:
  LaneAddresses addresses_;
  bool uniform_;
};

// Gathers one float of a record for each lane; where the index names no record, of any record.
template <size_t kMember, class Record>
HWY_INLINE VF GatherMember(std::span<const Record> table, VI index) {
  static_assert(kMember % sizeof(float) == 0 && kMember + sizeof(float) <= sizeof(Record));
  VI at = Mul(Clamped(index, table.size()), Set(static_cast<int32_t>(kFloatsOf<Record>)));
  if constexpr (kMember != 0) {
    at = Add(at, Set(static_cast<int32_t>(kMember / sizeof(float))));
  }
  return GatherIndex(FloatTag(), reinterpret_cast<const float*>(table.data()), at);
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
