// The catalogue of hard cases: situations in which ray tracers go wrong. Each case has a
// construction, a measure of the error and a bound that the error must keep. whit-verify runs the
// cases on a user's machine and prints a table of them, tests/hard runs them as tests. Numbers that
// have no case here are tested elsewhere; tests/hard/accounted.h says where.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/vec3.h"

namespace whit::verify {

// The kernels of one run, with the names of --simd and --packet; packet 0 is "auto".
struct Setup {
  std::string simd = "auto";
  int packet = 0;
};

// The setups that a case runs with: the default one, every SIMD target (each with its Embree ISA),
// or every target with packets of 1, 4, 8 and 16.
enum class Runs : std::uint8_t { once, targets, packets };

inline constexpr double kNoBound = std::numeric_limits<double>::infinity();
inline constexpr float kInf = std::numeric_limits<float>::infinity();
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// An input as text. Numbers with a fraction are hexadecimal, so that they can be pasted into C++.
inline std::string textOf(std::string_view text) { return std::string(text); }
std::string textOf(double value);
template <std::integral Number>
std::string textOf(Number number) {
  return std::to_string(number);
}
template <typename Number>
std::string textOf(const Vec3<Number>& v) {
  return textOf(double(v.x)) + " " + textOf(double(v.y)) + " " + textOf(double(v.z));
}

// The worst error of a run, and its input.
class Finding {
 public:
  // Sets the largest worst value that holds: 0 for a case that counts failures, which is the
  // default; kNoBound for one that is only reported.
  void boundBy(double bound) { bound_ = bound; }

  // Adds an error. `input` is what textOf() makes a text of, only where it is needed. NaN is worse
  // than any number.
  template <typename... Input>
  void note(double error, const Input&... input) {
    ++seen_;
    const double e = std::isnan(error) ? kNoBound : error;
    if (e <= worst_ && !input_.empty()) return;

    worst_ = std::max(e, worst_);
    input_ = (textOf(input) + ...);
  }
  // Counts failures instead of errors; keeps the input of the first failure.
  template <typename... Input>
  void count(bool failed, const Input&... input) {
    ++seen_;
    if (!failed) return;
    if (worst_ == 0) input_ = (textOf(input) + ...);
    worst_ += 1;
  }
  double worst() const { return worst_; }
  double bound() const { return bound_; }
  std::uint64_t seen() const { return seen_; }  // number of inputs tried
  const std::string& input() const { return input_; }
  // A case that has tried no input does not hold.
  bool holds() const { return seen_ > 0 && worst_ <= bound_; }

 private:
  double worst_ = 0, bound_ = 0;
  std::uint64_t seen_ = 0;
  std::string input_;
};

// A run of a case: its kernels, and what it finds.
struct Run : Setup, Finding {
  explicit Run(const Setup& setup) : Setup(setup) {}
};

struct Case {
  std::string_view name;          // "H13", with a letter behind it where a number has several
  std::string_view title;         // what must hold
  std::string_view construction;  // how the input is made and what it is held against
  void (*run)(Run& run) = nullptr;
  Runs runs = Runs::packets;

  int number() const { return std::atoi(name.data() + 1); }
};

// The cases of a file.
struct Family {
  std::string_view name;
  std::vector<Case> cases;
};
extern const Family kLeavingSurfaceCases, kThinPlaceCases, kWatertightnessCases, kOddDirectionCases,
    kDegenerateGeometryCases, kRandomSceneCases, kShadingNormalCases, kRefractionCases,
    kNestedDielectricCases, kRangeCases, kInvarianceCases, kRecursionCases, kLightAndFilmCases,
    kCoplanarFaceCases, kSphereCases, kSpherePathCases;

// All families in the order of the table.
const std::vector<Family>& families();

// The setups of this machine and build; at least one.
std::vector<Setup> setupsOf(Runs runs);

// Runs a case once, and sets the SIMD target back to "auto".
Finding runCase(const Case& c, const Setup& setup);

}  // namespace whit::verify
