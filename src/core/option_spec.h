// What is known of an option, apart from its value.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string_view>

#include "core/effects.h"

namespace whit {

// What a renderer has to make anew when an option changes, each with all that is before it.
enum class Rebuild {
  nothing,  // each frame is told, or it is no matter of a renderer's
  frame,    // the plan of the frames to come
  tables,   // the shading tables, if the plan calls for others
  workers,  // threads, their tiles and queues
  acceleration,
  scene,  // it is loaded again, which no renderer does
};

// What an inexact value costs the picture: rounding (the same rays, computed otherwise), rays and
// terms that are left out or approximated within Whitted's model, too few samples of a pixel, or
// light that the model leaves out.
enum class Cause { arithmetic, algorithm, sampling, transport };

// What a scene must have for an option to do anything there: one of these effects.
struct Need {
  EffectSet oneOf;
  std::string_view without;  // what is said of a scene that has none of them
};

// An option that trades accuracy for time, as `whit accuracy` sweeps it. Values are the words of
// the command line, and lists of them have blanks between.
struct KnobSpec {
  Cause cause = Cause::algorithm;
  std::string_view exact = {};
  std::string_view values = {};  // those that are swept
  std::string_view crossed =
      {};  // those of them that take part in the combinations of a full sweep
  // Those that lie between others, or make the same picture by construction: a quick sweep has them
  // last, and does without when its minute is over.
  std::string_view spare = {};
  // What else values that are not exact need to have an effect, as on the command line.
  std::string_view alongside = {};
  // With the exact value, rays that branch would never end: where there are such rays it is not
  // swept, and a small one stands for it.
  bool endless = false;
  std::array<Need, 2> needs = {};  // all of them
};

// Where the viewer's panel has a control for it.
enum class Tab { none, knobs, picture };

// Words with '|' between them are the only ones that are accepted; of an enumeration they stand in
// the order of its enumerators. No words: a flag.
struct OptionSpec {
  std::string_view name = {}, words = {};
  double low = std::numeric_limits<double>::lowest();
  double high = std::numeric_limits<double>::max();
  std::string_view help = {};
  Rebuild rebuilds = Rebuild::frame;
  // Whether it can change a bit of the picture. The others cannot by design: the bits do not depend
  // on how the work is shared out.
  bool changesPicture = true;
  Tab tab = Tab::knobs;
  // The value that the viewer measures the cost of others against: the cheapest that still makes a
  // picture of the scene. Empty: not measured.
  std::string_view cheapest = {};
  // Whether --help has it; the others are in --help-all.
  bool everyday = false;
  std::optional<KnobSpec> knob = {};
};

}  // namespace whit
