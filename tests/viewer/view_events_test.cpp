// whit-view under a restless user: other views, dropped files, errors, and random events.
#include <gtest/gtest.h>

#include <random>

#include "has_text.h"
#include "viewer_fixture.h"

namespace whit::view {
namespace {

TEST_F(Viewer, ShowsOtherViews) {
  play(
      "bare\nwait sharp\nscreenshot picture.png\nkey V\nwait 2 frames\nwait sharp\n"
      "screenshot depth.png\nkey V\nwait 2 frames\nwait sharp\nscreenshot normals.png\n");

  // The option shows what pressing V twice shows.
  play("bare\nwait sharp\nscreenshot again.png\n", {"--view", "normals"});
  EXPECT_NE(codes("picture.png").codes, codes("depth.png").codes);
  EXPECT_NE(codes("depth.png").codes, codes("normals.png").codes);
  expectSameCodes("again.png", "normals.png");
}

TEST_F(Viewer, DroppedFilesOpen) {
  std::string text = cli::readFile(folder_ / "tiny.json");
  text.replace(text.find("0, 2, 6"), 7, "1, 3, 7");
  std::ofstream(folder_ / "other.json") << text;

  const cli::Outcome outcome = play(
      "bare\nwait sharp\ndrop other.json\nwait 60 frames\nwait sharp\nscreenshot "
      "shown.png\n"
      "key C\n",
      {"--size", "120x80"});

  const std::vector<std::string> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 1u) << outcome.out;
  EXPECT_TRUE(hasText(lines[0], "other.json"));
  EXPECT_FALSE(hasText(lines[0], "--eye"));
  render(lines[0], "again.png");
  expectSameCodes("shown.png", "again.png");
}

// A reload before the dropped scene is there loads the dropped scene.
TEST_F(Viewer, ADroppedSceneReadAgainIsTheOneNamed) {
  const cli::Outcome outcome = play(
      "bare\nasked\nwait sharp\ndrop whitted\nkey R\nwait 60 frames\nwait sharp\n"
      "screenshot shown.png\nkey C\n");

  const std::vector<std::string> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 1u) << outcome.out;
  EXPECT_EQ(lines[0].find("whit render whitted "), 0u) << lines[0];
  render(lines[0], "again.png");
  expectSameCodes("shown.png", "again.png");
}

TEST_F(Viewer, ErrorsAreShownAndSurvived) {
  std::ofstream(folder_ / "broken.json") << "{ \"whit\": 1,\n \"lights\": 7 }";
  const cli::Outcome outcome = play(
      "errors show\nbare\nwait sharp\nscreenshot before.png\ndrop broken.json\nwait 30 frames\n"
      "wait sharp\nscreenshot error.png\ndrop missing.json\nwait 30 frames\nwait sharp\n",
      {"--size", "320x200"});
  EXPECT_TRUE(hasText(outcome.err, "broken.json#/lights"));
  EXPECT_TRUE(hasText(outcome.err, "missing.json"));
  EXPECT_NE(codes("before.png").codes, codes("error.png").codes);
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
  const cli::Outcome outcome = play(
      "asked\nkey W 0.3\nmouse left 10 5\npanel scene\nwait 10 frames\n"
      "click 30 139\nwait 5 frames\nclick 100 208\nclick 60 160 130 160\n"         // the lamp
      "click 30 289\nwait 5 frames\nclick 60 334 90 334\nclick 110 310 140 310\n"  // the mirror
      "bare\nwait 20 frames\nwait sharp\nscreenshot shown.png\nkey C\nkey F12\n",
      {"--size", "800x480"});

  const std::vector<std::string> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 2u) << outcome.out;
  EXPECT_EQ(lines[1], lines[0]);
  for (const char* edited : {"/lights/0/position=", "/lights/0/intensity=",
                             "/materials/mirror/specular=", "/materials/mirror/diffuse="}) {
    EXPECT_TRUE(hasText(lines[0], std::string("--set '") + edited));
  }
  // What was not edited is not set.
  EXPECT_FALSE(hasText(lines[0], "/materials/floor"));

  render(lines[0], "again.png");
  expectSameCodes("shown.png", "again.png");
  // The saved file is the one that the printed command makes.
  render(lines[0], "again.exr");
  expectSameFile(folder_ / "tiny-0001.exr", folder_ / "again.exr");
}

