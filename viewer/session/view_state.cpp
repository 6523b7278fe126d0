#include "viewer/session/view_state.h"

#include <algorithm>
#include <cmath>

#include "core/text.h"

namespace whit::view {

namespace {

// All scales are multiples of 1/16.
std::string fraction(double scale) {
  int above = static_cast<int>(std::lround(scale * 16)), below = 16;
  while (above > 0 && above % 2 == 0 && below > 1) {
    above /= 2;
    below /= 2;
  }
  return below == 1 ? "full" : formatted("%d/%d", above, below);
}

}  // namespace

Selection select(const RayPick& pick) {
  Selection selection;
  const RayNode& primary = pick.rays.packets.nodes.front();
  if (primary.triangle == kMiss) return selection;
  selection.material = primary.material;

  // The selected light is the one that adds most to the surface in its largest channel.
  double most = 0;
  for (const LightContribution& light : primary.lights) {
    const double radiance = maxComponent(light.radiance);
    if (radiance <= most || light.light == kAmbientLight) continue;

    most = radiance;
    selection.light = light.light;
  }
  return selection;
}

std::string errorText(double sampleError) {
  return sampleError > 0 ? formatted(", within about %.2g %%", 100 * sampleError) : "";
}

std::string sharpnessText(const FrameRequest& request) {
  const int window = std::max(request.window.width, 1);
  const int width = request.options.size ? request.options.size->width : window;
  std::string text = fraction(static_cast<double>(width) / window);
  if (request.spp != 1) text += formatted(", %d samples", request.spp);
  if (request.plain) text += ", without sampled rays";
  return text;
}

std::string statusText(const ViewState& state) {
  std::string text = sharpnessText(state.shown.request) + errorText(state.shown.sampleError);
  if (const auto& next = state.unfinished) {
    text = formatted("%d of %d samples", next->samples, next->request.spp) +
           errorText(next->sampleError);
  }
  if (state.pictureMs > 0) text += formatted(", %.0f frames/s", 1000 / state.pictureMs);
  return text;
}

std::string aboutText(const TracedFrame& frame) {
  const Machine& machine = frame.machine;
  return formatted("%s, %s; %s, packets of %d, %d thread%s", frame.scene->scene.name.c_str(),
                   frame.surfaces.c_str(), machine.simd.c_str(), machine.packet, machine.threads,
                   machine.threads == 1 ? "" : "s");
}

}  // namespace whit::view
