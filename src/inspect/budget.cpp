#include "inspect/budget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <string_view>

#include "core/display.h"
#include "core/error.h"
#include "core/option_table.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "inspect/knobs.h"
#include "inspect/metrics.h"

namespace whit {

namespace {

// Those that are measured first matter most where a small budget ends the measurements.
constexpr std::array kChosenKnobs{"glossy",       "ambient-samples", "light-samples",
                                  "indirect",     "depth",           "cutoff",
                                  "light-cutoff", "texture-filter",  "fresnel"};

// Errors are measured in blocks of this side: large enough for most of FLIP's filters, and small
// enough that a thousand pixels come from all of the picture. Blocks of a packet are enough for
// times. A list has as many pixels as a tile.
constexpr int kBlockSide = 8, kPacketSide = 4, kTimedSide = 16, kTimedSpp = 3;
constexpr std::size_t kListPixels = 1024;

// Shares of the budget: of all measurements, at least some and at most some. The chosen options
// are timed on a share of the picture's pixels.
constexpr double kProbeShare = 0.06, kMostProbeShare = 0.2, kLeastProbeMs = 12,
                 kPicturesShare = 0.05;
constexpr double kLeastPackets = 128, kLeastTimed = 16;
constexpr double kProbeMsOfTarget = 300;
// The time that is aimed at, as a share of the rest: a little less than all of it, and whole
// samples round to a little more at most.
constexpr double kAim = 1.06;
// Samples of the probes, and of the probe that stands for the truth.
constexpr int kFewSpp = 2, kSomeSpp = 4, kTruthFactor = 4, kMany = 4;
// A value has to save this share of the time to be worth an error.
constexpr double kLeastSaving = 0.02;
// The share by which sums of the model have been off (src/accuracy/README.md).
constexpr double kModelError = 0.25;
// Noise below this share of the baseline's is not believed.
constexpr double kLeastNoise = 0.02;
constexpr double kFlipMicrosecondsAPixel = 0.6;

constexpr double squared(double x) { return x * x; }

// Places of the lattice of the plastic number (Roberts 2018): the first few lie all over the
// square.
std::vector<std::size_t> spreadCells(int columns, int rows, std::size_t count) {
  const auto all = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  std::vector<std::size_t> cells;
  std::vector<bool> taken(all);
  const auto take = [&](std::size_t cell) {
    if (!taken[cell] && cells.size() < count) cells.push_back(cell);
    taken[cell] = true;
  };
  for (std::size_t k = 0; k < 4 * all; ++k) {
    const double u = 0.5 + 0.7548776662466927 * static_cast<double>(k);
    const double v = 0.5 + 0.5698402909980532 * static_cast<double>(k);
    const auto x = static_cast<std::size_t>((u - std::floor(u)) * columns);
    const auto y = static_cast<std::size_t>((v - std::floor(v)) * rows);
    take(y * static_cast<std::size_t>(columns) + x);
  }
  for (std::size_t cell = 0; cell < all; ++cell) take(cell);
  return cells;
}

// A picture of the blocks, side by side, and its codes' features for FLIP.
struct Mosaic {
  DisplayImage codes;
  FlipSide side;
};

struct Measured {
  double mean = 0, standardError = 0;  // over the blocks
};

// Renders some of the picture's pixels.
class Prober {
 public:
  Prober(Renderer& renderer, const Camera& camera, Film& film, bool inCodes)
      : renderer_(renderer), camera_(camera), film_(film), inCodes_(inCodes) {}

  double pixels() const { return static_cast<double>(film_.image.pixels.size()); }

  // From now on so many blocks are rendered.
  void chooseBlocks(int side, std::size_t count) {
    const Image& image = film_.image;
    side_ = std::min({side, image.windowWidth(), image.windowHeight()});
    const int columns = image.windowWidth() / side_, rows = image.windowHeight() / side_;
    const Crop& w = image.window;
    const PixelLists all =  // row by row
        makeTiles({w.x0, w.y0, w.x0 + columns * side_, w.y0 + rows * side_}, side_);
    blocks_.clear();
    for (const std::size_t cell : spreadCells(columns, rows, count)) blocks_.push_back(all[cell]);
    const auto lists = 2 * static_cast<std::size_t>(renderer_.machine().threads);
    const std::size_t most = std::max<std::size_t>(kListPixels / blocks_[0].size(), 1);
    const std::size_t together = std::clamp<std::size_t>(blocks_.size() / lists, 1, most);
    lists_.clear();
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      if (i % together == 0) {
        lists_.emplace_back().reserve(together * blocks_[i].size() + kListPadding);
      }
      lists_.back().insert(lists_.back().end(), blocks_[i].begin(), blocks_[i].end());
    }
  }
  double probedPixels() const { return static_cast<double>(blocks_.size()) * side_ * side_; }

