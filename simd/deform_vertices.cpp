#include "simd/deform_vertices.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/deform_vertices.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/product-inl.h"

#ifndef WHIT_DEFORM_KERNELS
#define WHIT_DEFORM_KERNELS
namespace whit::simd {

// Vertices are worked on so many at a time; columns of them have room for that.
inline constexpr size_t kVertices = 8;

// Components of vertices lie one after the other: x, y, z.
struct DeformKernels {
  // Adds what a target moves, `count` components, times its weight.
  void (*addTarget)(const float* moved, double weight, size_t count, double* to);
  // Vertices by their joints, and their sides. `normals` may be null.
  void (*skin)(const Deformation& deformation, const Affine* joints, size_t count,
               double* positions, double* normals, double* sides);
  // To unit length, or zero where there is no direction.
  void (*normalize)(size_t count, double* normals);
};

}  // namespace whit::simd
#endif

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE D3 Loaded(const double* from) {
  D3 v;
  hn::LoadInterleaved3(Doubles(), from, v.x, v.y, v.z);
  return v;
}
HWY_INLINE void Stored(const D3& v, double* to) {
  hn::StoreInterleaved3(v.x, v.y, v.z, Doubles(), to);
}
// x * v.x + y * v.y + z * v.z
HWY_INLINE D3 Combined(const D3& x, const D3& y, const D3& z, const D3& v) {
  return Add3(Add3(Scale3(x, v.x), Scale3(y, v.y)), Scale3(z, v.z));
}

void AddTarget(const float* moved, double weight, size_t count, double* to) {
  const Doubles d;
  const hn::Rebind<float, Doubles> floats;
  const size_t lanes = hn::Lanes(d);
  const VD w = hn::Set(d, weight);
  size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const VD by = hn::PromoteTo(d, hn::LoadU(floats, moved + i));
    hn::StoreU(hn::Add(hn::LoadU(d, to + i), hn::Mul(by, w)), d, to + i);
  }
  for (; i < count; ++i) to[i] += static_cast<double>(moved[i]) * weight;
}

// The maps of eight vertices, component by component.
struct alignas(64) Maps {
  static constexpr size_t kComponents = 12;  // of an Affine: x, y, z, p
  double of[kComponents][kVertices];

  HWY_INLINE D3 Column(size_t column, size_t i) const {
    const Doubles d;
    return {hn::Load(d, of[3 * column] + i), hn::Load(d, of[3 * column + 1] + i),
            hn::Load(d, of[3 * column + 2] + i)};
  }
};
static_assert(sizeof(Affine) == Maps::kComponents * sizeof(double));

HWY_INLINE void Blend(const Affine* joints, const Influence* begin, const Influence* end,
                      size_t vertex, Maps& maps) {
  const hn::CappedTag<double, 4> d;
  const size_t lanes = hn::Lanes(d);
  alignas(64) double map[Maps::kComponents];
  double sum = 0;
  for (const Influence* i = begin; i != end; ++i) sum += i->weight;
  const auto scale = hn::Set(d, 1 / sum);
  for (size_t k = 0; k < Maps::kComponents; k += lanes) {
    auto blended = hn::Zero(d);
    for (const Influence* i = begin; i != end; ++i) {
      const double* joint = &joints[i->joint].x.x + k;
      blended = hn::Add(blended, hn::Mul(hn::LoadU(d, joint), hn::Set(d, i->weight)));
    }
    hn::Store(hn::Mul(blended, scale), d, map + k);
  }
  for (size_t k = 0; k < Maps::kComponents; ++k) maps.of[k][vertex] = map[k];
}

// Affine::point and Affine::normal, and the sign of the determinant.
HWY_INLINE void Apply(const Maps& maps, size_t i, double* positions, double* normals,
                      double* sides) {
  const Doubles d;
  const D3 x = maps.Column(0, i), y = maps.Column(1, i), z = maps.Column(2, i);
  Stored(Add3(Combined(x, y, z, Loaded(positions)), maps.Column(3, i)), positions);
  const D3 yz = Cross3(y, z);
  const auto mirrored = hn::Lt(Dot3(x, yz), hn::Zero(d));
  const VD sign = hn::IfThenElse(mirrored, hn::Set(d, -1.0), hn::Set(d, 1.0));
  hn::StoreU(sign, d, sides);
  if (!normals) return;
  Stored(Scale3(Combined(yz, Cross3(z, x), Cross3(x, y), Loaded(normals)), sign), normals);
}

