#include "inspect/budget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <regex>
#include <span>
#include <utility>

#include "core/error.h"
#include "core/option_table.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "inspect/knobs.h"
#include "inspect/metrics.h"
#include "stages/lobes.h"

namespace whit {

namespace {

// The knobs are measured in this order, and a small budget ends the measurements early: those that
// matter most come first.
constexpr std::array kChosenKnobs{"glossy",       "ambient-samples", "light-samples",
                                  "indirect",     "depth",           "cutoff",
                                  "light-cutoff", "texture-filter",  "fresnel"};

// Errors are measured in blocks of this side: large enough for most of FLIP's filters, and small
// enough that a thousand pixels come from all of the picture. Blocks of a packet are enough for
// times. A list has as many pixels as a tile.
constexpr int kBlockSide = 8, kPooledSide = 4, kPacketSide = 4, kTimedSide = 16, kTimedSpp = 3;
constexpr std::size_t kListPixels = 1024;

// Shares of the budget: of all measurements, with a least and a largest; and the share of the
// picture's time that measuring it takes.
constexpr double kProbeShare = 0.1, kMostProbeShare = 0.2, kLeastProbeMs = 12, kPictureShare = 0.05;
constexpr double kProbeMsOfTarget = 300, kShortMs = 40;
constexpr double kLeastBlocks = 8, kMostBlocks = 1000, kLeastPackets = 128, kLeastTimed = 16;
constexpr double kAssessShare = 0.01;
constexpr double kChannelMargin = 1.25;  // factor of the noise that the channel `error` estimates
// The mean of k equal samples among black ones has the relative standard error 1 / sqrt(k) (Kish
// 1965 calls k the effective number of samples). Where fewer than so many decide a pixel and those
// around it, they tell little about the samples that were not drawn; and where the other pixels
// have less than this share of the squared error, the error is not known.
constexpr double kFewSamples = 8, kLeastKnown = 0.5;
constexpr int kRounds = 3;
// The time that is aimed at, over the rest of the budget: whole samples leave some of it, and
// measured times are a little too long, by caches that are cold.
constexpr double kAim = 1.06;
// Samples of the probes; the probe that stands for the truth has so many times as many.
constexpr int kFewSpp = 2, kSomeSpp = 4, kTruthFactor = 4;
// Times that are expected of a probe: over that of the middle, and of a pixel's FLIP.
constexpr double kCostOfProbe = 1.5, kFlipMicroseconds = 1;
// Most pictures have between half and twice the modelled error; a target is taken with a margin.
// Squared noise falls with a power of the number of samples. FLIP is about the 0.7th power of a
// difference, so that it falls more slowly; probes of one and four samples tell the power badly.
constexpr double kModelError = 1, kTargetMargin = 1.25;
constexpr double kLeastPower = 0.6, kMostFlipPower = 0.9, kMostCodesPower = 1.3;
// Noise below this share of the middle's is not believed. Among so many combinations those whose
// measurements flatter them would win, so that each value beside the middle's has to gain this
// share over the root of the number of blocks.
constexpr double kLeastNoise = 0.02, kDoubt = 0.5;
constexpr double kUnseenFlip = 2e-4, kUnseenCodes = 0.02;
// A pattern of 4096 samples takes 0.15 to 0.3 s: about a 25th of the budget.
constexpr double kSppOfRootMs = 50;

constexpr double kMostMs = 1e9;

constexpr double squared(double x) { return x * x; }

// Returns the means of squares of kPooledSide pixels, or the image itself if it is smaller.
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

void setError(Receipt& r, double error) {
  r.error = error;
  r.low = error / (1 + kModelError);
  r.high = error * (1 + kModelError);
}

// The error is an estimate that nothing bounds.
void leaveUnknown(Receipt& r, double estimate) {
  r.error = estimate;
  r.high = std::numeric_limits<double>::infinity();
  if (!r.note.empty()) r.note += "; ";
  r.note += "the error is not known: few samples decide most of what was measured";
}

// The root mean squares of radiance over the pixels that the channel `error` is pooled over.
std::vector<double> pooledRadiance(const Film& film) {
  // poolErrors() works on the channel `error`, so the radiance takes its place there.
  Film means;
  means.image = film.image;
  means.channels.resize(ChannelSet().with(Channel::error), film.image.pixels.size());
  const std::span<float> values = means.channels.floats(Channel::error);

  for (std::size_t i = 0; i < film.image.pixels.size(); ++i) {
    const Rgb& pixel = film.image.pixels[i];
    values[2 * i] = (pixel.x + pixel.y + pixel.z) / 3;
  }
  poolErrors(means);

  // The channel has two floats for each pixel; only the first is pooled.
  std::vector<double> pooled;
  for (std::size_t i = 0; i < values.size(); i += 2) pooled.push_back(double{values[i]});
  return pooled;
}

double brightestRadiance(const Scene& scene, const Image& image) {
  float brightest = 0;
  for (const Rgb& pixel : image.pixels) brightest = std::max(brightest, maxComponent(pixel));
  for (const Material& m : scene.materials)
    brightest = std::max(brightest, maxComponent(m.emission));

  // Parts of the sky that are out of view may be brighter than any pixel.
  const Sky& sky = scene.sky;
  if (sky.kind == Sky::Kind::none) return double{brightest};
  for (const Rgb& color : {sky.zenith, sky.horizon, sky.ground}) {
    brightest = std::max(brightest, sky.scale * maxComponent(color));
  }
  for (const std::vector<float>* texels : {&sky.image.r, &sky.image.g, &sky.image.b}) {
    for (const float texel : *texels) brightest = std::max(brightest, sky.scale * texel);
  }

  return double{brightest};
}

// Cells of a grid by the lattice of the plastic number (Roberts 2018): the first few lie all over
// it.
std::vector<std::pair<int, int>> spreadCells(int columns, int rows, double count) {
  const auto all = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  std::vector<std::pair<int, int>> cells;
  std::vector<bool> taken(all);

  for (std::size_t k = 0; k < 8 * all && static_cast<double>(cells.size()) < count; ++k) {
    double u = 0.5 + 0.7548776662466927 * static_cast<double>(k), whole = 0;
    double v = 0.5 + 0.5698402909980532 * static_cast<double>(k);
    u = std::modf(u, &whole);
    v = std::modf(v, &whole);

    const int x = static_cast<int>(u * columns), y = static_cast<int>(v * rows);
    const std::size_t cell = static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                             static_cast<std::size_t>(x);
    if (!taken[cell]) cells.emplace_back(x, y);
    taken[cell] = true;
  }
  return cells;
}

// Renders some of the picture's pixels, in blocks.
class Prober {
 public:
  Prober(Renderer& renderer, const Camera& camera, Film& film, bool inCodes)
      : renderer_(renderer), camera_(camera), film_(film), inCodes_(inCodes) {}

