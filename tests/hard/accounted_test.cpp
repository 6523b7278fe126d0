// Every number of the catalogue is tested somewhere; tests/README.md says where.
#include "hard/accounted.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "verify/case.h"

namespace whit::test {
namespace {

constexpr int kHighest = 83;

std::string textOf(const std::string& path) {
  const char* source = std::getenv("WHIT_SOURCE_DIR");
  const std::ifstream file((source ? std::string(source) : std::string(".")) + "/" + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string row(int number, std::string_view title, const std::string& where) {
  return "| H" + std::to_string(number) + " | " + std::string(title) + " | " + where + " |\n";
}

// The table of tests/README.md.
std::string table() {
  std::string text = "| number | what | where |\n|---|---|---|\n";
  for (int number = 1; number <= kHighest; ++number) {
    for (const verify::Family& family : verify::families()) {
      for (const verify::Case& c : family.cases) {
        if (c.number() == number) {
          text += row(number, c.title, "`Hard/CaseTest.Holds/" + std::string(c.name) + "`");
        }
      }
    }
    for (const Accounted& a : kAccounted) {
      if (a.number != number) continue;
      text += row(number, a.title, std::string(a.file) + ", `" + std::string(a.test) + "`");
    }
  }
  return text;
}

TEST(Accounted, EveryNumberIsTested) {
  std::set<int> known;
  for (const Accounted& a : kAccounted) known.insert(a.number);
  for (const verify::Family& family : verify::families()) {
    for (const verify::Case& c : family.cases) known.insert(c.number());
  }
  for (int number = 1; number <= kHighest; ++number) {
    EXPECT_TRUE(known.contains(number)) << "H" << number;
  }
}

TEST(Accounted, NamesAreUnique) {
  std::set<std::string_view> names;
  for (const verify::Family& family : verify::families()) {
    for (const verify::Case& c : family.cases) EXPECT_TRUE(names.insert(c.name).second) << c.name;
  }
}

TEST(Accounted, TestsElsewhereAreThere) {
  for (const Accounted& a : kAccounted) {
    const std::string test(a.test), file = textOf(std::string(a.file));
    const std::size_t dot = test.find('.');
    const std::string wanted = "(" + test.substr(0, dot) + ", " + test.substr(dot + 1) + ")";
    EXPECT_NE(file.find(wanted), std::string::npos) << a.file << " has no " << wanted;
  }
}

TEST(Accounted, TheReadmeHasThisTable) {
  const std::string readme = textOf("tests/README.md"), wanted = table();
  if (readme.find(wanted) != std::string::npos) return;
  const std::string path = testing::TempDir() + "hard_cases_table.md";
  std::ofstream(path) << wanted;
  ADD_FAILURE() << "tests/README.md lacks the table as it is now, which is in " << path;
}

}  // namespace
}  // namespace whit::test
