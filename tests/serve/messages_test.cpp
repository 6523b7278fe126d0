// The lines that the page sends: what is read, and what is refused.
#include "viewer/serve/messages.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace whit::serve {
namespace {

TEST(Messages, AreRead) {
  const auto messages = readMessages("left 3 -4.5\nset depth 2\nanimation walk and run\nfit");
  ASSERT_EQ(messages.size(), 4u);
  EXPECT_EQ(messages[0].act, Act::left);
  EXPECT_EQ(messages[0].numbers[0], 3);
  EXPECT_EQ(messages[0].numbers[1], -4.5);
  EXPECT_EQ(messages[1].act, Act::set);
  EXPECT_EQ(messages[1].name, "depth");
  EXPECT_EQ(messages[1].text, "2");
  EXPECT_EQ(messages[2].text, "walk and run");
  EXPECT_EQ(messages[3].act, Act::fit);
  EXPECT_TRUE(readMessages("").empty());
}

// The acts and their words stand in the same order.
TEST(Messages, EveryVerbIsItsAct) {
  for (std::size_t i = 0; i < kVerbs.size(); ++i) {
    std::string line(kVerbs[i].name);
    if (kVerbs[i].named) line += " name";
    for (std::size_t n = 0; n < kVerbs[i].numbers; ++n) line += " 1";
    if (kVerbs[i].text) line += " text";
    const auto messages = readMessages(line);
    ASSERT_EQ(messages.size(), 1u) << line;
    EXPECT_EQ(messages[0].act, static_cast<Act>(i)) << line;
  }
  EXPECT_EQ(kVerbs[static_cast<std::size_t>(Act::hold)].name, "hold");
  EXPECT_EQ(kVerbs[static_cast<std::size_t>(Act::effect)].name, "effect");
}

TEST(Messages, WhatIsNotOneIsRefusedWithItsLine) {
  const std::string many(kMessageLines + 1, '\n');
  for (const std::string& body :
       {std::string("left 3"), std::string("left 3 x"), std::string("left 3 4 5"),
        std::string("left nan 1"), std::string("left inf 1"), std::string("left 1e6 0"),
        std::string("fit now"), std::string("size 0 10 1"), std::string("no 1"),
        std::string(" fit"), std::string("set depth\t2"), std::string("set depth 2\r"),
        std::string("fit\0", 4), "set a " + std::string(kMessageBytes, 'x'), many}) {
    SCOPED_TRACE(body.substr(0, 40));
    EXPECT_THROW(readMessages(body), Error);
  }
  try {
    readMessages("fit\nleft 3 x");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "line 2 of the input: expected 2 numbers from -100000 to 100000 after 'left'");
  }
}

}  // namespace
}  // namespace whit::serve
