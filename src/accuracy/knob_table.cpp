// One row for each option that trades accuracy for time.
#include "accuracy/idle_knobs.h"
#include "accuracy/knob_row.h"
#include "accuracy/knobs.h"

namespace whit::accuracy {

namespace {

using O = RenderOptions;

Knob cutoffKnob() {
  Knob knob = knobOf<float>({"cutoff",
                             [](O& o) -> float& { return o.cutoff; },
                             Cause::algorithm,
                             0,
                             {0, 1e-4f, 3e-4f, 1e-3f, 4e-3f, 1.6e-2f},
                             {1e-4f, 1e-3f, 4e-3f},
                             {3e-4f}},
                            withoutImpulses);
  knob.values.front().idle = whereRaysBranch;
  knob.makeExact = [](O& o, const Exactness& exactness) { o.cutoff = exactness.cutoff; };
  return knob;
}

// Of lobes, a sample of a pixel of the reference. That has many of those.
constexpr int kExactGlossy = 4;

// Of adaptive supersampling: more than the 16 that are sampled everywhere, because they make up for
// the pixels that get few.
constexpr int kAdaptiveSpp = 24;

Knob adaptiveKnob() {
  Knob knob = knobOf<bool>({"adaptive",
                            [](O& o) -> bool& { return o.adaptive; },
                            Cause::sampling,
                            false,
                            {false, true},
                            {}},
                           never);
  KnobValue& on = knob.values.back();
  on.apply = [](O& o) { o.adaptive = true, o.spp = kAdaptiveSpp; };
  on.alongside = {"--spp", labelOf(kAdaptiveSpp)};
  return knob;
}

Knob contrastKnob() {
  Knob knob = knobOf<int>({"contrast",
                           [](O& o) -> int& { return o.contrast; },
                           Cause::sampling,
                           kDefaultContrast,
                           {kDefaultContrast, 4, 16, 24},
                           {}},
                          never);
  for (KnobValue& value : knob.values) {
    if (value.label == labelOf(kDefaultContrast)) continue;
    value.apply = [set = value.apply](O& o) {
      set(o);
      o.adaptive = true, o.spp = kAdaptiveSpp;
    };
    value.alongside = {"--adaptive", "on", "--spp", labelOf(kAdaptiveSpp)};
  }
  return knob;
}

std::vector<Knob> makeKnobs() {
  constexpr Cause kSampling = Cause::sampling, kAlgorithm = Cause::algorithm,
                  kArithmetic = Cause::arithmetic;
  return {
      knobOf<int>({"spp",
                   [](O& o) -> int& { return o.spp; },
                   kSampling,
                   1,
                   {1, 2, 4, 8, 16},
                   {1, 4, 16},
                   {2}},
                  never),
      adaptiveKnob(),
      contrastKnob(),
      knobOf<int>({"depth",
                   [](O& o) -> int& { return o.depth; },
                   kAlgorithm,
                   kDepthLimit,
                   {0, 1, 2, 3, 4, 8, 16, 32, kDepthLimit},
                   {4, 8, kDepthLimit},
                   {1, 3, 16, 32}},
                  withoutImpulses),
      cutoffKnob(),
      knobOf<int>({"glossy",
                   [](O& o) -> int& { return o.glossy; },
                   kSampling,
                   kExactGlossy,
                   {0, 1, 4, 16},
                   {},
                   {1, 4, 16}},
                  withoutGlossyReflection),
      knobOf<float>({"light-cutoff",
                     [](O& o) -> float& { return o.shading.lightCutoff; },
                     kAlgorithm,
                     0,
                     {0, 1e-4f, 1e-3f, 4e-3f},
                     {0, 4e-3f},
                     {1e-4f}},
                    withoutLights),
      knobOf<FresnelModel>({"fresnel",
                            [](O& o) -> FresnelModel& { return o.shading.fresnel; },
                            kAlgorithm,
                            FresnelModel::exact,
                            {FresnelModel::exact, FresnelModel::schlick},
                            {}},
                           withoutTransmission, named<FresnelModel>({"exact", "schlick"})),
      knobOf<OffsetMethod>({"offset",
                            [](O& o) -> OffsetMethod& { return o.shading.offset; },
                            kAlgorithm,
                            OffsetMethod::bound,
                            {OffsetMethod::bound, OffsetMethod::fixed, OffsetMethod::wachterBinder},
                            {},
                            {OffsetMethod::fixed, OffsetMethod::wachterBinder}},
                           withoutSecondaryRays,
                           named<OffsetMethod>({"bound", "fixed", "wachter-binder"})),
      knobOf<bool>({"terminator",
                    [](O& o) -> bool& { return o.shading.terminator; },
                    kAlgorithm,
                    false,
                    {false, true},
                    {},
                    {true}},
                   withoutSmoothShadows),
      knobOf<bool>({"bend",
                    [](O& o) -> bool& { return o.shading.bend; },
                    kAlgorithm,
                    true,
                    {true, false},
                    {},
                    {false}},
                   withoutBentImpulses),
      knobOf<TextureFilter>(
          {"texture-filter",
           [](O& o) -> TextureFilter& { return o.shading.textureFilter; },
           kAlgorithm,
           TextureFilter::bilinear,
           {TextureFilter::bilinear, TextureFilter::nearest, TextureFilter::trilinear},
           {}},
          withoutTextures, named<TextureFilter>({"nearest", "bilinear", "trilinear"})),
      knobOf<Mode>({"mode",
                    [](O& o) -> Mode& { return o.mode; },
                    kArithmetic,
                    Mode::reference,
                    {Mode::packets, Mode::reference},
                    {},
                    {Mode::reference}},
                   never, named<Mode>({"packets", "reference"})),
      knobOf<FilmPrecision>({"film",
                             [](O& o) -> FilmPrecision& { return o.film; },
                             kArithmetic,
                             FilmPrecision::single,
                             {FilmPrecision::single, FilmPrecision::half, FilmPrecision::eightBit},
                             {},
                             {FilmPrecision::half, FilmPrecision::eightBit}},
                            never, named<FilmPrecision>({"float", "half", "8bit"})),
      knobOf<SrgbEncoding>({"srgb",
                            [](O& o) -> SrgbEncoding& { return o.srgb; },
                            kArithmetic,
                            SrgbEncoding::exact,
                            {SrgbEncoding::exact, SrgbEncoding::table},
                            {},
                            {SrgbEncoding::table}},
                           never, named<SrgbEncoding>({"exact", "table"})),
      knobOf<Reciprocal>({"reciprocal",
                          [](O& o) -> Reciprocal& { return o.shading.reciprocal; },
                          kArithmetic,
                          Reciprocal::exact,
                          {Reciprocal::exact, Reciprocal::refined, Reciprocal::approximate},
                          {},
                          {Reciprocal::refined, Reciprocal::approximate}},
                         never, named<Reciprocal>({"exact", "refined", "approximate"})),
      knobOf<bool>({"robust",
                    [](O& o) -> bool& { return o.robust; },
                    kArithmetic,
                    true,
                    {true, false},
                    {true, false}},
                   never),
      knobOf<bool>({"retry",
                    [](O& o) -> bool& { return o.retry; },
                    kArithmetic,
                    true,
                    {true, false},
                    {},
                    {false}},
                   never),
      knobOf<BvhQuality>({"bvh",
                          [](O& o) -> BvhQuality& { return o.bvh; },
                          kArithmetic,
                          BvhQuality::medium,
                          {BvhQuality::low, BvhQuality::medium, BvhQuality::high},
                          {},
                          {BvhQuality::low, BvhQuality::high}},
                         never, named<BvhQuality>({"low", "medium", "high"})),
      knobOf<int>({"packet",
                   [](O& o) -> int& { return o.packet; },
                   kArithmetic,
                   0,
                   {1, 4, 8, 16},
                   {},
                   {1, 4, 8, 16}},
                  never),
      knobOf<EffectChoice>({"effects",
                            [](O& o) -> EffectChoice& { return o.effects; },
                            kArithmetic,
                            EffectChoice::automatic,
                            {EffectChoice::automatic, EffectChoice::all},
                            {},
                            {EffectChoice::all}},
                           never, named<EffectChoice>({"auto", "all"})),
  };
}

}  // namespace

const std::vector<Knob>& allKnobs() {
  static const std::vector<Knob> knobs = makeKnobs();
  return knobs;
}

}  // namespace whit::accuracy
