// addImpulses: the rays that surfels reflect, refract and sample become children, whose radiance
// returns to them. findLayers: how much light each layer of a surface leaves for the layers below.
#include <limits>

#include "simd/kernels.h"
#include "stages/lobes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/add_impulses.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "simd/lobes-inl.h"
#include "simd/material-inl.h"
#include "simd/new_rays-inl.h"
#include "simd/random_streams-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// Copies of what the kernels of this file read from a chunk. Compilers would read the chunk's own
// members again after each store to its columns, because the store might change them.
struct ImpulseJob {
  const Chunk& chunk;
  const ShadingTables& tables = chunk.tables();
  ShadingChoices shading = chunk.options().shading;
  bool last = chunk.depth >= chunk.options().depth;  // all paths end here
  float cutoff = last ? std::numeric_limits<float>::infinity() : chunk.options().cutoff;
  float roulette = last ? 0 : chunk.options().roulette;
  RayColumns rays = chunk.rays, children = chunk.children;
  SurfelColumns surfels = chunk.surfels;
  size_t n = chunk.n;
  LobeSampling glossySampling =
      lobeSampling(chunk.depth, glossySamples(chunk.options()), chunk.sampleNumber);
  bool cones = chunk.has(Feature::cones), coverage = chunk.has(Feature::coverage);
  bool lobes = chunk.has(Feature::lobes), streams = chunk.has(Feature::streams);
  bool transmission = chunk.has(Feature::transmission);
  bool frosted = transmission && (chunk.materialFlags & kMaterialFrosts) != 0;
  bool mirrorMaps = chunk.has(Feature::mirrorMaps);
  bool transmissionMaps = chunk.has(Feature::transmissionMaps);
  float* ended = chunk.radiance.ended;
  // Notes the light that ended paths could bring. Roulette loses none on average.
  bool notesEnds = chunk.has(Feature::ended) && roulette == 0;
};

// The values of a vector of surfels that all kinds of impulse need. Masks select surfels that:
struct ImpulseLanes {
  MF live;        // have an impulse of the kind in question
  MF dielectric;  // bound a medium
  MF hidden;      // bound a medium, where one of a higher priority is already
  MF dimsBelow;   // have a glossy lobe, which takes light from what lies below it
  MF scatters;    // have a glossy lobe that rays sample
  MF mirrors;     // have a glossy lobe that a mirrored ray replaces as far as it is smooth
  MF coated;      // have a mirror that is a coat
  MF chooses;     // follow only one of their lobes
  MF frosts;      // transmit light that rays sample
  MF facets;      // have an interface whose facets reflect in place of the lobe
  V3 direction, ng, ns;
  VF facing;  // cosine between viewer and geometric normal
  VF cosine;  // cosine between viewer and shading normal, in [0, 1]
  VI material;
};

// The least sine over the surface that a child keeps, if `elevation` is what it would have without
// bent normals. The scalar reference is smallestElevation(); src/reference/add_impulses.h gives the
// reasons.
HWY_INLINE VF SmallestElevation(const ImpulseJob& job, VF elevation) {
  if (!job.shading.bend) return Set(-std::numeric_limits<float>::infinity());
  return Min(Mul(Set(0.9f), elevation), Set(0.01f));
}

