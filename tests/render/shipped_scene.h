// Shipped scenes in small pictures, rendered in different ways.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "bake/scene.h"
#include "inspect/reference_frame.h"
#include "io/load_scene.h"
#include "reference/generate_rays.h"
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
inline RenderOptions smallOptions(ImageSize size = kSanitized ? ImageSize{53, 33} : kSmallSize) {
  RenderOptions o;
  o.size = size;
  o.threads = 2;
  o.depth = 8;
  return o;
}

// A frame with its statistics.
struct Picture : Film {
  FrameStats stats;
};

// In packets or by the reference, as the renderer is now.
inline Picture render(Renderer& renderer, bool packets) {
  const Camera camera = chooseCamera(renderer.scene(), renderer.options());
  Picture picture{makeFilm(renderer.scene(), renderer.options()), {}};
  picture.stats =
      packets ? renderer.render(camera, picture) : renderReference(renderer, camera, picture);
  return picture;
}

// As the renderer's options say.
inline Picture render(Renderer& renderer) {
  return render(renderer, renderer.options().mode == Mode::packets);
}

inline Picture render(const Scene& scene, const RenderOptions& options, bool packets) {
  Renderer renderer(scene, options);
  return render(renderer, packets);
}
inline Picture render(const Scene& scene, const RenderOptions& options) {
  Renderer renderer(scene, options);
  return render(renderer);
}

struct BothModes {
  Picture packets, reference;
};

inline BothModes renderBoth(const Scene& scene, const RenderOptions& options) {
  Renderer renderer(scene, options);
  return {render(renderer, true), render(renderer, false)};
}

// Calls visit(x, y) for each pixel of the picture, in coordinates of the whole image.
template <typename Visit>
void forEachPixel(const Image& image, const Visit& visit) {
  const Crop& window = image.window;
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x) visit(x, y);
  }
}

// Calls visit(ray, pixel) for each pixel that the scene's first camera shows, with the ray through
// its center.
template <typename Visit>
void forEachRay(const Scene& scene, const Image& image, const Visit& visit) {
  const CameraFrame frame = makeCameraFrame(scene.cameras[0], image.width, image.height);
  forEachPixel(image, [&](int x, int y) {
    visit(reference::generateRay(frame, x + 0.5, y + 0.5), image.at(x, y));
  });
}

// Counts the pixels that differ by `bound` or more in a channel.
inline std::size_t pixelsApart(const Image& a, const Image& b, float bound) {
  std::size_t apart = 0;
  for (const auto i : indices(a.pixels)) {
    apart += !(maxComponent(abs(a.pixels[i] - b.pixels[i])) < bound);
  }
  return apart;
}

// Returns a description of the first pixel whose bits differ, or an empty string.
inline std::string firstDifference(const Image& a, const Image& b) {
  if (a.pixels.size() != b.pixels.size()) return "different sizes";
  const auto width = static_cast<std::size_t>(a.windowWidth());
  for (const auto i : indices(a.pixels)) {
    const Rgb &p = a.pixels[i], &q = b.pixels[i];
    if (std::memcmp(&p, &q, sizeof(Rgb)) == 0) continue;
    std::ostringstream text;
    text << std::hexfloat << "pixel " << i % width << ',' << i / width << ": " << p.x << ' ' << p.y
         << ' ' << p.z << " against " << q.x << ' ' << q.y << ' ' << q.z;
    return text.str();
  }
  return {};
}

inline std::span<const std::byte> bytesOf(const ChannelLayers& layers, Channel channel) {
  if (infoOf(channel).countsThings) return std::as_bytes(layers.numbers(channel));
  return std::as_bytes(layers.floats(channel));
}

// The same for films, of which the channels are compared, too.
inline std::string firstDifference(const Film& a, const Film& b) {
  std::string difference = firstDifference(a.image, b.image);
  a.channels.channels().forEach([&](Channel c) {
    if (!std::ranges::equal(bytesOf(a.channels, c), bytesOf(b.channels, c))) {
      difference += " channel " + std::string(infoOf(c).name);
    }
  });
  return difference;
}

// Tests of a shipped scene, which is their parameter.
class SceneTest : public testing::TestWithParam<std::string> {
 protected:
  const Scene scene_ = load(GetParam());
};

// The name of a test of a shipped scene, without the scene's parameters.
inline std::string sceneName(const testing::TestParamInfo<std::string>& info) {
  return info.param.substr(0, info.param.find('?'));
}

// Scenes with the common effects. Only the scene `effects` has all of them.
inline const std::vector<std::string>& smallScenes() {
  static const std::vector<std::string> names{"whitted", "glass", "mirrors", "matte",
                                              "landscape?triangles=20000"};
  return names;
}

}  // namespace whit::test
