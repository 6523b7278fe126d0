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
  const FloatTag d;
  const V3 horizon = Broadcast3(sky.horizon);
  const MF above = hn::Ge(direction.y, hn::Zero(d));
  const V3 end = Select3(above, Broadcast3(sky.zenith), Broadcast3(sky.ground));
  return Mix3(horizon, end, hn::Min(hn::Abs(direction.y), hn::Set(d, 1.0f)));
}

// Bilinear in an equirectangular map; wraps around in azimuth, stops at the poles. `image` numbers
// images below each other.
HWY_INLINE V3 ImageSky(const SkyTable& sky, const V3& direction, MF live, VI image) {
  const FloatTag d;
  const IntTag di;
  const VF width = hn::Set(d, static_cast<float>(sky.width));
  const VF height = hn::Set(d, static_cast<float>(sky.height));

  VF turn = hn::Add(AzimuthFraction(direction.x, direction.z), hn::Set(d, sky.turn));
  turn = hn::Sub(turn, hn::Floor(turn));
  const VF y = hn::Min(hn::Max(direction.y, hn::Set(d, -1.0f)), hn::Set(d, 1.0f));
  const VF polar = hn::Mul(hn::Acos(d, y), hn::Set(d, 0.318309886f));

  const VF px = MulThenSub(turn, width, hn::Set(d, 0.5f));
  const VF py = MulThenSub(polar, height, hn::Set(d, 0.5f));
  const VF floorX = hn::Floor(px), floorY = hn::Floor(py);
  const VF fx = hn::Sub(px, floorX), fy = hn::Sub(py, floorY);

  const VI lastX = hn::Set(di, sky.width - 1), lastY = hn::Set(di, sky.height - 1);
  const VI zero = hn::Zero(di), one = hn::Set(di, 1);

  // Not a number has no integer: other lanes may hold it.
  const VI x0 = hn::ConvertTo(di, hn::IfThenElseZero(live, floorX));
  const VI y0 = hn::ConvertTo(di, hn::IfThenElseZero(live, floorY));
  const VI y1 = hn::Add(y0, one);

  // All of these are texels of the image whatever x0 and y0 are, and x0 + 1 may overflow.
  const VI left = hn::IfThenElse(hn::Lt(x0, zero), lastX, hn::Min(x0, lastX));
  const VI right = hn::IfThenZeroElse(hn::Eq(left, lastX), hn::Add(left, one));
  const VI top = hn::Min(hn::Max(y0, zero), lastY), bottom = hn::Min(hn::Max(y1, zero), lastY);

  const VI stride = hn::Set(di, sky.width);
  const VI first = hn::Mul(image, hn::Set(di, sky.height));
  const auto liveInt = hn::RebindMask(di, live);
  const auto index = [&](VI row, VI column) HWY_ATTR {
    return hn::IfThenElseZero(liveInt, hn::Add(hn::Mul(hn::Add(first, row), stride), column));
  };

  const VI i00 = index(top, left), i10 = index(top, right);
  const VI i01 = index(bottom, left), i11 = index(bottom, right);

  const auto channel = [&](const float* plane) HWY_ATTR {
    const VF a = hn::GatherIndex(d, plane, i00), b = hn::GatherIndex(d, plane, i10);
    const VF c = hn::GatherIndex(d, plane, i01), e = hn::GatherIndex(d, plane, i11);
    const VF upper = MulThenAdd(hn::Sub(b, a), fx, a), lower = MulThenAdd(hn::Sub(e, c), fx, c);
    return hn::Mul(MulThenAdd(hn::Sub(lower, upper), fy, upper), hn::Set(d, sky.scale));
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
      return ImageSky(sky, direction, live, hn::Zero(IntTag()));
    case Sky::Kind::none:
      break;
  }
  return Broadcast3(Vec3f());
}

// The counterpart of blurredRadiance().
HWY_INLINE V3 BlurredRadiance(const SkyTable& blurred, const V3& direction, VF roughness, MF live) {
  const FloatTag d;
  const VF blur = hn::Mul(roughness, hn::Set(d, kSkyBlurs - 1.0f));
  const VF lower = hn::Min(hn::Floor(blur), hn::Set(d, kSkyBlurs - 2.0f));
  const VF level = hn::Max(lower, hn::Zero(d));
  const VI image = hn::ConvertTo(IntTag(), hn::IfThenElseZero(live, level));
  const V3 sharper = ImageSky(blurred, direction, live, image);
  const VI next = hn::Add(image, hn::Set(IntTag(), 1));
  return Mix3(sharper, ImageSky(blurred, direction, live, next), hn::Sub(blur, level));
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
    return occluded_ ? Scale3(light, hn::Load(FloatTag(), surfels_.occlusion + i)) : light;
  }

 private:
  HWY_INLINE V3 Unoccluded(size_t i, MF hit) const {
    const FloatTag d;
    const V3 ns = Load3(surfels_.ns, i);
    const V3 albedo = Load3(surfels_.diffuse, i);
    const V3 all = Mul3(albedo, MulAdd3(half_, ns.y, middle_));
    if (HWY_LIKELY(!special_ || hn::AllFalse(d, hit))) return all;

    // Surfaces that reflect the scene do so in place of ambient light.
    const VI material = MaterialNumbers(surfels_, i);
    const VU flags = MaterialLanes(tables_, material, hit).Lobe().flags;
    const V3 left = Select3(HasFlags(flags, kMaterialDiffuses), Broadcast3(Vec3f()), all);
    const MF blurs = hn::And(hit, HasFlags(flags, kMaterialBlursSky));

    if (hn::AllFalse(d, blurs)) return left;

    // Lobes reflect the blurred sky with the share that no mirrored ray stands for.
    const V3 direction = DirectionAt(rays_, i);
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const VF towards = hn::Neg(Dot(ns, direction));
    const VF roughness = hn::Sqrt(hn::Load(d, surfels_.alpha + i));
    const V3 mirrored = Normalize3(MulAdd3(ns, hn::Add(towards, towards), direction));
    const V3 sky = BlurredRadiance(tables_.blurredSky, mirrored, roughness, blurs);

    V3 lobe = Load3(surfels_.lobe, i);
    const MF smooth = HasFlags(flags, kMaterialMirrorsByLobe);
    lobe = Scale3(lobe, hn::Sub(one, hn::IfThenElseZero(smooth, MirroredShare(roughness))));

    // A mirror or a coat lies above the lobe.
    if (HWY_UNLIKELY(!hn::AllFalse(d, hn::And(hit, HasFlags(flags, kMaterialReflects))))) {
      const VF cosine = hn::Min(hn::Max(towards, zero), one);
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