void Skin(const Deformation& deformation, const Affine* joints, size_t count, double* positions,
          double* normals, double* sides) {
  const size_t lanes = hn::Lanes(Doubles());
  const Influence* all = deformation.influences.data();
  for (size_t first = 0; first < count; first += kVertices) {
    Maps maps = {};
    for (size_t k = 0; k < kVertices && first + k < count; ++k) {
      Blend(joints, all + deformation.firstInfluence[first + k],
            all + deformation.firstInfluence[first + k + 1], k, maps);
    }
    for (size_t i = 0; i < kVertices; i += lanes) {
      const size_t at = 3 * (first + i);
      Apply(maps, i, positions + at, normals ? normals + at : nullptr, sides + first + i);
    }
  }
}

// Squares of lengths. Scaled by a power of two first, as whit::normalized does, a vector within
// these has the same direction to the last bit.
constexpr double kLeastSquare = 1e-200, kLargestSquare = 1e200;

void Normalize(size_t count, double* normals) {
  const Doubles d;
  const size_t lanes = hn::Lanes(d);
  for (size_t i = 0; i < count; i += lanes) {
    double* at = normals + 3 * i;
    const D3 n = Loaded(at);
    const VD square = Dot3(n, n), zero = hn::Zero(d);
    const auto ordinary = hn::And(hn::Gt(square, hn::Set(d, kLeastSquare)),
                                  hn::Lt(square, hn::Set(d, kLargestSquare)));
    const auto none = hn::And(hn::Eq(n.x, zero), hn::And(hn::Eq(n.y, zero), hn::Eq(n.z, zero)));
    if (!hn::AllTrue(d, hn::Or(ordinary, none))) {
      for (size_t k = 0; k < lanes; ++k) {
        const Vec3d unit = normalized(Vec3d{at[3 * k], at[3 * k + 1], at[3 * k + 2]}, Vec3d());
        at[3 * k] = unit.x, at[3 * k + 1] = unit.y, at[3 * k + 2] = unit.z;
      }
      continue;
    }
    const VD length = hn::IfThenElse(ordinary, hn::Sqrt(square), hn::Set(d, 1.0));
    Stored({hn::Div(n.x, length), hn::Div(n.y, length), hn::Div(n.z, length)}, at);
  }
}

DeformKernels FindDeformKernels() { return {AddTarget, Skin, Normalize}; }

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {

HWY_EXPORT(FindDeformKernels);

namespace {

std::vector<double> widened(const std::vector<Vec3f>& all) {
  std::vector<double> wide(3 * (all.size() + kVertices));
  if (!all.empty()) std::copy_n(&all.front().x, 3 * all.size(), wide.begin());
  return wide;
}

std::vector<Vec3f> rounded(const std::vector<double>& wide, std::size_t count) {
  std::vector<Vec3f> all(count);
  for (std::size_t i = 0; i < count; ++i) {
    all[i] = Vec3f(Vec3d{wide[3 * i], wide[3 * i + 1], wide[3 * i + 2]});
  }
  return all;
}

}  // namespace

DeformedVertices deformVertices(const Deformation& deformation, const DeformationPose& pose) {
  const DeformKernels kernels = HWY_DYNAMIC_DISPATCH(FindDeformKernels)();
  const std::size_t count = deformation.positions.size();
  const std::size_t withNormals = std::min(deformation.normals.size(), count);
  std::vector<double> positions = widened(deformation.positions);
  std::vector<double> normals = widened(deformation.normals);
  const auto add = [&](const std::vector<Vec3f>& moved, double weight, std::size_t most,
                       std::vector<double>& to) {
    const std::size_t moves = std::min(moved.size(), most);
    if (moves > 0) kernels.addTarget(&moved.front().x, weight, 3 * moves, to.data());
  };
  for (std::size_t i = 0; i < std::min(pose.weights.size(), deformation.targets.size()); ++i) {
    if (pose.weights[i] == 0) continue;
    add(deformation.targets[i].positions, pose.weights[i], count, positions);
    add(deformation.targets[i].normals, pose.weights[i], withNormals, normals);
  }
  DeformedVertices bent;
  if (deformation.hasSkin()) {
    bent.sides.resize(count + kVertices);
    kernels.skin(deformation, pose.joints.data(), count, positions.data(),
                 withNormals == count ? normals.data() : nullptr, bent.sides.data());
    bent.sides.resize(count);
  }
  kernels.normalize(withNormals, normals.data());
  bent.positions = rounded(positions, count);
  bent.normals = rounded(normals, withNormals);
  return bent;
}

}  // namespace whit::simd
#endif
