// The rays of a pixel that is clicked on are those of the picture, are drawn where it shows what
// they hit, and leave no trace where they are not wanted.
#include <gtest/gtest.h>

#include "render_thread_fixture.h"
#include "viewer/panel.h"
#include "viewer_fixture.h"

namespace whit::view {
namespace {

class RayPicking : public RenderThreadTest {
 protected:
  RayPicking() { request_.options.size = {48, 32}; }

  RayQuery queryFor(int x, int y) const {
    RayQuery query;
    query.picture.camera = request_.camera;
    query.picture.options = request_.options;
    query.x = x;
    query.y = y;
    return query;
  }
  RayPick picked(RenderThread& thread, int x, int y) const {
    thread.query(queryFor(x, y));
    EXPECT_TRUE(waitFor(thread));
    const auto pick = thread.takePick();
    EXPECT_FALSE(thread.takePick());
    return pick.value();
  }
};

TEST_F(RayPicking, TheRaysAreThoseOfThePicture) {
  RenderThread thread = begin();
  const TracedFrame frame = traced(thread);
  for (const auto& [x, y] : {std::pair{24, 14}, {20, 25}, {3, 30}}) {
    const RayPick pick = picked(thread, x, y);
    EXPECT_EQ(pick.rays.packets.pixel, frame.film.image.at(x, y)) << x << "," << y;
    EXPECT_EQ(pick.words.size(), pick.rays.packets.nodes.size());
    // The pixels in row 14 show the ball, the others the floor.
    EXPECT_TRUE(pick.words[0].hit.starts_with(y == 14 ? "mirror, " : "floor, "))
        << pick.words[0].hit;
  }
  expectRightPicture(thread);
}

TEST_F(RayPicking, WhatWasMetIsSelected) {
  RenderThread thread = begin();
  // The ball and the lamp that lights it are selected, and the sky selects nothing.
  const Selection sphere = select(picked(thread, 24, 14)), nothing = select(picked(thread, 0, 0));
  ASSERT_LT(sphere.material, scene_->scene.materials.size());
  EXPECT_EQ(scene_->scene.materials[sphere.material].name, "mirror");
  EXPECT_EQ(sphere.light, 0u);
  EXPECT_EQ(nothing.material, kNoCounterpart);
  EXPECT_EQ(nothing.light, kNoCounterpart);
}

// A query of rays neither ends the picture that is being traced nor changes it, and the picture
// does not change the rays.
TEST_F(RayPicking, PicturesUnderWayGoOn) {
  RenderThread thread = begin();
  const TracedFrame small = traced(thread);
  const RayQuery query = queryFor(24, 14);

  // The query comes while a large picture is being traced.
  request_.options.size = {480, 320};
  request_.spp = 64;
  request_.interruptible = true;
  thread.ask(request_);
  thread.query(query);
  expectSameFilm(taken(thread).film, expected());

  const auto pick = thread.takePick();
  ASSERT_TRUE(pick);
  EXPECT_EQ(pick->rays.packets.pixel, small.film.image.at(24, 14));
}

TEST_F(RayPicking, LinesEndWhereThePictureShowsWhatTheyMeet) {
  RenderThread thread = begin();
  const RayPick pick = picked(thread, 24, 14);

  constexpr double kRounding = 1e-3;  // pixels
  const LineView view(request_.camera, 48, 32);
  const RayNode& primary = pick.rays.packets.nodes[0];
  // The primary ray ends in the middle of its pixel.
  const auto seen = view.see(primary.position, primary.position + Vec3d{0, 0, 1e-9});
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->x1, 24.5, kRounding);
  EXPECT_NEAR(seen->y1, 14.5, kRounding);

  // Points behind the camera are not visible.
  const Vec3d eye(request_.camera.eye), back = eye - Vec3d(request_.camera.at);
  EXPECT_FALSE(view.see(eye + back, eye + back * 2));

  // The second view, from aside, shows all points that were hit.
  const LineView aside(pick.aside, 48, 32);
  for (const RayNode& n : pick.rays.packets.nodes) {
    if (n.triangle == kMiss) continue;
    const auto at = aside.see(n.position, n.position);
    ASSERT_TRUE(at);
    EXPECT_TRUE(at->x1 > 0 && at->x1 < 48 && at->y1 > 0 && at->y1 < 32);
  }
}

TEST_F(Viewer, AClickDrawsTheRaysIntoTheScene) {
  play(
      "bare\nasked\nwait sharp\nscreenshot plain.png\nclick 120 70\nwait 2 frames\nbare\n"
      "wait 2 frames\nwait sharp\n"
      "screenshot rays.png\nkey T\nwait 2 frames\nscreenshot hidden.png\nkey T\n"
      "mouse right 60 0\nwait 20 frames\nwait sharp\nscreenshot aside.png\nkey T\nwait 2 frames\n"
      "screenshot plain-aside.png\n",
      "240x160");
  expectOtherCodes("rays.png", "plain.png");
  // The key T hides the rays.
  expectSameCodes("hidden.png", "plain.png");
  expectOtherCodes("aside.png", "plain-aside.png");
}

TEST_F(Viewer, AClickTurnsThePanelToTheRays) {
  const std::string begin = "asked\nwait sharp\npanel time\nwait 2 frames\n";
  play(begin + "click 560 300\nwait 2 frames\nwait sharp\nwait 250 frames\nscreenshot rays.png\n",
       "800x480");
  play(begin + "wait 250 frames\nscreenshot time.png\n", "800x480");
  expectOtherCodes("rays.png", "time.png");
}

}  // namespace
}  // namespace whit::view
