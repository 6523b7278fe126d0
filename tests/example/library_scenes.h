// Helpers that tests of the library share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string>

#include "as_json.h"
#include "library/whit.h"
#include "temporary_folder.h"

namespace whit::api {

inline Renderer smallRenderer(Scene scene) {
  Renderer renderer(std::move(scene));
  renderer.set("size", "40x24").set("threads", "2");
  return renderer;
}

inline Renderer smallRenderer(const std::string& name, const LoadOptions& options = {}) {
  return smallRenderer(loadScene(name, options));
}

// The transform that scales along the axes, and then moves.
inline Matrix placed(const Vector& at, const Vector& scale = {1, 1, 1}) {
  return {scale[0], 0, 0, at[0], 0, scale[1], 0, at[1], 0, 0, scale[2], at[2]};
}

// A picture as it is, or the next one of a renderer.
struct Shown {
  Shown(const Image& picture) : image(picture) {}           // NOLINT(google-explicit-constructor)
  Shown(Renderer& renderer) : image(renderer.render()) {}   // NOLINT(google-explicit-constructor)
  Shown(Renderer&& renderer) : image(renderer.render()) {}  // NOLINT(google-explicit-constructor)
  Image image;
};

inline bool samePictures(const Shown& a, const Shown& b) {
  return std::ranges::equal(a.image.rgb(), b.image.rgb());
}

// A sheet of two triangles, of which one is bent, as a camera sees it, and dots for its texture.
inline constexpr std::array<float, 12> kBentCorners{-1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0.5f, 1};
inline constexpr std::array<std::uint32_t, 6> kHalves{0, 2, 1, 0, 3, 2};
inline const Camera kSheetCamera{{0.5, 2, 4}, {0, 0, 0}};
inline const Light kSheetLight{.position = {1, 4, 2}, .intensity = {30, 30, 30}};
inline constexpr std::array<std::uint8_t, 12> kDots{200, 30, 10,  20,  180, 90,
                                                    5,   60, 220, 255, 255, 255};

// Returns what `body` throws, or an error of status 0 if it throws nothing.
inline Error errorOf(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()), "");
    return error;
  }
  return {0, "nothing was thrown"};
}
inline int statusOf(const std::function<void()>& body) { return errorOf(body).status(); }

}  // namespace whit::api
