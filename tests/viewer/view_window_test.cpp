// whit-view itself, with a scripted user on a virtual display.
#include <gtest/gtest.h>

#include <cstring>

#include "viewer/view_files.h"
#include "viewer/window.h"
#include "viewer_fixture.h"

namespace whit::view {
namespace {

TEST_F(Viewer, ShowsWhatThePrintedCommandRenders) {
  const cli::Outcome outcome = play(
      "key H\nkey W 0.5\nmouse left 40 -25\nmouse right -30 5\nkey ]\nwait 3 frames\nwait sharp\n"
      "screenshot shown.png\nkey C\n",
      {"--size", "240x160"});
  const std::vector<std::string> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 1u) << outcome.out;
  EXPECT_EQ(lines[0].find("--eye=0,2,6"), std::string::npos) << "it has not moved: " << lines[0];
  EXPECT_NE(lines[0].find("--exposure=0.25"), std::string::npos) << lines[0];
  render(lines[0], "again.png");
  expectSameCodes("shown.png", "again.png");
}

// Pasted into a shell as it is.
TEST_F(Viewer, OnlyWhatDiffersIsPrinted) {
  const cli::Outcome outcome = play(
      "key H\nkey N\nwait sharp\nscreenshot first.png\nkey C\nkey 2\nwait 20 frames\nwait sharp\n"
      "screenshot second.png\nkey C\n");
  const std::vector<std::string> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 2u) << outcome.out;
  EXPECT_EQ(lines[0], "whit render tiny.json -o tiny.png");
  EXPECT_EQ(lines[1], "whit render tiny.json -o tiny.png --camera=side");
  paste(lines[0]);
  expectSameCodes("first.png", "tiny.png");
  paste(lines[1]);
  expectSameCodes("second.png", "tiny.png");
}

TEST_F(Viewer, ParallelRaysComeBackFromThePrintedCommand) {
  const cli::Outcome outcome =
      play("key H\nkey D 0.3\nwait 3 frames\nwait sharp\nscreenshot shown.png\nkey C\nkey F12\n",
           {"--size", "240x160", "--ortho", "3"});
  const std::vector<std::string> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 1u) << outcome.out;
  EXPECT_NE(lines[0].find("--ortho=3"), std::string::npos) << lines[0];
  render(lines[0], "again.png");
  expectSameCodes("shown.png", "again.png");
  EXPECT_EQ(readCamera(folder_ / "tiny-0001.json").orthographicHeight, 3);
}

// No option gives a lens, so the camera that has it is named.
TEST_F(Viewer, ALensComesBackFromThePrintedCommand) {
  const cli::Outcome outcome =
      play("key H\nkey D 0.3\nwait 3 frames\nwait sharp\nscreenshot shown.png\nkey C\nkey F12\n",
           {"--size", "240x160", "--spp", "4", "--camera", "side", "--set",
            "/cameras/side/aperture=0.3"});
  const std::vector<std::string> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 1u) << outcome.out;
  EXPECT_NE(lines[0].find("--camera=side"), std::string::npos) << lines[0];
  EXPECT_NE(lines[0].find("--eye="), std::string::npos) << lines[0];
  render(lines[0], "again.png");
  expectSameCodes("shown.png", "again.png");
  EXPECT_EQ(readCamera(folder_ / "tiny-0001.json").aperture, 0.3f);
}

TEST_F(Viewer, SavesThePictureAndItsCamera) {
  const cli::Outcome outcome =
      play("key A 0.2\nwait 3 frames\nwait sharp\nkey F12\nkey F12\nkey C\n");
  const std::vector<std::string> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 1u) << outcome.out;
  render(lines[0], "again.png");
  render(lines[0], "again.exr");
  expectSameCodes("tiny-0001.png", "again.png");
  EXPECT_EQ(cli::readFile(folder_ / "tiny-0001.exr"), cli::readFile(folder_ / "tiny-0002.exr"));
  Warnings warnings;
  const Image saved = readImage(folder_ / "tiny-0001.exr", ImageLimits(), warnings);
  const Image again = readImage(folder_ / "again.exr", ImageLimits(), warnings);
  ASSERT_EQ(saved.pixels.size(), again.pixels.size());
  EXPECT_EQ(
      std::memcmp(saved.pixels.data(), again.pixels.data(), saved.pixels.size() * sizeof(Rgb)), 0);
  const Camera camera = readCamera(folder_ / "tiny-0001.json");
  EXPECT_EQ(camera.fov, 40);
  EXPECT_LT(camera.eye.x, 0);  // it flew to the left
}