// Loads the surfels at i, masked to those whose material's flags have `kWanted`.
template <uint32_t kWanted>
HWY_INLINE ImpulseLanes LoadImpulseLanes(const ImpulseJob& job, size_t i) {
  const FloatTag d;
  const IntTag di;
  const RayColumns& rays = job.rays;
  const SurfelColumns& surfels = job.surfels;

  ImpulseLanes lanes;
  lanes.material = Load(di, reinterpret_cast<const int32_t*>(surfels.material) + i);
  lanes.live = RebindMask(d, NonNegative(lanes.material));
  lanes.dielectric = lanes.hidden = lanes.dimsBelow = lanes.scatters = lanes.mirrors =
      lanes.coated = lanes.chooses = lanes.frosts = lanes.facets = hn::MaskFromVec(Zero());
  if (AllFalse(lanes.live)) return lanes;

  const VU flags = MaterialLanes(job.tables, lanes.material, lanes.live).Lobe().flags;
  lanes.live = And(lanes.live, HasFlags(flags, kWanted));
  if (AllFalse(lanes.live)) return lanes;

  // The flags say which layers the material has.
  lanes.coated = HasFlags(flags, kMaterialCoated);
  if (job.lobes) {
    lanes.dimsBelow = And(lanes.live, HasFlags(flags, kMaterialDimsBelow));
    lanes.scatters = And(lanes.live, HasFlags(flags, kMaterialScatters));
    lanes.mirrors = And(lanes.live, HasFlags(flags, kMaterialMirrorsByLobe));
    if (job.chunk.depth > 0) {
      lanes.chooses = And(lanes.scatters, HasFlags(flags, kMaterialDiffuses));
    }
  }

  if (kWanted == kMaterialTransmits || job.transmission) {
    lanes.dielectric = And(lanes.live, HasFlags(flags, kMaterialTransmits));
    lanes.hidden = And(lanes.dielectric, HasFlags(Load(surfels.flags, i), kHidden));
  }

  if (job.frosted) {
    lanes.facets = And(lanes.live, HasFlags(flags, kMaterialFrostedInterface));
    lanes.frosts = And(lanes.live, HasFlags(flags, kMaterialFrosts));
  }

  lanes.direction = DirectionAt(rays, i);
  lanes.ng = Load3(surfels.ng, i);
  lanes.ns = Load3(surfels.ns, i);

  const VF towards = Neg(Dot(lanes.direction, lanes.ns));
  lanes.cosine = Clamped01(towards);
  lanes.facing = Neg(Dot(lanes.direction, lanes.ng));
  return lanes;
}

HWY_INLINE Interface InterfaceOf(const ImpulseJob& job, const ImpulseLanes& lanes, size_t i) {
  const VF before = IorOf(job.tables, Load(job.rays.media, i));
  const VF behind = IorOf(job.tables, Load(job.surfels.mediaBehind, i));
  return DielectricInterface(job.shading.fresnel, before, behind, lanes.cosine);
}

// The share of the light that interfaces reflect, but for facets, which are a lobe.
HWY_INLINE VF SmoothReflectance(const ImpulseJob& job, const ImpulseLanes& lanes, size_t i) {
  return IfThenElseZero(AndNot(lanes.facets, lanes.dielectric),
                        InterfaceOf(job, lanes, i).reflectance);
}

HWY_INLINE V3 MirrorAt(const ImpulseJob& job, const MaterialLanes& material, VF cosine, size_t i) {
  return MirrorReflectance(material, job.surfels, job.mirrorMaps, cosine, i);
}

HWY_INLINE V3 TransmissionAt(const ImpulseJob& job, const MaterialLanes& material, size_t i) {
  const SurfelColumns& s = job.surfels;
  const V3 color = material.Transmission().color;
  if (!job.transmissionMaps) return color;
  return Mul3(color, Load3(s.transmission, i));
}

// Scales the color down where color + taken would exceed 1. The scalar reference, which explains
// it, is limited() in src/reference/add_impulses.cpp.
HWY_INLINE V3 Limited(const V3& color, const V3& taken) {
  const VF one = Set(1.0f), zero = Zero(), largest = MaxComponent(color);
  const MF enough = Ge(Sub(one, MaxComponent(taken)), largest);
  if (HWY_LIKELY(AllTrue(enough))) return color;
  const V3 left{Max(Sub(one, taken.x), zero), Max(Sub(one, taken.y), zero),
                Max(Sub(one, taken.z), zero)};
  const auto own = [&](VF part, VF of)
                       HWY_ATTR { return IfThenElse(Gt(part, of), Div(of, part), one); };
  const VF common = Min(own(color.x, left.x), Min(own(color.y, left.y), own(color.z, left.z)));
  const auto share = [&](VF of) HWY_ATTR {
    return IfThenElse(Ge(of, largest), one, Max(common, Div(of, largest)));
  };
  return Mul3(color, {share(left.x), share(left.y), share(left.z)});
}

// The scalar reference is underMirror in src/reference/add_impulses.cpp.
HWY_INLINE V3 UnderMirror(const ImpulseLanes& lanes, const V3& color, const V3& mirror,
                          const V3& others) {
  const V3 taken = Add3(mirror, others);
  if (HWY_LIKELY(AllFalse(lanes.coated))) return Limited(color, taken);
  return Limited(Select3(lanes.coated, Mul3(color, Complement3(mirror)), color), taken);
}

// Returns the share of the light below their mirrors that the lobes of the surfels at i take, and 0
// in other lanes.
HWY_INLINE V3 LobeAt(const ImpulseJob& job, const ImpulseLanes& lanes, size_t i) {
  if (!job.lobes) return Zero3();
  const SurfelColumns& s = job.surfels;
  return Select3(lanes.dimsBelow, Load3(s.lobe, i), Zero3());
}

