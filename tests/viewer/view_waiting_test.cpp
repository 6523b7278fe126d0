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
  // Waits for a minute at most.
  static std::unique_ptr<Engine> waitFor(SceneReader& reader) {
    for (int i = 0; i < 60'000; ++i) {
      if (auto scene = reader.take()) return scene;
      if (!reader.busy()) return nullptr;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return nullptr;
  }
};

TEST_F(Reading, HandsOverTheScene) {
  SceneReader reader(common_);
  EXPECT_EQ(reader.text(), "");
  reader.read({name_, {"/lights/0/position/0=-2"}});
  EXPECT_TRUE(reader.busy());
  EXPECT_EQ(reader.text().find("reading " + name_), 0u) << reader.text();

  const std::unique_ptr<Engine> scene = waitFor(reader);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->scene().lights[0].position.x, -2);
  EXPECT_FALSE(reader.busy());
  EXPECT_EQ(reader.text(), "");
}

TEST_F(Reading, ABrokenSceneIsAnError) {
  std::ofstream(name_) << "{ \"whit\": 1, ";
  SceneReader reader(common_);
  reader.read({name_});

  std::string what;
  try {
    waitFor(reader);
  } catch (const std::exception& error) {
    what = error.what();
  }
  EXPECT_TRUE(hasText(what, "tiny.json:1"));
  EXPECT_FALSE(reader.busy());
}

TEST_F(Reading, TheLastChoiceCounts) {
  SceneReader reader(common_);
  reader.read({kSlowScene});
  reader.read({name_});
  const std::unique_ptr<Engine> scene = waitFor(reader);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->opened()->source.name, name_);
  EXPECT_FALSE(waitFor(reader));
}

TEST_F(Reading, IsGivenUp) {
  SceneReader reader(common_);
  reader.read({kSlowScene});
  reader.giveUp();
  EXPECT_FALSE(reader.busy());
  EXPECT_EQ(reader.text(), "");
  EXPECT_FALSE(reader.take());
}

TEST_F(Reading, ASceneThatWasReadIsFreedWhenItIsGivenUp) {
  SceneReader reader(common_);
  reader.read({name_});
  reader.giveUp();

  for (int i = 0; i < 60'000 && reader.holds(); ++i) {
    EXPECT_FALSE(reader.take());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_FALSE(reader.holds());
}

// Returns rows of a picture, from the top or, with a negative number, from the bottom.
std::vector<std::uint8_t> rows(const RawImage& image, int count) {
  const auto size = static_cast<std::ptrdiff_t>(std::abs(count)) * image.width * image.channels;
  const auto first = image.codes.begin(), last = image.codes.end();
  return count < 0 ? std::vector<std::uint8_t>(last - size, last)
                   : std::vector<std::uint8_t>(first, first + size);
}

// The second camera is chosen while another scene is read, and that is given up with Escape.
TEST_F(Viewer, TheOldSceneLivesWhileAnotherOneIsRead) {
  const cli::Outcome outcome =
      play(std::string("asked\nwait sharp\nscreenshot before.png\ndrop ") + kSlowScene +
               "\nwait 5 frames\nkey 2\nwait 100 frames\nscreenshot during.png\nkey Esc\n"
               "wait 10 frames\nwait sharp\nkey C\nwait 300 frames\nscreenshot after.png\n",
           {"--size", "400x300"});

  EXPECT_TRUE(hasText(outcome.out, "render tiny.json"));
  EXPECT_TRUE(hasText(outcome.out, " --camera=side"));
  EXPECT_NE(rows(codes("during.png"), 200), rows(codes("before.png"), 200));
  EXPECT_NE(rows(codes("during.png"), -40), rows(codes("after.png"), -40)) << "no progress";
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
  std::ofstream(folder_ / "slow.obj") << model;

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
  std::ofstream(folder_ / "broken.json") << "{ \"whit\": 1,\n \"lights\": 7 }";
  std::ofstream(folder_ / "script.txt")
      << "errors show\nwait 4 frames\nscreenshot choose.png\ndrop broken.json\nwait 9 frames\n"
         "screenshot error.png\nclick 320 60\nwait 9 frames\nwait sharp\nkey C\n";

  setenv("WHIT_SCENES", shipped.c_str(), 1);
  const cli::Outcome outcome =
      runOn(display_.name(), folder_.path().string(),
            {WHIT_VIEW_SCRIPT_PROGRAM, "--size", "640x480", "--script", "script.txt"});
  unsetenv("WHIT_SCENES");

  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(hasText(outcome.err, "broken.json#/lights"));
  EXPECT_TRUE(hasText(outcome.out, "whit render aa "));
  EXPECT_NE(rows(codes("error.png"), -60), rows(codes("choose.png"), -60));
}

TEST_F(Viewer, ABlackPictureSaysWhy) {
  std::string text = cli::readFile(folder_ / "tiny.json");
  text.replace(text.find("\"lights\""), 8, "\"unused\"");
  text.replace(text.find("\"unused\""), text.find("\"materials\"") - text.find("\"unused\""), "");
  std::ofstream(folder_ / "tiny.json") << text;
  play("asked\nkey Shift\nwait 300 frames\nwait sharp\nscreenshot dark.png\n",
       {"--size", "640x120"});

  const RawImage dark = codes("dark.png");
  EXPECT_EQ(rows(dark, 60), std::vector<std::uint8_t>(rows(dark, 60).size(), 0));
  EXPECT_NE(rows(dark, -40), std::vector<std::uint8_t>(rows(dark, -40).size(), 0));
}

// F12 waits for all samples, of which a picture in motion has one.
TEST_F(Viewer, EscapeEndsTheWaitForThePicture) {
  play("asked\nkey D 0.3\nkey F12\nkey Esc\nwait 3 frames\nwait sharp\nscreenshot shown.png\n",
       {"--size", "400x300", "--spp", "64"});
  EXPECT_TRUE(std::filesystem::exists(folder_ / "shown.png")) << "Escape has ended the viewer";
  EXPECT_FALSE(std::filesystem::exists(folder_ / "tiny-0001.png"));
}

// Another scene never completes the picture that was to be saved.
TEST_F(Viewer, AnotherSceneEndsTheWaitForThePicture) {
  std::filesystem::copy(folder_ / "tiny.json", folder_ / "other.json");
  play("asked\nkey D 0.3\nkey F12\ndrop other.json\nwait 60 frames\nwait sharp\nkey C\n",
       {"--size", "400x300", "--spp", "64"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "tiny-0001.png"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "other-0001.png"));
}

}  // namespace
}  // namespace whit::view
