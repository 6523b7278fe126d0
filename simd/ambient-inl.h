// Radiance of the sky along unit directions, and ambient light that surfels reflect (the scalar
// reference: src/reference/write_emitted_and_reflective_ambient.h).
#if defined(WHIT_SIMD_AMBIENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WHIT_SIMD_AMBIENT_INL_H_
#undef WHIT_SIMD_AMBIENT_INL_H_
#else
#define WHIT_SIMD_AMBIENT_INL_H_
#endif

#include "simd/lobes-inl.h"
#include "simd/material-inl.h"
#include "stages/chunk.h"
#include "stages/shading_tables.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

HWY_INLINE V3 Mix3(const V3& a, const V3& b, VF t) { return MulAdd3(Sub3(b, a), t, a); }

HWY_INLINE V3 GradientSky(const SkyTable& sky, const V3& direction) {
  const V3 horizon = Broadcast3(sky.horizon);
  const MF above = Ge(direction.y, Zero());
  const V3 end = Select3(above, Broadcast3(sky.zenith), Broadcast3(sky.ground));
  return Mix3(horizon, end, Min(Abs(direction.y), Set(1.0f)));
}

// Bilinear in an equirectangular map; wraps around in azimuth, stops at the poles. `image` numbers
// images below each other.
HWY_INLINE V3 ImageSky(const SkyTable& sky, const V3& direction, MF live, VI image) {
  const FloatTag d;
  const IntTag di;
  const VF width = Set(static_cast<float>(sky.width));
  const VF height = Set(static_cast<float>(sky.height));

  VF turn = Add(AzimuthFraction(direction.x, direction.z), Set(sky.turn));
  turn = Sub(turn, Floor(turn));
  const VF y = Min(Max(direction.y, Set(-1.0f)), Set(1.0f));
  const VF polar = Mul(hn::Acos(d, y), Set(0.318309886f));

  const VF px = MulThenSub(turn, width, Set(0.5f));
  const VF py = MulThenSub(polar, height, Set(0.5f));
  const VF floorX = Floor(px), floorY = Floor(py);
  const VF fx = Sub(px, floorX), fy = Sub(py, floorY);

  const VI lastX = Set(sky.width - 1), lastY = Set(sky.height - 1);
  const VI zero = Zero(di), one = Set(1);

  // Not a number has no integer: other lanes may hold it.
  const VI x0 = ConvertTo(di, IfThenElseZero(live, floorX));
  const VI y0 = ConvertTo(di, IfThenElseZero(live, floorY));
  const VI y1 = Add(y0, one);

  // All of these are texels of the image whatever x0 and y0 are, and x0 + 1 may overflow.
  const VI left = IfThenElse(Lt(x0, zero), lastX, Min(x0, lastX));
  const VI right = hn::IfThenZeroElse(Eq(left, lastX), Add(left, one));
  const VI top = Min(Max(y0, zero), lastY), bottom = Min(Max(y1, zero), lastY);

  const VI stride = Set(sky.width);
  const VI first = Mul(image, Set(sky.height));
  const auto liveInt = RebindMask(di, live);
  const auto index = [&](VI row, VI column) HWY_ATTR {
    return IfThenElseZero(liveInt, Add(Mul(Add(first, row), stride), column));
  };

  const VI i00 = index(top, left), i10 = index(top, right);
  const VI i01 = index(bottom, left), i11 = index(bottom, right);

  const auto channel = [&](const float* plane) HWY_ATTR {
    const VF a = GatherIndex(d, plane, i00), b = GatherIndex(d, plane, i10);
    const VF c = GatherIndex(d, plane, i01), e = GatherIndex(d, plane, i11);
    const VF upper = MulThenAdd(Sub(b, a), fx, a), lower = MulThenAdd(Sub(e, c), fx, c);
    return Mul(MulThenAdd(Sub(lower, upper), fy, upper), Set(sky.scale));
  };
  return {channel(sky.r), channel(sky.g), channel(sky.b)};
}

// `live` lanes only; the others may hold anything.
HWY_INLINE V3 SkyRadiance(const SkyTable& sky, const V3& direction, MF live) {
  switch (sky.kind) {
    case Sky::Kind::color:
      return Broadcast3(sky.zenith);
    case Sky::Kind::gradient:
      return GradientSky(sky, direction);
    case Sky::Kind::image:
      return ImageSky(sky, direction, live, Zero(IntTag()));
    case Sky::Kind::none:
      break;
  }
  return Broadcast3(Vec3f());
}