// The coverage of the surfels at i.
HWY_INLINE VF CoverageAt(const ImpulseJob& job, size_t i) {
  if (!job.coverage) return Set(1.0f);
  return Load(job.surfels.coverage, i);
}

struct Child {
  V3 origin, direction, weight;
  VU media, path;
  VF largest;  // largest channel of the weight, for the cutoff
  VF cone;
};

// Returns the lanes whose children survive Russian roulette. The weights of those that could have
// been ended grow in return.
HWY_INLINE MF Survivors(const ImpulseJob& job, Child& child, VF& throughput) {
  const VF roulette = Set(job.roulette), one = Set(1.0f);
  const MF survives = Lt(Mul(PathDraw(child.path, kRouletteSalt), roulette), throughput);
  const MF chance = And(survives, Lt(throughput, roulette));
  if (AllFalse(chance)) return survives;
  const VF grows = IfThenElse(chance, Div(roulette, throughput), one);
  child.weight = Scale3(child.weight, grows);
  throughput = IfThenElse(chance, roulette, throughput);
  return survives;
}

// Appends the children that are worth tracing, and returns their number.
HWY_INLINE size_t Append(const ImpulseJob& job, Child child, MF live, size_t i, size_t at) {
  const UintTag du;
  const RayColumns& children = job.children;

  // Without roulette, paths end whose throughput is below the cutoff.
  VF throughput = Mul(Load(job.rays.throughput, i), child.largest);
  const MF worth = HWY_UNLIKELY(job.roulette > 0) ? Survivors(job, child, throughput)
                                                  : Ge(throughput, Set(job.cutoff));
  const MF traced = And(live, And(worth, Gt(child.largest, Zero())));
  if (HWY_UNLIKELY(job.notesEnds)) {
    const VF end = IfThenElseZero(AndNot(worth, live), MaxComponent(child.weight));
    Store(Add(Load(job.ended, i), end), job.ended, i);
  }
  if (AllFalse(traced)) return 0;

  const Compactor compactor(traced);
  compactor.Store(child.origin, children.org, at);
  compactor.Store(child.direction, children.dir, at);
  compactor.Store(child.weight, children.weight, at);
  compactor.Store(throughput, children.throughput + at);
  if (job.transmission) compactor.Store(child.media, children.media + at);
  if (job.streams) compactor.Store(child.path, children.path + at);
  if (job.cones) compactor.Store(child.cone, children.cone + at);
  compactor.Store(hn::Iota(du, static_cast<uint32_t>(i)), children.parent + at);
  return compactor.Count();
}

// The media around a reflected child.
HWY_INLINE VU MediaAt(const ImpulseJob& job, size_t i) {
  if (!job.transmission) return Zero(UintTag());
  return Load(job.rays.media, i);
}

// The number of the child's path.
HWY_INLINE VU ChildStreamsAt(const ImpulseJob& job, size_t i, uint32_t branch) {
  const UintTag du;
  if (!job.streams) return Zero(du);
  return ChildStream(Load(job.rays.path, i), branch);
}

// The cone of a child starts as wide as its parent's ends.
HWY_INLINE VF ConesAt(const ImpulseJob& job, size_t i) {
  if (!job.cones) return Zero();
  return Load(job.surfels.cone, i);
}

// Returns the unit direction `r`, raised to the sine `elevation` above the plane of `ng` if it lies
// lower: a bent normal would send it below the surface (hard case H32).
HWY_INLINE V3 Raised(const V3& r, const V3& ng, VF elevation, MF live) {
  const VF height = Dot(r, ng);
  const MF low = Lt(height, elevation);
  if (HWY_LIKELY(AllFalse(And(low, live)))) return r;
  return Select3(low, NormalizeOr(MulAdd3(ng, Sub(elevation, height), r), ng), r);
}

// Returns the origin of a child. `side` is 1 for the viewer's side of the surface, and -1 for the
// other one.
HWY_INLINE V3 ChildOrigin(const ImpulseJob& job, const ImpulseLanes& lanes, size_t i, float side) {
  const SurfelColumns& surfels = job.surfels;
  const V3 position = Load3(surfels.pos, i);
  return RayOrigin(job.shading.offset, position, lanes.ng, lanes.direction,
                   LoadClearance(surfels, i), side);
}

