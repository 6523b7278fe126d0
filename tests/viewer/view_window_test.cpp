// whit-view itself, with a scripted user on a virtual display.
#include <gtest/gtest.h>
#include <imgui.h>

#include "has_text.h"
#include "viewer/panel.h"
#include "viewer/session/view_files.h"
#include "viewer/window.h"
#include "viewer_fixture.h"

namespace whit::view {
namespace {

using namespace std::string_literals;

// A script that prints commands, all of them equal, which render `picture`.
struct Shown {
  const char *name, *script, *size = "240x160";
  std::vector<std::string> options{}, parts{};  // of the viewer's and of the printed command
  std::size_t commands = 1;
  const char* picture = "shown.png";
  const char* begins = "whit render tiny.json -o tiny.png ";
};
void PrintTo(const Shown& shown, std::ostream* out) { *out << shown.name; }

class PrintedCommands : public Viewer, public testing::WithParamInterface<Shown> {};

TEST_P(PrintedCommands, RenderWhatIsShown) {
  const Shown& shown = GetParam();
  const Words lines = commandsOf(shown.commands, shown.script, shown.size, shown.options);
  EXPECT_TRUE(lines[0].starts_with(shown.begins)) << lines[0];
  for (const std::string& part : shown.parts) EXPECT_TRUE(hasText(lines[0], part));
  EXPECT_FALSE(hasText(lines[0], "--eye=0,2,6")) << "it has not moved";
  EXPECT_EQ(lines.back(), lines[0]);
  expectThatItShows(shown.picture, lines[0]);
}

// With parallel rays and a lens.
constexpr char kStepAside[] =
    "bare\nkey D 0.3\nwait 3 frames\nwait sharp\nscreenshot shown.png\nkey C\nkey F12\n";
const Shown kShown[] = {
    {.name = "AfterMoves",
     .script = "bare\nkey W 0.5\nmouse left 40 -25\nmouse right -30 5\nkey ]\nwait 3 frames\n"
               "wait sharp\nscreenshot shown.png\nkey C\n",
     .parts = {"--eye=", "--exposure=0.25"}},
    {.name = "WithParallelRays",
     .script = kStepAside,
     .options = {"--ortho", "3"},
     .parts = {"--ortho=3"},
     .commands = 2},
    // No option gives a lens, so the camera that has it is named.
    {.name = "WithALens",
     .script = kStepAside,
     .options = {"--spp", "4", "--camera", "side", "--set", "/cameras/side/aperture=0.3"},
     .parts = {"--camera=side", "--eye="},
     .commands = 2},
    // Fields of view differ, and the picture is narrower than the aspect of both cameras.
    {.name = "WithAnAspect",
     .script = "bare\nasked\nkey 2\nkey D 0.3\nwait 3 frames\nwait sharp\nscreenshot shown.png\n"
               "key C\n",
     .options = {"--set", "/cameras/front/aspect=3", "--set", "/cameras/side/aspect=3", "--set",
                 "/cameras/side/fov=25"},
     .parts = {"--camera=side", "--eye="}},
    {.name = "WithParallelRaysAndAnAspect",
     .script = "bare\nasked\nwheel 2\nwait 3 frames\nwait sharp\nscreenshot shown.png\nkey C\n",
     .options = {"--set",
                 "/cameras/front={\"eye\":[0,2,6],\"at\":[0,1,0],\"orthographicHeight\":3,"
                 "\"aspect\":3}"},
     .parts = {"--ortho="}},
    // F12 is pressed in motion, where the picture is coarser and has one sample.
    {.name = "SavedInMotion",
     .script = "asked\nkey D 0.3\nkey F12\nwait 3 frames\nwait sharp\nkey C\n",
     .size = "400x300",
     .options = {"--spp", "4", "--light-samples", "4"},
     .parts = {"--size=400x300", "--spp=4", "--light-samples=4"},
     .commands = 2,
     .picture = "tiny-0001.png"},
    // With many samples.
    {.name = "AccumulatedAtRest",
     .script = "bare\nwait sharp\nscreenshot shown.png\nkey C\n",
     .size = "120x80",
     .options = {"--glossy", "1", "--set",
                 "/materials/mirror={\"specular\": 0.8, \"roughness\": 0.4, "
                 "\"glossyReflection\": true}"},
     .parts = {"--spp=256"}},
    // A reload before the dropped scene is there loads the dropped scene.
    {.name = "OfADroppedSceneReadAgain",
     .script = "bare\nasked\nwait sharp\ndrop whitted\nkey R\nwait 60 frames\nwait sharp\n"
               "screenshot shown.png\nkey C\n",
     .size = "48x32",
     .begins = "whit render whitted "},
    {.name = "FullScreenMinimizedAndResized",
     .script = "bare\nkey F11\nwait 5 frames\nkey F11\nwait 5 frames\nminimize\nwait 5 frames\n"
               "restore\nwait 5 frames\nresize 200 100\nwait 10 frames\nwait sharp\n"
               "screenshot shown.png\nkey C\n",
     .size = "48x32",
     .parts = {"--size=200x100"}},
    // The list is at the right; its second entry is clicked on. Dear ImGui 1.90 takes a click of a
    // script only where the pointer has rested.
    {.name = "OfACameraOfTheList",
     .script = "asked\nkey L\nwait 5 frames\npoint 440 61\nwait 20 frames\nclick 440 61\nbare\n"
               "wait 3 frames\nwait sharp\nscreenshot shown.png\nkey C\n",
     .size = "500x300",
     .parts = {"--camera=side"}},
};
INSTANTIATE_TEST_SUITE_P(All, PrintedCommands, testing::ValuesIn(kShown),
                         [](const auto& shown) { return std::string(shown.param.name); });

// The command is pasted into a shell as it is. A camera that has moved is printed in full, and key
// 2 brings back the scene's own one.
TEST_F(Viewer, OnlyWhatDiffersIsPrinted) {
  const Words lines = commandsOf(
      4,
      "bare\nasked\nresize 48 32\nwait 20 frames\nwait sharp\nscreenshot first.png\nkey C\nkey 2\n"
      "wait 20 frames\nwait sharp\nscreenshot second.png\nkey C\nkey S 0.3\nwait 3 frames\n"
      "wait sharp\nkey C\nkey 2\nwait 3 frames\nwait sharp\nkey C\n",
      "");
  EXPECT_EQ(lines[0], "whit render tiny.json -o tiny.png");
  EXPECT_EQ(lines[1], lines[0] + " --camera=side");
  EXPECT_TRUE(hasText(lines[2], "--eye="));
  EXPECT_EQ(lines[3], lines[1]);

  paste(lines[0]);
  expectSameCodes("first.png", "tiny.png");
  paste(lines[1]);
  expectSameCodes("second.png", "tiny.png");
}

// One line at the bottom names the key for help, until a key is pressed; H opens the panel.
TEST_F(Viewer, StartsWithThePictureAndOneLine) {
  play(
      "wait sharp\nwait 300 frames\nscreenshot start.png\nkey Shift\nwait 2 frames\n"
      "screenshot picture.png\nkey P\nwait 4 frames\nscreenshot panel.png\nbare\n"
      "wait 2 frames\nscreenshot bare.png\n",
      "500x300");

  EXPECT_TRUE(sameIn("start.png", "bare.png", {0, 0, 500, 260}));
  EXPECT_FALSE(sameIn("start.png", "bare.png", {0, 260, 500, 300}));
  expectSameCodes("picture.png", "bare.png");
  EXPECT_FALSE(sameIn("panel.png", "bare.png", {10, 10, 400, 200}));
}

// The picture is 480x300 and the screen 800x600.
TEST_F(Viewer, OpensAtTwoThirdsOfTheScreenAndKeepsItsSettings) {
  const auto kept = [&] { return bytesOf("whit/viewer.json"); };
  EXPECT_TRUE(
      hasText(play("wait sharp\nkey C\nkey P\nwait 2 frames\n", "").out, " --size=533x355"));
  EXPECT_TRUE(hasText(kept(), "\"panel\": true"));
  EXPECT_TRUE(hasText(kept(), "/tiny.json\""));

  // The size of the window is kept for the next run.
  play("wait sharp\nresize 300 300\nwait 10 frames\n", "");
  EXPECT_TRUE(hasText(play("wait sharp\nkey C\n", "").out, " --size=300x200"));

  // It is limited to the screen, and kept for a larger one.
  play("wait sharp\nresize 2400 2400\nwait 10 frames\n", "");
  const std::string large = kept();
  EXPECT_TRUE(hasText(large, "2400,\n    2400"));
  EXPECT_TRUE(hasText(play("wait sharp\nkey C\n", "").out, " --size=800x533"));
  EXPECT_EQ(kept(), large);
}

TEST(RecentScenes, AreTheLastTenEachOnce) {
  std::vector<std::string> recent;
  for (const char* scene : {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "g"}) {
    rememberRecent(scene, recent);
  }
  EXPECT_EQ(recent, (std::vector<std::string>{"g", "l", "k", "j", "i", "h", "f", "e", "d", "c"}));
}

// A pixel is clicked on at the left: the panel is at its right. Another one is in the middle, where
// neither side has room: the panel is above.
TEST_F(Viewer, ThePanelLeavesTheClickedPointFree) {
  play(
      "bare\nasked\nwait sharp\nscreenshot bare.png\nclick 60 100\nwait 2 frames\nkey T\n"
      "wait 4 frames\nwait sharp\nscreenshot left.png\nbare\nwait 2 frames\nclick 240 160\n"
      "wait 2 frames\nkey T\nwait 4 frames\nwait sharp\nscreenshot middle.png\n",
      "500x300");

  EXPECT_TRUE(sameIn("left.png", "bare.png", {0, 0, 70, 300}));
  EXPECT_FALSE(sameIn("left.png", "bare.png", {100, 0, 500, 300}));
  EXPECT_TRUE(sameIn("middle.png", "bare.png", {0, 150, 500, 300}));
  EXPECT_FALSE(sameIn("middle.png", "bare.png", {0, 0, 500, 150}));
}

constexpr const char* kBox =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

// The reader fits a supplied camera to the size that it is given, but the window shows the camera
// that fits the scene's own size.
TEST_F(Viewer, AModelIsPrintedAsItIsSeenInAWindowOfAnyShape) {
  save("box.obj", kBox);
  for (const std::string size : {"90 150", "240 150", "300 60"}) {
    const Words lines = commandsOf(1,
                                   "bare\nasked\nresize " + size +
                                       "\ndrop box.obj\nwait sharp\n"
                                       "screenshot shown.png\nkey C\n",
                                   "");
    const bool hasShapeOfScene = size == "240 150";
    EXPECT_EQ(hasText(lines[0], "--eye"), !hasShapeOfScene) << lines[0];
    expectThatItShows("shown.png", lines[0]);
  }
}

// No drag loses a model; F fits it.
TEST_F(Viewer, AModelStaysInThePicture) {
  save("box.obj", kBox);
  play(
      "bare\nasked\ndrop box.obj\nwait sharp\nmouse left 900 -700\nmouse middle 5000 -3000\n"
      "wheel -500\nmouse right 100 4000\nwait 3 frames\nwait sharp\nscreenshot far.png\n"
      "key F\nwait 3 frames\nwait sharp\nscreenshot fit.png\nwheel 3\nmouse middle 30 9\n"
      "wait 3 frames\nwait sharp\nkey F\nbare\nwait 3 frames\nwait sharp\n"
      "screenshot again.png\n",
      "240x160");

  // The number of pixels that differ from the corner, which shows the background.
  const auto covered = [&](const char* file) {
    const std::vector<Rgb> pixels = imageIn(file).pixels;
    return std::ranges::count_if(pixels, [&](const Rgb& color) { return color != pixels[0]; });
  };

  EXPECT_GT(covered("far.png"), 240 * 160 / 1000);
  EXPECT_GT(covered("fit.png"), 240 * 160 / 5);
  expectSameCodes("again.png", "fit.png");
}

// The file, its name and the printed command are those of the view.
TEST_F(Viewer, TheSavedDebugViewIsTheOneShown) {
  const Words lines =
      commandsOf(1, "bare\nasked\nwait 3 frames\nwait sharp\nscreenshot shown.png\nkey F12\n",
                 "240x160", {"--view", "depth"});
  EXPECT_TRUE(lines[0].starts_with("whit-view tiny.json --view=depth ")) << lines[0];
  expectSameCodes("tiny-depth-0001.png", "shown.png");
  EXPECT_FALSE(exists("tiny-depth-0001.exr")) << "that would be the picture";
  EXPECT_NE(bytesOf("tiny-depth-0001.png").find("view\0depth"s), std::string::npos);
}

// The list of cameras and the keys take the place of the panel. Escape closes what is open, and
// then the viewer.
TEST_F(Viewer, EscapeClosesWhatIsOpen) {
  play(
      "asked\nwait 300 frames\nwait sharp\nkey Shift\nwait 5 frames\nscreenshot first.png\n"
      "key P\nwait 5 frames\nscreenshot panel.png\nkey L\nwait 5 frames\nscreenshot list.png\n"
      "key H\nwait 5 frames\nscreenshot keys.png\nkey Esc\nwait 5 frames\n"
      "screenshot closed.png\nkey Esc\nwait 3 frames\nscreenshot never.png\n",
      "500x300");
  expectSameCodes("closed.png", "first.png");
  const std::array shown{"panel.png", "list.png", "keys.png", "closed.png"};
  for (std::size_t i = 0; i < shown.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) expectOtherCodes(shown[i], shown[k]);
  }
  EXPECT_FALSE(exists("never.png"));
}

TEST_F(Viewer, TheListOfCamerasStaysInTheWindow) {
  saveTiny("tiny.json", "side", std::string(100, 'x'));
  play(
      "asked\nbare\nwait sharp\nscreenshot closed.png\nkey L\nwait 5 frames\nwait sharp\n"
      "screenshot open.png\n",
      "300x200");

  constexpr int kBeside = 9;  // pixels, less than the margin of the list
  EXPECT_TRUE(sameIn("open.png", "closed.png", {0, 0, kBeside, 200}));
  EXPECT_FALSE(sameIn("open.png", "closed.png", {kBeside, 0, 30, 200}));
}

// Dear ImGui alone breaks lines after the period.
TEST(PanelText, DoesNotBreakNumbers) {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DisplaySize = ImVec2(300, 200);
  unsigned char* atlas = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsAlpha8(&atlas, &width, &height);

  ImGui::NewFrame();
  ImGui::Begin("panel");
  const auto widthOf = [](const char* text) { return ImGui::CalcTextSize(text).x; };
  ImGui::BeginChild("room", ImVec2(widthOf("add 0.00"), 0));
  drawText("add 0.00054");
  EXPECT_EQ(ImGui::GetItemRectSize().x, widthOf("0.00054"));
  ImGui::EndChild();
  ImGui::End();
  ImGui::EndFrame();
  ImGui::DestroyContext();
}

// The first edit is of the lamp, the second one of its position.
const std::string kTwoEdits =
    "asked\npanel scene\nwait 10 frames\nclick 30 139\nwait 5 frames\nclick 100 208\n"
    "wait 60 frames\nclick 60 160 130 160\nwait 60 frames\nwait sharp\nkey C\n";

TEST_F(Viewer, EditsAreUndoneOneByOne) {
  const Words lines = commandsOf(
      3,
      kTwoEdits +
          "key Ctrl+Z\nwait 60 frames\nwait sharp\nkey C\nkey Ctrl+Z\nkey Ctrl+Z\n"
          "wait 60 frames\nbare\nwait 3 frames\nwait sharp\nscreenshot shown.png\nkey C\n",
      "800x480");
  EXPECT_TRUE(hasText(lines[0], "/lights/0/position="));
  EXPECT_TRUE(hasText(lines[1], "/lights/0/intensity="));
  EXPECT_FALSE(hasText(lines[1], "/lights/0/position="));
  EXPECT_EQ(lines[2], "whit render tiny.json -o tiny.png --size=800x480");
  expectThatItShows("shown.png", lines[2]);
}

TEST_F(Viewer, AsksBeforeEditsAreLost) {
  const std::string escapes = "key Esc\nwait 3 frames\nkey Esc\nwait 3 frames\n";
  play(kTwoEdits + escapes + "screenshot asked.png\nkey Esc\nwait 3 frames\nscreenshot no.png\n",
       "800x480");
  EXPECT_TRUE(exists("asked.png"));
  EXPECT_FALSE(exists("no.png"));

  play(kTwoEdits + "key Ctrl+S\n" + escapes + "screenshot saved.png\n", "800x480");
  EXPECT_FALSE(exists("saved.png"));
}

TEST(Letterbox, AnotherWindowKeepsThePicturesShape) {
  using Shares = std::array<double, 2>;
  EXPECT_EQ(sharesFilled({100, 100}, {100, 100}), (Shares{1, 1}));
  EXPECT_EQ(sharesFilled({100, 100}, {400, 400}), (Shares{1, 1}));
  EXPECT_EQ(sharesFilled({100, 100}, {400, 100}), (Shares{0.25, 1}));
  EXPECT_EQ(sharesFilled({400, 100}, {100, 100}), (Shares{1, 0.25}));
}

TEST_F(Viewer, ErrorsEndAScript) {
  const cli::Outcome outcome = run("drop missing.json\nwait 60 frames\nwait sharp\n");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(hasText(outcome.err, "missing.json"));
  const cli::Outcome unread = run("minimize\n\n# all is well\nkey Lft\n");
  EXPECT_EQ(unread.status, 3);
  EXPECT_TRUE(hasText(unread.err, "script.txt:4: expected key NAME [SECONDS], got 'key Lft'"));

  // A first scene that cannot be read, or lacks the camera, ends it as it ends other commands.
  const std::string goesOn = "errors show\nwait 60 frames\n";
  EXPECT_EQ(run(goesOn, "48x32", {"--camera", "nowhere"}).status, 2);
  save("tiny.json", "{");
  EXPECT_EQ(run(goesOn).status, 3);
}

TEST(ViewerAlone, SaysThatThereIsNoDisplay) {
  const cli::TemporaryFolder folder;
  const cli::Outcome outcome =
      runOn("", folder.path().string(), {WHIT_VIEW_PROGRAM, "whitted", "--quiet"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(hasText(outcome.err, "no display"));
  EXPECT_TRUE(hasText(outcome.err, "whit serve SCENE"));
}

TEST(ViewerAlone, RefusesWhatItCannotShow) {
  const cli::TemporaryFolder folder;
  for (const char* option : {"--crop=0,0,1,1", "--mode=reference", "--rate=5"}) {
    const cli::Outcome outcome =
        runOn("", folder.path().string(), {WHIT_VIEW_PROGRAM, "whitted", option});
    EXPECT_EQ(outcome.status, 2) << option;
    EXPECT_FALSE(hasText(outcome.err, "no display")) << option;
  }
}

}  // namespace
}  // namespace whit::view
