#include "viewer/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "core/formatted.h"

namespace whit::view {

bool Timeline::step(double later) {
  if (!there || !playing) return false;
  seconds += later;
  if (seconds > length) seconds = length > 0 ? std::fmod(seconds, length) : 0;
  return true;
}

Timeline timelineOf(const Scene& scene, const Instant& instant) {
  Timeline timeline;
  timeline.there = !scene.motion.empty();
  timeline.seconds = instant.seconds.value_or(0);
  timeline.playing = timeline.there && !instant.seconds;
  timeline.animation = instant.animation;
  for (const Animation& animation : scene.animations) {
    // A model's first animation plays unless another is named; motions of a scene file always do.
    const bool own = animation.name == kSceneMotion;
    if (!own && timeline.animation.empty()) timeline.animation = animation.name;
    if (!own) timeline.animations.push_back(animation.name);
    if (own || animation.name == timeline.animation) {
      timeline.length = std::max(timeline.length, animation.seconds);
    }
  }
  for (const MovingCamera& camera : scene.motion.given.cameras) {
    if (camera.node != kNoNode) continue;  // without a node it flies along the path
    timeline.length = std::max(timeline.length, static_cast<double>(scene.cameraPath.back().time));
  }
  if (timeline.animations.size() == 1) timeline.animations.clear();
  return timeline;
}

bool drawTimeline(Timeline& timeline) {
  if (!timeline.there) return false;
  const float fromBottom = 3.5f * ImGui::GetFontSize();  // messages are below
  constexpr auto kBare = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                         ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing;
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(window.x / 2, window.y - fromBottom), ImGuiCond_Always,
                          ImVec2(0.5f, 1));
  ImGui::SetNextWindowBgAlpha(kPanelAlpha);
  bool changed = false;
  if (ImGui::Begin("timeline", nullptr, kBare)) {
    const float line = ImGui::GetFontSize();
    if (ImGui::Button(timeline.playing ? "pause" : "play", ImVec2(4 * line, 0))) {
      timeline.playing = !timeline.playing;
      changed = true;
    }
    ImGui::SameLine();
    auto seconds = static_cast<float>(timeline.seconds);
    ImGui::SetNextItemWidth(std::max(0.3f * window.x, 6 * line));
    if (ImGui::SliderFloat("##time", &seconds, 0, static_cast<float>(timeline.length),
                           formatted("%%.2f of %.2f s", timeline.length).c_str(),
                           ImGuiSliderFlags_AlwaysClamp)) {
      timeline.seconds = static_cast<double>(seconds);
      timeline.playing = false;
      changed = true;
    }
    if (!timeline.animations.empty()) {
      ImGui::SameLine();
      ImGui::SetNextItemWidth(9 * line);
      if (ImGui::BeginCombo("##animation", timeline.animation.c_str())) {
        for (const std::string& name : timeline.animations) {
          if (!ImGui::Selectable(name.c_str(), name == timeline.animation)) continue;
          timeline.animation = name;
          timeline.another = changed = true;
        }
        ImGui::EndCombo();
      }
    }
  }
  ImGui::End();
  return changed;
}

}  // namespace whit::view
