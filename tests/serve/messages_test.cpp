// The lines that the page sends: which are read, and which are refused.
#include "viewer/session/verbs.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace whit::view {
namespace {

TEST(Messages, AreRead) {
  const auto messages = readMessages("left 3 -4.5\nset depth 2\nanimation walk and run\nfit");
  ASSERT_EQ(messages.size(), 4u);
  EXPECT_EQ(messages[0].verb->name, "left");
  EXPECT_EQ(messages[0].numbers[0], 3);
  EXPECT_EQ(messages[0].numbers[1], -4.5);

  EXPECT_EQ(messages[1].verb->name, "set");
  EXPECT_EQ(messages[1].name, "depth");
  EXPECT_EQ(messages[1].text, "2");
  EXPECT_EQ(messages[2].text, "walk and run");
  EXPECT_EQ(messages[3].verb->name, "fit");
  EXPECT_TRUE(readMessages("").empty());
}

TEST(Messages, WhatIsNotOneIsRefusedWithItsLine) {
  const std::string many(kMessageLines + 1, '\n');
  for (const std::string& body : std::vector<std::string>{
           "left 3", "left 3 x", "left 3 4 5", "left nan 1", "left inf 1", "left 1e6 0", "fit now",
           "size 0 10 1", "no 1", " fit", "set depth\t2", "set depth 2\r", std::string("fit\0", 4),
           "set a " + std::string(kMessageBytes, 'x'), many}) {
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
}  // namespace whit::view
