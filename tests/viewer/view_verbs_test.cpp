// The table of verbs: its keys, and the list of keys in viewer/README.md.
#include "viewer/session/verbs.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "core/option_table.h"
#include "has_text.h"

namespace whit::view {
namespace {

TEST(Verbs, AreInTheReadme) {
  std::string expected = "| keys | what they do |\n|---|---|\n";
  for (const Verb& verb : verbs()) {
    if (verb.keys.empty()) continue;
    expected += "| " + std::string(verb.keys) + " | " + std::string(verb.help) + " |\n";
  }

  const char* const source = std::getenv("WHIT_SOURCE_DIR");
  std::stringstream page;
  page << std::ifstream(std::string(source ? source : ".") + "/viewer/README.md").rdbuf();

  EXPECT_TRUE(hasText(page.str(), expected + "\n")) << expected;
}

TEST(Verbs, HaveKeysOfTheirOwn) {
  EXPECT_EQ(lineOfKey("F"), "fit");
  EXPECT_EQ(lineOfKey("3"), "camera 2");
  EXPECT_EQ(lineOfKey("["), "expose -0.25");
  EXPECT_EQ(lineOfKey("]"), "expose 0.25");
  EXPECT_EQ(lineOfKey("Ctrl+Z"), "undo");
  EXPECT_EQ(lineOfKey("W"), "") << "it is held";
  EXPECT_EQ(lineOfKey(""), "");

  std::set<std::string> known;
  for (const Verb& verb : verbs()) {
    if (verb.numbers.count > 1 || verb.text || verb.keys.empty()) continue;
    for (const std::string& key : split(std::string(verb.keys), ' ')) {
      EXPECT_TRUE(known.insert(key).second) << key;
    }
  }
}

}  // namespace
}  // namespace whit::view
