#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "core/option_table.h"
#include "core/stopwatch.h"
#include "inspect/budget.h"
#include "inspect/knobs.h"
#include "inspect/prober.h"

namespace whit {

namespace {

// The knobs are measured in this order. A small budget ends the measurements early, so the knobs
// that matter most come first.
constexpr std::array kChosenKnobs{"glossy",       "ambient-samples", "light-samples",
                                  "indirect",     "depth",           "cutoff",
                                  "light-cutoff", "texture-filter",  "fresnel"};

// All measurements together take kProbeShare of the budget, but at least kLeastProbeMs and at most
// kMostProbeShare of the budget. Each measurement of the whole picture's time takes kPictureShare
// of that time.
constexpr double kProbeShare = 0.1, kMostProbeShare = 0.2, kLeastProbeMs = 12, kPictureShare = 0.05;
// Time of all measurements for a target; measurements shorter than kShortMs use kFewSpp.
constexpr double kProbeMsOfTarget = 300, kShortMs = 40;
constexpr double kMostBlocks = 1000;
// The expected time is corrected by the measured one in at most this many rounds.
constexpr int kRounds = 3;
// The choice aims at this factor of the time that is left: rounding down to whole samples leaves
// some time unused, and cold caches make the measured times a little too long.
constexpr double kAim = 1.06;
// Samples per pixel of the probes. The truth, which the probes are compared with, has kTruthFactor
// times as many.
constexpr int kFewSpp = 2, kSomeSpp = 4, kTruthFactor = 4;
// Expected time of a probe as a multiple of the baseline's time.
constexpr double kCostOfProbe = 1.5;
// Squares with sides of this many pixels are averaged to tell bias from noise.
constexpr int kPooledSide = 4;
// The choice aims at the target divided by this margin.
constexpr double kTargetMargin = 1.25;
// Bounds on the power of the number of samples by which squared noise falls. Probes with few
// samples measure the power badly. It is smaller for FLIP, which is about the 0.7th power of a
// difference.
constexpr double kLeastPower = 0.6, kMostFlipPower = 0.9, kMostCodesPower = 1.3;
// Squared noise below kLeastNoise of the baseline's is taken for a measuring error. Among many
// combinations, one with lucky measurements would win. Each value that is not the baseline's
// therefore has to gain at least kDoubt over the root of the number of measured blocks.
constexpr double kLeastNoise = 0.02, kDoubt = 0.5;
// Noise that nobody can see; more samples than reach it are of no use.
constexpr double kUnseenFlip = 2e-4, kUnseenCodes = 0.02;
// At most this many samples, times the root of the budget in milliseconds. The time that making the
// sample pattern takes grows with the square of their number (0.15 to 0.3 s for 4096 samples), and
// thus stays about a 25th of the budget.
constexpr double kSppOfRootMs = 50;

// Returns the means of squares of kPooledSide x kPooledSide pixels, or the image itself if it is
// smaller than one square.
Image pooled(const Image& image) {
  if (std::min(image.width, image.height) < kPooledSide) return image;

  Image means(image.width / kPooledSide, image.height / kPooledSide);
  for (int y = 0; y < means.height * kPooledSide; ++y) {
    for (int x = 0; x < means.width * kPooledSide; ++x) {
      means.at(x / kPooledSide, y / kPooledSide) +=
          image.at(x, y) / static_cast<float>(squared(kPooledSide));
    }
  }
  return means;
}

// A value of a knob, with its cost and its error. Cost and noise are relative to the baseline.
struct Level {
  std::string value;
  double cost = 1;    // factor of the time of a sample
  double bias2 = 0;   // squared error that more samples per pixel do not reduce
  double noise2 = 0;  // change of the squared noise of one sample, at most 0
};

// A knob and the values that are measured for it.
struct KnobLevels {
  std::string name, exact, off;  // off: the value without samples; empty if the knob has none
  std::vector<Level> levels;     // the first is the baseline's
  bool endsExact() const { return levels.back().value == exact; }
};

// A picture of the chosen blocks.
struct Probe {
  double sampleUs = 0;  // time of a sample of a pixel
  Image image;
};

struct Combination {
  std::array<std::size_t, kChosenKnobs.size()> levels{};
  int spp = 1;
  double bias = 0;
  CostAndError total;  // cost in milliseconds and error of the picture
};

// Measures the knobs one by one against a baseline, and searches their combinations by the model
// that budget.h explains.
class Chooser {
 public:
  Chooser(Renderer& renderer, const Camera& camera, const std::set<std::string>& fixed,
          const Budget& budget, Film& film)
      : renderer_(renderer),
        fixed_(fixed),
        budget_(budget),
        channels_(renderer.options().channels),
        pictureChannels_(channels_.with(Channel::error)),
        wasAdaptive_(renderer.options().adaptive),
        baseline_(renderer.options()),
        prober_(renderer, camera, film, budget.inCodes) {
    // Probes keep no channels, and take all samples unless --adaptive was given explicitly.
    baseline_.channels = {};
    baseline_.adaptive = baseline_.adaptive && fixed.contains("adaptive");
    // Channel::error would turn adaptive sampling off.
    if (baseline_.adaptive) pictureChannels_ = channels_;
  }

