// What the viewer shows while it reads, where it has no scene or no light, and what ends waiting.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "has_text.h"
#include "render_thread_fixture.h"
#include "sanitized.h"
#include "viewer/session/scene_reader.h"
#include "viewer_fixture.h"

namespace whit::view {
namespace {

// Takes some seconds to read, so that a test can act meanwhile.
constexpr char kSlowScene[] = "landscape?triangles=2000000";

class Reading : public RenderThreadTest {
 protected:
  // Returns the scene that was read; null: reading was given up.
  static std::unique_ptr<Engine> readBy(SceneReader& reader) {
    std::unique_ptr<Engine> scene;
    waitUntil([&] {
      scene = reader.take();
      return scene || !reader.busy();
    });
    return scene;
  }

  SceneReader reader_{common_};
};

TEST_F(Reading, HandsOverTheScene) {
  EXPECT_EQ(reader_.text(), "");
  reader_.read({name_, {"/lights/0/position/0=-2"}});
  EXPECT_TRUE(reader_.busy());
  EXPECT_TRUE(reader_.text().starts_with("reading " + name_)) << reader_.text();

  const std::unique_ptr<Engine> scene = readBy(reader_);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->scene().lights[0].position.x, -2);
  EXPECT_FALSE(reader_.busy());
  EXPECT_EQ(reader_.text(), "");
}

TEST_F(Reading, ABrokenSceneIsAnError) {
  save("tiny.json", "{ \"whit\": 1, ");
  reader_.read({name_});
  try {
    readBy(reader_);
    ADD_FAILURE() << "it was read";
  } catch (const std::exception& error) {
    EXPECT_TRUE(hasText(error.what(), "tiny.json:1"));
  }
  EXPECT_FALSE(reader_.busy());
}

TEST_F(Reading, TheLastChoiceCounts) {
  reader_.read({kSlowScene});
  reader_.read({name_});
  const std::unique_ptr<Engine> scene = readBy(reader_);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->opened()->source.name, name_);
  EXPECT_FALSE(readBy(reader_));
}

TEST_F(Reading, ASceneThatWasReadIsFreedWhenItIsGivenUp) {
  reader_.read({name_});
  reader_.giveUp();
  EXPECT_FALSE(reader_.busy());
  EXPECT_EQ(reader_.text(), "");
  EXPECT_TRUE(waitUntil([&] {
    EXPECT_FALSE(reader_.take());
    return !reader_.holds();
  }));
}

// The second camera is chosen while another scene is read, and that is given up with Escape.
TEST_F(Viewer, TheOldSceneLivesWhileAnotherOneIsRead) {
  const Words lines =
      commandsOf(1,
                 std::string("asked\nwait sharp\nscreenshot before.png\ndrop ") + kSlowScene +
                     "\nwait 5 frames\nkey 2\nwait 100 frames\nscreenshot during.png\nkey Esc\n"
                     "wait 10 frames\nwait sharp\nkey C\nwait 300 frames\nscreenshot after.png\n",
                 "400x300");
  EXPECT_TRUE(hasText(lines[0], "render tiny.json"));
  EXPECT_TRUE(hasText(lines[0], " --camera=side"));

  EXPECT_FALSE(sameIn("during.png", "before.png", {0, 0, 400, 200}));
  EXPECT_FALSE(sameIn("during.png", "after.png", {0, 260, 400, 300})) << "no progress";
}

// Returns the processor time of all programs that this one has run so far.
double programSeconds() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

// Dropping the repetitions of a triangle takes long, and is not interrupted.
TEST_F(Viewer, QuitsWhileASceneIsRead) {
  constexpr int kRepetitions = kSanitized ? 60'000 : 300'000;
  std::string model = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < kRepetitions; ++i) model += "f 1 2 3\n";
  save("slow.obj", model);

  const double before = programSeconds();
  render("whit render slow.obj --size 16x16", "slow.png");
  const double rendered = programSeconds();
  play("asked\nwait sharp\ndrop slow.obj\nwait 20 frames\nkey Esc\nwait 2 frames\n");
  const double viewed = programSeconds();

  // Without waiting for the reader, little more is used than the viewer needs to start.
  constexpr double kMostOfTheReading = 0.5;
  EXPECT_LT(viewed - rendered, kMostOfTheReading * (rendered - before));
}

// Broken and missing files are said in the window, which goes on to ask for a scene.
TEST_F(Viewer, WithoutASceneItOffersSome) {
  const std::string shipped = folder_ / "shipped";
  std::filesystem::create_directory(shipped);
  std::filesystem::copy(folder_ / "tiny.json", shipped + "/aa.json");
  save("broken.json", "{ \"whit\": 1,\n \"lights\": 7 }");

  scene_.clear();
  setenv("WHIT_SCENES", shipped.c_str(), 1);
  const cli::Outcome outcome = play(
      "errors show\nwait 4 frames\nscreenshot choose.png\ndrop broken.json\nwait 9 frames\n"
      "screenshot error.png\nclick 320 60\nwait 9 frames\nwait sharp\nkey C\n"
      "drop missing.json\nwait 30 frames\nwait sharp\n",
      "640x480");
  unsetenv("WHIT_SCENES");

  EXPECT_TRUE(hasText(outcome.err, "broken.json#/lights"));
  EXPECT_TRUE(hasText(outcome.err, "missing.json"));
  EXPECT_TRUE(hasText(outcome.out, "whit render aa "));
  EXPECT_FALSE(sameIn("error.png", "choose.png", {0, 420, 640, 480}));
}

TEST_F(Viewer, ABlackPictureSaysWhy) {
  Json scene = jsonIn("tiny.json");
  scene.erase("lights");
  save("tiny.json", scene.dump());
  play("asked\nkey Shift\nwait 300 frames\nwait sharp\nscreenshot dark.png\n", "640x120");

  // Only words at the bottom are seen.
  const std::vector<Rgb> dark = imageIn("dark.png").pixels;
  const auto words = std::ranges::find_if(dark, [](const Rgb& color) { return color != Rgb(); });
  EXPECT_NE(words, dark.end());
  EXPECT_GE(words - dark.begin(), 640 * 60);
}

// F12 waits for all samples, of which a picture in motion has one.
TEST_F(Viewer, EscapeEndsTheWaitForThePicture) {
  play("asked\nkey D 0.3\nkey F12\nkey Esc\nwait 3 frames\nwait sharp\nscreenshot shown.png\n",
       "400x300", {"--spp", "64"});
  EXPECT_TRUE(exists("shown.png")) << "Escape has ended the viewer";
  EXPECT_FALSE(exists("tiny-0001.png"));
}

// Another scene never completes the picture that was to be saved.
TEST_F(Viewer, AnotherSceneEndsTheWaitForThePicture) {
  std::filesystem::copy(folder_ / "tiny.json", folder_ / "other.json");
  play("asked\nkey D 0.3\nkey F12\ndrop other.json\nwait sharp\nkey C\n", "400x300",
       {"--spp", "64"});
  EXPECT_FALSE(exists("tiny-0001.png"));
  EXPECT_FALSE(exists("other-0001.png"));
}

}  // namespace
}  // namespace whit::view
