// Every option of a render, declared once: a member of RenderOptions and its entry in
// withOptions(). The command line, --help, the manual page, the metadata of images, the library,
// what a renderer makes anew and the viewer's panel all follow from the entry; inspect/knobs.cpp
// has what the sweep of `whit accuracy` adds.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "core/channels.h"
#include "core/effects.h"
#include "core/shading_choices.h"
#include "core/vec3.h"

namespace whit {

// The part of a renderer that has to be rebuilt when an option changes. Each level includes the
// levels before it.
enum class Rebuild {
  nothing,  // the option is read by each frame, or does not concern the renderer
  frame,    // the plan of the following frames
  tables,   // the shading tables, if the plan needs others
  workers,  // threads, their tiles and queues
  acceleration,
  scene,  // it is loaded again, by the caller of the renderer
};

// Everything about an option but its value. Words with '|' between them are choices. A word in
// capitals among them (EV, COLOR) stands for a value; all others are accepted as they are. For an
// enumeration they stand in the order of its enumerators. A flag has no words.
struct OptionSpec {
  std::string_view name = {}, words = {};
  double low = std::numeric_limits<double>::lowest();
  double high = std::numeric_limits<double>::max();
  std::string_view help = {};
  Rebuild rebuilds = Rebuild::frame;
  // False for options that share out the work: the picture does not depend on them by design.
  bool changesPicture = true;
  bool inScenes = true;  // a scene file may state it, if it changes the picture of a frame
  bool inPanel = true;   // the viewer's panel has a control for it
  // The cheapest value that still makes a picture of the scene; the viewer measures the cost of the
  // other values against it, and not at all if this is empty.
  std::string_view cheapest = {};
  bool everyday = false;  // listed in --help; the others only in --help-all
};

enum class Mode { packets, reference };
enum class Batch { tile, frame };
enum class EffectChoice { automatic, all };
enum class ToneCurve { none, filmic, reinhard };
enum class Quality { good, standard, reference };
enum class BvhQuality { low, medium, high };

// Exposure of 8-bit output in EV. An automatic one is computed from the view by
// inspect/auto_exposure.h and is 0 until then.
struct Exposure {
  float ev = 0;
  bool automatic = false;
  bool operator==(const Exposure&) const = default;
};
// Primary rays that hit nothing, and what they see straight through surfaces, show the sky,
// nothing, or a color in sRGB codes.
struct Background {
  enum class Kind { sky, transparent, color } kind = Kind::sky;
  std::array<std::uint8_t, 3> color{};
  bool hidesSky() const { return kind != Kind::sky; }
  bool operator==(const Background&) const = default;
};
struct ImageSize {
  int width = 0, height = 0;
  bool operator==(const ImageSize&) const = default;
};
// Pixels [x0, x1) x [y0, y1), from the top left.
struct Crop {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  bool operator==(const Crop&) const = default;
};

inline constexpr int kDepthLimit = 64;
inline constexpr int kSphereSegmentsLimit = 4096;

// The members stand in the order of their entries below.
struct RenderOptions {
  Quality quality = Quality::standard;
  std::optional<ImageSize> size;
  std::string camera;
  std::optional<Vec3d> eye, at;  // points in coordinates of the file
  std::optional<Vec3f> up;
  std::optional<float> fov, ortho;
  std::optional<Crop> crop;
  int spp = 1;
  bool adaptive = false;
  int contrast = 8;  // neighbors that differ by more in some 8-bit code show an edge
  int depth = kDepthLimit;
  int glossy =
      0;  // rays that sample a rough surface's lobe; 0: it reflects lights and a blurred sky
  int indirect = 0;  // rays that sample indirect light on a diffuse surface; 0: none
  float cutoff = 1.0e-3f;
  float roulette = 0;      // Russian roulette below this throughput; 0: off
  int maxRays = 5000;      // impulses of a sample (sampling/ray_limit.h); 0: no bound
  int lightSamples = 1;    // points of a light with a radius; 1: its center
  int ambientSamples = 0;  // ambient occlusion rays; 0: off
  ShadingChoices shading;
  int threads = 0;  // 0: what affinity and cgroup quota allow
  int packet = 0;   // 0: the widest the CPU runs natively
  std::string simd = "auto";
  Mode mode = Mode::packets;
  Batch batch = Batch::tile;
  bool robust = true, retry = true;
  BvhQuality bvh = BvhQuality::medium;
  int sphereSegments = 0;  // triangles around each sphere that replace it; 0: it is exact
  EffectChoice effects = EffectChoice::automatic;
  EffectSet disable;
  Exposure exposure;
  ToneCurve toneCurve = ToneCurve::none;
  Background background;
  int tile = 32;  // pixels a side
  int queue = 0;  // rays a queue holds before the deeper one is drained; 0: two tiles
  ChannelSet channels;
  bool strict = false;

