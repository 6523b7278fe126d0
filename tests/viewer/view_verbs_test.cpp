// The table of verbs: its keys, and the list of keys in viewer/README.md.
#include "viewer/session/verbs.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "cli/run_command.h"
#include "core/option_table.h"

namespace whit::view {
namespace {

TEST(Verbs, AreInTheReadme) {
  std::string expected = "| keys | what they do |\n|---|---|\n";
  for (const Verb& verb : verbs()) {
    if (verb.keys.empty()) continue;
    expected += "| " + std::string(verb.keys) + " | " + std::string(verb.help) + " |\n";
  }

  const std::string source = std::getenv("WHIT_SOURCE_DIR");
  EXPECT_TRUE(hasText(cli::readFile(source + "/viewer/README.md"), expected + "\n"));
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