void AddReflections(Chunk& c) {
  const FloatTag d;
  const ImpulseJob job{c};
  size_t count = c.childCount;

  for (size_t i = 0; i < job.n; i += Lanes(d)) {
    ImpulseLanes lanes = LoadImpulseLanes<kMaterialReflects>(job, i);
    lanes.live = AndNot(lanes.hidden, lanes.live);
    if (AllFalse(lanes.live)) continue;

    // The mirror lies above the interface of a dielectric.
    const MaterialLanes material(job.tables, lanes.material, lanes.live);
    const V3 mirror = MirrorAt(job, material, lanes.cosine, i);
    V3 weight = mirror;
    if (job.coverage) weight = Scale3(weight, CoverageAt(job, i));
    if (job.transmission && !AllFalse(lanes.dielectric)) {
      const VF f = SmoothReflectance(job, lanes, i);
      weight = MulAdd3(weight, Sub(Set(1.0f), f), {f, f, f});
    }

    // The mirrored ray replaces the glossy lobe, by a share that grows as the lobe gets smoother.
    if (!AllFalse(lanes.mirrors)) {
      const VF roughness = Sqrt(Load(job.surfels.alpha, i));
      const VF share = IfThenElseZero(lanes.mirrors, MirroredShare(roughness));
      const V3 lobe = Mul3(LobeAt(job, lanes, i), Complement3(mirror));
      weight = MulAdd3(lobe, Mul(share, CoverageAt(job, i)), weight);
    }

    // d - 2 (d.n) n
    const VF twice = Mul(Set(-2.0f), Dot(lanes.direction, lanes.ns));
    const V3 mirrored = Normalize3(MulAdd3(lanes.ns, twice, lanes.direction));
    const V3 r = Raised(mirrored, lanes.ng, SmallestElevation(job, lanes.facing), lanes.live);

    const Child child{ChildOrigin(job, lanes, i, 1.0f),
                      r,
                      weight,
                      MediaAt(job, i),
                      ChildStreamsAt(job, i, kMirroredBranch),
                      MaxComponent(weight),
                      ConesAt(job, i)};

    count += Append(job, child, lanes.live, i, count);
  }
  c.childCount = count;
}

// Describes the facets of glossy lobes and of frosted glass.
class Facets {
 public:
  HWY_INLINE Facets(const ImpulseJob& job, const ImpulseLanes& lanes, size_t i)
      : ofInterface(lanes.facets), any(!AllFalse(ofInterface)), model_(job.shading.fresnel) {
    before_ = behind_ = Set(1.0f);
    if (any) {
      before_ = IorOf(job.tables, Load(job.rays.media, i));
      behind_ = IorOf(job.tables, Load(job.surfels.mediaBehind, i));
    }
    const MF flat = And(ofInterface, Eq(before_, behind_));
    lobes = LoadGlossyLobes(job.tables, job.surfels, lanes.direction, lanes.ns, flat, i);
  }

  HWY_INLINE Facet At(const UnitPoints& at) const {
    Facet facet = FacetAt(lobes, at);
    if (!any) return facet;
    const VF f = InterfaceAt(facet.cosine).reflectance;
    facet.reflectance = Select3(ofInterface, {f, f, f}, facet.reflectance);
    return facet;
  }

  HWY_INLINE Interface InterfaceAt(VF cosine) const {
    return DielectricInterface(model_, before_, behind_, cosine);
  }

  GlossyLobes lobes;
  MF ofInterface;
  bool any;  // true if any lane has an interface

 private:
  FresnelModel model_;
  VF before_, behind_;
};

// AddSamples() takes a structure like this for each sampled lobe. `kSide` is RayOrigin's, At()
// returns a sample, and `several` are the lanes that take more than one.
struct GlossySamples {
  static constexpr const Lobe& kLobe = kGlossyLobe;
  static constexpr float kSide = 1;

  HWY_INLINE GlossySamples(const ImpulseJob& job, const ImpulseLanes& lanes, size_t i)
      : facets(job, lanes, i), several(facets.lobes.rough) {}
  HWY_INLINE LobeSample At(const UnitPoints& at) const {
    const Facet facet = facets.At(at);
    return {facet.mirrored, Scale3(facet.reflectance, PassingShare(facets.lobes, facet.elevation)),
            facet.elevation};
  }

  Facets facets;
  MF several;  // a smooth lobe is one impulse
};

