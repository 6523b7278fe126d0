// Helpers that tests of the library share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

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

inline bool samePictures(const Image& a, const Image& b) {
  return std::equal(a.rgb().begin(), a.rgb().end(), b.rgb().begin(), b.rgb().end());
}

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