  double pixels() const { return static_cast<double>(film_.image.pixels.size()); }

  // From now on so many blocks are rendered, or all.
  void chooseBlocks(int side, double count) {
    const Image& image = film_.image;
    side_ = std::min({side, image.windowWidth(), image.windowHeight()});

    blocks_.clear();
    for (const auto& [column, row] :
         spreadCells(image.windowWidth() / side_, image.windowHeight() / side_, count)) {
      const int x = image.window.x0 + column * side_, y = image.window.y0 + row * side_;
      blocks_.push_back(makeTiles({x, y, x + side_, y + side_}, side_)[0]);
    }

    // Every worker gets at least two lists if there are enough blocks, so that the work is
    // balanced.
    const auto lists = 2 * static_cast<std::size_t>(renderer_.machine().threads);
    const std::size_t most = std::max<std::size_t>(kListPixels / blocks_[0].size(), 1);
    const std::size_t together = std::clamp<std::size_t>(blocks_.size() / lists, 1, most);

    lists_.clear();
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const std::size_t room = together * blocks_[i].size() + kListPadding;
      if (i % together == 0) lists_.emplace_back().reserve(room);
      lists_.back().insert(lists_.back().end(), blocks_[i].begin(), blocks_[i].end());
    }
  }

  // Number of pixels in the chosen blocks.
  double probed() const { return static_cast<double>(blocks_.size()) * side_ * side_; }

