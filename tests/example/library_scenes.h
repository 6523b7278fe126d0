// Helpers that tests of the library share.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "library/whit.h"

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

// A folder that its destructor removes.
class TemporaryFolder {
 public:
  TemporaryFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("whit-library-" + std::to_string(getpid()) + "-" +
               testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directory(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace whit::api
