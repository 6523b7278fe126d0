// The tracing thread's debug views are the same as a renderer's that is made for them.
#include <gtest/gtest.h>

#include "render/debug_frame.h"
#include "render_thread_fixture.h"

namespace whit::view {
namespace {

class ViewPieces : public FrameTracerTest, public testing::WithParamInterface<std::size_t> {
 protected:
  ViewPieces() {
    request_.options.size = ImageSize{100, 70};
    request_.view = static_cast<DebugView>(GetParam());
  }

  void expectAsWhole() {
    const TracedFrame frame = traced();
    EXPECT_GT(pieces_, 5);

    test::DebugFrame whole;
    const Film film = filmBy([&](Renderer& renderer, Film& target) {
      whole = test::renderDebugView(renderer, request_.camera, target, request_.view);
    });

    EXPECT_EQ(frame.film.image.pixels, film.image.pixels);
    ASSERT_TRUE(frame.debug);
    ASSERT_EQ(frame.debug->pixels.size(), whole.picture.pixels.size());

    // Times differ from run to run.
    if (request_.view == DebugView::cost) return;
    EXPECT_EQ(frame.film.display.rgba, film.display.rgba);
    EXPECT_EQ(frame.debug->legend(), whole.legend);
    for (std::size_t i = 0; i < whole.picture.pixels.size(); ++i) {
      ASSERT_EQ(frame.debug->textOf(i), whole.picture.textOf(i)) << i;
    }
  }
};

TEST_P(ViewPieces, AreThoseOfAWholePicture) { expectAsWhole(); }

TEST_P(ViewPieces, OfSeveralSamples) {
  request_.spp = 4;
  expectAsWhole();
}

TEST_P(ViewPieces, AreGivenUpInBetween) { expectIsGivenUpInBetween(); }

INSTANTIATE_TEST_SUITE_P(All, ViewPieces, testing::Range<std::size_t>(1, kDebugViewNames.size()),
                         [](const auto& view) { return std::string(kDebugViewNames[view.param]); });

}  // namespace
}  // namespace whit::view