  FrameStats render(RenderOptions options, int spp) {
    options.spp = spp;
    renderer_.setOptions(options);
    return renderer_.render({.camera = camera_, .film = film_, .pixels = &lists_});
  }

  // Microseconds of a sample of a pixel. The first frame after a change fills new queues and does
  // not count.
  double time(const RenderOptions& options, int spp) {
    render(options, 1);
    return 1e3 * render(options, spp).frameMs / (probed() * spp);
  }

  // Returns the blocks as last rendered, or as another picture of the film's size has them.
  Image mosaic() const { return mosaic(film_.image); }
  Image mosaic(const Image& picture) const {
    // The blocks are arranged in a grid that is nearly square.
    const int count = static_cast<int>(blocks_.size());
    const int columns = std::max(static_cast<int>(std::sqrt(count)), 1);
    Image image(columns * side_, (count + columns - 1) / columns * side_);

    for (int b = 0; b < count; ++b) {
      const std::vector<std::uint32_t>& block = blocks_[static_cast<std::size_t>(b)];
      for (const std::uint32_t pixel : block) {
        image.at(b % columns * side_ + pixelX(pixel) - pixelX(block[0]),
                 b / columns * side_ + pixelY(pixel) - pixelY(block[0])) =
            picture.at(pixelX(pixel), pixelY(pixel));
      }
    }
    return image;
  }

  double difference(const Image& a, const Image& b) const {
    const RenderOptions& o = renderer_.options();
    const ImageDifference d = compareImages(a, b, o.exposure.ev, o.toneCurve);
    return inCodes_ ? 255 * std::pow(10, -d.psnrDb / 20) : d.flipMean;
  }

  // Estimates the milliseconds of the whole picture as its rays times the time of a ray. The
  // measurement takes about `share` of the picture's time.
  double wholePictureMs(const RenderOptions& options, double share) {
    const int spp = options.spp, few = std::min(spp, kTimedSpp);
    const double packets = pixels() / squared(kPacketSide), blocks = pixels() / squared(kTimedSide);

    // Small packets from all over the picture give the number of rays per sample.
    chooseBlocks(kPacketSide, std::max(share * spp * packets, kLeastPackets));
    const double rays = static_cast<double>(render(options, 1).allRays()) / probed();

    // Larger blocks give the time per ray, because their rays are as coherent as the picture's.
    chooseBlocks(kTimedSide, std::max(share * spp / few * blocks, kLeastTimed));
    render(options, 1);  // fills new queues
    const FrameStats timed = render(options, few);
    const double ms = std::accumulate(timed.stageWorkerMs.begin(), timed.stageWorkerMs.end(), 0.0) /
                      timed.workers;

    return ms / static_cast<double>(timed.allRays()) * rays * pixels() * spp;
  }

 private:
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
  std::string name, exact, off;  // off: without samples; empty for other knobs
  std::vector<Level> levels;     // the first is the one of the middle
};

struct Combination {
  std::array<std::size_t, kChosenKnobs.size()> levels{};
  int spp = 1;
  double bias = 0;
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
        measured_(channels_.with(Channel::error)),
        wasAdaptive_(renderer.options().adaptive),
        middle_(renderer.options()),
        prober_(renderer, camera, film, budget.inCodes) {
    // Probes keep no channels, and take all samples unless --adaptive was given explicitly.
    middle_.channels = {};
    middle_.adaptive = middle_.adaptive && fixed.contains("adaptive");
    if (middle_.adaptive) measured_ = channels_;  // it takes all samples with the channel
  }

