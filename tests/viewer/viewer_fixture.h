// The viewer run by a script, and what it leaves behind.
#pragma once

#include "cli/run_command.h"
#include "virtual_display.h"

namespace whit::view {

// Now and then LeakSanitizer itself crashes over a driver's thread that is just ending, and finds
// neither leaks nor their absence: then the viewer runs once more.
inline constexpr int kAttempts = 4;

class Viewer : public cli::TinySceneTest {
 protected:
  void SetUp() override {
    if (display_.name().empty()) {
      GTEST_SKIP() << "Xvfb is not installed: the viewer's window is NOT tested (xvfb)";
    }
  }

  using Words = cli::Words;

  // Runs a script in a window of this size; without one it follows from the screen's.
  cli::Outcome run(const std::string& script, const char* size = "48x32",
                   const Words& options = {}) {
    save("script.txt", script);
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

  // Runs a command that the viewer has printed.
  void render(const std::string& command, const std::string& file) {
    paste(command + " --quiet -o " + file);
  }
  void paste(const std::string& command) { view::paste(command, folder_.path().string()); }
  // Renders with the printed command, which must give the picture that was shown.
  void expectThatItShows(const std::string& picture, const std::string& command) {
    render(command, "again.png");
    expectSameCodes(picture, "again.png");
  }

  void expectSameCodes(const std::string& a, const std::string& b) {
    const RawImage x = storedIn(a), y = storedIn(b);
    ASSERT_EQ(x.width, y.width);
    ASSERT_EQ(x.height, y.height);
    EXPECT_EQ(x.codes, y.codes);
  }
  void expectOtherCodes(const std::string& a, const std::string& b) {
    EXPECT_NE(storedIn(a).codes, storedIn(b).codes) << a << " and " << b;
  }

  // Returns whether a rectangle of both pictures is the same.
  bool sameIn(const std::string& a, const std::string& b, const Crop& rectangle) {
    const Image x = imageIn(a), y = imageIn(b);
    for (int row = rectangle.y0; row < rectangle.y1; ++row) {
      for (int column = rectangle.x0; column < rectangle.x1; ++column) {
        if (x.at(column, row) != y.at(column, row)) return false;
      }
    }
    return true;
  }

  VirtualDisplay display_;
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

}  // namespace whit::view