  Receipt choose() {
    for (const char* const name : kChosenKnobs) addKnob(chooseKnobs({name}).front());
    chooseBlocks();
    measure();
    Combination best = search();

    // Costs that were measured one by one may not multiply exactly. The measured time of the best
    // combination corrects the scale, after which another one may be better.
    for (int round = 0; round < kRounds; ++round) {
      scale_ *= prober_.wholePictureMs(optionsOf(best), kPictureShare) / best.total.cost;
      complete(best, leftMs());
      const Combination next = search();
      const bool same = next.levels == best.levels;
      // The last round keeps the combination whose time was measured, if that fits.
      if (same || round + 1 < kRounds || isTooSmallFor(best)) best = next;
      if (same) break;
    }

    return receiptOf(best);
  }

 private:
  bool timed() const { return budget_.ms > 0; }
  double leftMs() const { return budget_.ms - clock_.ms(); }
  double probeMs() const {
    const double most = kMostProbeShare * budget_.ms;
    return timed() ? std::clamp(kProbeShare * budget_.ms, std::min(kLeastProbeMs, most), most)
                   : kProbeMsOfTarget;
  }

  // Adds a knob, with the values to measure, if the scene uses it and the user has not fixed it. In
  // the baseline, lobes and lights take the fewest samples, and all other knobs have the values of
  // the options. The exact value comes last, in case there is no time for all.
  void addKnob(const Knob& knob) {
    const EffectSet effects = renderer_.scene().effects.without(baseline_.disable);
    const bool transports = knob.cause == Cause::transport;
    if (fixed_.contains(knob.name) || !knob.idle(effects).empty()) return;
    if (transports && baseline_.indirect == 0) return;

    RenderOptions exact = baseline_;
    knob.makeExact(exact, exactCutoff(effects, false));
    KnobLevels added{knob.name, optionText(exact, knob.name), {}, {}};

    if (knob.cause == Cause::algorithm) {
      // The value of the options comes first, then those of the sweep, and the exact one last.
      added.levels = {{optionText(baseline_, knob.name)}};
      for (const KnobValue& value : knob.values) {
        const bool known = value.label == added.levels[0].value || value.label == added.exact;
        if (!known && !value.endless && !value.minor) added.levels.push_back({value.label});
      }
      if (added.levels[0].value != added.exact) added.levels.push_back({added.exact});
    } else {
      // The baseline takes the fewest samples. The other levels are off and exact, but light
      // transport that was asked for is not switched off.
      const bool ofLights = knob.name == "light-samples";
      added.off = ofLights ? "1" : "0";
      added.levels = {{ofLights ? "2" : "1"}};
      if (!transports) added.levels.push_back({added.off});
      added.levels.push_back({added.exact});
      setOption(baseline_, knob.name, added.levels[0].value);
    }

    knobs_.push_back(std::move(added));
  }

  // Returns the time of the whole picture with one sample per pixel.
  double baselineMs() { return prober_.time(baseline_, 1) * prober_.pixels() / 1e3; }

  // Measures the time of a few packets, and chooses from it the samples per pixel of the probes and
  // the number of blocks.
  void chooseBlocks() {
    prober_.chooseBlocks(kPacketSide, kLeastPackets);
    double ms = baselineMs();

    // If not even one sample of the baseline fits, lobes and lights are not sampled. Indirect light
    // stays, because it was asked for.
    if (timed() && ms > budget_.ms) {
      for (KnobLevels& knob : knobs_) {
        if (knob.off.empty() || knob.name == "indirect") continue;
        knob.levels = {{knob.off}};
        setOption(baseline_, knob.name, knob.off);
      }
      ms = baselineMs();
    }

    probeSpp_ = probeMs() < kShortMs ? kFewSpp : kSomeSpp;
    if (timed() && ms > budget_.ms) probeSpp_ = 1;
    if (probeSpp_ > 1) putModerateFirst();

    // The time that is left for probes gives the number of pixels that can be measured.
    const double us = 1e3 * ms / prober_.pixels() * kCostOfProbe;
    const double pixels = 1e3 * (probeMs() - clock_.ms()) / usOfProbes(us);
    prober_.chooseBlocks(kBlockSide,
                         std::clamp(pixels / squared(kBlockSide), kLeastBlocks, kMostBlocks));
  }

