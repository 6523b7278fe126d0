// The rays of a pixel that is clicked on are those of the picture, are drawn where it shows what
// they hit, and leave no trace where they are not wanted.
#include <gtest/gtest.h>

#include "render_thread_fixture.h"
#include "viewer/panel.h"
#include "viewer_fixture.h"

namespace whit::view {
namespace {

using RayPicking = RenderThreadTest;

RayQuery queryFor(const FrameRequest& request, int x, int y) {
  RayQuery query;
  query.picture.camera = request.camera;
  query.picture.options = request.options;
  query.x = x;
  query.y = y;
  return query;
}

TEST_F(RayPicking, TheRaysAreThoseOfThePicture) {
  RenderThread thread(opened_, common_, [] {});
  request_.options.size = {48, 32};
  const TracedFrame frame = traced(thread);
  for (const auto& [x, y] : {std::pair{24, 14}, {20, 25}, {3, 30}}) {
    thread.query(queryFor(request_, x, y));
    ASSERT_TRUE(waitFor(thread));
    const auto pick = thread.takePick();
    ASSERT_TRUE(pick) << thread.takeError();
    EXPECT_EQ(pick->rays.packets.pixel, frame.film.image.at(x, y)) << x << "," << y;
    EXPECT_EQ(pick->words.size(), pick->rays.packets.nodes.size());
    // The pixels in row 14 show the ball, the others the floor.
    EXPECT_EQ(pick->words[0].hit.rfind(y == 14 ? "mirror, " : "floor, ", 0), 0u)
        << pick->words[0].hit;
    EXPECT_FALSE(thread.takePick());
  }
  expectRightPicture(thread);
}

TEST_F(RayPicking, WhatWasMetIsSelected) {
  RenderThread thread(opened_, common_, [] {});
  request_.options.size = {48, 32};
  const auto selected = [&](int x, int y) {
    thread.query(queryFor(request_, x, y));
    EXPECT_TRUE(waitFor(thread));
    return select(thread.takePick().value());
  };

  // The ball and the lamp that lights it are selected, and the sky selects nothing.
  const Selection sphere = selected(24, 14), nothing = selected(0, 0);
  ASSERT_LT(sphere.material, scene_->scene.materials.size());
  EXPECT_EQ(scene_->scene.materials[sphere.material].name, "mirror");
  EXPECT_EQ(sphere.light, 0u);
  EXPECT_EQ(nothing.material, kNoCounterpart);
  EXPECT_EQ(nothing.light, kNoCounterpart);
}

// A query of rays neither ends the picture that is being traced nor changes it, and the picture
// does not change the rays.
TEST_F(RayPicking, PicturesUnderWayGoOn) {
  RenderThread thread(opened_, common_, [] {});
  request_.options.size = {48, 32};
  const TracedFrame small = traced(thread);
  const RayQuery query = queryFor(request_, 24, 14);

  request_.options.size = {480, 320};
  request_.spp = 64;
  request_.interruptible = true;
  // The query comes while a large picture is being traced.
  thread.ask(request_);
  thread.query(query);
  ASSERT_TRUE(waitFor(thread));

  TracedFrame frame;
  ASSERT_TRUE(thread.take(frame)) << "the question has ended it";
  const Film film = expected();
  EXPECT_EQ(frame.film.display.rgba, film.display.rgba);

  const auto pick = thread.takePick();
  ASSERT_TRUE(pick);
  EXPECT_EQ(pick->rays.packets.pixel, small.film.image.at(24, 14));
}

TEST_F(RayPicking, LinesEndWhereThePictureShowsWhatTheyMeet) {
  RenderThread thread(opened_, common_, [] {});
  request_.options.size = {48, 32};
  thread.query(queryFor(request_, 24, 14));
  ASSERT_TRUE(waitFor(thread));
  const auto pick = thread.takePick();
  ASSERT_TRUE(pick);

  constexpr double kRounding = 1e-3;  // pixels
  const LineView view(request_.camera, 48, 32);
  const RayNode& primary = pick->rays.packets.nodes[0];
  // The primary ray ends in the middle of its pixel.
  const auto seen = view.see(primary.position, primary.position + Vec3d{0, 0, 1e-9});
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->x1, 24.5, kRounding);
  EXPECT_NEAR(seen->y1, 14.5, kRounding);

  // Points behind the camera are not visible.
  const Vec3d eye(request_.camera.eye), back = eye - Vec3d(request_.camera.at);
  EXPECT_FALSE(view.see(eye + back, eye + back * 2));

  // The second view, from aside, shows all points that were hit.
  const LineView aside(pick->aside, 48, 32);
  for (const RayNode& n : pick->rays.packets.nodes) {
    if (n.triangle == kMiss) continue;
    const auto at = aside.see(n.position, n.position);
    ASSERT_TRUE(at);
    EXPECT_TRUE(at->x1 > 0 && at->x1 < 48 && at->y1 > 0 && at->y1 < 32);
  }
}

TEST_F(Viewer, AClickDrawsTheRaysIntoTheScene) {
  play(
      "bare\nasked\nwait sharp\nscreenshot plain.png\nclick 120 70\nwait 2 frames\nbare\nwait 2 "
      "frames\nwait "
      "sharp\n"
      "screenshot rays.png\nkey T\nwait 2 frames\nscreenshot hidden.png\nkey T\n"
      "mouse right 60 0\nwait 20 frames\nwait sharp\nscreenshot aside.png\nkey T\nwait 2 frames\n"
      "screenshot plain-aside.png\n",
      {"--size", "240x160"});

  EXPECT_NE(codes("rays.png").codes, codes("plain.png").codes);
  // The key T hides the rays.
  expectSameCodes("hidden.png", "plain.png");
  EXPECT_NE(codes("aside.png").codes, codes("plain-aside.png").codes);
}

TEST_F(Viewer, AClickTurnsThePanelToTheRays) {
  play(
      "asked\nwait sharp\npanel time\nwait 2 frames\nclick 560 300\nwait 2 frames\nwait sharp\n"
      "wait 250 frames\nscreenshot rays.png\n",
      {"--size", "800x480"});
  play("asked\nwait sharp\npanel time\nwait 2 frames\nwait 250 frames\nscreenshot time.png\n",
       {"--size", "800x480"});
  EXPECT_NE(codes("rays.png").codes, codes("time.png").codes);
}

}  // namespace
}  // namespace whit::view
