// The views of the scalar reference and of the difference from it.
#include <gtest/gtest.h>

#include "has_text.h"
#include "inspect/reference_frame.h"
#include "render_thread_fixture.h"
#include "viewer_fixture.h"

namespace whit::view {
namespace {

// Counts the reports of the reference.
class ReportCount : public Progress {
 public:
  void report(const std::string& /*phase*/, double /*fraction*/) override { ++reports; }
  std::atomic<int> reports = 0;
};

class ReferenceViews : public FrameTracerTest {
 protected:
  ReferenceViews() { calls_.progress = &count_; }

  TracedFrame traced(FrameTracer& tracer, DebugView view) {
    request_.view = view;
    return FrameTracerTest::traced(tracer);
  }
  TracedFrame traced(DebugView view) {
    FrameTracer tracer(opened_, common_);
    return traced(tracer, view);
  }

  // Returns the picture by the scalar reference.
  Film reference() const {
    return filmBy(
        [&](Renderer& renderer, Film& film) { renderReference(renderer, request_.camera, film); });
  }

  ReportCount count_;
};

TEST_F(ReferenceViews, TheReferenceIsThatOfTheCommand) {
  const TracedFrame frame = traced(DebugView::reference);
  expectSameFilm(frame.film, reference());
  EXPECT_NE(frame.film.image.pixels, expected().image.pixels) << "the packets round as doubles do";
  EXPECT_EQ(frame.options.mode, Mode::reference);
  ASSERT_TRUE(frame.debug);
  EXPECT_EQ(frame.debug->textOf(0).find("0 codes off the reference, "), 0u);
}

TEST_F(ReferenceViews, TheDifferenceIsThatOfPacketsAndReference) {
  const TracedFrame frame = traced(DebugView::difference);

  // The largest difference of each pixel, in codes.
  const Film packets = expected(), film = reference();
  int largest = 0, sum = 0;
  for (std::size_t i = 0; i < film.image.pixels.size(); ++i) {
    int codes = 0;
    for (std::size_t at = 4 * i; at < 4 * i + 3; ++at) {
      codes = std::max(codes, std::abs(packets.display.rgba[at] - film.display.rgba[at]));
    }
    largest = std::max(largest, codes);
    sum += codes;
  }

  EXPECT_EQ(frame.film.image.pixels, packets.image.pixels);
  EXPECT_EQ(frame.options.mode, Mode::packets);
  ASSERT_TRUE(frame.debug);
  EXPECT_EQ(frame.debug->largest, largest);
  EXPECT_DOUBLE_EQ(frame.debug->mean, sum / static_cast<double>(film.image.pixels.size()));
}

TEST_F(ReferenceViews, TheOtherViewNeedsNoSecondReference) {
  FrameTracer tracer(opened_, common_);
  traced(tracer, DebugView::reference);
  const int reports = count_.reports;
  EXPECT_GT(reports, 0);

  traced(tracer, DebugView::difference);
  EXPECT_EQ(count_.reports, reports);

  request_.camera = scene_->scene.cameras[1];
  traced(tracer, DebugView::difference);
  EXPECT_GT(count_.reports, reports);
}

// Rows are reported one by one; a transparent background needs all of them a second time.
TEST_F(ReferenceViews, AStopEndsTheReferenceWithinSomeRows) {
  const int rows = request_.options.size->height;
  for (const int last : {5, rows + 5}) {
    setOption(request_.options, "background", last > rows ? "transparent" : "sky");
    count_.reports = 0;
    calls_.superseded = calls_.stopped = [&] { return count_.reports >= last; };

    FrameTracer tracer(opened_, common_);
    TracedFrame frame;
    request_.view = DebugView::difference;
    EXPECT_FALSE(tracer.trace(request_, frame, calls_));
    EXPECT_GE(count_.reports, last);
    EXPECT_LT(count_.reports, last + rows / 2);
  }
}

TEST_F(ReferenceViews, AReferenceGivesWayToAMovement) {
  RenderThread thread = begin();
  FrameRequest large = request_;
  large.view = DebugView::difference;
  large.options.size = {800, 800};
  ASSERT_TRUE(thread.ask(large));
  while (thread.progress().empty() && thread.busy()) std::this_thread::yield();
  EXPECT_FALSE(thread.committed());

  request_.interruptible = false;
  EXPECT_TRUE(samePicture(RenderThreadTest::traced(thread).request, request_));
  EXPECT_EQ(thread.progress(), "");
}

// The picture is moved while its reference is traced, and comes to rest again. It is so small that
// it has all pixels and samples in motion, where it is not the reference yet.
TEST_F(Viewer, TheReferenceHasTheBitsOfItsCommand) {
  const Words lines =
      commandsOf(3,
                 "bare\nkey D 0.3\nwait 10 frames\nmouse left 20 5\nwait 3 frames\nwait sharp\n"
                 "screenshot reference.png\nkey C\nkey F12\nkey V\nwait 3 frames\nwait sharp\n"
                 "screenshot difference.png\nkey C\n",
                 "240x160", {"--view", "reference"});
  EXPECT_TRUE(hasText(lines[0], " --mode=reference"));
  EXPECT_EQ(lines[1], lines[0]);
  EXPECT_FALSE(hasText(lines[2], " --mode"));
  expectThatItShows("reference.png", lines[0]);
  expectOtherCodes("difference.png", "reference.png");

  // The saved files are those of the command as well.
  expectSameCodes("tiny-reference-0001.png", "reference.png");
  render(lines[0], "again.exr");
  EXPECT_EQ(imageIn("tiny-reference-0001.exr").pixels, imageIn("again.exr").pixels);
}

}  // namespace
}  // namespace whit::view