  // Microseconds of a sample of a pixel. The first frame after a change fills new queues and does
  // not count.
  double time(RenderOptions options) {
    const int spp = options.spp;
    options.spp = 1;
    renderer_.setOptions(options);
    const FrameStats first = renderer_.renderLists(camera_, film_, lists_);
    if (spp == 1) return 1e3 * first.frameMs / probedPixels();
    options.spp = spp;
    renderer_.setOptions(options);
    return 1e3 * renderer_.renderLists(camera_, film_, lists_).frameMs / (probedPixels() * spp);
  }

  // The blocks as last rendered.
  Mosaic mosaic() const {
    const RenderOptions& o = renderer_.options();
    const int count = static_cast<int>(blocks_.size());
    const int columns = std::max(static_cast<int>(std::sqrt(count)), 1);
    Image image(columns * side_, (count + columns - 1) / columns * side_);
    for (int b = 0; b < count; ++b) {
      const std::vector<std::uint32_t>& block = blocks_[static_cast<std::size_t>(b)];
      const int left = pixelX(block[0]), top = pixelY(block[0]);
      for (const std::uint32_t pixel : block) {
        const int x = pixelX(pixel), y = pixelY(pixel);
        image.at(b % columns * side_ + x - left, b / columns * side_ + y - top) =
            film_.image.at(x, y);
      }
    }
    Mosaic made{toDisplay(image, o.exposure.ev, o.toneCurve), {}};
    if (!inCodes_) made.side = flipSide(made.codes);
    return made;
  }

  Measured difference(const Mosaic& a, const Mosaic& b) const {
    const std::vector<float> each =
        inCodes_ ? codes(a.codes, b.codes) : flipOfSides(a.side, b.side);
    const int columns = a.codes.width / side_;
    std::vector<double> means(blocks_.size());
    for (std::size_t i = 0; i < each.size(); ++i) {
      const int x = static_cast<int>(i) % a.codes.width, y = static_cast<int>(i) / a.codes.width;
      const auto block = static_cast<std::size_t>(y / side_ * columns + x / side_);
      if (block < means.size()) means[block] += static_cast<double>(each[i]) / (side_ * side_);
    }
    const double n = static_cast<double>(means.size());
    Measured m{std::accumulate(means.begin(), means.end(), 0.0) / n, 0};
    double deviations = 0;
    for (const double mean : means) deviations += squared(mean - m.mean);
    m.standardError = std::sqrt(deviations / std::max(n - 1, 1.0) / n);
    return m;
  }

  // Milliseconds of the whole picture, by the rays of packets from all over it, which stand for it
  // better than a few tiles, and by the time of a ray in whole tiles, whose rays are as coherent as
  // those of the picture.
  double wholePictureMs(const RenderOptions& options, double share) {
    RenderOptions one = options;
    one.spp = 1;
    const double packets = pixels() / squared(kPacketSide);
    chooseBlocks(kPacketSide, static_cast<std::size_t>(std::clamp(share * options.spp / 2 * packets,
                                                                  kLeastPackets, packets)));
    renderer_.setOptions(one);
    const auto rays = static_cast<double>(renderer_.renderLists(camera_, film_, lists_).allRays()) /
                      probedPixels() * pixels() * options.spp;
    const int few = std::min(options.spp, kTimedSpp);
    const double blocks = pixels() / squared(kTimedSide);
    chooseBlocks(kTimedSide, static_cast<std::size_t>(std::clamp(share * options.spp / few * blocks,
                                                                 kLeastTimed, blocks)));
    renderer_.renderLists(camera_, film_, lists_);  // fills new queues
    RenderOptions timedOptions = options;
    timedOptions.spp = few;
    renderer_.setOptions(timedOptions);
    const FrameStats timed = renderer_.renderLists(camera_, film_, lists_);
    const double ms = std::accumulate(timed.stageWorkerMs.begin(), timed.stageWorkerMs.end(), 0.0) /
                      timed.workers;
    return ms / static_cast<double>(timed.allRays()) * rays;
  }

