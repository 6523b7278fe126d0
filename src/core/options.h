// Every option of a render, declared once: a member of RenderOptions and its entry in
// withOptions(). The command line, --help, the manual page, the metadata of images, the library,
// what a renderer makes anew, the viewer's panel and the sweep of `whit accuracy` all follow from
// the entry.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "core/channels.h"
#include "core/effects.h"
#include "core/option_spec.h"
#include "core/shading_choices.h"
#include "core/vec3.h"

namespace whit {

enum class Mode { packets, reference };
enum class Batch { tile, frame };
enum class EffectChoice { automatic, all };
enum class ToneCurve { none, filmic, reinhard };
// How the picture is kept before exposure and encoding.
enum class FilmPrecision { single, half, eightBit };
// sRGB codes: rounded exactly, or looked up at the nearest of 4096 equal steps of linear light.
enum class SrgbEncoding { exact, table };
enum class Quality { draft, standard, fine, reference };
enum class BvhQuality { low, medium, high };
// Of shadows, proved beforehand (verdicts/verdict_tables.h): where that pays; never; or traced all
// the same, and the frame fails where one is wrong.
enum class Verdicts { automatic, off, audit };

// What several options need.
inline constexpr Need kNeedsImpulses{EffectSet().with(Effect::mirror).with(Effect::transmission),
                                     "nothing in the scene reflects or refracts"};
inline constexpr Need kNeedsVertexNormals{EffectSet().with(Effect::smoothNormals),
                                          "all surfaces are flat"};

// Of 8-bit output, in EV. An automatic one follows from the view (render/auto_exposure.h); until
// then it is 0.
struct Exposure {
  float ev = 0;
  bool automatic = false;
  bool operator==(const Exposure&) const = default;
};
struct ImageSize {
  int width = 0, height = 0;
  bool operator==(const ImageSize&) const = default;
};
// Pixels [x0, x1) x [y0, y1), from the top left.
struct Crop {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool operator==(const Crop&) const = default;
};

inline constexpr int kDepthLimit = 64;
inline constexpr int kSphereSegmentsLimit = 4096;

// In the order of their entries below.
struct RenderOptions {
  std::optional<ImageSize> size;
  std::string camera;
  std::optional<Vec3f> eye, at, up;
  std::optional<float> fov, ortho;
  std::optional<Crop> crop;
  int spp = 1;
  bool adaptive = false;
  int contrast = 8;  // neighbors that differ by more in some 8-bit code show an edge
  int depth = kDepthLimit;
  int glossy = 0;    // samples of a rough surface's lobe; 0: it reflects lights only
  int indirect = 0;  // samples of what a diffuse surface reflects of the scene; 0: lights only
  float cutoff = 1.0e-4f;
  float roulette =
      0;  // throughput below which impulses survive by chance; 0: all that are worth it
  int lightSamples = 1;    // points of a light with a radius; 1: its center
  int ambientSamples = 0;  // rays that look for what occludes ambient light; 0: nothing does
  ShadingChoices shading;
  int threads = 0;  // 0: what affinity and cgroup quota allow
  int packet = 0;   // 0: the widest the CPU runs natively
  std::string simd = "auto";
  Mode mode = Mode::packets;
  Batch batch = Batch::tile;
  bool robust = true, retry = true;
  BvhQuality bvh = BvhQuality::medium;
  Verdicts verdicts = Verdicts::automatic;
  int sphereSegments = 0;  // of the triangles in place of each sphere; 0: it is exact
  EffectChoice effects = EffectChoice::automatic;
  Quality quality = Quality::standard;
  EffectSet disable;
  Exposure exposure;
  ToneCurve toneCurve = ToneCurve::none;
  FilmPrecision film = FilmPrecision::single;
  SrgbEncoding srgb = SrgbEncoding::exact;
  int tile = 32;  // pixels a side
  int queue = 0;  // rays a queue holds before the deeper one is drained; 0: one tile
  ChannelSet channels;
  bool strict = false;

