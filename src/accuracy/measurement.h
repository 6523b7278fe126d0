// The results of a sweep, point by point. The table, the CSV file and the report follow from them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "inspect/knobs.h"
#include "inspect/metrics.h"
#include "render/renderer.h"

namespace whit::accuracy {

inline constexpr const char* kCauseNames[] = {"arithmetic", "algorithm", "sampling", "transport"};

// True for options with the light that Whitted's model leaves out, which is indirect light.
inline bool hasTransport(const RenderOptions& options) { return options.indirect > 0; }
// The number of paths of such light in a pixel: samples of the pixel times samples of a surfel.
inline double transportPaths(const RenderOptions& options) {
  return options.spp * options.indirect;
}

enum class PointKind { baseline, knob, preset, joint };
inline constexpr const char* kPointKindNames[] = {"baseline", "knob", "preset", "joint"};

// A round compares frames of the point with the baseline's frames before and after. The spread of
// times is known from this many rounds on; a point with fewer lies on no front.
inline constexpr int kLeastRounds = 3;
// A time is noisy until it is known within this many per cent, from this many rounds.
inline constexpr double kNoisyPct = 3;
inline constexpr int kConfidentRounds = 5;

struct Timing {
  int frames = 0;       // without those that warm up
  double medianMs = 0;  // as measured
  double leastMs = 0;
  int rounds = 0;
  double ratio = 1;                    // median of the rounds' ratios to the baseline
  double ratioLow = 1, ratioHigh = 1;  // see medianInterval()
  double steadyMs = 0;  // ratio times the baseline's median: drift of the machine cancels

  bool hasSpread() const { return rounds >= kLeastRounds; }
  double spreadPct() const { return ratio > 0 ? 50 * (ratioHigh - ratioLow) / ratio : 0; }
  bool noisy() const { return rounds < kConfidentRounds || spreadPct() > kNoisyPct; }
};

// The difference of packets from the scalar reference with the same options and samples.
struct ArithmeticError {
  ImageDifference samePath;       // pixels whose path diverged count as equal
  std::uint64_t divergences = 0;  // pixels
  double divergencesPerMpx = 0;
  // |packets - reference| in ulps of the pixel's largest channel, over pixels of the same path.
  double medianUlp = 0, ulp999 = 0, worstUlp = 0;  // ulp999: 99.9 % are at most that far off
};

// The truth that all points are measured against: the scalar reference of Whitted's model, or the
// picture with all transport.
enum class Truth { model, transport };
inline constexpr const char* kTruthNames[] = {"model", "transport"};

// Errors of a point. Points with the same picture share all of them.
struct PointErrors {
  ImageDifference total;  // against the truth
  // The pipeline without approximations against its limit for many samples, which is the reference,
  // or the picture with all transport if the point has all transport.
  ImageDifference sampling;
  ImageDifference algorithm;  // against the same pipeline without approximations
  // The limit for many samples against the truth, if the truth has all transport.
  std::optional<ImageDifference> transport;
  // Against the exact scalar reference with equal samples, if the point has the baseline's samples.
  std::optional<ImageDifference> sameSamples;
  std::optional<ArithmeticError> arithmetic;
};

struct Point : PointErrors {
  PointKind kind = PointKind::knob;
  std::string knob, value;  // "depth", "4"; of a joint point: "", "spp=4 depth=2"
  std::optional<Cause> cause;
  RenderOptions options;
  bool minor = false;  // a quick sweep measures it last

  Timing timing;
  FrameStats stats;                 // rays by kind of the last frame
  bool onFront = false;             // on the Pareto front of `total` over time
  bool onFrontSameSamples = false;  // on the front of `sameSamples` over time
  // PNG files: the displayed image, its difference from the truth and from the exact picture with
  // equal samples. They are empty if the picture is the baseline's, and for combinations off the
  // front.
  std::string imagePng, totalMapPng, sameSamplesMapPng;

  // "depth=4", "standard"
  std::string label() const { return kind == PointKind::knob ? knob + "=" + value : value; }
};

// A knob or a point that was not measured.
struct IdleKnob {
  std::string name, because;
};

// The picture with all transport, without its pixels.
struct TransportFacts {
  int passes = 0, samples = 0;
  double standardError = 0, meanRadiance = 0;  // see PassMean
  double noiseFlip = 0;                        // mean FLIP between the even passes and the odd ones
  double renderMs = 0;
};

struct SceneSweep {
  std::string scene;
  int width = 0, height = 0;
  Machine machine;
  int referenceSamples = 0;
  float referenceCutoff = 0;
  double referenceMs = 0;
  std::vector<Point> points;       // the baseline first, then in the order of the table of options
  std::vector<std::string> order;  // labels in the order in which they were measured
  std::vector<IdleKnob> idle;
  std::string truthPng;
  std::optional<TransportFacts> transport;  // set if it is the truth
  Truth truth() const { return transport ? Truth::transport : Truth::model; }
};

}  // namespace whit::accuracy