  Receipt choose() {
    for (const char* const name : kChosenKnobs) addLadder(chooseKnobs({name}).front());
    chooseBlocks();
    measure();
    Combination best = search();

    // Costs that were measured one by one may not multiply exactly. The measured time of the best
    // combination corrects the scale, after which another one may be better.
    for (int round = 0; round < kRounds; ++round) {
      scale_ *= prober_.wholePictureMs(optionsOf(best), kPictureShare) / best.total.cost;
      const Combination next = search();
      const bool same = next.levels == best.levels;
      // The last round keeps the combination whose time was measured.
      if (same || round + 1 < kRounds) best = next;
      complete(best, leftMs());
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

  // The middle has one sample of each lobe and light that the scene calls for, and of the other
  // knobs the values of the options. Cheap values come first and the exact one last, in case there
  // is no time for all.
  void addLadder(const Knob& knob) {
    const EffectSet effects = renderer_.scene().effects.without(middle_.disable);
    const bool transports = knob.cause == Cause::transport;
    if (fixed_.contains(knob.name) || !knob.idle(effects).empty()) return;
    if (transports && middle_.indirect == 0) return;

    RenderOptions exact = middle_;
    knob.makeExact(exact, exactCutoff(effects, false));
    Ladder ladder{knob.name, optionText(exact, knob.name), {}, {}};

    if (knob.cause == Cause::algorithm) {
      // The value of the options comes first, then those of the sweep, and the exact one last.
      ladder.levels = {{optionText(middle_, knob.name)}};
      for (const KnobValue& value : knob.values) {
        const bool known = value.label == ladder.levels[0].value || value.label == ladder.exact;
        if (!known && !value.endless && !value.spare) ladder.levels.push_back({value.label});
      }
      if (ladder.levels[0].value != ladder.exact) ladder.levels.push_back({ladder.exact});
    } else {
      // The middle takes the fewest samples. The other levels are off and exact, but light
      // transport that was asked for is not switched off.
      const bool ofLights = knob.name == "light-samples";
      ladder.off = ofLights ? "1" : "0";
      ladder.levels = {{ofLights ? "2" : "1"}};
      if (!transports) ladder.levels.push_back({ladder.off});
      ladder.levels.push_back({ladder.exact});
      setOption(middle_, knob.name, ladder.levels[0].value);
    }

    ladders_.push_back(std::move(ladder));
  }

  double sampleOfMiddle() { return prober_.time(middle_, 1) * prober_.pixels() / 1e3; }

  // As many blocks as there is time for, by the time of a few packets. Where not even one sample of
  // the middle fits, lobes and lights are not sampled.
  void chooseBlocks() {
    prober_.chooseBlocks(kPacketSide, kLeastPackets);
    double ms = sampleOfMiddle();

    if (timed() && ms > budget_.ms) {
      for (Ladder& ladder : ladders_) {
        if (ladder.off.empty() || ladder.name == "indirect") continue;
        ladder.levels = {{ladder.off}};
        setOption(middle_, ladder.name, ladder.off);
      }
      ms = sampleOfMiddle();
    }

    probeSpp_ = probeMs() < kShortMs ? kFewSpp : kSomeSpp;
    if (timed() && ms > budget_.ms) probeSpp_ = 1;

    // A moderate value is measured first, in case there is no time for all of them.
    for (Ladder& ladder : ladders_) {
      const bool toExact = ladder.levels.back().value == ladder.exact;
      const auto first = ladder.levels.begin() + 1, last = ladder.levels.end() - (toExact ? 1 : 0);
      if (probeSpp_ > 1 && first < last) std::rotate(first, first + (last - first) / 2, last);
    }

    // Each level renders one sample to warm up, then the samples of its probe, and is compared
    // once.
    double samples = kTruthFactor * probeSpp_, pictures = 0;  // of a pixel
    for (const Ladder& ladder : ladders_) {
      const auto levels = static_cast<double>(ladder.levels.size());
      samples += levels * (1 + (ladder.off.empty() ? 1 : probeSpp_));
      pictures += levels;
    }

    // The time that is left for probes gives the number of pixels that can be measured.
    const double us = 1e3 * ms / prober_.pixels() * kCostOfProbe * samples;
    const double pixels = 1e3 * (probeMs() - clock_.ms()) / (us + kFlipMicroseconds * pictures);
    prober_.chooseBlocks(kBlockSide,
                         std::clamp(pixels / squared(kBlockSide), kLeastBlocks, kMostBlocks));
  }

  void measure() {
    probed_ = prober_.probed();

    // The truth has other random numbers: noise that the probes share would hide what samples gain.
    renderer_.setSeed(1);
    prober_.time(middle_, kTruthFactor * probeSpp_);
    renderer_.setSeed(0);
    const Image truth = prober_.mosaic();

    // The noise of the middle is measured with one sample and with several.
    const double firstUs = prober_.time(middle_, 1);
    const Image first = prober_.mosaic();
    noise2_ = squared(prober_.difference(first, truth));
    sampleUs_ = prober_.time(middle_, probeSpp_);
    const Image own = prober_.mosaic();
    const double some = prober_.difference(own, truth);

    // Squared noise falls as spp^-power. The truth is noisy as well, by an amount that depends on
    // the power, so that we iterate.
    const double most = budget_.inCodes ? kMostCodesPower : kMostFlipPower;
    for (int i = 0; i < 3 && noise2_ > 0 && probeSpp_ > 1; ++i) {
      const double rest = noise2_ * std::pow(kTruthFactor * probeSpp_, -power_);
      const double some2 = std::max(squared(some) - rest, squared(some) / 4);
      power_ = std::clamp(std::log(noise2_ / some2) / std::log(probeSpp_), kLeastPower, most);
    }

    for (Ladder& ladder : ladders_) {
      if (ladder.off.empty()) {
        // One sample is enough to measure a bias, because all values share its noise.
        const std::vector<Image> shown = renderLevels(1, firstUs, first, ladder);
        const bool toExact = ladder.levels.back().value == ladder.exact;
        for (std::size_t i = 0; i < shown.size(); ++i) {
          ladder.levels[i].bias2 =
              squared(prober_.difference(shown[i], shown[toExact ? shown.size() - 1 : 0]));
        }
        continue;
      }

      const std::vector<Image> shown = renderLevels(probeSpp_, sampleUs_, own, ladder);
      for (std::size_t i = 1; i < shown.size(); ++i) {
        Level& level = ladder.levels[i];
        // Pooling tells bias from noise: means of many pixels show what all of them lack.
        if (level.value == ladder.off) level.bias2 = pooledBias2(shown[i], own, truth);
        // No level has more noise than the middle, so a positive difference is a measuring error.
        const double more =
            squared(prober_.difference(shown[i], truth)) - level.bias2 - squared(some);
        level.noise2 = std::min(more, 0.0) * std::pow(probeSpp_, power_);
      }
    }
  }

  // Returns the squared bias of the picture without samples of a knob. The truth's own noise is
  // subtracted by its share in the difference of two pictures that differ in nothing but noise.
  double pooledBias2(const Image& off, const Image& own, const Image& truth) const {
    const Image mean = pooled(truth);
    const double noise2 = squared(prober_.difference(pooled(own), mean)) / (1 + kTruthFactor);
    return std::max(squared(prober_.difference(pooled(off), mean)) - noise2, 0.0);
  }

  // Renders a picture with each value and sets the values' costs; the first picture and its time
  // are known. Values that there is no time for are left out.
  std::vector<Image> renderLevels(int spp, double us, const Image& first, Ladder& ladder) {
    std::vector<Image> shown{first};
    for (std::size_t i = 1; i < ladder.levels.size(); ++i) {
      const bool isLate = timed() && clock_.ms() > kMostProbeShare * budget_.ms;
      if (isLate && (i > 1 || probeSpp_ > 1)) {
        ladder.levels.resize(i);
        break;
      }

      RenderOptions options = middle_;
      setOption(options, ladder.name, ladder.levels[i].value);
      ladder.levels[i].cost = prober_.time(options, spp) / us;
      shown.push_back(prober_.mosaic());
    }
    return shown;
  }

  double wantedError() const { return budget_.error / kTargetMargin; }

  // Sets the samples of the combination, and the cost and error of the picture by its levels.
  void complete(Combination& c, double leftMs) const {
    // Costs multiply, and squared errors add up.
    double bias2 = 0, noise2 = noise2_, ms = scale_ * sampleUs_ * prober_.pixels() / 1e3;
    for (std::size_t i = 0; i < ladders_.size(); ++i) {
      const Level& level = ladders_[i].levels[c.levels[i]];
      bias2 += level.bias2;
      noise2 += level.noise2;
      ms *= level.cost;
    }

    // Noise far below the middle's is taken for a measuring error.
    noise2 = std::max(noise2, kLeastNoise * noise2_);

    c.spp = middle_.spp;
    if (!fixed_.contains("spp")) {
      const auto samplesFor = [&](double error2) {
        return error2 > 0 ? std::ceil(std::pow(noise2 / error2, 1 / power_)) : kSppLimit;
      };

      // More samples than take the noise below what anybody could see buy nothing.
      const double unseen = budget_.inCodes ? kUnseenCodes : kUnseenFlip;
      // Making a pattern of samples takes a time that grows with their square.
      const double most = kSppOfRootMs * std::sqrt(budget_.ms);

      // A budget takes as many samples as fit; a target, as many as bring the noise down to the
      // part of the error that the bias leaves.
      const double spp = timed() ? std::min({kAim * leftMs / ms, samplesFor(squared(unseen)), most})
                                 : samplesFor(squared(wantedError()) - bias2);
      c.spp = static_cast<int>(std::clamp(spp, 1.0, double{kSppLimit}));
    }

    c.bias = std::sqrt(bias2);
    c.total = {ms * c.spp, std::sqrt(bias2 + noise2 * std::pow(c.spp, -power_))};
  }

  // Returns the best combination of levels, or the one that is nearest to the budget or target.
  Combination search() const {
    std::vector<Combination> all;
    std::vector<CostAndError> costs, errors;
    Combination c;
    const double left = leftMs();

    // The levels of all ladders are counted up like the digits of a number.
    bool more = true;
    while (more) {
      complete(c, left);
      all.push_back(c);

      // Each value beside the middle's has to win by a margin, because it may only seem better.
      const auto same = static_cast<double>(std::ranges::count(c.levels, std::size_t{0}));
      const double doubt = std::pow(1 + kDoubt * kBlockSide / std::sqrt(probed_),
                                    static_cast<double>(c.levels.size()) - same);
      costs.push_back({c.total.cost, c.total.error * doubt});
      errors.push_back({c.total.error, c.total.cost * doubt});

      more = false;
      for (std::size_t i = 0; i < ladders_.size() && !more; ++i) {
        more = ++c.levels[i] < ladders_[i].levels.size();
        if (!more) c.levels[i] = 0;
      }
    }

    constexpr double kAny = std::numeric_limits<double>::infinity(), kRounding = 1 + 1e-9;
    const auto best =
        timed() ? bestWithin(costs, kAim * left) : bestWithin(errors, wantedError() * kRounding);
    // If nothing fits, we take the cheapest combination, or for a target the most accurate one.
    return all[best.value_or(bestWithin(timed() ? errors : costs, kAny).value_or(0))];
  }

  RenderOptions optionsOf(const Combination& c) const {
    RenderOptions options = middle_;
    for (std::size_t i = 0; i < ladders_.size(); ++i) {
      setOption(options, ladders_[i].name, ladders_[i].levels[c.levels[i]].value);
    }

    options.spp = c.spp;
    options.channels = measured_;
    return options;
  }

  Receipt receiptOf(const Combination& best) const {
    Receipt r;
    r.budget = budget_;
    r.options = optionsOf(best);
    renderer_.setOptions(r.options);
    r.options.channels = channels_;

    // The receipt lists the chosen values, and among them those that are not exact.
    if (!fixed_.contains("spp")) r.chosen.emplace_back("spp", std::to_string(best.spp));
    if (wasAdaptive_ && !middle_.adaptive) r.chosen.emplace_back("adaptive", "off");
    for (std::size_t i = 0; i < ladders_.size(); ++i) {
      const Ladder& ladder = ladders_[i];
      const Level& level = ladder.levels[best.levels[i]];
      r.chosen.emplace_back(ladder.name, level.value);
      if (level.bias2 > 0 || level.value == ladder.off) {
        r.approximate.push_back({ladder.name, level.value, ladder.exact, std::sqrt(level.bias2)});
      }
    }

    r.bias = best.bias;
    setError(r, best.total.error);
    r.expectedMs = best.total.cost;

    // The note explains a budget or target that is missed, and time that is left over.
    const double left = leftMs();
    const bool isCheapest = best.spp == 1 || fixed_.contains("spp");
    if (timed() && isCheapest && r.expectedMs > kAim * left) {
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
  ChannelSet channels_, measured_;  // asked for, and of the picture
  bool wasAdaptive_;
  RenderOptions middle_;  // of which one knob at a time is changed
  Prober prober_;
  std::vector<Ladder> ladders_;
  int probeSpp_ = kSomeSpp;
  double probed_ = 1;                           // pixels
  double sampleUs_ = 0, scale_ = 1;             // of a sample of the middle
  double noise2_ = 0, power_ = kMostFlipPower;  // squared error of one sample; see measure()
};

}  // namespace

Budget parseBudget(const std::string& time, const std::string& target) {
  static const std::regex times("([0-9.]+)(ms|s|min)"), errors("flip=([0-9.e-]+)|([0-9.]+)codes");
  if (!time.empty() && !target.empty()) {
    throwUsage("--budget gives the time and --target the error: give one of them");
  }

  Budget budget;
  std::smatch parts;
  if (std::regex_match(time, parts, times) && readNumber(parts[1].str(), budget.ms)) {
    if (parts[2] == "s") budget.ms *= 1e3;
    if (parts[2] == "min") budget.ms *= 60e3;
  }
  if (!time.empty() && !(budget.ms >= 1 && budget.ms <= kMostMs)) {
    throwUsage("--budget: expected a time of at least 1 ms, as 50ms, 10s or 2min, found '" + time +
               "'");
  }

  if (std::regex_match(target, parts, errors)) {
    budget.inCodes = parts[2].matched;
    readNumber(parts[budget.inCodes ? 2 : 1].str(), budget.error);
  }
  if (!target.empty() && !(budget.error > 0 && budget.error <= (budget.inCodes ? 255 : 1))) {
    throwUsage("--target: expected an error above 0, as 0.5codes or flip=0.01, found '" + target +
               "'");
  }

  return budget;
}

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

void assess(Receipt& r, Renderer& renderer, const Camera& camera, double ms, Film& film) {
  const Stopwatch clock;
  if (renderer.options().channels.has(Channel::error)) {
    Image noisy = film.image, steady = film.image, whole = film.image;
    const double brightest = brightestRadiance(renderer.scene(), film.image);
    const std::span<const float> errors = std::as_const(film.channels).floats(Channel::error);
    const std::vector<double> radiance = pooledRadiance(film);
    std::mt19937 random;
    std::uniform_real_distribution<float> noise(-std::sqrt(3.0f), std::sqrt(3.0f));  // variance 1

    // Three pictures differ from the rendered one: by noise of the estimated size, by the same
    // noise only where enough samples decide a pixel, and by the most light that ended paths could
    // bring.
    for (std::size_t i = 0; i < film.image.pixels.size(); ++i) {
      const double error = double{errors[2 * i]};
      const Rgb change(noise(random) * errors[2 * i]);
      noisy.pixels[i] += change;
      if (kFewSamples * squared(error) <= squared(radiance[i])) steady.pixels[i] += change;
      whole.pixels[i] += Rgb(static_cast<float>(brightest * double{errors[2 * i + 1]}));
    }

    Prober prober(renderer, camera, film, r.budget.inCodes);
    // Squares of codes may come from a few pixels, so that a target in codes takes all.
    const double pixels =
        r.budget.inCodes ? prober.pixels() : 1e3 * kAssessShare * ms / kFlipMicroseconds;
    prober.chooseBlocks(kBlockSide, std::max(pixels / squared(kBlockSide), kLeastBlocks));

    const Image shown = prober.mosaic();
    r.ended = prober.difference(prober.mosaic(whole), shown);
    const double sampled = prober.difference(prober.mosaic(noisy), shown);

    double most = r.error, known = sampled;
    if (r.options.spp > 1) {
      // Samples that are spread evenly have less noise than the channel says.
      most = std::sqrt(squared(r.bias) + squared(sampled));
      setError(r, std::min(r.error, most));
      r.high = kChannelMargin * most;
      known = prober.difference(prober.mosaic(steady), shown);
    }

    // Against one random path a pixel, what depth and other knobs leave out is measured too low.
    const bool isMeasured = r.options.spp > 1 && squared(r.bias) < 0.5 * squared(r.error);
    const bool isRandom = samplesLobes(renderer.plan().effects) && !isMeasured;
    if (isRandom || squared(known) < kLeastKnown * squared(sampled)) leaveUnknown(r, most);
  }

  film.channels.keepOnly(r.options.channels);
  renderer.setOptions(r.options);
  r.measuredMs = ms + clock.ms();
}

std::string receiptText(const Receipt& r, const std::string& command) {
  const char* const unit = r.budget.inCodes ? "codes" : "FLIP";
  std::string text = "  chosen ";
  std::string options;
  for (const auto& [name, value] : r.chosen) options += " --" + name + " " + value;
  text += options.empty() ? "nothing: every option was given" : options.substr(1);

  text += "\n  left out";
  for (const Receipt::Knob& knob : r.approximate) {
    text += " " + knob.name + " " + knob.exact;
    if (knob.error > 0) text += formatted(" (%s %.4f)", unit, knob.error);
  }
  if (r.approximate.empty()) text += " nothing but samples";

  text += formatted("\n  time %.0f ms: %.0f to choose, %.0f for the picture (expected %.0f)",
                    r.usedMs(), r.probeMs, r.measuredMs, r.expectedMs);
  if (r.budget.ms > 0) text += formatted(", %.0f %% of the budget", 100 * r.usedMs() / r.budget.ms);

  text += formatted("\n  error %.4f %s, ", r.error, unit);
  text += std::isinf(r.high) ? "by what the samples tell; not known"
                             : formatted("between %.4f and %.4f", r.low, r.high);
  if (r.ended) text += formatted("; --depth and --cutoff left out at most %.4f", *r.ended);

  text += "\n";
  if (!r.note.empty()) text += "  note: " + r.note + "\n";
  if (!command.empty()) text += "  the same picture: " + command + options + "\n";
  return text;
}

}  // namespace whit
