#include "viewer/scene_panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace whit::view {

namespace {

constexpr auto kClamp = ImGuiSliderFlags_AlwaysClamp;  // what is typed in, too
constexpr float kLargestIntensity = 1e6f, kLargestRadiance = 1e4f;

bool drawColor(const char* label, Rgb& color) {
  if (!ImGui::ColorEdit3(label, &color.x, ImGuiColorEditFlags_Float)) return false;
  color = min(max(color, Rgb(0.0f)), Rgb(1.0f));
  return true;
}

// Color and strength of what has no upper limit. The color's largest channel is 1.
bool drawBright(const char* label, const char* strengthLabel, float largest, Rgb& value) {
  float strength = maxComponent(value);
  Rgb color = strength > 0 ? value * (1 / strength) : Rgb{1, 1, 1};
  const bool recolored = drawColor(label, color);
  constexpr auto kFlags = kClamp | ImGuiSliderFlags_Logarithmic;
  const bool turned = ImGui::SliderFloat(strengthLabel, &strength, 0, largest, "%.3g", kFlags);
  if (!recolored && !turned) return false;
  value = color * strength;
  return true;
}

// A direction that was dragged to nowhere stays as it was.
bool drawDirection(Vec3f& direction) {
  Vec3f turned = normalized(direction, {0, -1, 0});
  if (!ImGui::DragFloat3("direction", &turned.x, 0.005f, -1, 1)) return false;
  direction = normalized(turned, direction);
  return true;
}

bool drawCone(Light& light) {
  constexpr float kLeastOuter = 0.5f, kLargestOuter = 90;
  bool changed = ImGui::SliderFloat("outer cone", &light.outerConeAngle, kLeastOuter, kLargestOuter,
                                    "%.1f", ImGuiSliderFlags_AlwaysClamp);
  changed |= ImGui::SliderFloat("inner cone", &light.innerConeAngle, 0, kLargestOuter, "%.1f",
                                ImGuiSliderFlags_AlwaysClamp);
  light.innerConeAngle = std::min(light.innerConeAngle, std::nextafter(light.outerConeAngle, 0.0f));
  return changed;
}

bool drawLight(Light& light) {
  const bool directional = light.kind == Light::Kind::directional;
  bool changed = drawBright("color", directional ? "irradiance" : "intensity", kLargestIntensity,
                            light.intensity);
  if (light.kind != Light::Kind::point) changed |= drawDirection(light.direction);
  if (light.kind == Light::Kind::spot) changed |= drawCone(light);
  if (directional) return changed;
  const float step = 0.002f * std::max(1.0f, maxComponent(abs(light.position)));
  constexpr float kFarthest = 1e18f;
  return ImGui::DragFloat3("position", &light.position.x, step, -kFarthest, kFarthest, "%.3f",
                           kClamp) ||
         changed;
}

bool drawMaterial(Material& m) {
  constexpr float kLeastIor = 1, kLargestIor = 3, kLargestAbsorption = 100;
  bool changed = drawColor("diffuse", m.diffuse);
  changed |= drawColor("specular", m.specular);
  if (m.hasGlossy()) changed |= ImGui::SliderFloat("roughness", &m.roughness, 0, 1, "%.3f", kClamp);
  changed |= drawColor("mirror", m.mirror);
  changed |= drawColor("mirror, grazing", m.mirrorGrazing);
  changed |= drawColor("transmission", m.transmission);
  if (m.hasTransmission()) {
    changed |= ImGui::SliderFloat("ior", &m.ior, kLeastIor, kLargestIor, "%.3f", kClamp);
    changed |= drawBright("absorption", "absorption per unit", kLargestAbsorption, m.absorption);
  }
  changed |= drawBright("emission", "radiance", kLargestRadiance, m.emission);
  return changed;
}

// A foldable node for each item, under its name or number.
template <typename Item, typename Draw>
bool drawItems(std::vector<Item>& items, const char* kind, const Draw& draw) {
  bool changed = false;
  ImGui::PushItemWidth(ImGui::GetFontSize() * 13);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string number = std::string(kind) + " " + std::to_string(i + 1);
    const std::string name = items[i].name.empty() ? number : items[i].name;
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::TreeNode(kind, "%s", name.c_str())) {
      changed |= draw(items[i]);
      ImGui::TreePop();
    }
    ImGui::PopID();
  }
  ImGui::PopItemWidth();
  if (items.empty()) ImGui::TextDisabled("none");
  return changed;
}

}  // namespace

bool drawLights(std::vector<Light>& lights) { return drawItems(lights, "light", drawLight); }

bool drawMaterials(std::vector<Material>& materials) {
  return drawItems(materials, "material", drawMaterial);
}

}  // namespace whit::view
