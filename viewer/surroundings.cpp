// The sky and the ambient light in the panel.
#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "io/supply_view.h"
#include "make/studio_sky.h"
#include "viewer/panel.h"

namespace whit::view {

namespace {

constexpr float kLargestScale = 1e4f, kLargestAmbient = 1e4f;
constexpr auto kLogarithmic = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic;

std::string nameOf(const SkyChoice& sky) {
  if (sky.source.empty()) return "the scene's own";
  return std::filesystem::path(sky.source).filename().string();
}

bool drawChoice(const SkyChoice& own, SkyChoice& sky) {
  const SkyChoice before = sky;
  if (!ImGui::BeginCombo("sky", nameOf(sky).c_str())) return false;
  const auto offer = [&](const SkyChoice& choice) {
    const bool current = choice.source == sky.source;
    if (ImGui::Selectable(nameOf(choice).c_str(), current) && !current) sky = choice;
  };
  offer(own);
  for (const char* source : {kNoSky, kStudio}) {
    if (own.source != source) offer(chooseSky(source));
  }
  ImGui::EndCombo();
  return sky != before;
}

bool drawSky(const SkyChoice& own, SkyChoice& sky) {
  bool changed = drawChoice(own, sky);
  if (sky.kind == Sky::Kind::none) return changed;
  changed |= ImGui::SliderFloat("brightness", &sky.scale, 0, kLargestScale, "%.3g", kLogarithmic);
  if (sky.kind == Sky::Kind::image) {
    constexpr float kHalfTurn = 180;
    changed |= ImGui::SliderFloat("rotation", &sky.rotation, -kHalfTurn, kHalfTurn, "%.1f");
  }
  return changed;
}

bool drawAmbient(bool skyThere, Ambient& ambient) {
  constexpr double kUsualShare = 0.4;
  bool changed = false, fromSky = ambient.ofSky > 0;
  if ((skyThere || fromSky) && ImGui::Checkbox("ambient light from the sky", &fromSky)) {
    ambient.ofSky = fromSky ? kUsualShare : 0;
    changed = true;
  }
  if (ambient.ofSky > 0) {
    constexpr float kLeast = 0.01f, kMost = 10;
    auto share = static_cast<float>(ambient.ofSky);
    if (!ImGui::SliderFloat("times the sky's mean", &share, kLeast, kMost, "%.2f", kLogarithmic)) {
      return changed;
    }
    ambient.ofSky = static_cast<double>(share);
    return true;
  }
  changed |= drawBright("ambient, from above", "radiance, from above", kLargestAmbient, ambient.up);
  changed |=
      drawBright("ambient, from below", "radiance, from below", kLargestAmbient, ambient.down);
  return changed;
}

}  // namespace

bool drawSurroundings(const SkyChoice& ownSky, ShadingEdit& scene) {
  ImGui::PushItemWidth(ImGui::GetFontSize() * 13);
  bool changed = drawSky(ownSky, scene.sky);
  changed |= drawAmbient(scene.sky.kind != Sky::Kind::none, scene.ambient);
  ImGui::PopItemWidth();
  return changed;
}

}  // namespace whit::view
