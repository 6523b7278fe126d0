// The tracing thread: its pictures are those of a renderer made for them, whatever came before.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>

#include "render_thread_fixture.h"

namespace whit::view {
namespace {

TEST_F(RenderThreadTest, OptionsChangeBetweenFrames) {
  RenderThread thread = begin();
  expectRightPicture(thread);
  request_.options.disable = request_.options.disable.with(Effect::mirror);
  expectRightPicture(thread);

  request_.options.disable = EffectSet().with(Effect::lights);
  expectRightPicture(thread);

  request_.options.disable = EffectSet();
  request_.options.exposure.ev = 1.5f;
  expectRightPicture(thread);

  request_.spp = 4;
  request_.options.size = {31, 17};
  request_.camera = scene_->scene.cameras[1];
  expectRightPicture(thread);

  // These need another renderer.
  request_.options.robust = false;
  expectRightPicture(thread);
  request_.options.packet = 4;
  request_.options.tile = 8;
  request_.options.batch = Batch::frame;
  expectRightPicture(thread);
  EXPECT_EQ(traced(thread).machine.packet, 4);
}

TEST_F(RenderThreadTest, TheNewestRequestWins) {
  RenderThread thread = begin();
  request_.interruptible = true;
  TracedFrame early;
  for (int i = 1; i <= 50; ++i) {
    request_.options.exposure.ev = static_cast<float>(i) / 8;
    // A picture that is there must be taken before another one can be requested.
    while (!thread.ask(request_)) thread.take(early);
  }
  EXPECT_TRUE(samePicture(taken(thread).request, request_));
  EXPECT_FALSE(thread.take(early));
}

TEST_F(RenderThreadTest, NothingQueuesBehindAPictureInMotion) {
  RenderThread thread = begin();
  request_.options.size = {480, 320};
  request_.spp = 64;
  request_.edits = 1;
  EXPECT_TRUE(thread.ask(request_));
  while (!thread.committed()) std::this_thread::yield();

  // While a picture in motion is traced, the next one has to wait.
  request_.edits = 2;
  EXPECT_FALSE(thread.ask(request_));
  ASSERT_TRUE(waitFor(thread));
  EXPECT_FALSE(thread.ask(request_)) << "the user has not seen the first one";

  TracedFrame frame = taken(thread);
  EXPECT_EQ(frame.request.edits, 1);
  EXPECT_FALSE(thread.take(frame));
  EXPECT_TRUE(thread.ask(request_));
}

TEST_F(RenderThreadTest, PicturesAtRestGiveWay) {
  RenderThread thread = begin();
  FrameRequest large = request_;
  large.options.size = {4000, 4000};
  large.spp = 64;
  large.interruptible = true;
  EXPECT_TRUE(thread.ask(large));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // the picture has begun
  EXPECT_FALSE(thread.committed());

  request_.edits = 2;
  TracedFrame frame = traced(thread);
  EXPECT_EQ(frame.request.edits, 2);
  EXPECT_FALSE(thread.take(frame));
}

// The window's loop as App::step() has it, with keys at any time: a picture with n edits shows the
// first n keys.
TEST_F(RenderThreadTest, AKeyIsShownByTheSecondPictureAtMost) {
  RenderThread thread = begin();

  request_.options.size = {24, 16};
  std::mt19937 random(1);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  std::vector<int> takenAtKey;  // number of pictures that were taken before each key
  int taken = 0, asked = 0, answered = 0, worst = 0;

  for (int turn = 0; turn < 3000; ++turn) {
    TracedFrame frame;
    if (thread.take(frame)) {
      ++taken;
      for (; answered < frame.request.edits; ++answered) {
        worst = std::max(worst, taken - takenAtKey[static_cast<std::size_t>(answered)]);
      }
    }

    if (below(3) == 0) takenAtKey.push_back(taken);
    const int struck = static_cast<int>(takenAtKey.size());
    request_.edits = struck;
    request_.interruptible = struck == asked;
    request_.options.exposure.ev = static_cast<float>(turn);
    if ((struck > asked || below(2) == 0) && thread.ask(request_)) asked = struck;
    if (below(3) == 0) takenAtKey.push_back(taken);
    if (below(2) == 0) std::this_thread::sleep_for(std::chrono::microseconds(below(300)));
  }

  EXPECT_GT(answered, 20) << "hardly any key was answered";
  EXPECT_EQ(worst, 2);
}

TEST_F(RenderThreadTest, KnobsThatThisMachineLacks) {
  RenderThread thread = begin();
  expectRightPicture(thread);

  const RenderOptions good = request_.options;
  request_.options.simd = "none";
  thread.ask(request_);
  ASSERT_TRUE(waitFor(thread));
  EXPECT_NE(thread.takeError(), "");

  request_.options = good;
  expectRightPicture(thread);
}

KnobCost costOf(const std::string& name, const std::vector<KnobCost>& costs) {
  const auto found = std::ranges::find(costs, name, &KnobCost::name);
  EXPECT_NE(found, costs.end()) << name << " was not measured";
  return found == costs.end() ? KnobCost() : *found;
}

TEST_F(RenderThreadTest, MeasuresWhatKnobsCost) {
  RenderThread thread = begin();
  request_.measureKnobs = true;
  request_.options.size = {240, 160};
  const TracedFrame frame = traced(thread);
  EXPECT_EQ(costOf("depth", frame.costs).other, "0");
  // The frames that are measured see what the picture shows.
  EXPECT_GT(costOf("depth", frame.costs).now.of(RayKind::reflection).rays, 0u);
  EXPECT_GT(costOf("shadows", frame.costs).now.of(RayKind::shadow).rays, 0u);
  for (const KnobCost& cost : frame.costs) EXPECT_NE(cost.name, "glossy");  // the scene has none

  request_.measureKnobs = false;
  expectRightPicture(thread);
}

// A frame without impulses lacks the rays of mirrors and the rays that these cause, and no others.
TEST_F(RenderThreadTest, CostsAreThoseOfFramesWithAndWithout) {
  const RenderOptions& options = request_.options;
  Renderer renderer(scene_->scene, options);
  Film film = makeFilm(scene_->scene, options);
  const FrameStats stats = renderer.render(request_.camera, film);

  std::vector<KnobCost> costs;
  EXPECT_TRUE(measureKnobs(renderer, options, request_.camera, film, 1,
                           [&](const std::vector<KnobCost>& sofar, double measured) {
                             EXPECT_EQ(measured == 0, sofar.empty());
                             costs = sofar;
                             return true;
                           }));

  const auto raysOf = [&](const char* name) {
    const KnobCost cost = costOf(name, costs);
    return cost.now.allRays() - cost.then.allRays();
  };

  EXPECT_EQ(raysOf("depth"), raysOf("mirror"));
  EXPECT_GE(raysOf("depth"), stats.of(RayKind::reflection).rays);
  EXPECT_GE(raysOf("shadows"), stats.of(RayKind::shadow).rays);
  for (const KnobCost& cost : costs) EXPECT_EQ(cost.now.allRays(), stats.allRays()) << cost.name;
}

TEST_F(RenderThreadTest, EditsBetweenFrames) {
  RenderThread thread = begin();
  const auto hasMirrors = [](const TracedFrame& frame) {
    return frame.reasons[static_cast<std::size_t>(Effect::mirror)].on;
  };
  const TracedFrame before = traced(thread);
  EXPECT_TRUE(hasMirrors(before));

  SceneEdit edit{scene_, {"/lights/0/position/0=-2"}};
  for (const Material& m : scene_->scene.materials) {
    Material edited = m;
    edited.mirror = edited.mirrorGrazing = {0, 0, 0};
    edited.diffuse = {0.2f, 0.9f, 0.1f};
    addMemberSettings(m, edited, {}, edit.settings);
  }
  thread.edit(edit);
  ++request_.edits;

  const TracedFrame after = traced(thread);
  EXPECT_NE(after.film.display.rgba, before.film.display.rgba);
  EXPECT_FALSE(hasMirrors(after));
  expectRightPicture(thread);  // the picture of a renderer made for the edited scene

  // An edit of a scene that is no longer there is ignored.
  thread.edit({nullptr, {"/lights/0/position/0=2"}});
  ASSERT_TRUE(waitFor(thread));
  EXPECT_EQ(scene_->scene.lights[0].position.x, -2);
}

TEST_F(RenderThreadTest, ReloadsTheScene) {
  RenderThread thread = begin();
  EXPECT_EQ(traced(thread).scene, scene_);

  saveTiny("tiny.json", "\"diffuse\": 0.5", "\"diffuse\": 0.9");

  thread.load(readScene({.name = name_, .options = request_.options}, common_));
  const TracedFrame frame = traced(thread);
  EXPECT_NE(frame.scene, scene_);
  scene_ = frame.scene;
  expectRightPicture(thread);
}

}  // namespace
}  // namespace whit::view
