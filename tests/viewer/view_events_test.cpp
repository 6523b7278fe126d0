// whit-view under a restless user: other views, dropped files, errors, and random events.
#include <gtest/gtest.h>

#include <random>

#include "core/option_table.h"
#include "has_text.h"
#include "viewer_fixture.h"

namespace whit::view {
namespace {

TEST_F(Viewer, ShowsOtherViews) {
  play(
      "bare\nwait sharp\nscreenshot picture.png\nkey V\nwait 2 frames\nwait sharp\n"
      "screenshot depth.png\nkey V\nwait 2 frames\nwait sharp\nscreenshot normals.png\n");

  // The option shows what pressing V twice shows.
  play("bare\nwait sharp\nscreenshot again.png\n", "48x32", {"--view", "normals"});
  expectOtherCodes("picture.png", "depth.png");
  expectOtherCodes("depth.png", "normals.png");
  expectSameCodes("again.png", "normals.png");
}

// Only whit render writes the digest of the scene, which --resume compares.
constexpr char kSceneDigest[] = "sceneDigest";

// Compares the bits of the pixels, and all that the files say about themselves.
void expectSameFile(const std::string& viewed, const std::string& rendered) {
  const Image a = readImage(viewed, ImageLimits());
  const Image b = readImage(rendered, ImageLimits());
  EXPECT_EQ(a.pixels, b.pixels);

  ImageMetadata said = readExrMetadata(rendered);
  EXPECT_EQ(std::erase_if(said, [](const auto& entry) { return entry.first == kSceneDigest; }), 1u);
  EXPECT_EQ(readExrMetadata(viewed), said);
}

// The user presses keys, moves the mouse, and then unfolds and changes a light and a material in
// the panel.
TEST_F(Viewer, EditsComeBackFromThePrintedCommand) {
  const Words lines = commandsOf(
      3,
      "asked\nkey W 0.3\nmouse left 10 5\npanel scene\nwait 10 frames\n"
      "click 30 139\nwait 5 frames\nclick 100 208\nclick 60 160 130 160\n"         // the lamp
      "click 30 289\nwait 5 frames\nclick 60 334 90 334\nclick 110 310 140 310\n"  // the mirror
      "bare\nwait 20 frames\nwait sharp\nscreenshot shown.png\nkey C\nkey F12\nkey F12\n",
      "800x480");
  EXPECT_EQ(lines, Words(3, lines[0]));
  for (const std::string edited : {"/lights/0/position=", "/lights/0/intensity=",
                                   "/materials/mirror/specular=", "/materials/mirror/diffuse="}) {
    EXPECT_TRUE(hasText(lines[0], "--set '" + edited));
  }
  // What was not edited is not set.
  EXPECT_FALSE(hasText(lines[0], "/materials/floor"));

  expectThatItShows("shown.png", lines[0]);
  // The saved file is the one that the printed command makes.
  render(lines[0], "again.exr");
  expectSameFile(folder_ / "tiny-0001.exr", folder_ / "again.exr");
  EXPECT_EQ(bytesOf("tiny-0002.exr"), bytesOf("tiny-0001.exr"));
}

// The scene's first camera is at (0, 2, 6) and looks along -z and down.
TEST_F(Viewer, EachKeyWalksItsOwnWay) {
  struct Key {
    const char* held;  // the key, and for how long
    int axis;
    float way;
  };
  constexpr Key kKeys[] = {{"E 0.4", 1, 1},  {"Q 0.2", 1, -1}, {"D 0.4", 0, 1},
                           {"A 0.2", 0, -1}, {"W 0.4", 2, -1}, {"S 0.2", 2, 1}};
  std::string script;
  for (const Key& key : kKeys) {
    script += std::string("key ") + key.held + "\nwait 20 frames\nwait sharp\nkey C\n";
  }

  const Words lines = commandsOf(std::size(kKeys), script);
  Vec3f before{0, 2, 6};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto& [held, axis, way] = kKeys[i];
    const std::string option = "--eye=";
    const std::size_t at = lines[i].find(option);
    ASSERT_NE(at, std::string::npos) << lines[i];
    Vec3f eye;
    parseValue(OptionSpec{}, cli::split(lines[i].substr(at + option.size()))[0], eye);
    EXPECT_GT(way * (eye[axis] - before[axis]), 0) << held;
    before = eye;
  }
}

// Makes events of all kinds that keys and mouse have, except for quitting and for writing files.
std::string randomEvents(unsigned seed, int count) {
  constexpr std::array kKeys{"W",     "A", "S", "D", "Q",     "E",    "Left", "Up",
                             "Space", "1", "2", "9", "P",     "T",    "[",    "]",
                             "F",     "H", "V", "R", "Shift", "Home", "F11",  "L"};
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const auto numbers = [&](const ImageSize& range, int x, int y) {
    x += below(range.width);
    y += below(range.height);
    return ' ' + std::to_string(x) + ' ' + std::to_string(y);
  };
  const ImageSize all{400, 300}, window{320, 240};
  std::string script = "errors show";

  for (int i = 0; i < count; ++i) {
    script += '\n';
    switch (below(9)) {
      case 0:
        script += "mouse left" + numbers(all, -200, -150);
        break;
      case 1:
        script += "mouse right" + numbers(all, -200, -150);
        break;
      case 2:
        script += "wheel " + std::to_string(below(7) - 3);
        break;
      case 3:
        script += "click" + numbers(window, 0, 0);
        break;
      case 4:
        script += "click" + numbers(window, 0, 0);
        script += numbers(window, 0, 0);
        break;
      case 5:
        if (below(4) == 0) script += "resize" + numbers(all, 1, 1) + '\n';
        if (below(4) == 0) script += "key Ctrl+Z\n";
        if (below(8) == 0) script += "minimize\nwait 2 frames\nrestore\n";
        if (below(8) == 0) script += below(2) == 0 ? "drop tiny.json\n" : "drop none.json\n";
        script += "wait " + std::to_string(1 + below(5)) + " frames";
        break;
      default:
        script += std::string("key ") + kKeys[static_cast<std::size_t>(below(kKeys.size()))];
        if (below(2) == 0) script += " 0.05";
    }
  }
  return script;
}

TEST_F(Viewer, SurvivesTwoHundredRandomEvents) {
  EXPECT_FALSE(hasText(play(randomEvents(7, 200), "320x240").err, "Sanitizer"));
}

}  // namespace
}  // namespace whit::view