 private:
  static std::vector<float> codes(const DisplayImage& a, const DisplayImage& b) {
    std::vector<float> each(a.rgba.size() / 4);
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
      const auto apart = static_cast<float>(std::abs(int{a.rgba[i]} - int{b.rgba[i]}));
      each[i / 4] = std::max(each[i / 4], apart);
    }
    return each;
  }

  Renderer& renderer_;
  const Camera& camera_;
  Film& film_;
  bool inCodes_;
  int side_ = kBlockSide;
  PixelLists blocks_, lists_;
};

// A value of a knob, with its cost and its error against the middle of the model.
struct Level {
  std::string value;
  double cost = 1;    // factor of the time of a sample
  double bias2 = 0;   // squared error that more samples of pixels do not take away
  double noise2 = 0;  // added to the squared error of one sample
};
struct Ladder {
  std::string name, exact;
  bool samples = false;       // numbers of samples
  std::vector<Level> levels;  // the first is the one of the middle
};

struct Combination {
  std::array<std::size_t, kChosenKnobs.size()> levels{};
  int spp = 1;
  CostAndError total;  // milliseconds of the picture
};

class Chooser {
 public:
  Chooser(Renderer& renderer, const Camera& camera, const std::set<std::string>& fixed,
          const Budget& budget, Film& film)
      : renderer_(renderer),
        fixed_(fixed),
        budget_(budget),
        channels_(renderer.options().channels),
        middle_(renderer.options()),
        prober_(renderer, camera, film, budget.inCodes) {
    middle_.channels = {};
    middle_.adaptive = middle_.adaptive && fixed.contains("adaptive");
  }