// Draws directions of transmitted light through frosted glass. The scalar reference is
// frostedImpulse() in src/reference/add_impulses.cpp.
struct FrostedSamples {
  static constexpr const Lobe& kLobe = kFrostedLobe;
  static constexpr float kSide = -1;

  HWY_INLINE FrostedSamples(const ImpulseJob& job, const ImpulseLanes& lanes, size_t i)
      : facets(job, lanes, i),
        several(facets.lobes.rough),
        reflects(lanes.scatters),
        straight(AndNot(several, InterfaceOf(job, lanes, i).straight)) {}

  HWY_INLINE LobeSample At(const UnitPoints& at) const {
    const VF one = Set(1.0f);
    const GlossyLobes& lobes = facets.lobes;
    const Facet facet = facets.At(at);

    // A sheet mirrors the mirrored direction once more.
    VF depth = Abs(facet.elevation), passes = one;
    const VF twice = Add(depth, facet.elevation);
    V3 direction = MulAdd3(lobes.z, Neg(twice), facet.mirrored);

    // An interface bends the direction at the facet.
    if (facets.any) {
      const Interface bending = facets.InterfaceAt(facet.cosine);
      const V3 back = MulAdd3(facet.normal, bending.bend, lobes.view);
      const VF scale = Div(Set(-1.0f), bending.eta);
      direction =
          Select3(facets.ofInterface, NormalizeOr(Scale3(back, scale), facet.normal), direction);
      const VF below = Neg(Dot(lobes.z, direction));
      depth = IfThenElse(facets.ofInterface, below, depth);
      passes = IfThenElse(facets.ofInterface, SeenShare(below, lobes.alpha), one);
    }

    const V3 reflected = Select3(reflects, facet.reflectance, Zero3());
    return {direction, Scale3(Complement3(reflected), passes), depth};
  }

  Facets facets;
  MF several, reflects;
  MF straight;  // the direction does not change at all
};

struct DiffuseSamples {
  static constexpr const Lobe& kLobe = kDiffuseLobe;
  static constexpr float kSide = 1;

  HWY_INLINE DiffuseSamples(const ImpulseJob& job, const ImpulseLanes& lanes, size_t i)
      : normal(lanes.ns),
        albedo(Load3(job.surfels.diffuse, i)),
        lobes(lanes.ns),
        several(lanes.live) {}
  HWY_INLINE LobeSample At(const UnitPoints& at) const {
    const V3 direction = lobes.Direction(at);
    return {direction, albedo, Dot(normal, direction)};
  }

  V3 normal, albedo;
  CosineLobes lobes;
  MF several;
};

// The scalar reference is pointOf() in src/stages/lobes.h.
template <const Lobe& kLobe>
HWY_INLINE UnitPoints PointsOf(VU path, LobeSampling sampling, uint32_t k) {
  sampling.lattice = kLobe.lattice;
  if constexpr (kLobe.salt == 0) {
    return LobePoints(path, sampling, k);
  } else {
    return SaltedPoints(path, sampling, kLobe.salt, k);
  }
}

// The light that mirror and interface leave for the samples of a glossy lobe.
HWY_INLINE V3 LeftAboveLobe(const ImpulseJob& job, const ImpulseLanes& lanes, size_t i) {
  const MaterialLanes material(job.tables, lanes.material, lanes.live);
  const V3 left = Complement3(MirrorAt(job, material, lanes.cosine, i));
  if (!job.transmission || AllFalse(lanes.dielectric)) return left;
  const VF f = SmoothReflectance(job, lanes, i);
  return Scale3(left, Sub(Set(1.0f), f));
}

// The albedo of the glossy lobes towards the viewer: of those that are sampled, the mean weight of
// the samples that AddSamples() takes.
HWY_INLINE V3 WeightOfLobe(const ImpulseJob& job, const ImpulseLanes& lanes, size_t i) {
  const VF zero = Zero();
  const SurfelColumns& s = job.surfels;
  V3 weight = Zero3();
  if (AllFalse(lanes.dimsBelow)) return weight;

  // The albedo of lobes that no rays sample is looked up.
  if (!AllTrue(Or(lanes.scatters, hn::Not(lanes.dimsBelow)))) {
    const V3 f0 = Load3(s.specular, i);
    const VF roughness = Sqrt(Load(s.alpha, i));
    const VF f90 = LobeGrazing(job.tables, s, f0, i);
    weight = LobeAlbedo(*job.tables.lobes, f0, f90, lanes.cosine, roughness, lanes.dimsBelow);
    weight = Select3(lanes.dimsBelow, weight, Zero3());
  }
  if (AllFalse(lanes.scatters)) return weight;

  const GlossySamples samples(job, lanes, i);
  const VU path = Load(job.rays.path, i);
  V3 sum = Zero3();
  for (uint32_t k = 0; k < job.glossySampling.count; ++k) {
    const LobeSample sample = samples.At(PointsOf<kGlossyLobe>(path, job.glossySampling, k));
    sum = Select3(Gt(sample.cosine, zero), Add3(sum, sample.weight), sum);
  }
  const VF share = Set(1.0f / static_cast<float>(job.glossySampling.count));
  return Select3(lanes.scatters, Scale3(sum, share), weight);
}

