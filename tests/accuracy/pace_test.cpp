#include "accuracy/scope.h"

#include <gtest/gtest.h>

#include <vector>

namespace whit::accuracy {
namespace {

class Recorder : public Progress {
 public:
  void report(const std::string&, double fraction) override { fractions.push_back(fraction); }
  std::vector<double> fractions;
};

TEST(Pace, StepsCountByTheirWork) {
  Recorder recorder;
  Pace pace(&recorder, "room");
  pace.plan(10);
  pace.plan(30);
  pace.begin("first", 10);
  pace.report("rows", 0.5);
  pace.end();
  pace.begin("second", 30);
  pace.report("rows", 1);
  EXPECT_EQ(recorder.fractions, (std::vector<double>{0, 0.125, 0.25, 1}));
}

// What comes from a file takes no time: it must not make the rest look quick.
TEST(Pace, WhatIsSkippedDoesNotCount) {
  Recorder recorder;
  Pace pace(&recorder, "room");
  pace.plan(40);
  pace.begin("reference", 30);
  pace.skip();
  pace.begin("point", 10);
  pace.report("", 0.5);
  EXPECT_EQ(recorder.fractions.back(), 0.5);
}

}  // namespace
}  // namespace whit::accuracy
