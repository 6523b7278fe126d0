// The viewer run by a script, and what it leaves behind.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
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

  using Words = std::vector<std::string>;

  void write(const std::string& file, const std::string& text) {
    std::ofstream(folder_ / file) << text;
  }
  std::string read(const std::string& file) { return cli::readFile(folder_ / file); }
  bool exists(const std::string& file) { return std::filesystem::exists(folder_ / file); }
  // Writes a scene that is the tiny one but for one text in it.
  void writeChanged(const std::string& file, const std::string& text, const std::string& other) {
    std::string scene = read("tiny.json");
    write(file, scene.replace(scene.find(text), text.size(), other));
  }

  // Runs a script in a window of this size; without one it follows from the screen's.
  cli::Outcome run(const std::string& script, const char* size = "48x32",
                   const Words& options = {}) {
    write("script.txt", script);
    Words words{WHIT_VIEW_SCRIPT_PROGRAM, "--quiet", "--script", "script.txt"};
    if (*size != 0) words.insert(words.end(), {"--size", size});
    words.insert(words.end(), scene_.begin(), scene_.end());
    words.insert(words.end(), options.begin(), options.end());

    cli::Outcome outcome;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      outcome = runOn(display_.name(), folder_.path().string(), words);
      if (outcome.err.find("LeakSanitizer has encountered a fatal error") == std::string::npos)
        break;
    }
    return outcome;
  }
  cli::Outcome play(const std::string& script, const char* size = "48x32",
                    const Words& options = {}) {
    const cli::Outcome outcome = run(script, size, options);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome;
  }
  // Plays a script that prints so many commands, and returns them.
  Words commandsOf(std::size_t count, const std::string& script, const char* size = "48x32",
                   const Words& options = {}) {
    std::istringstream out(play(script, size, options).out);
    Words lines;
    for (std::string line; std::getline(out, line);) lines.push_back(line);
    EXPECT_EQ(lines.size(), count) << out.str();
    lines.resize(count);
    return lines;
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
  // Renders with the printed command, which must give the picture that was shown.
  void expectThatItShows(const std::string& picture, const std::string& command) {
    render(command, "again.png");
    expectSameCodes(picture, "again.png");
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
  void expectOtherCodes(const std::string& a, const std::string& b) {
    EXPECT_NE(codes(a).codes, codes(b).codes) << a << " and " << b;
  }

  VirtualDisplay display_;
  cli::TemporaryFolder folder_;
  Words scene_{"tiny.json"};  // what the viewer is started with
};

// Writes the image of a sky whose pixels all differ, and one of which is bright.
inline void writeSky(const std::string& file) {
  Image sky(4, 2);
  for (std::size_t i = 0; i < sky.pixels.size(); ++i) {
    sky.pixels[i] = {0.2f * static_cast<float>(i), 1, i == 1 ? 5.0f : 0.5f};
  }
  writeExr(file, sky, {});
}

// Returns whether the bytes of a rectangle of both pictures are equal.
inline bool sameIn(const RawImage& a, const RawImage& b, int x0, int y0, int x1, int y1) {
  const auto channels = static_cast<std::size_t>(a.channels);
  for (int y = y0; y < y1; ++y) {
    const std::size_t from = static_cast<std::size_t>(y * a.width + x0) * channels;
    const std::size_t bytes = static_cast<std::size_t>(x1 - x0) * channels;
    if (std::memcmp(&a.codes[from], &b.codes[from], bytes) != 0) return false;
  }
  return true;
}

}  // namespace whit::view
