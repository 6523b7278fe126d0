#include "viewer/session/control.h"

#include <array>
#include <string_view>

#include "core/text.h"

namespace whit::view {

namespace {

constexpr std::array<std::string_view, 8> kFirst{"spp",      "depth",         "glossy",
                                                 "indirect", "light-samples", "ambient-samples",
                                                 "exposure", "tonemap"};

}  // namespace

std::vector<Control> controlsOf(const RenderOptions& options) {
  std::vector<Control> controls;
  forEachOption(options, [&](const OptionSpec& spec, const auto& field) {
    if (!spec.inPanel) return;
    controls.push_back(describeControl(spec, field));
    controls.back().first = std::ranges::find(kFirst, spec.name) != kFirst.end();
  });
  return controls;
}

const std::vector<std::string>& presetNames() {
  static const std::vector<std::string> kNames = namesIn(qualityPresets());
  return kNames;
}

void applyPreset(const std::string& name, RenderOptions& options) {
  setOption(options, "quality", name);
  applyQuality(options, {"mode"});  // the reference is too slow here
}

std::string presetOf(const RenderOptions& options) {
  for (const std::string& name : presetNames()) {
    RenderOptions preset = options;
    applyPreset(name, preset);
    RenderOptions now = options;
    now.quality = preset.quality;
    if (now == preset) return name;
  }
  return "";
}

}  // namespace whit::view
