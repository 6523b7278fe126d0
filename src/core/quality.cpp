#include "core/quality.h"

namespace whit {

namespace {

struct Preset {
  Quality quality;
  int spp, depth;
  float cutoff, lightCutoff;
  Mode mode;
};

const RenderOptions kDefaults;
// Points of the fronts that `whit accuracy` finds. Rays and mean FLIP at equal samples, 128x128:
//
//            whitted          glass            sponza-mirror
// draft       81k  0.018      141k  0.065       62k  0.002
// standard   196k  0.009      349k  0.050       65k  0.000
// fine       817k  0.002     1314k  0.024      258k  0.000
//
// A lower depth would save as many rays as draft's cutoffs and lose four times as much (depth 4
// with a cutoff of 4e-3: 71k rays, 0.067 on whitted); fine spends on depth what its light cutoff
// saves. reference drops so few impulses that no pixel of the shipped scenes changes by more than a
// code. Without a cutoff, rays that branch at every dielectric would double to the depth's limit.
const Preset kPresets[] = {
    {Quality::draft, 1, kDefaults.depth, 1.6e-2f, 1.0e-3f, Mode::packets},
    {Quality::standard, kDefaults.spp, kDefaults.depth, kDefaults.cutoff,
     kDefaults.shading.lightCutoff, kDefaults.mode},
    {Quality::fine, 4, 16, kDefaults.cutoff, 1.0e-4f, Mode::packets},
    {Quality::reference, 16, kDepthLimit, 1.0e-5f, 0, Mode::reference},
};

}  // namespace

void applyQuality(RenderOptions& options, const std::set<std::string>& given) {
  for (const Preset& preset : kPresets) {
    if (preset.quality != options.quality) continue;
    if (!given.contains("spp")) options.spp = preset.spp;
    if (!given.contains("depth")) options.depth = preset.depth;
    if (!given.contains("cutoff")) options.cutoff = preset.cutoff;
    if (!given.contains("light-cutoff")) options.shading.lightCutoff = preset.lightCutoff;
    if (!given.contains("mode")) options.mode = preset.mode;
  }
}

}  // namespace whit
