// The catalogue of hard cases (tests/verify), one test for each case: Hard/CaseTest.Holds/H13.
#include <gtest/gtest.h>

#include "sanitized.h"
#include "verify/case.h"

namespace whit::verify {

// Prints the names that ctest shows.
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

namespace {

std::vector<Case> allCases() {
  std::vector<Case> cases;
  for (const Family& family : families()) {
    cases.insert(cases.end(), family.cases.begin(), family.cases.end());
  }
  return cases;
}

class CaseTest : public testing::TestWithParam<Case> {};

TEST_P(CaseTest, Holds) {
  const Case& c = GetParam();
  const std::vector<verify::Setup> setups = setupsOf(c.runs);

  // A sanitizer sees the same code with fewer setups. Where every target has four widths of
  // packets, each fifth setup has another target and another width.
  const std::size_t sparse = c.runs == Runs::targets ? 3 : 5;
  const std::size_t step = kSanitized ? sparse : 1;

  for (std::size_t i = 0; i < setups.size(); i += step) {
    const verify::Setup& setup = setups[i];
    const Finding finding = runCase(c, setup);
    std::printf("%s, %s, packet %d: worst %.4g, bound %.4g of %llu\n", std::string(c.name).c_str(),
                setup.simd.c_str(), setup.packet, finding.worst(), finding.bound(),
                static_cast<unsigned long long>(finding.seen()));
    EXPECT_TRUE(finding.holds()) << c.title << "\n  " << c.construction << "\n  input "
                                 << finding.input();
  }
}

INSTANTIATE_TEST_SUITE_P(Hard, CaseTest, testing::ValuesIn(allCases()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace whit::verify
