// What tests expect of the commands that they run: success, or a refusal with its reason.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "has_text.h"
#include "run_program.h"

namespace whit::cli {

using Words = std::vector<std::string>;

inline Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// Runs a command that must succeed, and returns what it said.
inline Outcome succeed(
    const Words& words, const std::function<void()>& prepare = [] {}) {
  const Outcome outcome = runWhit(words, prepare);
  EXPECT_EQ(outcome.status, 0) << testing::PrintToString(words) << outcome.err;
  return outcome;
}

// Expects that a command has ended with this status and with a message that says this.
inline void expectFailed(const Outcome& outcome, int status, const std::string& said) {
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("whit: ")) << outcome.err;
  EXPECT_TRUE(hasText(outcome.err, said));
}

// Runs a command that must fail with this status, say this, and print nothing else.
inline void expectFailure(const Words& words, int status, const std::string& said) {
  SCOPED_TRACE(testing::PrintToString(words));
  const Outcome outcome = runWhit(words);
  expectFailed(outcome, status, said);
  EXPECT_EQ(outcome.out, "");
}

// Gives each test a folder of its own with the tiny scene in it.
class TinySceneTest : public testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::string tiny_ = writeTinyScene(folder_);
};

}  // namespace whit::cli
