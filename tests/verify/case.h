// The catalogue of hard cases: situations in which ray tracers go wrong. Each case has a
// construction, a measure of the error and a bound that the error must keep. whit-verify runs the
// cases on a user's machine and prints a table of them, tests/hard runs them as tests. Numbers that
// have no case here are tested elsewhere; tests/hard/accounted.h says where.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
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

// The worst error of a run, and its input.
class Finding {
 public:
  // `bound` is the largest worst value that holds; kNoBound for a case that is only reported.
  explicit Finding(double bound) : bound_(bound) {}

  // Adds an error; `describe()` returns its input as text with hex floats. NaN is worse than any
  // number.
  template <typename Describe>
  void note(double error, const Describe& describe) {
    ++seen_;
    const double e = std::isnan(error) ? kNoBound : error;
    if (e <= worst_ && !input_.empty()) return;

    worst_ = std::max(e, worst_);
    input_ = describe();
  }
  // Counts failures instead of errors; keeps the input of the first failure.
  template <typename Describe>
  void count(bool failed, const Describe& describe) {
    ++seen_;
    if (!failed) return;
    if (worst_ == 0) input_ = describe();
    worst_ += 1;
  }
  // Adds the failures of another finding.
  void merge(const Finding& other);

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

struct Case {
  std::string_view name;          // "H13", with a letter behind it where a number has several
  std::string_view title;         // what must hold
  std::string_view construction;  // how the input is made and what it is held against
  Runs runs = Runs::packets;
  Finding (*run)(const Setup& setup) = nullptr;

  int number() const;
};

// One family per file.
std::span<const Case> leavingSurfaceCases();
std::span<const Case> thinPlaceCases();
std::span<const Case> watertightnessCases();
std::span<const Case> oddDirectionCases();
std::span<const Case> degenerateGeometryCases();
std::span<const Case> randomSceneCases();
std::span<const Case> shadingNormalCases();
std::span<const Case> refractionCases();
std::span<const Case> nestedDielectricCases();
std::span<const Case> rangeCases();
std::span<const Case> invarianceCases();
std::span<const Case> recursionCases();
std::span<const Case> lightAndFilmCases();
std::span<const Case> coplanarFaceCases();
std::span<const Case> sphereCases();
std::span<const Case> spherePathCases();

struct Family {
  std::string_view name;
  std::span<const Case> cases;
};
std::vector<Family> families();

// The setups of this machine and build; at least one.
std::vector<Setup> setupsOf(Runs runs);

// Runs a case once, and sets the SIMD target back to "auto".
Finding runCase(const Case& c, const Setup& setup);

// Numbers as text that can be pasted into C++.
std::string hexText(double value);
std::string hexText(const Vec3f& v);
std::string hexText(const Vec3f& origin, const Vec3f& direction);

}  // namespace whit::verify