  bool operator==(const RenderOptions&) const = default;
};

inline constexpr int kSppLimit = 4096;
inline constexpr int kImageSideLimit = 65536;
inline constexpr double kLeastFov = 0.001, kLargestFov = 179.9;  // degrees

// An option and its value.
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
      // A preset sets options that are listed after it.
      Option{{.name = "quality", .words = "good|standard|reference",
              .help = "preset of other options, see below; good: a picture to show (default: "
                      "standard, one sample per pixel)",
              .rebuilds = Rebuild::nothing, .inPanel = false, .everyday = true},
             o.quality},
      Option{{.name = "size", .words = "WxH",
              .help = "image size in pixels (default: the scene's, else 480x300)",
              .rebuilds = Rebuild::nothing, .inPanel = false, .everyday = true},
             o.size},

      // These options choose the view.
      Option{{.name = "camera", .words = "NAME",
              .help = "one of the scene's cameras (default: the first)",
              .rebuilds = Rebuild::nothing, .inPanel = false, .everyday = true},
             o.camera},
      Option{{.name = "eye", .words = "x,y,z", .help = "position of the camera",
              .rebuilds = Rebuild::nothing, .inPanel = false, .everyday = true},
             o.eye},
      Option{{.name = "at", .words = "x,y,z", .help = "point that the camera looks at",
              .rebuilds = Rebuild::nothing, .inPanel = false, .everyday = true},
             o.at},
      Option{{.name = "up", .words = "x,y,z", .help = "direction that is up in the image; or y, z or x: the axis that is up in an OBJ "
                      "or PLY model",
              .rebuilds = Rebuild::nothing, .inPanel = false, .everyday = true},
             o.up},
      Option{{.name = "fov", .words = "DEG", .low = kLeastFov, .high = kLargestFov,
              .help = "vertical field of view in degrees",
              .rebuilds = Rebuild::nothing, .inPanel = false, .everyday = true},
             o.fov},
      Option{{.name = "ortho", .words = "HEIGHT", .low = 0, .high = 1e18,
              .help = "orthographic camera: height of its view in the scene (0: perspective)",
              .rebuilds = Rebuild::nothing, .inPanel = false},
             o.ortho},
      Option{{.name = "crop", .words = "x0,y0,x1,y1",
              .help = "pixels that are rendered; they become the EXR's data window",
              .rebuilds = Rebuild::nothing, .inPanel = false, .everyday = true},
             o.crop},

      // These options choose the samples of a pixel.
      Option{{.name = "spp", .words = "N", .low = 1, .high = kSppLimit,
              .help = "samples per pixel, for anti-aliasing",
              .everyday = true},
             o.spp},
      Option{{.name = "adaptive", .words = "on|off",
              .help = "adaptive anti-aliasing: --spp samples at edges of surfaces and contrast, "
                      "one elsewhere; with --glossy, --indirect, --ambient-samples or "
                      "--light-samples all pixels get all samples"},
             o.adaptive},
      Option{{.name = "contrast", .words = "N", .low = 0, .high = 255,
              .help = "difference of neighboring pixels, in 8-bit codes, above which --adaptive "
                      "samples them"},
             o.contrast},

      // These options bound reflected, refracted and sampled rays.
      Option{{.name = "depth", .words = "N", .low = 0, .high = kDepthLimit,
              .help = "maximum ray depth: bounces of reflected and refracted rays, here also "
                      "called impulses",
              .cheapest = "0",
              .everyday = true},
             o.depth},
      Option{{.name = "glossy", .words = "N", .low = 0, .high = 64,
              .help = "glossy reflections: sampled rays per hit on a rough surface, one per hit "
                      "after a bounce; 0: rough surfaces reflect lights and a blurred sky, and frosted "
                      "glass is clear",
              .rebuilds = Rebuild::tables,
              .cheapest = "0",
              .everyday = true},
             o.glossy},
      Option{{.name = "indirect", .words = "N", .low = 0, .high = 64,
              .help = "indirect diffuse lighting, as by a path tracer: sampled rays per hit on a "
                      "diffuse surface, one per hit after a bounce, in place of the ambient light; "
                      "0: direct and ambient light only",
              .rebuilds = Rebuild::tables,
              .cheapest = "0",
              .everyday = true},
             o.indirect},
      Option{{.name = "cutoff", .words = "X", .low = 0, .high = 1,
              .help = "contribution to the pixel below which reflected and refracted rays are not "
                      "traced",
              .cheapest = "0.004"},
             o.cutoff},
      Option{{.name = "roulette", .words = "X", .low = 0, .high = 1,
              .help = "Russian roulette: rays that contribute less are traced by chance and "
                      "weighted to keep the mean; replaces --cutoff; 0: off",
              .rebuilds = Rebuild::tables},
             o.roulette},
      Option{{.name = "max-rays", .words = "N", .low = 0, .high = 1e9,
              .help = "reflected, refracted and sampled rays of a sample; a sample that would have "
                      "more is traced with fewer: of the rays of a surface one is followed by "
                      "chance and weighted to keep the mean; 0: no bound",
              .inPanel = false},
             o.maxRays},

