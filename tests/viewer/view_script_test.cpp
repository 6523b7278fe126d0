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
            "walk.txt:4: there is no key 'Lft'; did you mean 'Left'?");
  EXPECT_EQ(errorOf("wait 3"), "walk.txt:1: expected wait N frames, wait N seconds or wait sharp");
  EXPECT_EQ(errorOf("mouse wheel 1 2"), "walk.txt:1: expected mouse left|right|middle DX DY");
  EXPECT_EQ(errorOf("wheel x"), "walk.txt:1: expected a number of at most 1e6, got 'x'");
  EXPECT_EQ(errorOf("wheel 1e9"), "walk.txt:1: expected a number of at most 1e6, got '1e9'");
  EXPECT_EQ(errorOf("wheel nan"), "walk.txt:1: expected a number of at most 1e6, got 'nan'");
  EXPECT_EQ(errorOf("screenshot a.jpg"), "walk.txt:1: expected screenshot FILE.png");
  EXPECT_EQ(errorOf("jump"),
            "walk.txt:1: expected key, mouse, wheel, wait, screenshot, click, point, panel, drop, "
            "resize, minimize, restore, bare, asked, errors or quit, got 'jump'");
}

TEST(Script, ErrorsOfCommandsToTheWindow) {
  EXPECT_EQ(errorOf("click 3"), "walk.txt:1: expected click X Y [X2 Y2]");
  EXPECT_EQ(errorOf("panel ray"), "walk.txt:1: the panel has no tab 'ray'; did you mean 'rays'?");
  EXPECT_EQ(errorOf("drop"), "walk.txt:1: expected drop FILE");
  EXPECT_EQ(errorOf("resize 0 10"), "walk.txt:1: expected resize W H, from 1 to 16384");
  EXPECT_EQ(errorOf("resize 10"), "walk.txt:1: expected resize W H, from 1 to 16384");
  EXPECT_EQ(errorOf("errors hide"), "walk.txt:1: expected errors show or errors end");
  EXPECT_EQ(errorOf("restore now").substr(0, 30), "walk.txt:1: expected key, mous");
}

TEST(Script, ClicksAndDragsOnThePanel) {
  ScriptPlayer player(parseScript("click 10 20 30 40", "walk.txt"));
  const auto expectPointer = [&](double x, double y, bool down) {
    Input input;
    player.next(true, input);
    ASSERT_TRUE(input.pointer);
    EXPECT_EQ(input.pointer->x, x);
    EXPECT_EQ(input.pointer->y, y);
    EXPECT_EQ(input.pointer->down, down);
  };

  expectPointer(10, 20, false);
  expectPointer(10, 20, true);
  expectPointer(30, 40, true);
  expectPointer(30, 40, false);

  Input input;
  EXPECT_TRUE(player.next(true, input).quit);
}

TEST(Script, CommandsToTheWindowComeOnce) {
  ScriptPlayer player(
      parseScript("resize 320 200\nminimize\nerrors show\ndrop a.json\n", "walk.txt"));

  Input input;
  ScriptStep step = player.next(true, input);
  EXPECT_EQ(step.resize, (ImageSize{320, 200}));
  EXPECT_FALSE(step.minimize || step.showErrors);

  step = player.next(true, input);
  EXPECT_FALSE(step.resize || step.showErrors);
  EXPECT_TRUE(step.minimize);

  step = player.next(true, input);
  EXPECT_FALSE(step.resize || step.minimize);
  EXPECT_EQ(step.showErrors, true);

  step = player.next(true, input);
  EXPECT_FALSE(step.resize || step.minimize || step.showErrors);
  EXPECT_EQ(input.dropped, std::vector<std::string>{"a.json"});
}

TEST(Script, KeysAreHeldForTheirTime) {
  ScriptPlayer player(parseScript("key W 0.5\nkey F12", "walk.txt"));
  for (int frame = 0; frame < 30; ++frame) {  // half a second
    Input input;
    player.next(true, input);
    EXPECT_TRUE(input.isHeld("W"));
    EXPECT_EQ(input.pressed.size(), frame == 0 ? 1u : 0u);
  }

  Input input;
  player.next(true, input);
  EXPECT_FALSE(input.isHeld("W"));
  EXPECT_EQ(input.pressed.size(), 1u);
}

TEST(Script, MouseAndWheel) {
  ScriptPlayer player(
      parseScript("mouse left 3 -4\nmouse right 5 6\nmouse middle 7 8\nwheel -2", "walk.txt"));
  Input input;
  for (int frame = 0; frame < 4; ++frame) player.next(true, input);
  EXPECT_EQ(input.left.x, 3);
  EXPECT_EQ(input.left.y, -4);
  EXPECT_EQ(input.right.x, 5);
  EXPECT_EQ(input.right.y, 6);
  EXPECT_EQ(input.middle.x, 7);
  EXPECT_EQ(input.middle.y, 8);
  EXPECT_EQ(input.wheel, -2);
}

TEST(Script, WaitsAndQuits) {
  EXPECT_EQ(framesOf(""), 0);
  EXPECT_EQ(framesOf("wait 7 frames"), 7);
  EXPECT_EQ(framesOf("wait 2 seconds"), 120);
  EXPECT_EQ(framesOf("wait 2 frames\nquit\nwait 9 frames"), 2);
  EXPECT_EQ(framesOf("wait sharp", true), 1);
  EXPECT_EQ(framesOf("wait sharp", false), 1000);  // for as long as it takes
}

TEST(Script, ThePointerRests) {
  ScriptPlayer player(parseScript("wait 1 frames\npoint 3 4\nwait 1 frames", "walk.txt"));
  Input input;
  player.next(true, input);
  EXPECT_FALSE(input.pointer);

  for (int frame = 0; frame < 2; ++frame) {
    input = Input();
    player.next(true, input);
    ASSERT_TRUE(input.pointer);
    EXPECT_EQ(input.pointer->x, 3);
    EXPECT_EQ(input.pointer->y, 4);
    EXPECT_FALSE(input.pointer->down);
  }
}

TEST(Script, ControlIsForCommands) {
  ScriptPlayer player(parseScript("key Ctrl+S", "walk.txt"));
  Input input;
  player.next(true, input);
  EXPECT_EQ(input.pressed, std::vector<std::string>{"Ctrl+S"});
  EXPECT_TRUE(input.held.empty());
}

TEST(Script, ScreenshotsOnce) {
  ScriptPlayer player(parseScript("screenshot a.png # the hall\nwait 1 frames", "walk.txt"));
  Input input;
  EXPECT_EQ(player.next(true, input).screenshot, "a.png");
  EXPECT_EQ(player.next(true, input).screenshot, "");
}

}  // namespace
}  // namespace whit::view