// The scalar reference is findLayers in src/reference/add_impulses.cpp.
void FindLayers(Chunk& c) {
  const FloatTag d;
  const ImpulseJob job{c};
  const SurfelColumns& surfels = job.surfels;
  const VF one = Set(1.0f), zero = Zero();
  for (size_t i = 0; i < job.n; i += Lanes(d)) {
    ImpulseLanes lanes = LoadImpulseLanes<kMaterialLayered>(job, i);
    lanes.live = AndNot(lanes.hidden, lanes.live);
    lanes.dimsBelow = And(lanes.dimsBelow, lanes.live);
    if (AllFalse(lanes.live)) continue;

    // `below` is the share of the light that reaches the diffuse layer.
    const MaterialLanes material(job.tables, lanes.material, lanes.live);
    const V3 mirror = MirrorAt(job, material, lanes.cosine, i);
    const V3 albedo = WeightOfLobe(job, lanes, i);
    V3 lobe = albedo, below = Complement3(albedo), through = Zero3();

    // Dielectrics transmit a part and reflect a part, which lobe and diffuse layer do not get.
    if (job.transmission) {
      const V3 transmission = TransmissionAt(job, material, i);
      const MF transmits =
          And(lanes.dielectric, Gt(MaxComponent(material.Transmission().color), zero));
      const VF passed = Sub(one, SmoothReflectance(job, lanes, i));
      through = Select3(transmits, UnderMirror(lanes, transmission, mirror, through), through);
      lobe = Scale3(lobe, passed);
      below = Scale3(below, passed);
    }

    if (job.lobes) {
      const V3 before = Load3(surfels.lobe, i);
      Store3(Select3(lanes.live, lobe, before), surfels.lobe, i);
    }
    const V3 diffuse = Load3(surfels.diffuse, i);
    const V3 left = Mul3(UnderMirror(lanes, diffuse, mirror, through), below);
    Store3(Select3(lanes.live, left, diffuse), surfels.diffuse, i);
  }
}

// The counterpart of factorOfLobe() behind the first hit: 0 where the other lobe is followed.
HWY_INLINE VF FactorOfChoice(const ImpulseJob& job, const ImpulseLanes& lanes, bool isGlossy,
                             size_t i) {
  const VF zero = Zero(), one = Set(1.0f);
  const SurfelColumns& s = job.surfels;
  const MaterialLanes material(job.tables, lanes.material, lanes.live);
  const V3 left = Complement3(MirrorAt(job, material, lanes.cosine, i));
  const VF glossy = MaxComponent(Mul3(LobeAt(job, lanes, i), left));
  const VF diffuse = MaxComponent(Load3(s.diffuse, i));
  const VF both = Add(glossy, diffuse);

  const VU path = Load(job.rays.path, i);
  const MF followsGlossy = Lt(Mul(PathDraw(path, kLobeSalt), both), glossy);
  const MF followed = isGlossy ? followsGlossy : hn::Not(followsGlossy);
  const VF own = isGlossy ? glossy : diffuse;
  const VF grows = IfThenElse(Gt(own, zero), Div(both, own), one);
  return IfThenElse(lanes.chooses, IfThenElseZero(followed, grows), one);
}

// The lanes whose transmitted light is sampled: sheets that lie on a dielectric's face are clear.
HWY_INLINE MF Frosts(const ImpulseJob& job, const ImpulseLanes& lanes, size_t i) {
  if (AllFalse(lanes.frosts)) return lanes.frosts;
  const MF scatters = Or(lanes.facets, InterfaceOf(job, lanes, i).straight);
  return AndNot(lanes.hidden, And(lanes.frosts, scatters));
}

