// How the time of a point and its interval follow from the samples, and when a time counts as
// noisy.
#include "accuracy/timing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace whit::accuracy {
namespace {

TEST(MedianInterval, ByHand) {
  const auto expect = [](const std::vector<double>& values, double low, double high) {
    const Interval interval = medianInterval(values);
    EXPECT_EQ(interval.low, low);
    EXPECT_EQ(interval.high, high);
  };
  expect({}, 0, 0);
  expect({7}, 7, 7);
  expect({3, 1, 2}, 1, 3);
  expect({5, 4, 3, 2, 1}, 1, 5);  // the range holds the median with a probability of 1 - 2/32

  // One value at either end is left out once 2 (1 + n) / 2^n is at most a tenth. It is 16/128 for 7
  // values and 18/256 for 8.
  expect({1, 2, 3, 4, 5, 6, 7}, 1, 7);
  expect({1, 2, 3, 4, 5, 6, 7, 8}, 2, 7);
}

// For 10,000 values the bounds lie 1.645 standard deviations from the middle, and the standard
// deviation of the binomial distribution is 50.
TEST(MedianInterval, OfVeryManyValuesIsNarrow) {
  std::vector<double> values(10000);
  std::iota(values.begin(), values.end(), 1.0);
  const Interval interval = medianInterval(values);
  EXPECT_NEAR(interval.low, 5000 - 1.645 * 50, 1.5);
  EXPECT_NEAR(interval.high, 5001 + 1.645 * 50, 1.5);
}

// The interval holds the median of the distribution, however skewed that is, as often as is
// promised.
TEST(MedianInterval, HoldsTheMedianAsOftenAsItSays) {
  constexpr int kTrials = 4000;
  // Three standard deviations of a share of 0.9 in so many trials.
  const double slack = 3 * std::sqrt(0.9 * 0.1 / kTrials);

  std::mt19937 random(5);
  std::lognormal_distribution<double> skewed(0, 1);  // its median is 1

  for (const int values : {5, 6, 8, 13, 25}) {
    int held = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<double> sample(static_cast<std::size_t>(values));
      for (double& value : sample) value = skewed(random);
      const Interval interval = medianInterval(sample);
      held += interval.low <= 1 && interval.high >= 1;
    }
    EXPECT_GE(static_cast<double>(held) / kTrials, kMedianConfidence - slack) << values;
  }
}

// The interval of five rounds is their range: 3 % above and below the median, and a little more.
TEST(TimeSamples, AreNoisyIfTheyAreFewOrFarApart) {
  struct Row {
    std::vector<double> ratios;
    bool isFirstFrame, hasSpread, noisy;
  };
  for (const Row& row :
       {Row{{1.2}, true, false, true}, Row{{1, 1, 1}, false, true, true},
        Row{{1, 1, 1, 1, 1}, false, true, false}, Row{{1.94, 2, 2, 2, 2.05}, false, true, false},
        Row{{1.94, 2, 2, 2, 2.08}, false, true, true}}) {
    const Timing timing = TimeSamples{{}, row.ratios, row.isFirstFrame}.timing();
    EXPECT_EQ(timing.hasSpread(), row.hasSpread) << row.ratios.back();
    EXPECT_EQ(timing.noisy(), row.noisy) << row.ratios.back();
  }

  const Timing first = TimeSamples{{12}, {1.2}, true}.timing();
  EXPECT_EQ(first.rounds, 0);
  EXPECT_EQ(first.ratio, 1.2);
  EXPECT_NEAR((TimeSamples{{}, {1.94, 2, 2, 2, 2.06}, false}).timing().spreadPct(), 3, 1e-9);
}

}  // namespace
}  // namespace whit::accuracy
