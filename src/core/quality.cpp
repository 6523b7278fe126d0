#include "core/quality.h"

namespace whit {

namespace {

struct Preset {
  Quality quality;
  int spp, depth;
  float cutoff;
  Mode mode;
};

const RenderOptions kDefaults;
// draft drops impulses worth less than one 8-bit sRGB step at the dark end (1 / 255 = 4e-3);
// reference drops so few that no pixel of the shipped scenes changes by more than a code. Without a
// cutoff, rays that branch at every dielectric would double to the depth's limit.
const Preset kPresets[] = {
    {Quality::draft, 1, 4, 4.0e-3f, Mode::packets},
    {Quality::standard, kDefaults.spp, kDefaults.depth, kDefaults.cutoff, kDefaults.mode},
    {Quality::fine, 4, kDefaults.depth, kDefaults.cutoff, Mode::packets},
    {Quality::reference, 16, kDepthLimit, 1.0e-5f, Mode::reference},
};

}  // namespace

void applyQuality(RenderOptions& options, const std::set<std::string>& given) {
  for (const Preset& preset : kPresets) {
    if (preset.quality != options.quality) continue;
    if (!given.contains("spp")) options.spp = preset.spp;
    if (!given.contains("depth")) options.depth = preset.depth;
    if (!given.contains("cutoff")) options.cutoff = preset.cutoff;
    if (!given.contains("mode")) options.mode = preset.mode;
  }
}

}  // namespace whit