// The light that the layers above leave for samples of this kind.
template <typename Samples>
HWY_INLINE V3 LeftForSamples(const ImpulseJob& job, const ImpulseLanes& lanes, size_t i) {
  const VF one = Set(1.0f);
  if constexpr (Samples::kLobe.flag == kMaterialScatters) return LeftAboveLobe(job, lanes, i);
  if constexpr (Samples::kLobe.flag == kMaterialFrosts) {
    const MaterialLanes material(job.tables, lanes.material, lanes.live);
    const V3 mirror = MirrorAt(job, material, lanes.cosine, i);
    return UnderMirror(lanes, TransmissionAt(job, material, i), mirror, Broadcast3(Vec3f()));
  }
  return {one, one, one};
}

template <typename Samples>
HWY_INLINE void AddSamples(Chunk& c) {
  constexpr const Lobe& kLobe = Samples::kLobe;
  const FloatTag d;
  const ImpulseJob job{c};
  const LobeSampling sampling = lobeSampling(c.depth, kLobe.samples(c.options()), c.sampleNumber);
  const VF one = Set(1.0f), share = Set(1.0f / static_cast<float>(sampling.count));
  constexpr bool kPasses = Samples::kSide < 0;

  // The scalar reference is factorOfLobe() in src/reference/add_impulses.cpp.
  const bool occluded = !kPasses && c.depth == 0 && c.has(Feature::occlusionMaps);

  size_t count = c.childCount;

  for (size_t i = 0; i < job.n; i += Lanes(d)) {
    ImpulseLanes lanes = LoadImpulseLanes<kLobe.flag>(job, i);
    lanes.live = kPasses ? Frosts(job, lanes, i) : AndNot(lanes.hidden, lanes.live);
    if (AllFalse(lanes.live)) continue;

    V3 left = LeftForSamples<Samples>(job, lanes, i);
    if (HWY_UNLIKELY(!kPasses && !AllFalse(lanes.chooses))) {
      const VF factor = FactorOfChoice(job, lanes, kLobe.flag == kMaterialScatters, i);
      lanes.live = And(lanes.live, Gt(factor, Zero()));
      if (AllFalse(lanes.live)) continue;
      left = Scale3(left, factor);
    }

    if (job.coverage) left = Scale3(left, CoverageAt(job, i));
    if (occluded) left = Scale3(left, Load(job.surfels.occlusion, i));

    const Samples samples(job, lanes, i);
    const VF counts = IfThenElse(samples.several, share, one);
    const V3 origin = ChildOrigin(job, lanes, i, Samples::kSide);
    const VU media = kPasses ? Load(job.surfels.mediaBehind, i) : MediaAt(job, i);
    const V3 outward = Scale3(lanes.ng, Set(Samples::kSide));
    const VU path = Load(job.rays.path, i);
    const VF cone = ConesAt(job, i);

    // The first sample stands for all of a lobe that is a single impulse.
    for (uint32_t k = 0; k < sampling.count; ++k) {
      const MF sampled = k == 0 ? lanes.live : And(lanes.live, samples.several);
      if (AllFalse(sampled)) break;

      LobeSample sample = samples.At(PointsOf<kLobe>(path, sampling, k));
      sample.weight = Mul3(sample.weight, left);
      const MF live = And(sampled, Gt(sample.cosine, Zero()));
      V3 r = Raised(sample.direction, outward, SmallestElevation(job, sample.cosine), live);
      if constexpr (kPasses) r = Select3(samples.straight, lanes.direction, r);

      const Child child{origin,
                        r,
                        Scale3(sample.weight, counts),
                        media,
                        ChildStream(path, kLobe.firstBranch + k),
                        MaxComponent(sample.weight),
                        cone};
      count += Append(job, child, live, i, count);
    }
  }
  c.childCount = count;
}

void AddGlossyReflections(Chunk& c) { AddSamples<GlossySamples>(c); }
void AddFrostedRefractions(Chunk& c) { AddSamples<FrostedSamples>(c); }
void AddIndirect(Chunk& c) { AddSamples<DiffuseSamples>(c); }

