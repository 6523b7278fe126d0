// The inspector's text about the pixel under the pointer.
#include <gtest/gtest.h>

#include "viewer/overlay.h"
#include "viewer_fixture.h"

namespace whit::view {
namespace {

// A picture of two pixels for a window of 200x100.
class Inspector : public testing::Test {
 protected:
  Inspector() {
    frame_.scene = std::make_shared<OpenScene>(false);
    frame_.request.window = {200, 100};
    frame_.film.image = Image(2, 1);
    frame_.film.image.pixels = {{0.5f, 0.25f, 2}, {0, 0, 0.125f}};
    frame_.film.display = {2, 1, {188, 137, 255, 255, 0, 0, 99, 255}};
  }
  // Returns the text for the right half of the window, which shows the second pixel.
  std::string right() { return inspect(frame_, {200, 100}, {150, 40}); }

  TracedFrame frame_;
};

// A window that was made twice as wide shows the picture in its middle.
TEST_F(Inspector, KnowsWhereThePictureIs) {
  const ImageSize wide{400, 100};
  EXPECT_EQ(inspect(frame_, wide, {200, 40}), "") << "there is no debug view";
  frame_.debug = std::make_shared<const DebugPicture>(DebugPicture{DebugView::depth, 4, {{}, {}}});
  EXPECT_EQ(inspect(frame_, wide, {99, 40}), "");
  EXPECT_EQ(inspect(frame_, wide, {300, 40}), "");
  EXPECT_EQ(inspect(frame_, wide, {100, 40}).substr(0, 11), "pixel 0, 40");
  EXPECT_EQ(inspect(frame_, wide, {299, 40}).substr(0, 13), "pixel 199, 40");
  EXPECT_EQ(inspect(TracedFrame(), wide, {200, 40}), "");
}

TEST_F(Inspector, SaysWhatEachViewShows) {
  WatchedPixel seen;
  seen.sum = {6, 2, 0};
  seen.count = 2;
  const auto expectText = [&](DebugView view, const std::string& text) {
    frame_.request.view = view;
    frame_.debug = std::make_shared<const DebugPicture>(DebugPicture{view, 4, {seen, seen}});
    EXPECT_EQ(right(), "pixel 150, 40\n" + text);
  };

  expectText(DebugView::depth, "distance 3 units");
  seen.sum = {1, 2, 0};
  expectText(DebugView::normals, "normal 0.000 1.000 -1.000");
  expectText(DebugView::albedo, "albedo 0.500 1.000 0.000, linear");
  expectText(DebugView::occupancy, "50.0 % of the lanes live");

  seen = WatchedPixel();
  expectText(DebugView::depth, "nothing is hit");
  expectText(DebugView::normals, "nothing is hit");
  seen.sum = {10, 0, 0};
  expectText(DebugView::rays, "2.5 rays a sample");
  expectText(DebugView::cost, "2.5 microseconds a sample");
}

// The text of a debug view appears beside the pointer and nowhere else, and needs no click.
TEST_F(Viewer, SaysWhatIsUnderThePointer) {
  const std::string script =
      "asked\nwait 250 frames\nwait sharp\nscreenshot before.png\npoint 200 150\n"
      "wait 4 frames\nscreenshot at.png\n";
  play(script, "500x300");
  expectSameCodes("at.png", "before.png");

  play("key V\n" + script, "500x300");
  EXPECT_FALSE(sameIn("before.png", "at.png", {210, 160, 300, 200}));
  // Only pixels in the tooltip's box may differ.
  EXPECT_TRUE(sameIn("before.png", "at.png", {0, 0, 500, 151}));
  EXPECT_TRUE(sameIn("before.png", "at.png", {0, 240, 500, 300}));
  EXPECT_TRUE(sameIn("before.png", "at.png", {0, 0, 201, 300}));
  EXPECT_TRUE(sameIn("before.png", "at.png", {420, 0, 500, 300}));
}

}  // namespace
}  // namespace whit::view
