// Scripts: their syntax, and the input they make.
#include <gtest/gtest.h>

#include "core/error.h"
#include "script.h"

namespace whit::view {
namespace {

std::string errorOf(const std::string& text) {
  try {
    parseScript(text, "walk.txt");
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::badScene);
    return error.what();
  }
  return "no error";
}

// Returns the number of frames until the script quits, at most 1000.
int framesOf(const std::string& text, bool sharp = true) {
  ScriptPlayer player(parseScript(text, "walk.txt"));
  for (int frame = 0; frame < 1000; ++frame) {
    Input input;
    if (player.next(sharp, input).quit) return frame;
  }
  return 1000;
}

TEST(Script, ErrorsNameTheLine) {
  EXPECT_EQ(errorOf("quit\n\n# all is well\nkey Lft\n"),
            "walk.txt:4: expected key NAME [SECONDS], got 'key Lft'");
  EXPECT_EQ(errorOf("wait 3"),
            "walk.txt:1: expected wait sharp or wait N frames|seconds, got 'wait 3'");
  EXPECT_EQ(errorOf("jump"), "walk.txt:1: there is no command 'jump'");

  for (const std::string line :
       {"mouse wheel 1 2", "wheel x", "wheel 1e9", "wheel nan", "screenshot a.jpg", "click 3",
        "panel ray", "drop", "resize 0 10", "resize 10", "errors hide", "restore now"}) {
    const std::string error = errorOf(line);
    EXPECT_TRUE(error.starts_with("walk.txt:1: expected ")) << error;
  }
}

// A script, and the input and steps of its frames.
class Played {
 public:
  explicit Played(const std::string& script) : player_(parseScript(script, "walk.txt")) {}

  // Plays a frame.
  ScriptStep next() {
    input = Input();
    return player_.next(true, input);
  }
  void expectPointer(double x, double y, bool down) {
    next();
    ASSERT_TRUE(input.pointer);
    EXPECT_EQ(input.pointer->x, x);
    EXPECT_EQ(input.pointer->y, y);
    EXPECT_EQ(input.pointer->down, down);
  }

  Input input;  // of the last frame

 private:
  ScriptPlayer player_;
};

TEST(Script, ClicksAndDragsOnThePanel) {
  Played played("click 10 20 30 40");
  played.expectPointer(10, 20, false);
  played.expectPointer(10, 20, true);
  played.expectPointer(30, 40, true);
  played.expectPointer(30, 40, false);
  EXPECT_TRUE(played.next().quit);
}

TEST(Script, KeysAreHeldForTheirTime) {
  Played played("key W 0.5\nkey F12");
  for (int frame = 0; frame <= 30; ++frame) {  // half a second, and the other key
    played.next();
    EXPECT_EQ(played.input.isHeld("W"), frame < 30);
    EXPECT_EQ(played.input.pressed.size(), frame % 30 == 0 ? 1u : 0u);
  }
}

TEST(Script, MouseAndWheel) {
  Played played("mouse left 3 -4\nmouse right 5 6\nmouse middle 7 8\nwheel -2");
  const std::array<double, 7> all{3, -4, 5, 6, 7, 8, -2};
  for (std::size_t frame = 0; frame < 4; ++frame) {
    played.next();
    const Input& in = played.input;
    const std::array found{in.left.x,   in.left.y,   in.right.x, in.right.y,
                           in.middle.x, in.middle.y, in.wheel};
    // Each command fills its own numbers, and no others.
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(found[i], i / 2 == frame ? all[i] : 0);
  }
}

TEST(Script, WaitsAndQuits) {
  EXPECT_EQ(framesOf(""), 0);
  EXPECT_EQ(framesOf("wait 7 frames"), 7);
  EXPECT_EQ(framesOf("wait 2 seconds"), 120);
  EXPECT_EQ(framesOf("wait 2 frames\nquit\nwait 9 frames"), 2);
  EXPECT_EQ(framesOf("wait sharp", true), 1);
  EXPECT_EQ(framesOf("wait sharp", false), 1000);  // for as long as it takes
}

}  // namespace
}  // namespace whit::view