void AddRefractions(Chunk& c) {
  const FloatTag d;
  const ImpulseJob job{c};
  const VF one = Set(1.0f);

  size_t count = c.childCount;
  for (size_t i = 0; i < job.n; i += Lanes(d)) {
    const ImpulseLanes lanes = LoadImpulseLanes<kMaterialTransmits>(job, i);
    if (AllFalse(lanes.live)) continue;

    const Interface interface = InterfaceOf(job, lanes, i);
    const MaterialLanes material(job.tables, lanes.material, lanes.live);
    const VF through = Sub(one, interface.reflectance);
    const V3 mirror = MirrorAt(job, material, lanes.cosine, i);

    // The mirror and the lobe lie above what passes.
    V3 transmittance = UnderMirror(lanes, TransmissionAt(job, material, i), mirror, Zero3());
    if (!AllFalse(lanes.dimsBelow)) {
      const VF inverse = Div(one, Max(through, Set(1e-30f)));
      const V3 albedo = Scale3(LobeAt(job, lanes, i), inverse);
      transmittance = Mul3(transmittance, Complement3(albedo));
    }

    // Samples bring what frosted glass transmits.
    transmittance = Select3(Frosts(job, lanes, i), Zero3(), transmittance);

    if (job.coverage) {
      const VF covered = CoverageAt(job, i), rest = Sub(one, covered);
      transmittance = MulAdd3(transmittance, covered, {rest, rest, rest});
    }

    const V3 weight = Select3(lanes.hidden, {one, one, one}, Scale3(transmittance, through));
    const V3 bent = MulAdd3(lanes.ns, Neg(interface.bend), lanes.direction);
    V3 r = NormalizeOr(Scale3(bent, Div(one, interface.eta)), lanes.direction);

    // A bent normal must not send the ray back out of the surface (hard case H32).
    const VF height = Dot(r, lanes.ng);
    // Under the geometric normal the ray would leave this steeply, if at all; normals that agree
    // change nothing.
    const VF g2 = MulThenAdd(lanes.facing, lanes.facing, interface.k);
    const VF leaving = Div(Sqrt(Max(g2, Zero())), interface.eta);
    const VF elevation = SmallestElevation(job, IfThenElse(Gt(g2, Zero()), leaving, one));
    const MF high = Gt(height, Neg(elevation));

    const V3 pressed =
        NormalizeOr(MulAdd3(lanes.ng, Neg(Add(elevation, height)), r), lanes.direction);
    r = Select3(high, pressed, r);
    r = Select3(Or(interface.straight, lanes.hidden), lanes.direction, r);

    const Child child{ChildOrigin(job, lanes, i, -1.0f),
                      r,
                      weight,
                      Load(job.surfels.mediaBehind, i),
                      ChildStreamsAt(job, i, kRefractedBranch),
                      MaxComponent(weight),
                      ConesAt(job, i)};
    count += Append(job, child, lanes.live, i, count);
  }
  c.childCount = count;
}

// The radiance at i, as the parent's radiance or the eye gets it.
HWY_INLINE V3 WeightedRadiance(const Chunk& c, size_t i) {
  const V3 weight = Load3(c.rays.weight, i);
  return Mul3(weight, Load3(c.radiance.rgb, i));
}

void ReturnImpulses(Chunk& c) {
  const FloatTag d;
  const Columns3 parentRadiance = c.parentRadiance.rgb;
  const size_t n = c.n;
  HWY_ALIGN float r[16], g[16], b[16];
  const Columns3 perLane{r, g, b};
  for (size_t i = 0; i < n; i += Lanes(d)) {
    Store3(WeightedRadiance(c, i), perLane, 0);

    // A parent may occur twice, for its reflected and its refracted child: one after the other.
    const size_t live = HWY_MIN(Lanes(d), n - i);
    for (size_t lane = 0; lane < live; ++lane) {
      const uint32_t parent = c.rays.parent[i + lane];
      parentRadiance.set(parent, parentRadiance.at(parent) + perLane.at(lane));
    }
  }
}

void ReturnToEye(Chunk& c) {
  const FloatTag d;
  const RadianceColumns radiance = c.radiance;
  const size_t n = c.n;
  for (size_t i = 0; i < n; i += Lanes(d)) {
    Store3(WeightedRadiance(c, i), radiance.rgb, i);
  }
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
WHIT_EXPORT_KERNEL(FindLayers)
WHIT_EXPORT_KERNEL(AddReflections)
WHIT_EXPORT_KERNEL(AddGlossyReflections)
WHIT_EXPORT_KERNEL(AddRefractions)
WHIT_EXPORT_KERNEL(AddFrostedRefractions)
WHIT_EXPORT_KERNEL(AddIndirect)
WHIT_EXPORT_KERNEL(ReturnImpulses)
WHIT_EXPORT_KERNEL(ReturnToEye)
}  // namespace whit::simd
#endif
