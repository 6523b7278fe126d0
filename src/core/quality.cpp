// Presets of the options that trade time for accuracy.
#include "core/option_table.h"
#include "core/option_values.h"

namespace whit {

namespace {

struct Preset {
  Quality quality;
  int spp, depth;
  float cutoff, lightCutoff;
  Mode mode;
};

const RenderOptions kDefaults;
// Points of the fronts that `whit accuracy` finds. Rays and mean FLIP against depth 64 and a cutoff
// of 1e-5 in double precision at equal samples, 128x128:
//
//            whitted          glass            mirrors         atrium          sponza-mirror
// draft      100k  0.011      271k  0.019       93k  0.003      53k  0.000      62k  0.002
// standard   327k  0.002     1496k  0.004       98k  0.000      53k  0.000      65k  0.000
// fine      1110k  0.002     3766k  0.006      389k  0.000     213k  0.000     258k  0.000
//
// Depth costs rays only where there is something to follow, and what a lower one leaves out is seen
// first: depth 8 with a cutoff of 4e-3 has 245k rays and 0.056 on glass. With the cutoff of
// standard no more than one pixel in a thousand of whitted, mirrors, atrium and sponza-mirror is
// two codes off; three times as much leaves six times as many. Without a cutoff, rays that branch
// at every dielectric would double to the depth's limit.
const Preset kPresets[] = {
    {Quality::draft, 1, kDefaults.depth, 4.0e-3f, 1.0e-3f, Mode::packets},
    {Quality::standard, kDefaults.spp, kDefaults.depth, kDefaults.cutoff,
     kDefaults.shading.lightCutoff, kDefaults.mode},
    {Quality::fine, 4, kDefaults.depth, kDefaults.cutoff, 1.0e-4f, Mode::packets},
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

std::vector<QualityPreset> qualityPresets() {
  std::vector<QualityPreset> all;
  for (const Preset& preset : kPresets) {
    RenderOptions options;
    options.quality = preset.quality;
    applyQuality(options, {});
    QualityPreset said{optionText(options, "quality"), ""};
    forEachOption(options, [&](const OptionSpec& spec, const auto& field) {
      const std::string name(spec.name), value = formatValue(spec, field);
      if (name == "quality" || value == optionText(kDefaults, name)) return;
      said.options += (said.options.empty() ? "--" : " --") + name + " " + value;
    });
    all.push_back(std::move(said));
  }
  return all;
}

void applyModelDefaults(RenderOptions& options, const std::set<std::string>& given) {
  if (!given.contains("exposure")) options.exposure = {0, true};
  if (!given.contains("terminator")) options.shading.terminator = true;
}

}  // namespace whit
