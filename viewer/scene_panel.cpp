// The tab of the scene: lights, materials, sky and ambient light as controls.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/load_scene.h"
#include "make/studio_sky.h"
#include "scene/members.h"
#include "viewer/scene_panel.h"

namespace whit::view {

namespace {

constexpr auto kClamp = ImGuiSliderFlags_AlwaysClamp;  // also clamps typed values
constexpr auto kLogarithmic = kClamp | ImGuiSliderFlags_Logarithmic;
constexpr float kLargestScale = 1e4f, kLargestAmbient = 1e4f;

bool drawColor(const char* label, Rgb& color) {
  if (!ImGui::ColorEdit3(label, &color.x, ImGuiColorEditFlags_Float)) return false;
  color = min(max(color, Rgb(0.0f)), Rgb(1.0f));
  return true;
}

// Shows a value without upper limit as its largest channel and a color that has 1 there.
bool drawBright(const char* label, const char* strengthLabel, float largest, Rgb& value) {
  float strength = maxComponent(value);
  Rgb color = strength > 0 ? value * (1 / strength) : Rgb{1, 1, 1};
  const bool recolored = drawColor(label, color);
  const bool turned =
      ImGui::SliderFloat(strengthLabel, &strength, 0, largest, "%.3g", kLogarithmic);
  if (!recolored && !turned) return false;

  value = color * strength;
  return true;
}

// The change of a value without limits for each pixel that the mouse is dragged.
float dragStep(float value) { return 0.002f * std::max(1.0f, std::abs(value)); }

template <typename Noun, typename Value>
bool drawMember(const Member<Noun, Value>& member, Value& value) {
  const auto low = static_cast<float>(member.rules.low);
  const auto high = static_cast<float>(std::min(member.rules.high, member.rules.usual));

  if constexpr (std::is_same_v<Value, Light::Kind>) {
    return false;  // the kind decides which members there are
  } else if constexpr (std::is_same_v<Value, bool>) {
    return ImGui::Checkbox(member.name, &value);
  } else if constexpr (std::is_same_v<Value, int>) {
    return ImGui::SliderInt(member.name, &value, static_cast<int>(low), static_cast<int>(high),
                            "%d", kClamp);
  } else if constexpr (std::is_same_v<Value, float>) {
    const bool endless = member.rules.usual >= kLargestNumber;
    return endless
               ? ImGui::DragFloat(member.name, &value, dragStep(value), low, high, "%.3f", kClamp)
               : ImGui::SliderFloat(member.name, &value, low, high, "%.3f", kClamp);
  } else if (member.rules.kind != MemberKind::color) {
    const float step = dragStep(maxComponent(abs(value)));
    return ImGui::DragFloat3(member.name, &value.x, step, low, high, "%.3f", kClamp);
  } else if (member.rules.high <= 1) {
    return drawColor(member.name, value);
  } else {
    return drawBright(member.name, (std::string("times##") + member.name).c_str(), high, value);
  }
}

template <typename Noun>
bool drawMembers(Noun& noun) {
  bool changed = false;
  forEachMemberInFiles(noun, [&](const auto& member) {
    if (member.rules.baked || (member.rules.matters && !member.rules.matters(noun))) return;
    changed |= drawMember(member, noun.*member.field);
  });
  return changed;
}

bool drawLight(Light& light) {
  const Vec3f before = light.direction;
  if (!drawMembers(light)) return false;
  if (light.direction == Vec3f()) light.direction = before;
  light.innerConeAngle = std::min(light.innerConeAngle, std::nextafter(light.outerConeAngle, 0.0f));
  return true;
}

// Draws a foldable node for each item, under its name or number; unfolds `selected` once and
// scrolls to it. Adds the settings by which the user has edited the items.
template <typename Item, typename Draw>
void drawItems(std::vector<Item>& items, const char* kind, std::size_t& selected, const Draw& draw,
               const Vec3d& origin, std::vector<std::string>& settings) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string number = std::string(kind) + " " + std::to_string(i + 1);
    const std::string name = items[i].name.empty() ? number : items[i].name;

    ImGui::PushID(static_cast<int>(i));
    if (i == selected) {
      ImGui::SetNextItemOpen(true);
      ImGui::SetScrollHereY(0);
      selected = kNoCounterpart;
    }

    if (ImGui::TreeNode(kind, "%s", name.c_str())) {
      const Item before = items[i];
      ImGui::BeginDisabled(before.pointer.empty());  // no setting can name it
      if (draw(items[i])) addMemberSettings(before, items[i], origin, settings);
      ImGui::EndDisabled();
      ImGui::TreePop();
    }
    ImGui::PopID();
  }

  if (items.empty()) ImGui::TextDisabled("none");
}

std::string nameOf(const Sky& sky) {
  if (isNoSky(sky)) return kNoSky;
  return sky.name.empty() ? "the scene's own" : skyName(sky);
}

bool drawChoice(const Sky& own, Sky& sky) {
  if (!ImGui::BeginCombo("sky", nameOf(sky).c_str())) return false;

  bool changed = false;
  const auto offer = [&](const Sky& choice) {
    const bool current = isSameSky(choice, sky);
    if (!ImGui::Selectable(nameOf(choice).c_str(), current) || current) return;
    sky = choice;
    changed = true;
  };

  // The scene's own sky comes first. If it is one of the two others, it is listed only once.
  offer(own);
  for (const char* source : {kNoSky, kStudio}) {
    if (nameOf(own) != source) offer(skyFrom(source));
  }

  ImGui::EndCombo();
  return changed;
}

bool drawSky(const Sky& own, Sky& sky) {
  bool changed = drawChoice(own, sky);
  if (isNoSky(sky)) return changed;

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

  // Ambient light from the sky is a multiple of the sky's mean radiance.
  if (ambient.ofSky > 0) {
    constexpr float kLeast = 0.01f, kMost = 10;
    auto share = static_cast<float>(ambient.ofSky);
    if (!ImGui::SliderFloat("of the sky's mean", &share, kLeast, kMost, "%.2f", kLogarithmic)) {
      return changed;
    }

    ambient.ofSky = static_cast<double>(share);
    return true;
  }

  // Otherwise it is a radiance from above and another one from below.
  changed |= drawBright("ambient, above", "times##above", kLargestAmbient, ambient.up);
  changed |= drawBright("ambient, below", "times##below", kLargestAmbient, ambient.down);
  return changed;
}

}  // namespace

std::vector<std::string> drawScene(const Sky& ownSky, Selection& unfolds, EditedScene& scene) {
  std::vector<std::string> settings;
  const Vec3d& origin = scene.origin;
  ImGui::PushItemWidth(-20 * ImGui::CalcTextSize("0").x);  // names stand behind their widgets

  ImGui::TextDisabled("lights");
  if (origin != Vec3d()) {
    ImGui::TextWrapped("positions are from %.17g,%.17g,%.17g", origin.x, origin.y, origin.z);
  }
  drawItems(scene.lights, "light", unfolds.light, drawLight, origin, settings);

  ImGui::TextDisabled("materials");
  drawItems(scene.materials, "material", unfolds.material, drawMembers<Material>, origin, settings);

  ImGui::TextDisabled("surroundings");
  if (drawSky(ownSky, scene.sky)) addSkySetting(scene, settings);
  if (drawAmbient(!isNoSky(scene.sky), scene.ambient)) addAmbientSetting(scene, settings);
  ImGui::PopItemWidth();
  return settings;
}

}  // namespace whit::view