  // A moderate value is measured first, in case there is no time for all of them.
  void putModerateFirst() {
    for (KnobLevels& knob : knobs_) {
      const auto first = knob.levels.begin() + 1;
      const auto last = knob.levels.end() - (knob.endsExact() ? 1 : 0);
      if (first < last) std::rotate(first, first + (last - first) / 2, last);
    }
  }

  // Returns the microseconds that all probes together take for one pixel, if one sample takes `us`.
  // Each level renders one sample to warm up, then the samples of its probe, and is compared once.
  double usOfProbes(double us) const {
    double samples = kTruthFactor * probeSpp_, pictures = 0;
    for (const KnobLevels& knob : knobs_) {
      const auto levels = static_cast<double>(knob.levels.size());
      samples += levels * (1 + (knob.off.empty() ? 1 : probeSpp_));
      pictures += levels;
    }
    return us * samples + kFlipMicroseconds * pictures;
  }

  void measure() {
    probed_ = prober_.probed();

    // The truth uses other random numbers than the probes. Otherwise part of their noise would
    // cancel in the differences, and more samples would seem to gain less.
    renderer_.setSeed(1);
    const Image truth = probe(baseline_, kTruthFactor * probeSpp_).image;
    renderer_.setSeed(0);

    // The noise of the baseline is measured with one sample and with several.
    const Probe one = probe(baseline_, 1), several = probe(baseline_, probeSpp_);
    const double error2 = difference2(several.image, truth);
    sampleUs_ = several.sampleUs;
    noise2_ = difference2(one.image, truth);
    findPower(error2);

    for (KnobLevels& knob : knobs_) {
      if (knob.off.empty()) {
        measureBias(knob, one);
      } else {
        measureSampling(knob, several, error2, truth);
      }
    }
  }

  Probe probe(const RenderOptions& options, int spp) {
    return {.sampleUs = prober_.time(options, spp), .image = prober_.mosaic()};
  }

  double difference2(const Image& a, const Image& b) const {
    return squared(prober_.difference(a, b));
  }

  // Finds the power with which squared noise falls as spp^-power: it is noise2_ with one sample and
  // `error2` with probeSpp_ samples. The truth is noisy as well, by an amount that depends on the
  // power, so we iterate.
  void findPower(double error2) {
    const double most = budget_.inCodes ? kMostCodesPower : kMostFlipPower;
    for (int i = 0; i < 3 && noise2_ > 0 && probeSpp_ > 1; ++i) {
      const double ofTruth = noise2_ * std::pow(kTruthFactor * probeSpp_, -power_);
      const double rest = std::max(error2 - ofTruth, error2 / 4);
      power_ = std::clamp(std::log(noise2_ / rest) / std::log(probeSpp_), kLeastPower, most);
    }
  }

  // One sample is enough to measure a bias, because all values share its noise.
  void measureBias(KnobLevels& knob, const Probe& one) {
    const std::vector<Image> shown = renderLevels(1, one, knob);
    const Image& truth = shown[knob.endsExact() ? shown.size() - 1 : 0];
    for (const auto i : indices(shown)) {
      knob.levels[i].bias2 = difference2(shown[i], truth);
    }
  }

  // `several` is the probe of the baseline, and `error2` its squared error.
  void measureSampling(KnobLevels& knob, const Probe& several, double error2, const Image& truth) {
    const std::vector<Image> shown = renderLevels(probeSpp_, several, knob);
    for (std::size_t i = 1; i < shown.size(); ++i) {
      Level& level = knob.levels[i];
      // The mean of many pixels has little noise, so its error is the bias.
      if (level.value == knob.off) level.bias2 = pooledBias2(shown[i], several.image, truth);

      // No level has more noise than the baseline, so a positive difference is a measuring error.
      // The difference is scaled from the samples of the probe to one sample.
      const double more = difference2(shown[i], truth) - level.bias2 - error2;
      level.noise2 = std::min(more, 0.0) * std::pow(probeSpp_, power_);
    }
  }

