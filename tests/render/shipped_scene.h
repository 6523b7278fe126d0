// Shipped scenes in small pictures, rendered in different ways.
#pragma once

#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bake/scene.h"
#include "inspect/reference_frame.h"
#include "io/load_scene.h"
#include "render/renderer.h"
#include "sanitized.h"
#include "verify/scene_builder.h"

namespace whit::test {

using verify::repaired;

inline SceneDescription described(const std::string& name, const LoadOptions& options = {}) {
  Warnings warnings;
  return loadScene(name, options, warnings);
}

// Scenes are made once a process, because that takes most of the time of a small picture.
inline Scene load(const std::string& name) {
  static std::map<std::string, Scene> scenes;
  const auto known = scenes.find(name);
  if (known != scenes.end()) return known->second;

  return scenes.emplace(name, repaired(described(name))).first->second;
}

inline constexpr ImageSize kSmallSize{107, 67};

// The default small picture is wide enough for several tiles and not a multiple of any of them,
// also where a sanitizer watches the code, which a quarter of the pixels runs as well. Paths caught
// in glass multiply rounding errors with every bounce; at this depth few have diverged.
inline RenderOptions smallOptions() {
  RenderOptions o;
  o.size = kSanitized ? ImageSize{53, 33} : kSmallSize;
  o.threads = 2;
  o.depth = 8;
  return o;
}

// A frame with its statistics.
struct Picture : Film {
  FrameStats stats;
};

// In packets or by the reference, as the renderer is now.
inline Picture render(Renderer& renderer, bool packets = true) {
  const Camera camera = chooseCamera(renderer.scene(), renderer.options());
  Picture picture{makeFilm(renderer.scene(), renderer.options()), {}};
  picture.stats =
      packets ? renderer.render(camera, picture) : renderReference(renderer, camera, picture);
  return picture;
}

inline Picture render(const Scene& scene, const RenderOptions& options, bool packets = true) {
  Renderer renderer(scene, options);
  return render(renderer, packets);
}

struct BothModes {
  Picture packets, reference;
};

inline BothModes renderBoth(const Scene& scene, const RenderOptions& options) {
  Renderer renderer(scene, options);
  return {render(renderer), render(renderer, false)};
}

// Returns a description of the first pixel whose bits differ, or an empty string.
inline std::string firstDifference(const Image& a, const Image& b) {
  if (a.pixels.size() != b.pixels.size()) return "different sizes";
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(Rgb)) == 0) continue;
    const auto w = static_cast<std::size_t>(a.windowWidth());
    char text[160];
    std::snprintf(text, sizeof(text), "pixel %zu,%zu: %a %a %a against %a %a %a", i % w, i / w,
                  double{a.pixels[i].x}, double{a.pixels[i].y}, double{a.pixels[i].z},
                  double{b.pixels[i].x}, double{b.pixels[i].y}, double{b.pixels[i].z});
    return text;
  }
  return {};
}

// Scenes with the common effects. Only the scene `effects` has all of them.
inline const std::vector<std::string>& smallScenes() {
  static const std::vector<std::string> names{"whitted", "glass", "mirrors", "matte",
                                              "landscape?triangles=20000"};
  return names;
}

}  // namespace whit::test