// A setting of the command line belongs to the scene that is named there. It stays when that scene
// is read again, and goes when another one is opened.
TEST_F(Viewer, SettingsStayWithTheirScene) {
  std::ofstream(folder_ / "other.json") << cli::readFile(folder_ / "tiny.json");
  const cli::Outcome outcome = play(
      "asked\nwait sharp\nkey C\nkey R\nwait 60 frames\nwait sharp\nkey C\n"
      "drop other.json\nwait 60 frames\nwait sharp\nkey C\n",
      {"--set", "/materials/floor/diffuse=[0.9, 0.1, 0.1]"});

  const std::vector<std::string> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 3u) << outcome.out;
  EXPECT_TRUE(hasText(lines[0], " --set '/materials/floor/diffuse=[0.9, 0.1, 0.1]'"));
  EXPECT_EQ(lines[1], lines[0]);
  EXPECT_FALSE(hasText(lines[2], "--set"));
}

// Makes events of all kinds that keys and mouse have, except for quitting and for writing files.
std::string randomEvents(unsigned seed, int count) {
  constexpr std::array kKeys{"W",     "A", "S", "D", "Q",     "E",    "Left", "Up",
                             "Space", "1", "2", "9", "P",     "T",    "[",    "]",
                             "F",     "H", "V", "R", "Shift", "Home", "F11",  "L"};
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  std::ostringstream script;
  script << "errors show\n";

  for (int i = 0; i < count; ++i) {
    switch (below(9)) {
      case 0:
        script << "mouse left " << below(400) - 200 << ' ' << below(300) - 150 << "\n";
        break;
      case 1:
        script << "mouse right " << below(400) - 200 << ' ' << below(300) - 150 << "\n";
        break;
      case 2:
        script << "wheel " << below(7) - 3 << "\n";
        break;
      case 3:
        script << "click " << below(320) << ' ' << below(240) << "\n";
        break;
      case 4:
        script << "click " << below(320) << ' ' << below(240) << ' ' << below(320) << ' '
               << below(240) << "\n";
        break;
      case 5:
        if (below(4) == 0) script << "resize " << 1 + below(400) << ' ' << 1 + below(300) << "\n";
        if (below(4) == 0) script << "key Ctrl+Z\n";
        if (below(8) == 0) script << "minimize\nwait 2 frames\nrestore\n";
        if (below(8) == 0) script << "drop " << (below(2) == 0 ? "tiny.json" : "none.json") << "\n";
        script << "wait " << 1 + below(10) << " frames\n";
        break;
      default:
        script << "key " << kKeys[static_cast<std::size_t>(below(kKeys.size()))];
        if (below(2) == 0) script << " 0.1";
        script << "\n";
    }
  }
  return script.str();
}

TEST_F(Viewer, SurvivesTwoHundredRandomEvents) {
  const cli::Outcome outcome = play(randomEvents(7, 200), {"--size", "320x240"});
  EXPECT_FALSE(hasText(outcome.err, "Sanitizer"));
}

TEST_F(Viewer, FullScreenMinimizedAndResized) {
  const cli::Outcome outcome = play(
      "bare\nkey F11\nwait 5 frames\nkey F11\nwait 5 frames\nminimize\nwait 5 frames\nrestore\n"
      "wait 5 frames\nresize 200 100\nwait 10 frames\nwait sharp\nscreenshot shown.png\nkey C\n");

  const RawImage shown = codes("shown.png");
  EXPECT_EQ(shown.width, 200);
  EXPECT_EQ(shown.height, 100);

  const std::vector<std::string> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 1u) << outcome.out;
  render(lines[0], "again.png");
  expectSameCodes("shown.png", "again.png");
}

}  // namespace
}  // namespace whit::view