  // Returns the squared bias of `off`, the picture without a knob's samples. The noise of the truth
  // is subtracted. It is estimated from the baseline's picture `own`, which differs from the truth
  // in noise only: the truth has kTruthFactor times the samples, so that it has one part in
  // 1 + kTruthFactor of the squared difference.
  double pooledBias2(const Image& off, const Image& own, const Image& truth) const {
    const Image mean = pooled(truth);
    const double noise2 = difference2(pooled(own), mean) / (1 + kTruthFactor);
    return std::max(difference2(pooled(off), mean) - noise2, 0.0);
  }

  // Renders a picture with each value of the knob and sets the costs of the values. `first` is the
  // probe of the first value. Values that there is no time for are removed from the knob.
  std::vector<Image> renderLevels(int spp, const Probe& first, KnobLevels& knob) {
    std::vector<Image> shown{first.image};
    for (std::size_t i = 1; i < knob.levels.size(); ++i) {
      const bool isLate = timed() && clock_.ms() > kMostProbeShare * budget_.ms;
      const bool isOff = knob.levels[i].value == knob.off;  // the budget may be for nothing else
      if (isLate && !isOff && (i > 1 || probeSpp_ > 1)) {
        knob.levels.resize(i);
        break;
      }

      RenderOptions options = baseline_;
      setOption(options, knob.name, knob.levels[i].value);
      Probe own = probe(options, spp);
      knob.levels[i].cost = own.sampleUs / first.sampleUs;
      shown.push_back(std::move(own.image));
    }
    return shown;
  }

  double wantedError() const { return budget_.error / kTargetMargin; }

  // Sets the number of samples of the combination, and the cost and error that the model expects of
  // the picture.
  void complete(Combination& c, double leftMs) const {
    // Costs multiply, and squared errors add up.
    double bias2 = 0, noise2 = noise2_, ms = scale_ * sampleUs_ * prober_.pixels() / 1e3;
    for (const auto i : indices(knobs_)) {
      const Level& level = knobs_[i].levels[c.levels[i]];
      bias2 += level.bias2;
      noise2 += level.noise2;
      ms *= level.cost;
    }

    // Noise far below the baseline's is taken for a measuring error.
    noise2 = std::max(noise2, kLeastNoise * noise2_);

    c.spp = baseline_.spp;
    if (!fixed_.contains("spp")) {
      // For a budget we take as many samples as fit. For a target we take as many as reduce the
      // squared noise to what the squared bias leaves of the squared target.
      const double spp = timed() ? std::min(kAim * leftMs / ms, usefulSamples(noise2))
                                 : samplesFor(noise2, squared(wantedError()) - bias2);
      c.spp = static_cast<int>(std::clamp(spp, 1.0, double{kSppLimit}));
    }

    c.bias = std::sqrt(bias2);
    c.total = {ms * c.spp, std::sqrt(bias2 + noise2 * std::pow(c.spp, -power_))};
  }

  // Returns the number of samples that reduces `noise2`, the squared noise of one sample, to
  // `error2`.
  double samplesFor(double noise2, double error2) const {
    return error2 > 0 ? std::ceil(std::pow(noise2 / error2, 1 / power_)) : kSppLimit;
  }

  // Returns the number of samples with which nobody could see the noise that is left, or fewer if
  // making their pattern would take too much of the budget.
  double usefulSamples(double noise2) const {
    const double unseen = budget_.inCodes ? kUnseenCodes : kUnseenFlip;
    return std::min(samplesFor(noise2, squared(unseen)), kSppOfRootMs * std::sqrt(budget_.ms));
  }

  // Counts the levels of all knobs up, like the digits of a number. Returns false after the last
  // combination.
  bool advance(Combination& c) const {
    for (const auto i : indices(knobs_)) {
      if (++c.levels[i] < knobs_[i].levels.size()) return true;
      c.levels[i] = 0;
    }
    return false;
  }

