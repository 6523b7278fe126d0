// Every number of the catalogue is tested, by tests/verify or by the tests that accounted.h lists.
#include "hard/accounted.h"

#include <gtest/gtest.h>

#include <set>

#include "source_files.h"
#include "verify/case.h"

namespace whit::test {
namespace {

constexpr int kHighest = 83;

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
    const std::string test(a.test), file = sourceText(std::string(a.file));
    const std::size_t dot = test.find('.');
    const std::string wanted = "(" + test.substr(0, dot) + ", " + test.substr(dot + 1) + ")";
    EXPECT_NE(file.find(wanted), std::string::npos) << a.file << " has no " << wanted;
  }
}

}  // namespace
}  // namespace whit::test