  bool operator==(const RenderOptions&) const = default;
};

inline constexpr int kSppLimit = 4096;
inline constexpr int kImageSideLimit = 65536;
inline constexpr double kLeastFov = 0.001, kLargestFov = 179.9;  // degrees

// What is known of an option, and its value.
template <typename Field>
struct Option {
  OptionSpec spec;
  Field& field;
};
template <typename Field>
Option(OptionSpec, Field&) -> Option<Field>;

// Calls use(option, ...) with all options, in the order of --help.
template <typename Options, typename Use>
decltype(auto) withOptions(Options& o, Use&& use) {
  // clang-format off
  return use(
      Option{{.name = "size", .words = "WxH",
              .help = "image size in pixels (default: the scene's, else 480x300)",
              .rebuilds = Rebuild::nothing, .tab = Tab::none, .everyday = true},
             o.size},
      Option{{.name = "camera", .words = "NAME",
              .help = "one of the scene's cameras (default: the first)",
              .rebuilds = Rebuild::nothing, .tab = Tab::none, .everyday = true},
             o.camera},
      Option{{.name = "eye", .words = "x,y,z", .help = "viewpoint",
              .rebuilds = Rebuild::nothing, .tab = Tab::none, .everyday = true},
             o.eye},
      Option{{.name = "at", .words = "x,y,z", .help = "point looked at",
              .rebuilds = Rebuild::nothing, .tab = Tab::none, .everyday = true},
             o.at},
      Option{{.name = "up", .words = "x,y,z", .help = "direction that is up in the image",
              .rebuilds = Rebuild::nothing, .tab = Tab::none},
             o.up},
      Option{{.name = "fov", .words = "DEG", .low = kLeastFov, .high = kLargestFov,
              .help = "vertical field of view",
              .rebuilds = Rebuild::nothing, .tab = Tab::none, .everyday = true},
             o.fov},
      Option{{.name = "ortho", .words = "HEIGHT", .low = 0, .high = 1e18,
              .help = "parallel rays; height of the picture in the scene (0: perspective)",
              .rebuilds = Rebuild::nothing, .tab = Tab::none},
             o.ortho},
      Option{{.name = "crop", .words = "x0,y0,x1,y1",
              .help = "pixels traced; the EXR's data window",
              .rebuilds = Rebuild::nothing, .tab = Tab::none, .everyday = true},
             o.crop},
      Option{{.name = "spp", .words = "N", .low = 1, .high = kSppLimit,
              .help = "samples per pixel",
              .everyday = true,
              .knob = KnobSpec{.cause = Cause::sampling, .exact = "1",
                               .values = "1 2 4 8 16", .crossed = "1 4 16", .spare = "2"}},
             o.spp},
      // More samples than the 16 that are swept everywhere: they make up for the pixels that get
      // few.
      Option{{.name = "adaptive", .words = "on|off",
              .help = "--spp samples only where neighbors differ in surface or contrast, elsewhere "
                      "one",
              .everyday = true,
              .knob = KnobSpec{.cause = Cause::sampling, .exact = "off", .values = "off on",
                               .alongside = "--spp 24"}},
             o.adaptive},
      Option{{.name = "contrast", .words = "N", .low = 0, .high = 255,
              .help = "8-bit codes by which neighbors may differ before --adaptive acts",
              .knob = KnobSpec{.cause = Cause::sampling, .exact = "8", .values = "8 4 16 24",
                               .alongside = "--adaptive on --spp 24"}},
             o.contrast},
      Option{{.name = "depth", .words = "N", .low = 0, .high = kDepthLimit,
              .help = "deepest impulse",
              .cheapest = "0",
              .everyday = true,
              .knob = KnobSpec{.cause = Cause::algorithm, .exact = "64",
                               .values = "0 1 2 3 4 8 16 32 64", .crossed = "4 8 64",
                               .spare = "1 3 16 32", .needs = {kNeedsImpulses}}},
             o.depth},
      // Its exact value is of each sample of the reference, which has many of a pixel.
      Option{{.name = "glossy", .words = "N", .low = 0, .high = 64,
              .help = "rays that sample the reflection of a rough surface, one where it is seen by "
                      "such a ray or by an impulse; 0: rough surfaces reflect lights only",
              .rebuilds = Rebuild::tables,
              .cheapest = "0",
              .everyday = true,
              .knob = KnobSpec{.cause = Cause::sampling, .exact = "4", .values = "0 1 4 16",
                               .spare = "1 4 16",
                               .needs = {Need{EffectSet().with(Effect::glossyReflection),
                                              "no glossy lobe in the scene reflects it"}}}},
             o.glossy},
      Option{{.name = "indirect", .words = "N", .low = 0, .high = 64,
              .help = "rays that sample the light which a diffuse surface gets from others, from "
                      "emission and sky, one where it is seen by such a ray or by an impulse, in "
                      "place of the ambient light; 0: it reflects lights and ambient light only",
              .rebuilds = Rebuild::tables,
              .cheapest = "0",
              .everyday = true,
              .knob = KnobSpec{.cause = Cause::transport, .exact = "4", .values = "0 1 4 16 64",
                               .needs = {Need{EffectSet().with(Effect::indirect),
                                              "no diffuse surface reflects the scene"}}}},
             o.indirect},
      Option{{.name = "cutoff", .words = "X", .low = 0, .high = 1,
              .help = "smallest contribution of an impulse that is still traced",
              .cheapest = "0.004",
              .knob = KnobSpec{.cause = Cause::algorithm, .exact = "0",
                               .values = "0 1e-4 3e-4 1e-3 4e-3 1.6e-2",
                               .crossed = "1e-4 1e-3 4e-3", .spare = "3e-4", .endless = true,
                               .needs = {kNeedsImpulses}}},
             o.cutoff},
      Option{{.name = "roulette", .words = "X", .low = 0, .high = 1,
              .help = "contribution below which an impulse is traced by chance only, and then counts "
                      "for more, so that the mean is right; in place of --cutoff; 0: never",
              .rebuilds = Rebuild::tables,
              .knob = KnobSpec{.cause = Cause::sampling, .exact = "0", .values = "0 0.01 0.1 0.5",
                               .spare = "0.01 0.1 0.5",
                               .needs = {kNeedsImpulses}}},
             o.roulette},
      Option{{.name = "light-samples", .words = "N", .low = 1, .high = 64,
              .help = "points of a light with a radius that a surface is lit from, each with its "
                      "shadow ray; 1: its center",
              .rebuilds = Rebuild::tables,
              .cheapest = "1",
              .everyday = true,
              .knob = KnobSpec{.cause = Cause::sampling, .exact = "4", .values = "1 4 16",
                               .needs = {Need{EffectSet().with(Effect::softShadows),
                                              "no light has a radius and a shadow"}}}},
             o.lightSamples},
      Option{{.name = "ambient-samples", .words = "N", .low = 0, .high = 64,
              .help = "rays from a surface that look for what occludes its ambient light, where the "
                      "scene says how far they reach; 0: nothing does",
              .rebuilds = Rebuild::tables,
              .cheapest = "0",
              .everyday = true,
              .knob = KnobSpec{.cause = Cause::sampling, .exact = "4", .values = "0 1 4 16",
                               .spare = "1 16",
                               .needs = {Need{EffectSet().with(Effect::ambientOcclusion),
                                              "the ambient light has no radius of occlusion"}}}},
             o.ambientSamples},
      Option{{.name = "light-cutoff", .words = "X", .low = 0, .high = 1e6,
              .help = "smallest contribution of a light to the pixel that is still added, and its "
                      "shadow traced",
              .cheapest = "0.004",
              .knob = KnobSpec{.cause = Cause::algorithm, .exact = "0",
                               .values = "0 1e-4 1e-3 4e-3", .crossed = "0 4e-3", .spare = "1e-4",
                               .needs = {Need{EffectSet().with(Effect::lights),
                                              "the scene has no light"}}}},
             o.shading.lightCutoff},
      Option{{.name = "fresnel", .words = "exact|schlick",
              .help = "reflectance of dielectrics: Fresnel's equations, or Schlick's polynomial",
              .cheapest = "schlick",
              .knob = KnobSpec{.cause = Cause::algorithm, .exact = "exact",
                               .values = "exact schlick",
                               .needs = {Need{EffectSet().with(Effect::transmission),
                                              "nothing in the scene is transparent"}}}},
             o.shading.fresnel},
      Option{{.name = "texture-filter", .words = "nearest|bilinear|trilinear",
              .help = "how textures are looked up, trilinear: in mip maps; alpha masks: bilinear",
              .rebuilds = Rebuild::tables,
              .cheapest = "nearest",
              .everyday = true,
              .knob = KnobSpec{.cause = Cause::algorithm, .exact = "bilinear",
                               .values = "bilinear nearest trilinear",
                               .needs = {Need{EffectSet().with(Effect::textures)
                                                         .with(Effect::normalMaps),
                                              "the scene has no texture"}}}},
             o.shading.textureFilter},
      Option{{.name = "offset", .words = "bound|fixed|wachter-binder",
              .help = "start of rays off their surface: by its error bound, 1e-3, or 256 ulps and "
                      "more",
              .cheapest = "fixed",
              .knob = KnobSpec{.cause = Cause::algorithm, .exact = "bound",
                               .values = "bound fixed wachter-binder",
                               .spare = "fixed wachter-binder",
                               .needs = {Need{kNeedsImpulses.oneOf.with(Effect::shadows),
                                              kNeedsImpulses.without}}}},
             o.shading.offset},
      Option{{.name = "terminator", .words = "on|off",
              .help = "shadow rays from above the facets of smooth surfaces: no staircase where the "
                      "light ends",
              .cheapest = "off",
              .knob = KnobSpec{.cause = Cause::algorithm, .exact = "off", .values = "off on",
                               .spare = "on",
                               .needs = {kNeedsVertexNormals,
                                         Need{EffectSet().with(Effect::shadows),
                                              "nothing in the scene casts a shadow"}}}},
             o.shading.terminator},
      Option{{.name = "bend", .words = "on|off",
              .help = "impulses that normal maps send to the wrong side of their surface are turned "
                      "back",
              .cheapest = "off",
              .knob = KnobSpec{.cause = Cause::algorithm, .exact = "on", .values = "on off",
                               .spare = "off",
                               .needs = {Need{kNeedsVertexNormals.oneOf.with(Effect::normalMaps),
                                              kNeedsVertexNormals.without},
                                         kNeedsImpulses}}},
             o.shading.bend},
      Option{{.name = "reciprocal", .words = "exact|refined|approximate",
              .help = "1/sqrt of the kernels' normalizations: divided, or estimated with or without "
                      "a Newton step",
              .cheapest = "approximate",
              .knob = KnobSpec{.cause = Cause::arithmetic, .exact = "exact",
                               .values = "exact refined approximate",
                               .spare = "refined approximate"}},
             o.shading.reciprocal},
      Option{{.name = "threads", .words = "N", .low = 0, .high = 1024,
              .help = "workers (default: what affinity and cgroup quota allow)",
              .rebuilds = Rebuild::workers, .changesPicture = false, .tab = Tab::none, .everyday = true},
             o.threads},
      Option{{.name = "packet", .words = "auto|1|4|8|16",
              .help = "rays per packet (auto: widest the CPU runs natively)",
              .rebuilds = Rebuild::workers,
              .knob = KnobSpec{.cause = Cause::arithmetic, .exact = "auto", .values = "1 4 8 16",
                               .spare = "1 4 8 16"}},
             o.packet},
      Option{{.name = "simd", .words = "auto|avx3|avx2|sse4|sse2|neon|scalar",
              .help = "kernel target, and the Embree ISA with it",
              .rebuilds = Rebuild::acceleration, .tab = Tab::none},
             o.simd},
      Option{{.name = "mode", .words = "packets|reference",
              .help = "vector pipeline in float, or the scalar recursive reference in double",
              .rebuilds = Rebuild::nothing, .tab = Tab::none,
              .everyday = true,
              .knob = KnobSpec{.cause = Cause::arithmetic, .exact = "reference",
                               .values = "packets reference", .spare = "reference"}},
             o.mode},
      Option{{.name = "batch", .words = "tile|frame",
              .help = "stages run over a tile at a time, or over the whole frame",
              .rebuilds = Rebuild::workers, .changesPicture = false},
             o.batch},
      Option{{.name = "robust", .words = "on|off", .help = "Embree's watertight traversal",
              .rebuilds = Rebuild::acceleration,
              .knob = KnobSpec{.cause = Cause::arithmetic, .exact = "on", .values = "on off",
                               .crossed = "on off"}},
             o.robust},
      Option{{.name = "retry", .words = "on|off",
              .help = "robust rays that find nothing in a closed scene are traced once more",
              .rebuilds = Rebuild::acceleration,
              .knob = KnobSpec{.cause = Cause::arithmetic, .exact = "on", .values = "on off",
                               .spare = "off"}},
             o.retry},
      Option{{.name = "bvh", .words = "low|medium|high",
              .help = "Embree's build quality; high, for spatial splits, is ignored by Embree when "
                      "robust",
              .rebuilds = Rebuild::acceleration,
              .knob = KnobSpec{.cause = Cause::arithmetic, .exact = "medium",
                               .values = "low medium high", .spare = "low high"}},
             o.bvh},
      Option{{.name = "verdicts", .words = "auto|off|audit",
              .help = "shadows proved beforehand, whose rays are not traced: auto: in films and "
                      "pictures of so many samples that it pays, while the viewer rests, and in "
                      "bench --ab-verdicts; audit: in bench and render, but traced all the same, "
                      "and a wrong one ends the run",
              .rebuilds = Rebuild::tables, .changesPicture = false, .tab = Tab::none},
             o.verdicts},
      Option{{.name = "sphere-segments", .words = "N", .low = 0, .high = kSphereSegmentsLimit,
              .help = "triangles in place of the scene's exact spheres, so many around each and "
                      "half as many from pole to pole, 4 or more; 0: they are exact",
              .rebuilds = Rebuild::scene, .tab = Tab::none,
              .knob = KnobSpec{.cause = Cause::algorithm, .exact = "0",
                               .values = "0 16 48 192 384",
                               .needs = {Need{EffectSet().with(Effect::spheres),
                                              "the scene has no exact sphere"}}}},
             o.sphereSegments},
      Option{{.name = "effects", .words = "auto|all",
              .help = "kernels for what the scene calls for, or every effect",
              .rebuilds = Rebuild::tables,
              .cheapest = "auto",
              .knob = KnobSpec{.cause = Cause::arithmetic, .exact = "auto", .values = "auto all",
                               .spare = "all"}},
             o.effects},
      Option{{.name = "quality", .words = "draft|standard|fine|reference",
              .help = "presets of the other options",
              .rebuilds = Rebuild::nothing, .tab = Tab::none, .everyday = true},
             o.quality},
      Option{{.name = "disable", .words = "a,b",
              .help = "effects left out (the names that whit info prints)",
              .rebuilds = Rebuild::tables, .tab = Tab::none},
             o.disable},
      Option{{.name = "exposure", .words = "EV|auto", .low = -64, .high = 64,
              .help = "exposure of 8-bit output; auto: what the view calls for (default: 0, of "
                      "models without a scene file auto)",
              .tab = Tab::picture, .everyday = true},
             o.exposure},
      Option{{.name = "tonemap", .words = "none|filmic|reinhard",
              .help = "tone curve of 8-bit output",
              .tab = Tab::picture, .everyday = true},
             o.toneCurve},
      Option{{.name = "film", .words = "float|half|8bit",
              .help = "numbers that the picture is kept in before exposure; 8bit: sRGB codes",
              .cheapest = "float",
              .knob = KnobSpec{.cause = Cause::arithmetic, .exact = "float",
                               .values = "float half 8bit", .spare = "half 8bit"}},
             o.film},
      Option{{.name = "srgb", .words = "exact|table", .help = "how 8-bit codes are found",
              .cheapest = "table",
              .knob = KnobSpec{.cause = Cause::arithmetic, .exact = "exact",
                               .values = "exact table", .spare = "table"}},
             o.srgb},
      Option{{.name = "tile", .words = "N", .low = 1, .high = 4096,
              .help = "side of a tile in pixels",
              .rebuilds = Rebuild::workers, .changesPicture = false},
             o.tile},
      Option{{.name = "queue", .words = "N", .low = 0, .high = 1 << 24,
              .help = "rays a queue holds before the deeper one is drained (0: one tile)",
              .rebuilds = Rebuild::workers, .changesPicture = false},
             o.queue},
      Option{{.name = "channels", .words = "a,b",
              .help = "kept beside the picture, of the surface that the sample nearest to each "
                      "pixel's center meets first: depth, position, normal, albedo, uv, object, "
                      "material, triangle, rays",
              .rebuilds = Rebuild::frame, .changesPicture = false, .tab = Tab::none,
              .everyday = true},
             o.channels},
      Option{{.name = "strict",
              .help = "anything that would be repaired and counted is an error",
              .rebuilds = Rebuild::nothing, .tab = Tab::none},
             o.strict});
  // clang-format on
}

// Calls visit(spec, field) for each option.
template <typename Options, typename Visitor>
void forEachOption(Options& o, Visitor&& visit) {
  withOptions(o, [&](const auto&... option) { (visit(option.spec, option.field), ...); });
}

// Effects that a scene's contents alone do not turn on: an option has to ask for them as well.
struct AskedFor {
  Effect effect;
  bool asked;
  std::string_view otherwise;  // what is said where it is not
};
inline std::array<AskedFor, 4> effectsAskedFor(const RenderOptions& o) {
  return {{{Effect::glossyReflection, o.glossy > 0, "but --glossy is 0"},
           {Effect::softShadows, o.lightSamples > 1, "but --light-samples is 1"},
           {Effect::indirect, o.indirect > 0, "but --indirect is 0"},
           {Effect::ambientOcclusion, o.ambientSamples > 0, "but --ambient-samples is 0"}}};
}
// Those that the options do not ask for.
inline EffectSet notAskedFor(const RenderOptions& o) {
  EffectSet set;
  for (const AskedFor& a : effectsAskedFor(o)) {
    if (!a.asked) set = set.with(a.effect);
  }
  return set;
}

}  // namespace whit