  // Returns the best combination of levels, or the one that is nearest to the budget or target.
  Combination search() const {
    std::vector<Combination> all;
    std::vector<CostAndError> costs, errors;
    Combination c;
    const double left = leftMs();

    do {
      complete(c, left);
      all.push_back(c);

      // Each value beside the baseline's has to win by a margin, because it may only seem better.
      const auto same = static_cast<double>(std::ranges::count(c.levels, std::size_t{0}));
      const double doubt = std::pow(1 + kDoubt * kBlockSide / std::sqrt(probed_),
                                    static_cast<double>(c.levels.size()) - same);
      costs.push_back({c.total.cost, c.total.error * doubt});
      errors.push_back({c.total.error, c.total.cost * doubt});
    } while (advance(c));

    constexpr double kRounding = 1 + 1e-9;
    const std::vector<CostAndError>& wanted = timed() ? costs : errors;
    const double most = timed() ? kAim * left : wantedError() * kRounding;
    if (const auto best = bestWithin(wanted, most)) return all[*best];

    // If nothing fits, we take the cheapest combination, or for a target the most accurate one.
    Combination nearest = all[bestWithin(timed() ? errors : costs, kInfinity).value_or(0)];
    if (!timed()) return nearest;

    // Nothing is cheaper than no samples, whatever was measured.
    for (const auto i : indices(knobs_)) {
      const KnobLevels& knob = knobs_[i];
      if (knob.levels.size() > 1 && knob.levels[1].value == knob.off) nearest.levels[i] = 1;
    }
    complete(nearest, left);
    return nearest;
  }

  // True if the budget is too small for even the least number of samples of the combination.
  bool isTooSmallFor(const Combination& c) const {
    const bool isLeast = c.spp == 1 || fixed_.contains("spp");
    return timed() && isLeast && c.total.cost > kAim * leftMs();
  }

  RenderOptions optionsOf(const Combination& c) const {
    RenderOptions options = baseline_;
    for (const auto i : indices(knobs_)) {
      setOption(options, knobs_[i].name, knobs_[i].levels[c.levels[i]].value);
    }

    options.spp = c.spp;
    options.channels = pictureChannels_;
    return options;
  }

  Receipt receiptOf(const Combination& best) const {
    Receipt r;
    r.budget = budget_;
    r.options = optionsOf(best);
    renderer_.setOptions(r.options);
    r.options.channels = channels_;

    // The receipt lists all chosen values, and once more those that are not exact.
    if (!fixed_.contains("spp")) r.chosen.emplace_back("spp", std::to_string(best.spp));
    if (wasAdaptive_ && !baseline_.adaptive) r.chosen.emplace_back("adaptive", "off");
    for (const auto i : indices(knobs_)) {
      const KnobLevels& knob = knobs_[i];
      const Level& level = knob.levels[best.levels[i]];
      r.chosen.emplace_back(knob.name, level.value);
      if (level.bias2 > 0 || level.value == knob.off) {
        r.approximate.push_back({knob.name, level.value, knob.exact, std::sqrt(level.bias2)});
      }
    }

    r.bias = best.bias;
    r.setError(best.total.error);
    r.expectedMs = best.total.cost;

    // The note explains a budget or target that is missed, and time that is left over.
    const double left = leftMs();
    if (isTooSmallFor(best)) {
      r.note = "the budget is too small: this is the cheapest choice";
    } else if (timed() && r.expectedMs * (1 + 1.0 / best.spp) < left) {
      r.note = "more time would buy nothing that was measured: the picture is done early";
    } else if (budget_.error > 0 && r.error > budget_.error) {
      r.note = "the target is out of reach: this is the least error";
    }

    r.probeMs = clock_.ms();
    return r;
  }

  Stopwatch clock_;
  Renderer& renderer_;
  const std::set<std::string>& fixed_;
  Budget budget_;
  ChannelSet channels_;         // the channels that the user requested
  ChannelSet pictureChannels_;  // with Channel::error, if assess() can use it
  bool wasAdaptive_;
  RenderOptions baseline_;  // probes change one knob of it at a time
  Prober prober_;
  std::vector<KnobLevels> knobs_;
  int probeSpp_ = kSomeSpp;
  double probed_ = 1;                // pixels of a probe
  double sampleUs_ = 0, scale_ = 1;  // time of a baseline sample; factor that corrects costs
  double noise2_ = 0, power_ = kMostFlipPower;  // squared error of one sample; see findPower()
};

}  // namespace

Receipt chooseOptions(Renderer& renderer, const Camera& camera, const std::set<std::string>& fixed,
                      const Budget& budget, Film& film) {
  if (fixed.contains("quality")) throwUsage("--budget and --target choose what --quality sets");
  if (renderer.options().mode == Mode::reference) {
    throwUsage("--budget and --target choose options of packets: leave out --mode reference");
  }

  // Measuring changes the seed, and a failure must not leave it changed.
  try {
    return Chooser(renderer, camera, fixed, budget, film).choose();
  } catch (...) {
    renderer.setSeed(0);
    throw;
  }
}

}  // namespace whit
