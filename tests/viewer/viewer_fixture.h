// The viewer run by a script, and what it leaves behind.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "io/image/image_file.h"
#include "virtual_display.h"

namespace whit::view {

// Now and then LeakSanitizer itself crashes over a driver's thread that is just ending, and finds
// neither leaks nor their absence: then the viewer runs once more.
inline constexpr int kAttempts = 4;

class Viewer : public testing::Test {
 protected:
  void SetUp() override {
    if (display_.name().empty()) {
      GTEST_SKIP() << "Xvfb is not installed: the viewer's window is NOT tested (xvfb)";
    }
    cli::writeTinyScene(folder_);
  }

  cli::Outcome view(std::vector<std::string> words) {
    words.insert(words.begin(), {WHIT_VIEW_SCRIPT_PROGRAM, "tiny.json", "--quiet"});
    // The words "--size scene" are left out, so that the window's size follows from the screen's.
    const auto size = std::find(words.begin(), words.end(), "--size");
    if (size == words.end()) words.insert(size, {"--size", "48x32"});
    if (const auto scene = std::find(words.begin(), words.end(), "scene"); scene != words.end()) {
      words.erase(scene - 1, scene + 1);
    }

    cli::Outcome outcome;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      outcome = runOn(display_.name(), folder_.path().string(), words);
      if (outcome.err.find("LeakSanitizer has encountered a fatal error") == std::string::npos)
        break;
    }
    return outcome;
  }
  cli::Outcome play(const std::string& script, std::vector<std::string> words = {}) {
    std::ofstream(folder_ / "script.txt") << script;
    words.insert(words.end(), {"--script", "script.txt"});
    const cli::Outcome outcome = view(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome;
  }
  // Runs a command that the viewer has printed, as a shell would.
  void render(const std::string& command, const std::string& file) {
    paste(command + " --quiet -o " + file);
  }
  void paste(const std::string& command) {
    ASSERT_EQ(command.rfind("whit render ", 0), 0u) << command;
    const std::string line = WHIT_PROGRAM + command.substr(4);
    const cli::Outcome outcome = runOn("", folder_.path().string(), {"/bin/sh", "-c", line});
    ASSERT_EQ(outcome.status, 0) << line << "\n" << outcome.err;
  }
  RawImage codes(const std::string& file) {
    Warnings warnings;
    return readRawImage(folder_ / file, ImageLimits(), warnings);
  }
  void expectSameCodes(const std::string& a, const std::string& b) {
    const RawImage x = codes(a), y = codes(b);
    ASSERT_EQ(x.width, y.width);
    ASSERT_EQ(x.height, y.height);
    EXPECT_EQ(x.codes, y.codes);
  }

  VirtualDisplay display_;
  cli::TemporaryFolder folder_;
};

inline std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

}  // namespace whit::view