// The counterpart of blurredRadiance().
HWY_INLINE V3 BlurredRadiance(const SkyTable& blurred, const V3& direction, VF roughness, MF live) {
  const VF blur = Mul(roughness, Set(kSkyBlurs - 1.0f));
  const VF lower = Min(Floor(blur), Set(kSkyBlurs - 2.0f));
  const VF level = Max(lower, Zero());
  const VI image = ConvertTo(IntTag(), IfThenElseZero(live, level));
  const V3 sharper = ImageSky(blurred, direction, live, image);
  const VI next = Add(image, Set(1));
  return Mix3(sharper, ImageSky(blurred, direction, live, next), Sub(blur, level));
}

class ReflectedAmbient {
 public:
  HWY_INLINE explicit ReflectedAmbient(const Chunk& c)
      : tables_(c.tables()),
        rays_(c.rays),
        surfels_(c.surfels),
        // down + (up - down) * (1 + n.y) / 2 as middle + half * n.y
        middle_(Broadcast3((tables_.ambient.up + tables_.ambient.down) * 0.5f)),
        half_(Broadcast3((tables_.ambient.up - tables_.ambient.down) * 0.5f)),
        special_((c.materialFlags & (kMaterialDiffuses | kMaterialBlursSky)) != 0),
        occluded_(c.has(Feature::occlusionMaps)),
        mirrorMaps_(c.has(Feature::mirrorMaps)) {}

  // The ambient light at the surfels from i on; `hit` masks the lanes whose ray hit a surface.
  HWY_INLINE V3 At(size_t i, MF hit) const {
    const V3 light = Unoccluded(i, hit);
    return occluded_ ? Scale3(light, Load(surfels_.occlusion, i)) : light;
  }

 private:
  HWY_INLINE V3 Unoccluded(size_t i, MF hit) const {
    const V3 ns = Load3(surfels_.ns, i);
    const V3 albedo = Load3(surfels_.diffuse, i);
    const V3 all = Mul3(albedo, MulAdd3(half_, ns.y, middle_));
    if (HWY_LIKELY(!special_ || AllFalse(hit))) return all;

    // Surfaces that reflect the scene do so in place of ambient light.
    const VI material = MaterialNumbers(surfels_, i);
    const VU flags = MaterialLanes(tables_, material, hit).Lobe().flags;
    const V3 left = Select3(HasFlags(flags, kMaterialDiffuses), Broadcast3(Vec3f()), all);
    const MF blurs = And(hit, HasFlags(flags, kMaterialBlursSky));

    if (AllFalse(blurs)) return left;

    // Lobes reflect the blurred sky with the share that no mirrored ray stands for.
    const V3 direction = DirectionAt(rays_, i);
    const VF one = Set(1.0f);
    const VF towards = Neg(Dot(ns, direction));
    const VF roughness = Sqrt(Load(surfels_.alpha, i));
    const V3 mirrored = Normalize3(MulAdd3(ns, Add(towards, towards), direction));
    const V3 sky = BlurredRadiance(tables_.blurredSky, mirrored, roughness, blurs);

    V3 lobe = Load3(surfels_.lobe, i);
    const MF smooth = HasFlags(flags, kMaterialMirrorsByLobe);
    lobe = Scale3(lobe, Sub(one, IfThenElseZero(smooth, MirroredShare(roughness))));

    // A mirror or a coat lies above the lobe.
    if (HWY_UNLIKELY(!AllFalse(And(hit, HasFlags(flags, kMaterialReflects))))) {
      const VF cosine = Clamped01(towards);
      const V3 mirror = MirrorReflectance(MaterialLanes(tables_, material, hit), surfels_,
                                          mirrorMaps_, cosine, i);
      lobe = Mul3(lobe, Complement3(mirror));
    }

    return Select3(blurs, Add3(left, Mul3(sky, lobe)), left);
  }

  const ShadingTables& tables_;
  RayColumns rays_;
  SurfelColumns surfels_;
  V3 middle_, half_;
  bool special_, occluded_, mirrorMaps_;
};

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
