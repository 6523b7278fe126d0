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

}  // namespace whit::api