  Receipt choose() {
    chooseLadders();
    measure();
    Combination best = search();
    // Measured by whole tiles, another combination may be better.
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds; ++round) {
      scale_ *= prober_.wholePictureMs(optionsOf(best), kPicturesShare) / best.total.cost;
      const Combination next = search();
      const bool same = next.levels == best.levels;
      if (same || round + 1 < kRounds) {
        best = next;
      } else {
        complete(best, leftMs());
      }
      if (same) break;
    }
    return receiptOf(best);
  }

 private:
  double probeMs() const {
    if (budget_.ms == 0) return kProbeMsOfTarget;
    return std::min(std::max(kProbeShare * budget_.ms, kLeastProbeMs),
                    kMostProbeShare * budget_.ms);
  }

  void chooseLadders() {
    const EffectSet effects = renderer_.scene().effects.without(middle_.disable);
    const float cutoff = exactCutoff(effects, false);
    for (const char* const name : kChosenKnobs) {
      const Knob knob = chooseKnobs({name}).front();
      const bool transports = knob.cause != Cause::transport || middle_.indirect > 0;
      if (fixed_.contains(name) || !knob.idle(effects).empty() || !transports) continue;
      RenderOptions exact = middle_;
      knob.makeExact(exact, cutoff);
      Ladder ladder{name, optionText(exact, name), knob.cause != Cause::algorithm, {}};
      std::vector<std::string> values;
      if (ladder.samples) {
        ladder.exact = std::to_string(kMany);
        const bool on = knob.cause == Cause::transport;
        values = ladder.name == "light-samples" ? std::vector<std::string>{"2", "1", "4"}
                 : on                           ? std::vector<std::string>{"1", "4"}
                                                : std::vector<std::string>{"1", "0", "4"};
        setOption(middle_, name, values.front());
      } else {
        const std::string own = optionText(middle_, name);
        values = {own};
        if (own != ladder.exact) values.push_back(ladder.exact);
        for (const KnobValue& value : knob.values) {
          const bool known = std::ranges::find(values, value.label) != values.end();
          if (!known && !value.endless && !value.spare) values.push_back(value.label);
        }
      }
      for (const std::string& value : values) ladder.levels.push_back({value});
      ladders_.push_back(std::move(ladder));
    }
  }

  // The middle without samples of lights and lobes, where there is no time for one of each.
  void leaveOutSamples() {
    std::erase_if(ladders_, [&](const Ladder& ladder) {
      if (!ladder.samples) return false;
      for (const Level& level : ladder.levels) {
        if (isOff(ladder, level)) setOption(middle_, ladder.name, level.value);
      }
      return true;
    });
  }

  // As many blocks as there is time for, by the time of a few of them.
  void chooseBlocks() {
    const auto sampleOfMiddle = [&] {
      RenderOptions one = middle_;
      one.spp = 1;
      prober_.time(one);
      return prober_.time(one);
    };
    prober_.chooseBlocks(kPacketSide, static_cast<std::size_t>(kLeastPackets));
    double sample = sampleOfMiddle();
    if (budget_.ms > 0 && sample * prober_.pixels() > 1e3 * budget_.ms) {
      leaveOutSamples();
      sample = sampleOfMiddle();
    }
    constexpr double kShortMs = 40;
    if (probeMs() < kShortMs) probeSpp_ = kFewSpp;
    tight_ = budget_.ms > 0 && sample * prober_.pixels() > 1e3 * budget_.ms;
    if (tight_) probeSpp_ = 1;
    double probes = 3;
    for (const Ladder& ladder : ladders_) probes += static_cast<double>(ladder.levels.size() - 1);
    constexpr double kCostOfExact = 1.5;  // of the values that are measured, against the middle
    const double costOfPixel = sample * kCostOfExact * (probeSpp_ + 1) * (probes + kTruthFactor) +
                               kFlipMicrosecondsAPixel * probes;
    const double pixels = 1e3 * (probeMs() - clock_.ms()) / costOfPixel;
    constexpr double kLeastBlocks = 16, kMostBlocks = 1000;
    prober_.chooseBlocks(kBlockSide, static_cast<std::size_t>(std::clamp(
                                         pixels / squared(kBlockSide), kLeastBlocks, kMostBlocks)));
  }

  void measure() {
    chooseBlocks();
    RenderOptions truth = middle_;
    for (const Ladder& ladder : ladders_) {
      if (ladder.samples) setOption(truth, ladder.name, ladder.exact);
    }
    truth.spp = (kTruthFactor * probeSpp_);
    prober_.time(truth);
    const Mosaic many = prober_.mosaic();
    RenderOptions middle = middle_;
    middle.spp = 1;
    prober_.time(middle);
    const Measured one = prober_.difference(prober_.mosaic(), many);
    middle.spp = probeSpp_;
    sampleUs_ = prober_.time(middle);
    const Mosaic own = prober_.mosaic();
    const Measured some = prober_.difference(own, many);
    fitNoise(one, some);
    for (Ladder& ladder : ladders_) measureLadder(middle, own, some, many, ladder);
  }

  // The noise of the truth is a part of both.
  void fitNoise(const Measured& one, const Measured& some) {
    constexpr double kLeastPower = 0.5, kMostPower = 1.5;  // of squared errors
    noise2_ = squared(one.mean);
    double some2 = squared(some.mean);
    for (int i = 0; i < 3 && noise2_ > 0 && probeSpp_ > 1; ++i) {
      const double rest = noise2_ * std::pow((kTruthFactor * probeSpp_), -power_);
      some2 = std::max(squared(some.mean) - rest, squared(some.mean) / 4);
      power_ = std::clamp(std::log(noise2_ / std::max(some2, 1e-12)) / std::log(probeSpp_),
                          kLeastPower, kMostPower);
    }
    spread_ = one.mean > 0 ? one.standardError / one.mean : 0;
  }

  void measureLadder(const RenderOptions& middle, const Mosaic& own, const Measured& some,
                     const Mosaic& many, Ladder& ladder) {
    std::optional<Mosaic> exact;
    std::vector<Level> wanted = ladder.levels;
    ladder.levels.resize(1);
    if (tight_) {  // the cheapest first, which may be all that there is time for
      std::erase_if(wanted, [&](const Level& l) {
        return l.value == ladder.exact && l.value != wanted[0].value;
      });
      if (ladder.name != "depth") std::reverse(wanted.begin() + 1, wanted.end());
    }
    for (std::size_t i = 1; i < wanted.size(); ++i) {
      const bool isLate = budget_.ms > 0 && clock_.ms() > kMostProbeShare * budget_.ms;
      if (isLate && !(tight_ && i == 1)) break;
      Level level = wanted[i];
      RenderOptions options = middle;
      setOption(options, ladder.name, level.value);
      level.cost = prober_.time(options) / sampleUs_;
      const Mosaic shown = prober_.mosaic();
      if (ladder.samples) {
        const double more = squared(prober_.difference(shown, many).mean) - squared(some.mean);
        if (isOff(ladder, level)) {
          level.bias2 = std::max(more, 0.0);
        } else {
          level.noise2 = std::min(more, 0.0) * std::pow(probeSpp_, power_);
        }
      } else if (level.value == ladder.exact) {
        exact = shown;
        ladder.levels[0].bias2 = squared(prober_.difference(own, shown).mean);
      } else {
        level.bias2 = squared(prober_.difference(shown, exact ? *exact : own).mean);
      }
      ladder.levels.push_back(level);
    }
    dropUseless(ladder);
  }

  static bool isOff(const Ladder& ladder, const Level& level) {
    return level.value == (ladder.name == "light-samples" ? "1" : "0");
  }

  // A value that another one beats in both, or nearly so, is left out.
  static void dropUseless(Ladder& ladder) {
    const std::vector<Level> all = ladder.levels;
    std::erase_if(ladder.levels, [&](const Level& a) {
      return std::ranges::any_of(all, [&](const Level& b) {
        const bool better = b.bias2 <= a.bias2 && b.noise2 <= a.noise2 &&
                            (b.bias2 < a.bias2 || b.noise2 < a.noise2 || b.cost < a.cost);
        return b.value != a.value && better && b.cost * (1 - kLeastSaving) <= a.cost;
      });
    });
  }

  double leftMs() const {
    return budget_.ms > 0 ? budget_.ms - clock_.ms() : std::numeric_limits<double>::infinity();
  }

  // By the levels of the combination, the cost and error of the picture with as many samples as
  // fit.
  void complete(Combination& c, double leftMs) const {
    double bias2 = 0, noise2 = noise2_, ms = scale_ * sampleUs_ * prober_.pixels() / 1e3;
    for (std::size_t i = 0; i < ladders_.size(); ++i) {
      const Level& level = ladders_[i].levels[c.levels[i]];
      bias2 += level.bias2, noise2 += level.noise2, ms *= level.cost;
    }
    noise2 = std::max(noise2, kLeastNoise * noise2_);
    c.spp = middle_.spp;
    if (!fixed_.contains("spp")) {
      const double rest2 = squared(wantedError()) - bias2;
      const double spp = budget_.ms > 0 ? kAim * leftMs / ms
                         : rest2 > 0    ? std::ceil(std::pow(noise2 / rest2, 1 / power_))
                                        : kSppLimit;
      // More samples than take the noise below what anybody could see buy nothing.
      const double useful = std::ceil(std::pow(noise2 / squared(unseen()), 1 / power_));
      c.spp = static_cast<int>(std::clamp(std::min(spp, useful), 1.0, double{kSppLimit}));
    }
    c.total = {ms * c.spp, std::sqrt(bias2 + noise2 * std::pow(c.spp, -power_))};
  }

  // The best of all combinations of levels, or what is nearest to the budget or target.
  Combination search() const {
    std::vector<Combination> all;
    std::vector<CostAndError> costs, errors;
    Combination c;
    const double left = leftMs();
    for (bool more = true; more;) {
      complete(c, left);
      all.push_back(c);
      costs.push_back(c.total);
      errors.push_back({c.total.error, c.total.cost});
      more = false;
      for (std::size_t i = 0; i < ladders_.size() && !more; ++i) {
        more = ++c.levels[i] < ladders_[i].levels.size();
        if (!more) c.levels[i] = 0;
      }
    }
    constexpr double kAny = std::numeric_limits<double>::infinity(), kRounding = 1 + 1e-9;
    const bool timed = budget_.ms > 0;
    const auto best =
        timed ? bestWithin(costs, kAim * left) : bestWithin(errors, wantedError() * kRounding);
    return all[best.value_or(bestWithin(timed ? errors : costs, kAny).value_or(0))];
  }

  double unseen() const { return budget_.inCodes ? 0.02 : 2e-4; }
  double wantedError() const { return budget_.error / (1 + kModelError); }

  RenderOptions optionsOf(const Combination& c) const {
    RenderOptions options = middle_;
    for (std::size_t i = 0; i < ladders_.size(); ++i) {
      setOption(options, ladders_[i].name, ladders_[i].levels[c.levels[i]].value);
    }
    options.spp = c.spp;
    return options;
  }

  Receipt receiptOf(const Combination& best) const {
    Receipt r;
    r.budget = budget_;
    r.options = optionsOf(best);
    r.options.channels = channels_;
    renderer_.setOptions(r.options);
    if (!fixed_.contains("spp")) r.chosen.emplace_back("spp", std::to_string(best.spp));
    for (std::size_t i = 0; i < ladders_.size(); ++i) {
      const Ladder& ladder = ladders_[i];
      const Level& level = ladder.levels[best.levels[i]];
      r.chosen.emplace_back(ladder.name, level.value);
      if (level.bias2 > 0) {
        r.approximate.push_back({ladder.name, level.value, ladder.exact, std::sqrt(level.bias2)});
      }
    }
    const double spread = std::hypot(2 * spread_, kModelError);
    r.error = best.total.error;
    r.low = r.error / (1 + spread), r.high = r.error * (1 + spread);
    r.expectedMs = best.total.cost;
    const double left = leftMs();
    if (budget_.ms > 0 && r.expectedMs > kAim * left) {
      r.note = "the budget is too small: this is the cheapest choice";
    } else if (budget_.ms > 0 && r.expectedMs * (1 + 1.0 / best.spp) < left) {
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
  ChannelSet channels_;
  RenderOptions middle_;  // of which one knob at a time is changed
  Prober prober_;
  std::vector<Ladder> ladders_;
  int probeSpp_ = kSomeSpp;
  bool tight_ = false;                          // not even one sample of the middle fits
  double sampleUs_ = 0, scale_ = 1;             // of a sample of the middle
  double noise2_ = 0, power_ = 1, spread_ = 0;  // squared error of one sample; see fitNoise()
};

[[noreturn]] void refuse(const std::string& option, const std::string& expected,
                         const std::string& text) {
  throwUsage("--" + option + ": expected " + expected + ", found '" + text + "'");
}

}  // namespace

