// A picture within a time, or of an error (--budget, --target): the options are chosen by a model
// of cost and error that small pictures of the view are measured for.
//
// Costs of knobs are factors of the time of a sample. Errors of knobs that approximate add up in
// squares; noise is a power of the number of samples. The number of samples is chosen last, by the
// time that the chosen options take for some tiles of the very picture.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/options.h"
#include "render/renderer.h"

namespace whit {

struct Budget {
  double ms = 0;         // time of the picture and of all that is measured for it; 0: any
  double error = 0;      // 0: any
  bool inCodes = false;  // the error is the root mean square in 8-bit codes, else the mean FLIP
  bool isSet() const { return ms > 0 || error > 0; }
};

// Reads "50ms", "10s" or "2min", and "0.5codes" or "flip=0.01"; either may be empty. Throws
// Error(usage) for others, and if both are given.
Budget parseBudget(const std::string& time, const std::string& target);

// Tells what was chosen, what was left out, and what it took.
struct Receipt {
  struct Knob {
    std::string name, value, exact;
    double error = 0;  // error that this value leaves by itself
  };
  Budget budget;
  RenderOptions options;
  std::vector<std::pair<std::string, std::string>> chosen;  // options and values, as given
  std::vector<Knob> approximate;                            // knobs that are not exact
  double probeMs = 0;                                       // spent on measuring and choosing
  double expectedMs = 0;                                    // expected time of the picture
  double measuredMs = 0;                                    // time of the picture, set by assess()
  double bias = 0;  // the part of the error that more samples would not take away
  // The upper bound is infinite where the error is not known: then it is what the samples tell.
  double error = 0, low = 0, high = 0;
  // Upper bound on the error from paths that depth and cutoff ended; not measured with --adaptive.
  std::optional<double> ended;
  std::string note;  // empty, or why budget or target are not met or the error is not known

  double usedMs() const { return probeMs + measuredMs; }
  // Sets the error to what the model expects, with the bounds of the model's own error.
  void setError(double value);
};

// Chooses the options that are not in `fixed`. `film` is that of the picture, whose pixels are
// overwritten. The renderer is left with the chosen options, and with the channel `error`.
Receipt chooseOptions(Renderer& renderer, const Camera& camera, const std::set<std::string>& fixed,
                      const Budget& budget, Film& film);

// Adds to the receipt what the picture itself tells, which took so long: the most noise by the
// channel `error`, unless few samples decide most of it, and the bound of what depth and cutoff
// left out by the brightest radiance of sky, emission and picture: nothing out of view is taken to
// be brighter. Leaves the channels that were asked for.
void assess(Receipt& receipt, Renderer& renderer, const Camera& camera, double ms, Film& film);

// Lines for people. The last is the command of the same picture, which ends with the words, unless
// they are empty.
std::string receiptText(const Receipt& receipt, const std::string& words);

}  // namespace whit