      // These options approximate light and surfaces.
      Option{{.name = "light-samples", .words = "N", .low = 1, .high = 64,
              .help = "soft shadows of area lights: shadow rays per hit and light with a radius; "
                      "1: to its center only",
              .rebuilds = Rebuild::tables,
              .cheapest = "1",
              .everyday = true},
             o.lightSamples},
      Option{{.name = "ambient-samples", .words = "N", .low = 0, .high = 64,
              .help = "ambient occlusion, where the scene's ambient light has a radius of it: rays "
                      "per hit; 0: off",
              .rebuilds = Rebuild::tables,
              .cheapest = "0",
              .everyday = true},
             o.ambientSamples},
      Option{{.name = "light-cutoff", .words = "X", .low = 0, .high = 1e6,
              .help = "contribution to the pixel below which a light is skipped, with its shadow "
                      "ray",
              .cheapest = "0.004"},
             o.shading.lightCutoff},
      Option{{.name = "fresnel", .words = "exact|schlick",
              .help = "reflectance of dielectrics: Fresnel's equations or Schlick's approximation",
              .cheapest = "schlick"},
             o.shading.fresnel},
      Option{{.name = "texture-filter", .words = "nearest|bilinear|trilinear",
              .help = "texture filtering; trilinear uses mip maps; alpha masks are always "
                      "bilinear",
              .rebuilds = Rebuild::tables,
              .cheapest = "nearest"},
             o.shading.textureFilter},
      Option{{.name = "offset", .words = "bound|fixed|wachter-binder",
              .help = "offset of ray origins from the surface, against self-intersection: the "
                      "error bound of the point, 1e-3, or 256 ulps and more",
              .cheapest = "fixed"},
             o.shading.offset},
      Option{{.name = "terminator", .words = "on|off",
              .help = "avoid shadow-terminator artifacts on smooth-shaded meshes: shadow rays "
                      "start above the facets, Hanika 2021",
              .cheapest = "off"},
             o.shading.terminator},
      Option{{.name = "bend", .words = "on|off",
              .help = "turn back reflected and refracted rays that a normal map sends to the "
                      "wrong side of the surface",
              .cheapest = "off"},
             o.shading.bend},

      // These options choose how the work is done.
      Option{{.name = "threads", .words = "N", .low = 0, .high = 1024,
              .help = "worker threads (default: those that CPU affinity and cgroup quota allow)",
              .rebuilds = Rebuild::workers, .changesPicture = false, .inPanel = false, .everyday = true},
             o.threads},
      Option{{.name = "packet", .words = "auto|1|4|8|16",
              .help = "rays per packet (auto: widest the CPU runs natively)",
              .rebuilds = Rebuild::workers},
             o.packet},
      Option{{.name = "simd", .words = "auto|avx3|avx2|sse4|sse2|neon|scalar",
              .help = "SIMD target of the kernels and of Embree",
              .rebuilds = Rebuild::acceleration, .inPanel = false},
             o.simd},
      Option{{.name = "mode", .words = "packets|reference",
              .help = "vector pipeline in float, or the scalar recursive reference in double",
              .rebuilds = Rebuild::nothing, .inPanel = false},
             o.mode},
      Option{{.name = "batch", .words = "tile|frame",
              .help = "run each stage over one tile at a time, or over the whole frame",
              .rebuilds = Rebuild::workers, .changesPicture = false},
             o.batch},
      Option{{.name = "robust", .words = "on|off", .help = "Embree's watertight traversal",
              .rebuilds = Rebuild::acceleration},
             o.robust},
      Option{{.name = "retry", .words = "on|off",
              .help = "trace rays of --robust that miss in a closed scene once more",
              .rebuilds = Rebuild::acceleration},
             o.retry},
      Option{{.name = "bvh", .words = "low|medium|high",
              .help = "Embree's build quality; high adds spatial splits, which Embree ignores "
                      "when robust",
              .rebuilds = Rebuild::acceleration},
             o.bvh},