Budget parseBudget(const std::string& time, const std::string& target) {
  constexpr std::array<std::pair<std::string_view, double>, 3> kUnits{
      {{"ms", 1}, {"min", 60e3}, {"s", 1e3}}};
  Budget budget;
  if (!time.empty() && !target.empty()) {
    throwUsage("--budget gives the time and --target the error: give one of them");
  }
  for (const auto& [unit, ms] : kUnits) {
    if (time.ends_with(unit) && readNumber(time.substr(0, time.size() - unit.size()), budget.ms)) {
      budget.ms *= ms;
      break;
    }
  }
  constexpr double kLeastMs = 1, kMostMs = 1e9;
  if (!time.empty() && !(budget.ms >= kLeastMs && budget.ms <= kMostMs)) {
    refuse("budget", "a time of at least 1 ms, as 50ms, 10s or 2min", time);
  }
  constexpr std::string_view kFlip = "flip=", kCodes = "codes";
  budget.inCodes = target.ends_with(kCodes);
  const bool read =
      budget.inCodes
          ? readNumber(target.substr(0, target.size() - kCodes.size()), budget.error)
          : target.starts_with(kFlip) && readNumber(target.substr(kFlip.size()), budget.error);
  const double most = budget.inCodes ? 255 : 1;
  if (!target.empty() && !(read && budget.error > 0 && budget.error <= most)) {
    refuse("target", "an error above 0, as 0.5codes or flip=0.01", target);
  }
  return budget;
}

