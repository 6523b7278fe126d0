// Asserts that a text contains another one, and shows the text where it does not.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace whit {

// EXPECT_TRUE(hasText(...)) and EXPECT_FALSE(hasText(...)) print both texts if they fail.
inline testing::AssertionResult hasText(const std::string& text, std::string_view part) {
  const bool found = text.find(part) != std::string::npos;
  return (found ? testing::AssertionSuccess() : testing::AssertionFailure())
         << "looked for '" << part << "' in: " << text;
}

}  // namespace whit