      // These options change what the scene has.
      Option{{.name = "sphere-segments", .words = "N", .low = 0, .high = kSphereSegmentsLimit,
              .help = "triangles in place of exact spheres: N around and half as many from pole "
                      "to pole, at least 4; 0: exact",
              .rebuilds = Rebuild::scene, .inPanel = false},
             o.sphereSegments},
      Option{{.name = "effects", .words = "auto|all",
              .help = "plan the frame for the effects that the scene uses, or for every effect",
              .rebuilds = Rebuild::tables, .inScenes = false,
              .cheapest = "auto"},
             o.effects},
      Option{{.name = "disable", .words = "a,b",
              .help = "effects to leave out, by the names that whit info prints",
              .rebuilds = Rebuild::tables, .inPanel = false},
             o.disable},

      // These options turn radiance into codes.
      Option{{.name = "exposure", .words = "EV|auto", .low = -64, .high = 64,
              .help = "exposure of 8-bit output in stops; auto: measured in the view (default: 0, "
                      "of models without a scene file auto)",
              .everyday = true},
             o.exposure},
      Option{{.name = "tonemap", .words = "none|filmic|reinhard",
              .help = "tone curve of 8-bit output",
              .everyday = true},
             o.toneCurve},
      Option{{.name = "background", .words = "sky|transparent|COLOR",
              .help = "what is behind all surfaces: the sky; nothing, as alpha in PNG and EXR; or "
                      "a color, as ff8000, white or black, which an EXR leaves transparent",
              .inPanel = false, .everyday = true},
             o.background},

      // These options choose the sizes of the work.
      Option{{.name = "tile", .words = "N", .low = 1, .high = 4096,
              .help = "side of a tile in pixels",
              .rebuilds = Rebuild::workers, .changesPicture = false},
             o.tile},
      Option{{.name = "queue", .words = "N", .low = 0, .high = 1 << 24,
              .help = "rays in a queue before the next depth is traced (0: two tiles)",
              .rebuilds = Rebuild::workers, .changesPicture = false},
             o.queue},

      // These options choose and judge the results.
      Option{{.name = "channels", .words = "a,b",
              .help = "extra output channels (AOVs) of the first hit, at the sample nearest to "
                      "the pixel's center: depth, position, normal, albedo, uv, object, material, "
                      "triangle, rays, roughness, metallic; motion, in pixels since the frame "
                      "before; alpha, the share that surfaces cover; and error, the standard error "
                      "of the mean of the samples and the share of light that depth and cutoff "
                      "ended",
              .rebuilds = Rebuild::frame, .changesPicture = false, .inPanel = false,
              .everyday = true},
             o.channels},
      Option{{.name = "strict",
              .help = "anything that would be repaired and counted is an error",
              .rebuilds = Rebuild::nothing, .inPanel = false},
             o.strict});
  // clang-format on
}

// Calls visit(spec, field) for each option.
template <typename Options, typename Visitor>
void forEachOption(Options& o, Visitor&& visit) {
  withOptions(o, [&](const auto&... option) { (visit(option.spec, option.field), ...); });
}

// The rays that sample a glossy lobe at the first hit. Paths of indirect light sample lobes, too:
// the blurred sky would light closed rooms.
inline int glossySamples(const RenderOptions& o) {
  return o.glossy == 0 && o.indirect > 0 && !o.disable.has(Effect::indirect) ? 1 : o.glossy;
}

// The channels that frames keep.
inline ChannelSet keptChannels(const RenderOptions& o) {
  return o.background.hidesSky() ? o.channels.with(Channel::alpha) : o.channels;
}

// Effects that a scene does not switch on by itself: an option must ask for them as well.
struct OptionalEffect {
  Effect effect;
  bool isOn;
  std::string_view otherwise;  // the reason if it is off
};
inline std::array<OptionalEffect, 6> optionalEffects(const RenderOptions& o) {
  return {{{Effect::glossyReflection, glossySamples(o) > 0, "but --glossy and --indirect are 0"},
           {Effect::blurredSky, glossySamples(o) == 0,
            "but --glossy or --indirect samples reflections"},
           {Effect::softShadows, o.lightSamples > 1, "but --light-samples is 1"},
           {Effect::indirect, o.indirect > 0, "but --indirect is 0"},
           {Effect::ambientOcclusion, o.ambientSamples > 0, "but --ambient-samples is 0"},
           {Effect::depthOfField, o.spp > 1, "but --spp is 1"}}};
}

// Returns those of the effects above that the options leave off.
inline EffectSet optionalEffectsOff(const RenderOptions& o) {
  EffectSet set;
  for (const OptionalEffect& optional : optionalEffects(o)) {
    if (!optional.isOn) set = set.with(optional.effect);
  }
  return set;
}

}  // namespace whit
