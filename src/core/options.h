// Every option of a render, declared once: forEachOption() is visited by the command-line parser,
// by --help, and by the metadata written into images, so that none of them can disagree.
#pragma once

#include <optional>
#include <string>

#include "core/effects.h"
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

struct ImageSize {
  int width = 0, height = 0;
  bool operator==(const ImageSize&) const = default;
};
// Pixels [x0, x1) x [y0, y1), from the top left.
struct Crop {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool operator==(const Crop&) const = default;
};

// Neighboring pixels that differ by more in some 8-bit code show an edge.
inline constexpr int kDefaultContrast = 8;

inline constexpr int kDepthLimit = 64;

struct RenderOptions {
  std::optional<ImageSize> size;
  std::string camera;
  std::optional<Vec3f> eye, at, up;
  std::optional<float> fov, ortho;
  std::optional<Crop> crop;
  int spp = 1;
  bool adaptive = false;
  int contrast = kDefaultContrast;
  int depth = kDepthLimit;
  int glossy = 0;  // samples of a rough surface's lobe; 0: it reflects lights only
  float cutoff = 1.0e-4f;
  int threads = 0;  // 0: what affinity and cgroup quota allow
  int packet = 0;   // 0: the widest the CPU runs natively
  std::string simd = "auto";
  Mode mode = Mode::packets;
  Batch batch = Batch::tile;
  ShadingChoices shading;
  bool robust = true, retry = true;
  BvhQuality bvh = BvhQuality::medium;
  EffectChoice effects = EffectChoice::automatic;
  Quality quality = Quality::standard;
  EffectSet disable;
  float exposure = 0;  // EV
  ToneCurve toneCurve = ToneCurve::none;
  FilmPrecision film = FilmPrecision::single;
  SrgbEncoding srgb = SrgbEncoding::exact;
  int tile = 32;  // pixels a side
  int queue = 0;  // rays a queue holds before the deeper one is drained; 0: one tile
  bool strict = false;

  bool operator==(const RenderOptions&) const = default;
};

inline constexpr int kSppLimit = 4096;
inline constexpr int kGlossyLimit = 64;
inline constexpr int kImageSideLimit = 65536;
inline constexpr int kThreadLimit = 1024;

// Calls visit(name, placeholder, help, field) for each option, in the order of --help.
template <typename Options, typename Visitor>
void forEachOption(Options& o, Visitor&& visit) {
  visit("size", "WxH", "image size in pixels (default: the scene's, else 480x300)", o.size);
  visit("camera", "NAME", "one of the scene's cameras (default: the first)", o.camera);
  visit("eye", "x,y,z", "viewpoint", o.eye);
  visit("at", "x,y,z", "point looked at", o.at);
  visit("up", "x,y,z", "direction that is up in the image", o.up);
  visit("fov", "DEG", "vertical field of view", o.fov);
  visit("ortho", "HEIGHT", "parallel rays; height of the picture in the scene (0: perspective)",
        o.ortho);
  visit("crop", "x0,y0,x1,y1", "pixels traced; the EXR's data window", o.crop);
  visit("spp", "N", "samples per pixel", o.spp);
  visit("adaptive", "on|off",
        "--spp samples only where neighbors differ in surface or contrast, elsewhere one",
        o.adaptive);
  visit("contrast", "N", "8-bit codes by which neighbors may differ before --adaptive acts",
        o.contrast);
  visit("depth", "N", "deepest impulse", o.depth);
  visit("glossy", "N",
        "rays that sample the reflection of a rough surface, one where it is seen by such a ray or "
        "by an impulse; 0: rough surfaces reflect lights only",
        o.glossy);
  visit("cutoff", "X", "smallest contribution of an impulse that is still traced", o.cutoff);
  visit("light-cutoff", "X",
        "smallest contribution of a light to the pixel that is still added, and its shadow traced",
        o.shading.lightCutoff);
  visit("fresnel", "exact|schlick",
        "reflectance of dielectrics: Fresnel's equations, or Schlick's polynomial",
        o.shading.fresnel);
  visit("texture-filter", "nearest|bilinear|trilinear",
        "how textures are looked up, trilinear: in mip maps; alpha masks: bilinear",
        o.shading.textureFilter);
  visit("offset", "bound|fixed|wachter-binder",
        "start of rays off their surface: by its error bound, 1e-3, or 256 ulps and more",
        o.shading.offset);
  visit("terminator", "on|off",
        "shadow rays from above the facets of smooth surfaces: no staircase where the light ends",
        o.shading.terminator);
  visit("bend", "on|off",
        "impulses that normal maps send to the wrong side of their surface are turned back",
        o.shading.bend);
  visit(
      "reciprocal", "exact|refined|approximate",
      "1/sqrt of the kernels' normalizations: divided, or estimated with or without a Newton step",
      o.shading.reciprocal);
  visit("threads", "N", "workers (default: what affinity and cgroup quota allow)", o.threads);
  visit("packet", "auto|1|4|8|16", "rays per packet (auto: widest the CPU runs natively)",
        o.packet);
  visit("simd", "auto|avx3|avx2|sse4|sse2|neon|scalar", "kernel target, and the Embree ISA with it",
        o.simd);
  visit("mode", "packets|reference",
        "vector pipeline in float, or the scalar recursive reference in double", o.mode);
  visit("batch", "tile|frame", "stages run over a tile at a time, or over the whole frame",
        o.batch);
  visit("robust", "on|off", "Embree's watertight traversal", o.robust);
  visit("retry", "on|off", "robust rays that find nothing in a closed scene are traced once more",
        o.retry);
  visit("bvh", "low|medium|high",
        "Embree's build quality; high, for spatial splits, is ignored by Embree when robust",
        o.bvh);
  visit("effects", "auto|all", "kernels for what the scene calls for, or every effect", o.effects);
  visit("quality", "draft|standard|fine|reference", "presets of the other options", o.quality);
  visit("disable", "a,b", "effects left out (the names that whit info prints)", o.disable);
  visit("exposure", "EV", "exposure of 8-bit output", o.exposure);
  visit("tonemap", "none|filmic|reinhard", "tone curve of 8-bit output", o.toneCurve);
  visit("film", "float|half|8bit",
        "numbers that the picture is kept in before exposure; 8bit: sRGB codes", o.film);
  visit("srgb", "exact|table", "how 8-bit codes are found", o.srgb);
  visit("tile", "N", "side of a tile in pixels", o.tile);
  visit("queue", "N", "rays a queue holds before the deeper one is drained (0: one tile)", o.queue);
  visit("strict", "", "anything that would be repaired and counted is an error", o.strict);
}

}  // namespace whit