Receipt chooseOptions(Renderer& renderer, const Camera& camera, const std::set<std::string>& fixed,
                      const Budget& budget, Film& film) {
  if (fixed.contains("quality")) throwUsage("--budget and --target choose what --quality sets");
  if (renderer.options().mode == Mode::reference) {
    throwUsage("--budget and --target choose options of packets: leave out --mode reference");
  }
  return Chooser(renderer, camera, fixed, budget, film).choose();
}

std::string receiptText(const Receipt& r, const std::string& command) {
  const char* const unit = r.budget.inCodes ? "codes" : "FLIP";
  std::string text = "  chosen ";
  std::string options;
  for (const auto& [name, value] : r.chosen) options += " --" + name + " " + value;
  text += options.empty() ? "nothing: every option was given" : options.substr(1);
  text += "\n  left out";
  for (const Receipt::Knob& knob : r.approximate) {
    text += formatted(" %s %s (%s %.4f)", knob.name.c_str(), knob.exact.c_str(), unit, knob.error);
  }
  if (r.approximate.empty()) text += " nothing but samples";
  text += formatted("\n  time %.0f ms: %.0f to choose, %.0f for the picture (expected %.0f)",
                    r.usedMs(), r.probeMs, r.measuredMs, r.expectedMs);
  if (r.budget.ms > 0) text += formatted(", %.0f %% of the budget", 100 * r.usedMs() / r.budget.ms);
  text += formatted("\n  error %.4f %s, between %.4f and %.4f\n", r.error, unit, r.low, r.high);
  if (!r.note.empty()) text += "  note: " + r.note + "\n";
  if (!command.empty()) text += "  the same picture: " + command + options + "\n";
  return text;
}

}  // namespace whit
