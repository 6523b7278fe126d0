// Values between keys against closed forms. glTF 2.0 specification, appendix C.
#include "scene/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/index.h"
#include "pi.h"

namespace whit {
namespace {

using Values = std::vector<double>;

// Rounding of about ten operations on doubles of about 1.
constexpr double kTrackRounding = 1e-14;

Track trackOf(Track::Interpolation interpolation, Values times, Values values,
              std::size_t components = 1) {
  return {interpolation, false, components, std::move(times), std::move(values)};
}

Values turn(double degrees, double side = 1) {  // about z
  const double half = degrees * kPi / 360;
  return {0, 0, side * std::sin(half), side * std::cos(half)};
}

Track turning(const Values& from, const Values& to) {
  Track track = trackOf(Track::Interpolation::linear, {0, 1}, from, 4);
  track.values.insert(track.values.end(), to.begin(), to.end());
  track.rotation = true;
  return track;
}

void expectValues(const Values& a, const Values& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto i : indices(a)) EXPECT_NEAR(a[i], b[i], kTrackRounding) << i;
}

TEST(Tracks, StandStillBeforeAndBehindTheirKeys) {
  for (const auto how : {Track::Interpolation::step, Track::Interpolation::linear}) {
    const Track track = trackOf(how, {1, 2}, {3, 4, 5, 6}, 2);
    for (const double t : {-1, 1}) EXPECT_EQ(valueAt(track, t), (Values{3, 4}));
    for (const double t : {2, 9}) EXPECT_EQ(valueAt(track, t), (Values{5, 6}));
  }
  EXPECT_EQ(valueAt(trackOf(Track::Interpolation::linear, {7}, {1}), 3), Values{1});
}

// Most of these keys are a little later in single precision than the frames they are meant for.
TEST(Tracks, StepsOfAFileAreNoFrameLate) {
  Values times, values;
  for (int frame = 0; frame < 48; ++frame) {
    times.push_back(double{static_cast<float>(frame / 24.0)});
    values.push_back(frame);
  }

  const Track track = trackOf(Track::Interpolation::step, times, values);
  for (int frame = 1; frame < 48; ++frame) {
    EXPECT_EQ(valueAt(track, frame / 24.0), Values(1, frame));
    EXPECT_EQ(valueAt(track, (frame - 0.001) / 24), Values(1, frame - 1));
  }
}

TEST(Tracks, LinearIsAStraightLineBetweenUnevenKeys) {
  const Track track = trackOf(Track::Interpolation::linear, {0, 1, 5}, {0, 2, 10});
  for (const double t : {0.0, 0.3, 1.0, 1.7, 4.9, 5.0}) expectValues(valueAt(track, t), {2 * t});
}

// Hermite splines reproduce polynomials of degree three.
TEST(Tracks, CubicSplinesFollowACubic) {
  const auto x = [](double t) { return 2 * t * t * t - 5 * t * t + t - 3; };
  const auto slope = [](double t) { return 6 * t * t - 10 * t + 1; };

  Track track = trackOf(Track::Interpolation::cubic, {0, 0.5, 2}, {});
  for (const double t : track.times) {
    for (const double value : {slope(t), x(t), slope(t)}) track.values.push_back(value);
  }

  for (double t = 0; t <= 2; t += 0.0625) expectValues(valueAt(track, t), {x(t)});
  EXPECT_EQ(valueAt(track, 3), Values{x(2)});
}

TEST(Tracks, TheTangentBehindAKeyMayDifferFromThatBefore) {
  const Track track = trackOf(Track::Interpolation::cubic, {0, 1}, {100, 0, 1, 1, 1, 100});
  for (double t = 0; t <= 1; t += 0.125) expectValues(valueAt(track, t), {t});
}

TEST(Tracks, RotationsTurnEvenly) {
  for (const double t : {0.0, 0.25, 0.5, 0.9, 1.0}) {
    for (const double by : {120.0, 1e-7, 0.0}) {
      expectValues(valueAt(turning(turn(10), turn(10 + by)), t), turn(10 + by * t));
    }
  }
}

// q and -q are the same rotation: the path from 0 to 90 degrees never takes 270.
TEST(Tracks, RotationsTakeTheShorterWay) {
  expectValues(valueAt(turning(turn(0), turn(90, -1)), 0.5), turn(45));
}

TEST(Tracks, RotationsAreNormalized) {
  for (const Values& q : {Values{0, 0, 0, 2}, {0, 0, 0, 0}}) {
    expectValues(valueAt(turning(q, q), 0), {0, 0, 0, 1});
  }
}

}  // namespace
}  // namespace whit