TEST_F(Viewer, KeysChooseCameras) {
  const cli::Outcome outcome = play(
      "key 2\nwait 3 frames\nwait sharp\nkey C\nkey F5\nkey S 0.3\nwait 3 frames\nwait sharp\n"
      "key C\nkey F9\nwait 3 frames\nwait sharp\nkey C\n");
  const std::vector<std::string> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 3u) << outcome.out;
  EXPECT_NE(lines[0].find(" --camera=side"), std::string::npos) << lines[0];
  EXPECT_EQ(lines[0].find("--eye"), std::string::npos) << lines[0];
  EXPECT_NE(lines[1], lines[0]);
  EXPECT_EQ(lines[2], lines[0]);
}

TEST_F(Viewer, ThePanelCoversThePicture) {
  play("wait sharp\nscreenshot with.png\nkey H\nwait 2 frames\nscreenshot without.png\n",
       {"--size", "400x300"});
  EXPECT_NE(codes("with.png").codes, codes("without.png").codes);
}

TEST(Letterbox, AnotherWindowKeepsThePicturesShape) {
  using Shares = std::array<double, 2>;
  EXPECT_EQ(sharesFilled({100, 100}, {100, 100}), (Shares{1, 1}));
  EXPECT_EQ(sharesFilled({100, 100}, {400, 400}), (Shares{1, 1}));
  EXPECT_EQ(sharesFilled({100, 100}, {400, 100}), (Shares{0.25, 1}));
  EXPECT_EQ(sharesFilled({400, 100}, {100, 100}), (Shares{1, 0.25}));
}

TEST_F(Viewer, ErrorsEndAScript) {
  std::ofstream(folder_ / "script.txt") << "key F9\n";  // nothing was saved
  const cli::Outcome outcome = view({"--script", "script.txt"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("tiny-camera.json"), std::string::npos) << outcome.err;
  std::ofstream(folder_ / "script.txt") << "wait\n";
  EXPECT_EQ(view({"--script", "script.txt"}).status, 3);
}

TEST(ViewerAlone, SaysThatThereIsNoDisplay) {
  const cli::TemporaryFolder folder;
  const cli::Outcome outcome =
      runOn("", folder.path().string(), {WHIT_VIEW_PROGRAM, "whitted", "--quiet"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("no display"), std::string::npos) << outcome.err;
}

TEST(ViewerAlone, RefusesWhatItCannotShow) {
  const cli::TemporaryFolder folder;
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--crop", "0,0,1,1"}, {"--mode", "reference"}, {"--rate", "5"}}) {
    std::vector<std::string> all{WHIT_VIEW_PROGRAM, "whitted"};
    all.insert(all.end(), words.begin(), words.end());
    EXPECT_EQ(runOn("", folder.path().string(), all).status, 2) << words[0];
  }
}

TEST(ViewFiles, CamerasComeBackBitForBit) {
  const cli::TemporaryFolder folder;
  Camera camera;
  camera.eye = {0.1f, -1e-20f, 3.3333333e7f};
  camera.at = {1.0f / 3, 2, -0.0f};
  camera.up = {0.7f, 0.1f, 0};
  camera.fov = 33.3f;
  camera.aperture = 0.07f;
  camera.focus = 1.9f;
  writeCamera(folder / "camera.json", camera);
  const Camera read = readCamera(folder / "camera.json");
  EXPECT_EQ(read.eye, camera.eye);
  EXPECT_EQ(read.at, camera.at);
  EXPECT_EQ(read.up, camera.up);
  EXPECT_EQ(read.fov, camera.fov);
  EXPECT_TRUE(sameView(read, camera));
}

TEST(ViewFiles, BadCamerasSayWhere) {
  const cli::TemporaryFolder folder;
  const auto errorOf = [&](const std::string& text) {
    std::ofstream(folder / "camera.json") << text;
    try {
      readCamera(folder / "camera.json");
    } catch (const Error& error) {
      return std::string(error.what()).substr(folder.path().string().size() + 1);
    }
    return std::string("no error");
  };
  EXPECT_EQ(errorOf("[]"), "camera.json#: expected an object, found a list of 0");
  EXPECT_EQ(errorOf(R"({"eye": [0, 0]})"), "camera.json#: expected a member \"at\"");
  EXPECT_EQ(errorOf(R"({"eye": [0, 0], "at": [0, 0, 0]})"),
            "camera.json#/eye: expected three numbers [x, y, z], found a list of 2");
  EXPECT_EQ(errorOf(R"({"eye": [0, 0, 1], "at": [0, 0, 1]})"),
            "camera.json#: expected eye and at to differ, found an object of 2");
  EXPECT_EQ(errorOf(R"({"eye": [0, 0, 1], "at": [0, 0, 0], "fov": 0})"),
            "camera.json#/fov: expected a number from 0.001 to 179.9, found 0");
}

}  // namespace
}  // namespace whit::view
